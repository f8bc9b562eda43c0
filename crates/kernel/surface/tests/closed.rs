//! Whatever a field holds, its surface is closed and manifold.

mod common;

use common::{Random, any_brick, any_grid, assert_sound, values, volume};
use glam::{IVec3, Vec3};
use midair_field::{Brick, Grid};
use midair_surface::{Surface, grid_from_fn};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn any_field_gives_a_sound_mesh(
        kinds in prop::collection::vec(0u64..12, 12),
        low in prop::array::uniform3(-3i32..3),
        seed: u64,
    ) {
        let grid = any_grid(&kinds, low.into(), 0.01, seed);
        assert_sound(&Surface::extract(&grid).mesh());
    }

    #[test]
    fn one_kind_of_brick_alone_gives_a_sound_mesh(
        kind in 0u64..12,
        low in prop::array::uniform3(-130i32..130),
        seed: u64,
    ) {
        // A millimetre step a metre from the origin: the coarsest f32 gets in practice.
        let grid = any_grid(&[kind; 12], low.into(), 0.001, seed);
        assert_sound(&Surface::extract(&grid).mesh());
    }

    #[test]
    fn far_from_the_origin_triangles_keep_their_area(power in 7u32..18, seed: u64) {
        let low = IVec3::new(1 << power, -(1 << power), 3);
        let grid = any_grid(&[9; 4], low, 0.001, seed);
        assert_sound(&Surface::extract(&grid).mesh());
    }
}

#[test]
fn every_kind_of_neighbour_is_met() {
    let mut r = Random(5);
    for a in 0..12 {
        for b in 0..12 {
            for d in [
                IVec3::X,
                IVec3::Y,
                IVec3::Z,
                IVec3::ONE,
                IVec3::NEG_X + IVec3::Z,
            ] {
                let mut grid = Grid::new(0.005);
                grid.set(IVec3::ZERO, any_brick(a, 0.005, &mut r));
                grid.set(d, any_brick(b, 0.005, &mut r));
                assert_sound(&Surface::extract(&grid).mesh());
            }
        }
    }
}

#[test]
fn a_lone_inside_brick_is_a_box() {
    let mut grid = Grid::new(0.5);
    grid.set(IVec3::ZERO, Some(Brick::Inside));
    let mesh = Surface::extract(&grid).mesh();
    assert_sound(&mesh);
    // The surface lies half a step beyond its nodes, corners cut.
    assert!(
        (volume(&mesh) / 64.0 - 1.0).abs() < 0.03,
        "{}",
        volume(&mesh)
    );
}

#[test]
fn a_false_summary_does_not_open_the_surface() {
    for (low, high) in [(1.0, 2.0), (-2.0, -1.0), (f32::NAN, f32::NAN), (-1.0, 0.0)] {
        let mut r = Random(3);
        let mut grid = any_grid(&[2; 12], IVec3::ZERO, 0.01, 1);
        let Brick::Values { values, .. } = values(|_| r.signed()) else {
            unreachable!()
        };
        let lie = Brick::Values {
            values,
            min: low,
            max: high,
        };
        grid.set(IVec3::new(1, 1, 0), Some(lie));
        assert_sound(&Surface::extract(&grid).mesh());
    }
}

#[test]
fn nothing_comes_of_nothing() {
    for step in [0.01, 0.0, -1.0, f32::NAN, f32::INFINITY] {
        let mesh = Surface::extract(&Grid::new(step)).mesh();
        assert!(mesh.positions.is_empty() && mesh.triangles.is_empty());
    }
    let mut unsound = Grid::new(f32::NAN);
    unsound.set(IVec3::ZERO, Some(Brick::Inside));
    assert_eq!(Surface::extract(&unsound).triangles(), 0);
}

#[test]
fn coordinates_at_the_end_of_their_range_do_no_harm() {
    for at in [i32::MIN, i32::MAX, i32::MAX / 8] {
        let mut grid = Grid::new(0.01);
        grid.set(IVec3::splat(at), Some(Brick::Inside));
        let mut surface = Surface::extract(&grid);
        surface.update(&grid, &[IVec3::splat(at)]);
        let _ = surface.mesh();
    }
}

#[test]
fn a_sphere_is_where_it_should_be() {
    let (centre, radius) = (Vec3::splat(0.5), 0.4);
    let mut errors = Vec::new();
    for n in [33, 65] {
        let step = 1.0 / (n - 1) as f32;
        let grid = grid_from_fn([n; 3], step, 8.0 * step, |p| p.distance(centre) - radius);
        let mesh = Surface::extract(&grid).mesh();
        assert_sound(&mesh);
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            assert!((p.distance(centre) - radius).abs() < 0.2 * step * step / radius + 1e-6);
            assert!(n.dot((p - centre).normalize()) > 0.999);
        }
        let exact = 4.0 / 3.0 * std::f64::consts::PI * 0.064;
        errors.push((volume(&mesh) / exact - 1.0).abs());
    }
    assert!(
        errors[1] < 0.002 && errors[1] < 0.3 * errors[0],
        "{errors:?}"
    );
}
