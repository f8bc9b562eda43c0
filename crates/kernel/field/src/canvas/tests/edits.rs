//! What is evaluated again after an edit, and what is left out.

use proptest::prelude::*;

use super::*;
use crate::{Grid, Op, Operand, changed_box, refuse, refuse_from};

fn stroke() -> impl Strategy<Value = Stroke> {
    let place = prop::array::uniform3(-0.25f32..0.25).prop_map(Vec3::from);
    let skeleton =
        (0..5, prop::collection::vec((place, 0.5f32..1.5), 4..12)).prop_map(|(kind, p)| {
            let bend = |i: usize| p[i].0;
            match kind {
                0 => Skeleton::Points(p.iter().map(|(a, w)| a.extend(*w)).collect()),
                1 => Skeleton::Line(bend(0), bend(1)),
                2 => Skeleton::Polygon((0..4).map(bend).collect()),
                3 => Skeleton::Volume(
                    Primitive::Sphere {
                        radius: 0.05 + p[0].1 * 0.05,
                    }
                    .into(),
                ),
                _ => {
                    let inner = canvas(vec![
                        Stroke::point(bend(0), 0.05),
                        line(bend(1).to_array(), bend(2).to_array(), 0.03),
                    ]);
                    Skeleton::Volume(Recipe::new(Node::Canvas(inner)))
                }
            }
        });
    let turn = (
        prop::array::uniform3(-1.0f32..1.0),
        0.6f32..1.5,
        any::<bool>(),
    );
    let one = (skeleton, 0.02f32..0.06, 0..4, turn, 0u32..3);
    one.prop_map(|(skeleton, radius, erase, (v, s, uneven), twin)| Stroke {
        erase: erase == 0,
        twin,
        placement: Placement {
            translation: Vec3::from(v) * 0.1,
            rotation: Quat::from_scaled_axis(Vec3::from(v)),
            scale: Vec3::new(s, if uneven { 1.0 } else { s }, s),
        },
        ..Stroke::new(skeleton, radius)
    })
}

fn compile(recipe: &Recipe, step: f32) -> Program {
    let at = Placement::at(Vec3::new(0.03, -0.02, 0.01));
    Program::compile(recipe, &at, step, &()).unwrap()
}

fn same(a: &Grid, b: &Grid) {
    assert_eq!(a.sorted_coords(), b.sorted_coords());
    for (c, brick) in a.bricks() {
        assert_eq!(Some(brick), b.brick(c), "{c}");
    }
}

/// What a surface and its normals are made from is the same: signs everywhere, values within two steps of it.
fn alike(a: &Grid, b: &Grid, step: f32) {
    let mut coords = a.sorted_coords();
    coords.extend(b.sorted_coords());
    for c in coords {
        for n in crate::grid::cube(c * 8, 8) {
            assert_eq!(a.is_inside(n), b.is_inside(n), "node {n}");
        }
        let near = |v: f32| v.abs() <= 2.0 * step;
        match (a.brick(c), b.brick(c)) {
            (Some(Brick::Values { values: v, .. }), Some(Brick::Values { values: w, .. })) => {
                for (x, y) in v.iter().zip(w.iter()) {
                    assert!(x == y || !(near(*x) || near(*y)), "{c} {x} {y}");
                }
            }
            (Some(Brick::Values { values, .. }), _) | (_, Some(Brick::Values { values, .. })) => {
                assert!(!values.iter().any(|v| near(*v)), "{c}");
            }
            _ => {}
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// No node loses its sign where bricks are left out, and an edit evaluates enough again.
    #[test]
    fn bricks_left_out_hold_nothing(
        strokes in prop::collection::vec(stroke(), 1..7),
        more in stroke(),
        at in 0usize..8,
        blend in prop::sample::select(vec![1.0f32, 1.0, 2.5, HARD]),
    ) {
        let mut painted = Canvas { blend, ..canvas(strokes) };
        prop_assume!(painted.validate().is_ok() && more.placement.is_sound());
        let step = 0.02;
        let cut = |c: &Canvas| {
            // In company, as a part that is cut.
            let operand = |recipe, op| Operand { op, placement: Placement::IDENTITY, recipe, muted: false };
            Recipe::new(Node::Solid(vec![
                operand(Recipe::new(Node::Canvas(c.clone())), Op::Union),
                operand(Primitive::Sphere { radius: 0.07 }.into(), Op::Subtract),
            ]))
        };
        for company in [false, true] {
            let of = |c: &Canvas| if company { cut(c) } else { Recipe::new(Node::Canvas(c.clone())) };
            let before = compile(&of(&painted), step);
            let mut grid = fuse(&before, &FuseOptions::default()).unwrap();
            for z in -28..28 {
                for y in -28..28 {
                    for x in -28..28 {
                        let n = IVec3::new(x, y, z);
                        let exact = before.at(n.as_vec3() * step);
                        if exact.abs() > 2e-3 * step {
                            prop_assert_eq!(grid.is_inside(n), exact < 0.0, "{} {}", n, exact);
                        }
                    }
                }
            }
            let mut changed = painted.clone();
            let i = at % (changed.strokes.len() + 1);
            if i < changed.strokes.len() && at % 2 == 0 {
                changed.strokes.remove(i);
            } else {
                changed.strokes.insert(i, more.clone());
            }
            let after = compile(&of(&changed), step);
            let mut felt = grid.clone();
            refuse_from(&mut felt, &before, &after, &FuseOptions::default()).unwrap();
            let dirty = changed_box(&before, &after);
            refuse(&mut grid, &after, &dirty, &FuseOptions::default()).unwrap();
            let anew = fuse(&after, &FuseOptions::default()).unwrap();
            same(&grid, &anew);
            alike(&felt, &anew, step);
        }
        painted.strokes.clear();
    }
}

/// Where an edit ends within what is wholly inside.
#[test]
fn an_edit_of_a_large_solid_leaves_its_inside() {
    let ball = canvas(vec![Stroke::point(Vec3::ZERO, 0.5)]);
    let before = program(&ball, 0.01);
    let old = fuse(&before, &FuseOptions::default()).unwrap();
    for i in 0..6 {
        let t = i as f32;
        let at = 0.42 * Vec3::new(t.sin(), t.cos(), (2.0 * t).sin()).normalize();
        for erase in [true, false] {
            let stroke = Stroke {
                erase,
                ..Stroke::point(at, 0.12)
            };
            let mut strokes = ball.strokes.clone();
            strokes.push(stroke);
            let after = program(&canvas(strokes), 0.01);
            let anew = fuse(&after, &FuseOptions::default()).unwrap();
            let (mut boxed, mut felt) = (old.clone(), old.clone());
            let dirty = changed_box(&before, &after);
            refuse(&mut boxed, &after, &dirty, &FuseOptions::default()).unwrap();
            refuse_from(&mut felt, &before, &after, &FuseOptions::default()).unwrap();
            same(&boxed, &anew);
            alike(&felt, &anew, 0.01);
        }
    }
}
