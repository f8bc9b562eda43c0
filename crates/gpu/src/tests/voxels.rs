//! The volume brush (3DBrushVR §4.2) against the same worked out plainly.

use glam::{IVec3, Vec3};
use midair_field::Brick;
use midair_mesh::TriMesh;

use super::support::*;
use crate::{GpuSolid, SolidOptions};

/// A box of twelve triangles, or several.
fn boxes(all: &[(Vec3, Vec3)]) -> TriMesh {
    let mut mesh = TriMesh::default();
    for (low, high) in all {
        let first = mesh.positions.len() as u32;
        for i in 0..8 {
            let pick = |k: usize| if i >> k & 1 == 0 { low[k] } else { high[k] };
            mesh.positions.push(Vec3::new(pick(0), pick(1), pick(2)));
        }
        for quad in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            let q = quad.map(|v: u32| v + first);
            mesh.triangles
                .extend([[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
        }
    }
    mesh
}

#[test]
fn a_brush_is_its_voxels_smoothed() {
    let Some(gpu) = gpu() else { return };
    let step = 0.01;
    // Off the lattice, one wall across several words of a row.
    let (low, high) = (
        Vec3::new(-0.234, -0.121, -0.087),
        Vec3::new(0.312, 0.143, 0.092),
    );
    let solid = GpuSolid::from_mesh(&gpu, &boxes(&[(low, high)]), step).unwrap();
    // Touched or within: the nodes whose cubes meet the box.
    let (first, last) = (
        (low / step).round().as_ivec3(),
        (high / step).round().as_ivec3(),
    );
    let filled = |n: IVec3| n.cmpge(first).all() && n.cmple(last).all();
    let grid = solid.grid().unwrap();
    let mut compared = 0;
    for (c, brick) in grid.bricks() {
        for n in crate::solid::corners(c * 8, c * 8 + 7) {
            let around = crate::solid::corners(n - 1, n + 1)
                .filter(|n| filled(*n))
                .count();
            let expected = (0.5 - around as f32 / 27.0) * 3.0 * step;
            match brick {
                Brick::Inside => assert_eq!(around, 27, "{n}"),
                Brick::Values { values, .. } => {
                    let l = n - c * 8;
                    let v = values[(l.x + 8 * (l.y + 8 * l.z)) as usize];
                    assert!((v - expected).abs() < 1e-6 * step, "{n}: {v} {expected}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 10_000);
    let mesh = solid.mesh().unwrap();
    assert_sound(&mesh, "a box as a brush");
    // Half a voxel beyond the outermost filled nodes.
    let size = (last - first + 1).as_dvec3() * f64::from(step);
    let volume = size.element_product();
    assert!(
        (mesh.volume() / volume - 1.0).abs() < 0.02,
        "{} {volume}",
        mesh.volume()
    );
}

#[test]
fn buffers_that_held_something_else_hold_a_brush_as_new_ones_do() {
    let Some(gpu) = gpu() else { return };
    let step = 0.01;
    let small = boxes(&[(Vec3::splat(-0.06), Vec3::splat(0.07))]);
    let large = boxes(&[(Vec3::new(-0.3, -0.1, -0.2), Vec3::new(0.2, 0.1, 0.25))]);
    let fresh = |mesh: &TriMesh| GpuSolid::from_mesh(&gpu, mesh, step).unwrap();
    let same = |a: &GpuSolid, b: &GpuSolid, name: &str| {
        assert_eq!(a.size(), b.size(), "{name}");
        assert_sound(&a.mesh().unwrap(), name);
        let (far, signs, compared) = difference(&a.grid().unwrap(), &b.grid().unwrap(), 1.5, 0.01);
        assert!(
            far == 0.0 && signs == 0 && compared > 500,
            "{name}: {far}, {signs} of {compared}"
        );
    };
    let program = compile(&nested(), 0.02);
    let quantised = SolidOptions {
        quantised: true,
        ..SolidOptions::default()
    };
    for options in [SolidOptions::default(), quantised] {
        let mut solid = GpuSolid::make_with(&gpu, &program, options).unwrap();
        for mesh in [&small, &large, &small] {
            solid.make_again_from(mesh, step).unwrap();
            same(&solid, &fresh(mesh), "a brush");
        }
        // And a solid again, as if nothing had been there.
        solid.update(&program).unwrap();
        let anew = GpuSolid::make_with(&gpu, &program, options).unwrap();
        same(&solid, &anew, "a solid");
    }
}

#[test]
fn what_lies_between_two_boxes_stays_empty() {
    let Some(gpu) = gpu() else { return };
    let a = (Vec3::splat(-0.2), Vec3::splat(-0.05));
    let b = (Vec3::splat(0.05), Vec3::splat(0.2));
    let solid = GpuSolid::from_mesh(&gpu, &boxes(&[a, b]), 0.01).unwrap();
    let mesh = solid.mesh().unwrap();
    assert_sound(&mesh, "two boxes");
    let grid = solid.grid().unwrap();
    assert!(!grid.is_inside(IVec3::ZERO));
    assert!(grid.is_inside(IVec3::splat(12)) && grid.is_inside(IVec3::splat(-12)));
}

#[test]
fn a_brush_that_is_too_fine_or_nothing_is_refused() {
    let Some(gpu) = gpu() else { return };
    let mesh = boxes(&[(Vec3::splat(-1.0), Vec3::splat(1.0))]);
    assert!(GpuSolid::from_mesh(&gpu, &mesh, 1e-5).is_err());
    assert!(GpuSolid::from_mesh(&gpu, &mesh, f32::NAN).is_err());
    assert!(GpuSolid::from_mesh(&gpu, &TriMesh::default(), 0.01).is_err());
}
