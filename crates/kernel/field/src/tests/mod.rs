mod booleans;
mod culling;
mod distances;
mod incremental;
mod recipes;
mod swept;
mod zoo;

use glam::{Quat, Vec3};
use proptest::prelude::*;

pub(crate) use zoo::zoo;

use crate::{Node, Op, Operand, Placement, Primitive, Program, Recipe};

/// A step that is a power of two, so that whole steps are exact.
pub(crate) const STEP: f32 = 1.0 / 64.0;

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
