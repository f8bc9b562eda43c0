mod booleans;
mod culling;
mod distances;
mod incremental;
mod recipes;
mod swept;

use glam::{Quat, Vec2, Vec3};
use proptest::prelude::*;

use crate::{Node, Op, Operand, Placement, Primitive, Program, Recipe};

/// A step that is a power of two, so that whole steps are exact.
pub(crate) const STEP: f32 = 1.0 / 64.0;

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

pub(crate) fn solid(parts: &[(Op, &Recipe, Placement)]) -> Recipe {
    let operand = |(op, recipe, placement): &(Op, &Recipe, Placement)| Operand {
        op: *op,
        placement: *placement,
        recipe: (*recipe).clone(),
        muted: false,
    };
    Recipe::new(Node::Solid(parts.iter().map(operand).collect()))
}

pub(crate) fn compile(recipe: &Recipe) -> Program {
    Program::compile(recipe, &Placement::IDENTITY, STEP, &()).expect("a sound recipe")
}

pub(crate) fn op() -> impl Strategy<Value = Op> {
    prop_oneof![Just(Op::Union), Just(Op::Intersect), Just(Op::Subtract)]
}

pub(crate) fn point(reach: f32) -> impl Strategy<Value = Vec3> {
    [-reach..reach, -reach..reach, -reach..reach].prop_map(Vec3::from)
}

pub(crate) fn placement() -> impl Strategy<Value = Placement> {
    let scale = prop_oneof![
        Just(Vec3::ONE),
        (0.5f32..1.5).prop_map(Vec3::splat),
        [0.5f32..1.5, 0.5f32..1.5, -1.5f32..-0.5].prop_map(Vec3::from),
    ];
    (point(0.2), point(3.0), scale).prop_map(|(translation, turn, scale)| Placement {
        translation,
        rotation: Quat::from_scaled_axis(turn),
        scale,
    })
}

pub(crate) fn leaf() -> impl Strategy<Value = Recipe> {
    (0..zoo().len()).prop_map(|i| zoo().swap_remove(i).into())
}

/// Sequences of one to four operands, some of which are sequences themselves.
pub(crate) fn recipe() -> impl Strategy<Value = Recipe> {
    leaf().prop_recursive(2, 8, 4, |inner| {
        prop::collection::vec((op(), inner, placement()), 1..4).prop_map(|parts| {
            let refs: Vec<_> = parts.iter().map(|(o, r, p)| (*o, r, *p)).collect();
            solid(&refs)
        })
    })
}
