//! Times the bake of a torus of 25,600 triangles, and of the mesh files named, at 128 nodes a
//! side, beside parry3d's signed distance at the same nodes.
//!
//! `RAYON_NUM_THREADS=2 cargo run -p midair-field --example bake -- [MESH]...`

use std::path::PathBuf;
use std::time::Instant;

use glam::{UVec3, Vec3};
use midair_field::bake::{BakeOptions, Progress, Volume, bake};
use midair_mesh::TriMesh;
use parry3d::math::Vector;
use parry3d::query::PointQueryWithLocation;
use rayon::prelude::*;

const NODES: u32 = 128;
const RUNS: usize = 9;

fn torus(around: u32, across: u32, large: f32, small: f32) -> TriMesh {
    let mut mesh = TriMesh::default();
    for i in 0..around {
        for j in 0..across {
            let a = i as f32 / around as f32 * std::f32::consts::TAU;
            let b = j as f32 / across as f32 * std::f32::consts::TAU;
            let r = large + small * b.cos();
            let p = Vec3::new(r * a.cos(), r * a.sin(), small * b.sin());
            mesh.positions.push(p);
            let at = |i: u32, j: u32| (i % around) * across + j % across;
            let (p, q, r, s) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            mesh.triangles.extend([[p, q, r], [p, r, s]]);
        }
    }
    mesh
}

fn node(i: usize) -> Vec3 {
    let i = i as u32;
    let at = UVec3::new(i % NODES, i / NODES % NODES, i / (NODES * NODES));
    (at.as_vec3() + 0.5) * (2.0 / NODES as f32) - 1.0
}

fn compare(name: &str, mut mesh: TriMesh) -> anyhow::Result<()> {
    let b = mesh.bounds();
    let scale = 1.7 / b.size().max_element();
    for p in &mut mesh.positions {
        *p = (*p - b.centre()) * scale;
    }
    let step = 2.0 / NODES as f32;
    let options = BakeOptions {
        step,
        // The nodes are the middles of 128³ cells over [-1, 1]³.
        padding: 1.0 - 0.85 - 0.5 * step,
    };
    let mut times = Vec::new();
    let mut volume: Option<Volume> = None;
    for _ in 0..RUNS {
        let start = Instant::now();
        volume = Some(bake(&mesh, &options, &Progress::new())?);
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    times.sort_by(f64::total_cmp);
    let ours = times[RUNS / 2];
    let Some(volume) = volume else { return Ok(()) };

    let points = mesh
        .positions
        .iter()
        .map(|p| Vector::new(p.x, p.y, p.z))
        .collect();
    let flags = parry3d::shape::TriMeshFlags::ORIENTED;
    let peer = parry3d::shape::TriMesh::with_flags(points, mesh.triangles.clone(), flags)?;
    let start = Instant::now();
    let theirs: Vec<f32> = (0..NODES.pow(3) as usize)
        .into_par_iter()
        .map(|i| {
            let n = node(i);
            let p = Vector::new(n.x, n.y, n.z);
            // Only with the location does it know the pseudo-normal, and so the sign.
            let (found, _) = peer.project_local_point_and_get_location(p, false);
            let d = (found.point - p).length();
            if found.is_inside { -d } else { d }
        })
        .collect();
    let peer_time = start.elapsed().as_secs_f64() * 1e3;

    let (mut band, mut most, mut wrong, mut inside) = (0.0f32, 0.0f32, 0, 0);
    for (i, &d) in theirs.iter().enumerate() {
        let s = volume.sample(node(i));
        if d.abs() < 1.5 * step {
            band = band.max((s.abs() - d.abs()).abs() / step);
        }
        most = most.max(s.abs() / d.abs().max(step));
        wrong += usize::from((s < 0.0) != (d < 0.0) && d.abs() > 1e-3 * step);
        inside += usize::from(s < 0.0);
    }
    println!(
        "{name}: median {ours:.1} ms (least {:.1}, greatest {:.1}), {:.1} MB; parry3d {peer_time:.0} ms, ratio {:.4}",
        times[0],
        times[RUNS - 1],
        volume.bytes() as f64 / 1e6,
        ours / peer_time
    );
    println!(
        "  within 1.5 steps |φ|, interpolated across z, differs by at most {band:.1e} steps; claims at most {most:.3} of the distance; {wrong} signs differ; volume {:.5}",
        inside as f64 * f64::from(step).powi(3)
    );
    Ok(())
}

fn main() -> anyhow::Result<()> {
    compare("torus-25k/128", torus(160, 80, 0.6, 0.25))?;
    for path in std::env::args_os().skip(1).map(PathBuf::from) {
        let name = path.display().to_string();
        compare(&name, midair_mesh::read(&path)?.mesh)?;
    }
    Ok(())
}
