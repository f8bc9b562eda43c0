//! The tests of crates/gpu look at the same: this file names nothing but what stands around it.

use glam::{Vec2, Vec3};

use super::Primitive;

/// One of every kind.
pub(crate) fn zoo() -> Vec<Primitive> {
    let star: Vec<Vec2> = (0..10)
        .map(|i| {
            let r = if i % 2 == 0 { 0.2 } else { 0.08 };
            r * Vec2::from_angle(0.2 * std::f32::consts::PI * i as f32)
        })
        .collect();
    let ring = |n: usize, r: f32, c: Vec2| -> Vec<Vec2> {
        let angle = |i: usize| std::f32::consts::TAU * i as f32 / n as f32;
        (0..n).map(|i| c + r * Vec2::from_angle(angle(i))).collect()
    };
    let box_points = |h: Vec3| -> Vec<Vec3> {
        (0..8)
            .map(|i| {
                h * Vec3::new(
                    [-1.0, 1.0][i & 1],
                    [-1.0, 1.0][i >> 1 & 1],
                    [-1.0, 1.0][i >> 2],
                )
            })
            .collect()
    };
    let ball: Vec<Vec3> = (0..60)
        .map(|i| {
            let (y, t) = (1.0 - 2.0 * (i as f32 + 0.5) / 60.0, i as f32 * 2.4);
            0.2 * Vec3::new(
                (1.0 - y * y).sqrt() * t.cos(),
                y,
                (1.0 - y * y).sqrt() * t.sin(),
            )
        })
        .collect();
    vec![
        Primitive::Sphere { radius: 0.2 },
        Primitive::Cuboid {
            half: Vec3::new(0.2, 0.1, 0.15),
            rounding: 0.0,
        },
        Primitive::Cuboid {
            half: Vec3::new(0.2, 0.1, 0.15),
            rounding: 0.05,
        },
        Primitive::Cylinder {
            radius: 0.12,
            half_height: 0.2,
            rounding: 0.0,
        },
        Primitive::Cylinder {
            radius: 0.12,
            half_height: 0.2,
            rounding: 0.04,
        },
        Primitive::Frustum {
            bottom: 0.2,
            top: 0.05,
            half_height: 0.15,
        },
        Primitive::Frustum {
            bottom: 0.15,
            top: 0.0,
            half_height: 0.2,
        },
        Primitive::Torus {
            major: 0.15,
            minor: 0.05,
        },
        Primitive::Capsule {
            radius: 0.08,
            half_height: 0.12,
        },
        Primitive::Extrusion {
            contours: vec![star.clone()],
            half_height: 0.05,
            rounding: 0.0,
        },
        Primitive::Extrusion {
            contours: vec![ring(200, 0.2, Vec2::ZERO), ring(40, 0.1, Vec2::ZERO)],
            half_height: 0.1,
            rounding: 0.02,
        },
        Primitive::Revolution {
            contours: vec![ring(30, 0.06, Vec2::new(0.13, 0.02))],
            rounding: 0.0,
        },
        Primitive::Revolution {
            contours: vec![
                [(0.0, -0.2), (0.15, -0.2), (0.05, 0.2), (0.0, 0.2)]
                    .map(Vec2::from)
                    .to_vec(),
            ],
            rounding: 0.03,
        },
        Primitive::Convex {
            points: box_points(Vec3::new(0.1, 0.15, 0.2)),
        },
        Primitive::Convex {
            points: [
                (0.2, -0.1, 0.2),
                (-0.2, -0.1, 0.2),
                (0.0, -0.1, -0.2),
                (0.0, 0.2, 0.0),
            ]
            .map(Vec3::from)
            .to_vec(),
        },
        Primitive::Convex { points: ball },
        Primitive::Helix {
            major: 0.15,
            minor: 0.03,
            pitch: 0.1,
            turns: 2.6,
        },
        Primitive::Helix {
            major: 0.1,
            minor: 0.02,
            pitch: -0.6,
            turns: 0.4,
        },
        Primitive::Ellipsoid {
            half: Vec3::new(0.2, 0.05, 0.12),
        },
    ]
}
