use glam::{Quat, Vec3};
use proptest::prelude::*;

use super::{compile, point, solid, zoo};
use crate::shape::{NODES, Points, Shape};
use crate::{Op, Placement, Primitive, Recipe};

fn shape(i: usize) -> Shape {
    Shape::new(&zoo()[i]).expect("sound")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_primitive_is_steeper_than_one(a in point(0.5), d in point(0.1)) {
        for (i, p) in zoo().iter().enumerate() {
            let s = shape(i);
            let (va, vb) = (s.at(a), s.at(a + d));
            prop_assert!((va - vb).abs() <= d.length() * 1.0001 + 2e-6, "{p:?}: {va} {vb}");
        }
    }

    #[test]
    fn boxes_hold_their_primitives(p in point(0.5)) {
        for (i, primitive) in zoo().iter().enumerate() {
            let b = primitive.bounds();
            let d = shape(i).at(p);
            let reach = b.distance(p);
            prop_assert!(reach == 0.0 || d >= reach - 1e-5, "{primitive:?}: {d} within {reach}");
        }
    }

    /// Walking the distance along the gradient leads to the surface, from inside and outside.
    #[test]
    fn outside_the_distance_is_reached(p in point(0.4)) {
        for (i, primitive) in zoo().iter().enumerate() {
            // Rims with corners beside them are lower bounds by declaration.
            if matches!(primitive, Primitive::Extrusion { rounding, .. } if *rounding > 0.0) {
                continue;
            }
            let s = shape(i);
            let d = s.at(p);
            let e = 1e-3;
            let slope = Vec3::new(
                s.at(p + Vec3::X * e) - s.at(p - Vec3::X * e),
                s.at(p + Vec3::Y * e) - s.at(p - Vec3::Y * e),
                s.at(p + Vec3::Z * e) - s.at(p - Vec3::Z * e),
            ) / (2.0 * e);
            // Not at a ridge, where the gradient is that of neither side.
            if (slope.length() - 1.0).abs() < 1e-3 {
                let foot = p - slope.normalize() * d;
                prop_assert!(s.at(foot).abs() < 2e-3, "{primitive:?} at {p}: {d}, {}", s.at(foot));
            }
        }
    }

    #[test]
    fn bricks_hold_what_points_hold(centre in point(0.3), step in 0.002f32..0.03) {
        let mut points = Points {
            x: [0.0; NODES], y: [0.0; NODES], z: [0.0; NODES],
            centre: centre + 3.5 * step,
            radius: 3.5 * step * 1.7321,
        };
        for i in 0..NODES {
            points.x[i] = centre.x + (i & 7) as f32 * step;
            points.y[i] = centre.y + (i >> 3 & 7) as f32 * step;
            points.z[i] = centre.z + (i >> 6) as f32 * step;
        }
        let mut out = [0.0; NODES];
        for (k, primitive) in zoo().iter().enumerate() {
            let s = shape(k);
            s.brick(&points, &mut out);
            for (i, out) in out.iter().enumerate() {
                let at = s.at(Vec3::new(points.x[i], points.y[i], points.z[i]));
                prop_assert!((at - out).abs() < 1e-6, "{primitive:?}: {at} {out}");
            }
        }
    }

    #[test]
    fn scale_keeps_the_surface(p in point(0.4), turn in point(3.0), sx in 0.4f32..2.5, sz in 0.4f32..2.5) {
        let scale = Vec3::new(sx, -1.0, sz);
        let placement = Placement { translation: Vec3::ZERO, rotation: Quat::from_scaled_axis(turn), scale };
        let outer = Placement { translation: Vec3::ZERO, rotation: Quat::IDENTITY, scale: Vec3::new(1.0, 2.0, 1.0) };
        for (i, primitive) in zoo().iter().enumerate() {
            let recipe: Recipe = primitive.clone().into();
            let once = solid(&[(Op::Union, &recipe, placement)]);
            let twice = solid(&[(Op::Union, &once, outer)]);
            for (recipe, to_world) in [(&once, placement.affine()), (&twice, outer.affine() * placement.affine())] {
                let world = to_world.transform_point3(p);
                let (local, d) = (shape(i).at(p), compile(recipe).at(world));
                if local.abs() > 1e-5 {
                    prop_assert_eq!(local < 0.0, d < 0.0, "{:?}: {} {}", primitive, local, d);
                }
            }
        }
    }
}

#[test]
fn known_distances() {
    let at = |p: Primitive, x: f32, y: f32, z: f32| {
        Shape::new(&p).expect("sound").at(Vec3::new(x, y, z))
    };
    let close = |a: f32, b: f32| assert!((a - b).abs() < 2e-6, "{a} is not {b}");
    let cuboid = |rounding| Primitive::Cuboid {
        half: Vec3::splat(0.1),
        rounding,
    };
    close(at(cuboid(0.0), 0.2, 0.2, 0.0), 0.1 * 2f32.sqrt());
    close(at(cuboid(0.02), 0.2, 0.0, 0.0), 0.1);
    close(at(cuboid(0.0), 0.0, 0.0, 0.03), -0.07);
    let cone = Primitive::Frustum {
        bottom: 0.1,
        top: 0.0,
        half_height: 0.1,
    };
    close(at(cone.clone(), 0.0, 0.3, 0.0), 0.2);
    close(at(cone, 0.0, -0.3, 0.0), 0.2);
    let ellipsoid = Primitive::Ellipsoid {
        half: Vec3::new(0.3, 0.2, 0.1),
    };
    close(at(ellipsoid.clone(), 0.0, 0.0, 0.0), -0.1);
    close(at(ellipsoid.clone(), 0.5, 0.0, 0.0), 0.2);
    close(at(ellipsoid, 0.0, 0.0, 0.4), 0.3);
    let helix = Primitive::Helix {
        major: 0.2,
        minor: 0.05,
        pitch: 0.3,
        turns: 2.0,
    };
    close(at(helix.clone(), 0.2, 0.0, 0.0), -0.05);
    close(at(helix.clone(), -0.2, 0.15, 0.0), -0.05);
    close(at(helix, 0.2, 0.6, 0.0), 0.25);
}

/// Against a fine sampling of the curve.
#[test]
fn the_helix_finds_its_closest_turn() {
    for (pitch, turns) in [
        (0.1, 2.6),
        (0.02, 3.0),
        (1.5, 0.7),
        (-0.3, 1.25),
        (4.0, 0.1),
    ] {
        let (major, minor) = (0.15, 0.01);
        let helix = Primitive::Helix {
            major,
            minor,
            pitch,
            turns,
        };
        let s = Shape::new(&helix).expect("sound");
        let curve: Vec<Vec3> = (0..=20_000)
            .map(|i| {
                let t = std::f32::consts::PI * turns * (i as f32 / 10_000.0 - 1.0);
                let (sin, cos) = t.sin_cos();
                Vec3::new(
                    major * cos,
                    pitch.abs() * t / std::f32::consts::TAU,
                    major * sin * pitch.signum(),
                )
            })
            .collect();
        for k in 0..300 {
            let f = |m: usize| ((k * m) % 101) as f32 / 101.0 - 0.5;
            let p = Vec3::new(f(37), 0.8 * f(59), f(83));
            let nearest = curve
                .iter()
                .map(|c| c.distance_squared(p))
                .fold(f32::MAX, f32::min);
            let (exact, found) = (nearest.sqrt() - minor, s.at(p));
            assert!(
                (exact - found).abs() < 3e-5,
                "pitch {pitch} at {p}: {found} for {exact}"
            );
        }
    }
}
