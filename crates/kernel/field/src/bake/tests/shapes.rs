use std::f32::consts::{PI, TAU};

use glam::Vec3;
use midair_mesh::TriMesh;

/// A closed ball.
pub fn ball(radius: f32, around: u32, rings: u32) -> TriMesh {
    let mut mesh = TriMesh::default();
    mesh.positions.push(Vec3::new(0.0, 0.0, radius));
    for i in 1..rings {
        let a = i as f32 / rings as f32 * PI;
        for j in 0..around {
            let b = j as f32 / around as f32 * TAU;
            let p = Vec3::new(a.sin() * b.cos(), a.sin() * b.sin(), a.cos());
            mesh.positions.push(radius * p);
        }
    }
    mesh.positions.push(Vec3::new(0.0, 0.0, -radius));
    let last = mesh.positions.len() as u32 - 1;
    let at = |i: u32, j: u32| 1 + (i - 1) * around + j % around;
    for j in 0..around {
        mesh.triangles.push([0, at(1, j), at(1, j + 1)]);
        mesh.triangles
            .push([last, at(rings - 1, j + 1), at(rings - 1, j)]);
        for i in 1..rings - 1 {
            mesh.triangles
                .push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            mesh.triangles
                .push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    mesh
}

/// A closed torus around z.
pub fn torus(large: f32, small: f32, around: u32, across: u32) -> TriMesh {
    let mut mesh = TriMesh::default();
    for i in 0..around {
        for j in 0..across {
            let a = i as f32 / around as f32 * TAU;
            let b = j as f32 / across as f32 * TAU;
            let r = large + small * b.cos();
            mesh.positions
                .push(Vec3::new(r * a.cos(), r * a.sin(), small * b.sin()));
            let at = |i: u32, j: u32| (i % around) * across + j % across;
            let (p, q, r, s) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            mesh.triangles.extend([[p, q, r], [p, r, s]]);
        }
    }
    mesh
}

/// The upper half of a ball, as a shell without a lid.
pub fn bowl(radius: f32) -> TriMesh {
    let mut mesh = ball(radius, 48, 24);
    let positions = mesh.positions.clone();
    mesh.triangles
        .retain(|t| t.iter().all(|&v| positions[v as usize].z > -1e-5 * radius));
    mesh
}

pub fn moved(mut mesh: TriMesh, by: Vec3) -> TriMesh {
    mesh.positions.iter_mut().for_each(|p| *p += by);
    mesh
}

pub fn inverted(mut mesh: TriMesh) -> TriMesh {
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    mesh
}

pub fn joined(mut a: TriMesh, b: &TriMesh) -> TriMesh {
    let first = a.positions.len() as u32;
    a.positions.extend(&b.positions);
    a.triangles
        .extend(b.triangles.iter().map(|t| t.map(|v| v + first)));
    a
}
