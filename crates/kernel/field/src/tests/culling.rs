use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::{IVec3, Quat, Vec3};
use midair_mesh::{Aabb, MeshHash};
use proptest::prelude::*;

use super::{STEP, compile, placement, point, recipe, solid};
use crate::bake::Volume;
use crate::fuse::bricks_touching;
use crate::scratch::EXACT;
use crate::{
    Brick, Canvas, FuseError, FuseOptions, Grid, MeshSource, Node, Op, Placement, Primitive,
    Program, Recipe, Skeleton, Stroke, fuse,
};

/// A ring of which every mesh hash is the name.
struct Ring;

impl MeshSource for Ring {
    fn volume(&self, _: &MeshHash, local_step: f32) -> Option<Arc<Volume>> {
        let torus = |p: Vec3| ((p.x.hypot(p.y) - 0.12).hypot(p.z)) - 0.05;
        let around = Aabb::around(Vec3::ZERO, Vec3::splat(0.25));
        Volume::from_fn(around, local_step.max(0.01), torus)
            .ok()
            .map(Arc::new)
    }
}

fn ring() -> Recipe {
    Recipe::new(Node::Mesh {
        mesh: MeshHash([7; 32]),
        bounds: Aabb::around(Vec3::ZERO, Vec3::new(0.17, 0.17, 0.05)),
    })
}

/// Values equal where there are values, three steps from the surface no less, signs equal everywhere, and no sign change beside a brick
/// without values.
fn check(program: &Program, grid: &Grid) -> Result<(), TestCaseError> {
    let all = program.bounds();
    if all.is_empty() {
        prop_assert_eq!(grid.bricks().count(), 0);
        return Ok(());
    }
    let (low, high) = bricks_touching(&all, STEP);
    let size = (high - low + 1).max_element();
    let mut signs = std::collections::HashMap::new();
    for c in crate::grid::cube(low, size) {
        let brute = program.brute_brick(c);
        match grid.brick(c) {
            Some(Brick::Values { values, min, max }) => {
                for (v, b) in values.iter().zip(brute.iter()) {
                    let far = b.min(*v) >= EXACT * STEP;
                    prop_assert!(v == b || (far && v > b), "{} {}", v, b);
                }
                prop_assert_eq!(*min, values.iter().copied().fold(f32::MAX, f32::min));
                prop_assert_eq!(*max, values.iter().copied().fold(f32::MIN, f32::max));
            }
            Some(Brick::Inside) => prop_assert!(brute.iter().all(|v| *v < 0.0)),
            None => prop_assert!(brute.iter().all(|v| *v > 0.0), "{:?}", c),
        }
        signs.insert(c, brute.map(|v| v < 0.0));
    }
    let inside = |n: IVec3| {
        let c = n >> 3;
        let l = n - c * 8;
        signs
            .get(&c)
            .is_some_and(|s| s[(l.x + 8 * (l.y + 8 * l.z)) as usize])
    };
    for (c, brick) in grid.bricks() {
        if matches!(brick, Brick::Inside) {
            let mut around = crate::grid::cube(c * 8 - 1, 10);
            prop_assert!(around.all(inside), "{:?} has no rim", c);
        }
    }
    for (&c, s) in &signs {
        if grid.brick(c).is_none() {
            prop_assert!(s.iter().all(|s| !s));
            prop_assert!(
                !crate::grid::cube(c * 8 - 1, 10).any(inside),
                "{:?} has no rim",
                c
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn culling_changes_nothing(r in recipe()) {
        let program = compile(&r);
        check(&program, &fuse(&program, &FuseOptions::default()).expect("fits"))?;
    }

    #[test]
    fn culling_changes_nothing_with_meshes(r in recipe(), at in placement(), turn in placement(), op in super::op()) {
        let inner = solid(&[(Op::Union, &ring(), turn), (op, &r, Placement::IDENTITY), (Op::Union, &ring(), at)]);
        let program = Program::compile(&inner, &Placement::IDENTITY, STEP, &Ring).expect("sound");
        check(&program, &fuse(&program, &FuseOptions::default()).expect("fits"))?;
    }

    #[test]
    fn boxes_hold_solids(r in recipe(), p in super::point(1.0)) {
        let program = compile(&r);
        if program.at(p) < -1e-5 {
            prop_assert!(program.bounds().distance(p) == 0.0);
            prop_assert!(r.bounds().distance(p) == 0.0);
        }
    }
}

#[test]
fn threads_do_not_matter() {
    let ball: Recipe = Primitive::Sphere { radius: 0.3 }.into();
    let r = solid(&[
        (Op::Union, &ball, Placement::IDENTITY),
        (Op::Subtract, &ball, Placement::at(Vec3::new(0.2, 0.1, 0.0))),
    ]);
    let program = compile(&r);
    let with = |n| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n)
            .build()
            .expect("threads");
        pool.install(|| fuse(&program, &FuseOptions::default()).expect("fits"))
    };
    let (one, four) = (with(1), with(4));
    assert_eq!(one.sorted_coords(), four.sorted_coords());
    assert!(one.bricks().all(|(c, b)| four.brick(c) == Some(b)));
}

#[test]
fn limits_and_cancelling() {
    let ball: Recipe = Primitive::Sphere { radius: 10.0 }.into();
    let at = |step| Program::compile(&ball, &Placement::IDENTITY, step, &()).expect("sound");
    let few = FuseOptions {
        max_bricks: 1000,
        ..Default::default()
    };
    assert!(matches!(
        fuse(&at(0.01), &few),
        Err(FuseError::TooFine { .. })
    ));
    assert!(matches!(
        fuse(&at(1.0e-7), &few),
        Err(FuseError::TooFine { .. })
    ));
    let stop = AtomicBool::new(true);
    let stopped = FuseOptions {
        cancel: Some(&stop),
        ..Default::default()
    };
    assert_eq!(fuse(&at(0.5), &stopped).err(), Some(FuseError::Cancelled));
}

#[test]
fn a_missing_mesh_is_named() {
    let error = Program::compile(&ring(), &Placement::IDENTITY, STEP, &()).err();
    assert!(error.expect("missing").to_string().starts_with("mesh 0707"));
}

proptest! {
    /// Eight points together are eight points by themselves, and a part is the whole where it holds.
    #[test]
    fn points_together_are_what_they_are_alone(recipe in recipe(), around in point(0.3)) {
        let program = compile(&recipe);
        let mut r = 0.0_f32;
        let points = [(); crate::TOGETHER].map(|()| {
            r += 1.0;
            around + 0.9 * STEP * Vec3::new(r.sin(), (2.0 * r).cos(), (3.0 * r).sin())
        });
        let alone = points.map(|p| program.at(p).to_bits());
        prop_assert_eq!(program.at_all(&points).map(f32::to_bits), alone);
        let part = program.part(around, STEP);
        prop_assert_eq!(part.at_all(&points).map(f32::to_bits), points.map(|p| part.at(p).to_bits()));
    }
}

#[test]
fn a_painting_holds_values_no_further_from_a_volume_than_normals_need() {
    let stroke = Stroke {
        placement: Placement {
            translation: Vec3::new(0.03, 0.02, 0.01),
            rotation: Quat::from_scaled_axis(Vec3::new(0.2, 0.5, 0.1)),
            ..Placement::IDENTITY
        },
        ..Stroke::new(Skeleton::Volume(ring()), 0.12)
    };
    let canvas = Canvas {
        strokes: vec![stroke.clone()],
        ..Canvas::default()
    };
    let step = 0.005;
    let make = |recipe: &Recipe, at: &Placement| {
        let program = Program::compile(recipe, at, step, &Ring).expect("compiles");
        fuse(&program, &FuseOptions::default())
            .expect("fuses")
            .bricks()
            .count()
    };
    let painted = make(&Recipe::new(Node::Canvas(canvas)), &Placement::IDENTITY);
    let alone = make(&ring(), &stroke.placement);
    // The potential falls off as φ rises: no brick more is wanted than for the mesh as an operand.
    assert!(painted <= alone + alone / 20, "{painted} {alone}");
}
