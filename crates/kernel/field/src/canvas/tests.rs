mod edits;

use std::sync::Arc;

use glam::{IVec3, Quat, Vec3};

use super::kernel::T;
use super::*;
use crate::{Brick, FuseOptions, Node, Placement, Primitive, Program, Recipe, fuse};

fn canvas(strokes: Vec<Stroke>) -> Canvas {
    Canvas {
        strokes,
        ..Canvas::default()
    }
}

fn program(canvas: &Canvas, step: f32) -> Program {
    let recipe = Recipe::checked(Node::Canvas(canvas.clone())).unwrap();
    Program::compile(&recipe, &Placement::IDENTITY, step, &()).unwrap()
}

fn line(a: [f32; 3], b: [f32; 3], radius: f32) -> Stroke {
    Stroke::new(Skeleton::Line(a.into(), b.into()), radius)
}

fn erasing(stroke: Stroke) -> Stroke {
    Stroke {
        erase: true,
        ..stroke
    }
}

/// How far from `from` along `to` the surface lies.
fn reach(p: &Program, from: Vec3, to: Vec3) -> f32 {
    let (mut low, mut high) = (0.0, 1.0);
    assert!(p.at(from) < 0.0 && p.at(from + to) > 0.0);
    for _ in 0..40 {
        let mid = 0.5 * (low + high);
        if p.at(from + to * mid) < 0.0 {
            low = mid;
        } else {
            high = mid;
        }
    }
    low * to.length()
}

#[test]
fn a_point_is_its_sphere() {
    let p = program(&canvas(vec![Stroke::point(Vec3::ZERO, 0.05)]), 0.01);
    for i in 0..40 {
        let a = i as f32;
        let d = Vec3::new(a.sin(), (2.3 * a).cos(), (1.7 * a).sin()).normalize();
        assert!((reach(&p, Vec3::ZERO, d * 0.2) - 0.05).abs() < 1e-4);
        // A signed distance near the surface.
        assert!((p.at(d * 0.052) - 0.002).abs() < 2e-4);
        assert!((p.at(d * 0.048) + 0.002).abs() < 2e-4);
    }
}

#[test]
fn a_led_point_is_a_round_cone_and_does_not_swell() {
    let points = [[0.0, 0.0, 0.0, 1.0], [0.3, 0.0, 0.0, 0.5]].map(glam::Vec4::from);
    let mut twice = points.to_vec();
    twice.extend(points.iter().rev());
    for way in [points.to_vec(), twice] {
        let p = program(
            &canvas(vec![Stroke::new(Skeleton::Points(way.into()), 0.04)]),
            0.01,
        );
        assert!((reach(&p, Vec3::ZERO, Vec3::NEG_X * 0.2) - 0.04).abs() < 1e-4);
        assert!((reach(&p, Vec3::X * 0.3, Vec3::X * 0.2) - 0.02).abs() < 1e-4);
        let mid = reach(&p, Vec3::X * 0.15, Vec3::Y * 0.2);
        assert!((0.029..0.032).contains(&mid), "{mid}");
    }
}

#[test]
fn two_halves_of_a_line_are_the_line() {
    let whole = program(
        &canvas(vec![line([-0.2, 0.0, 0.0], [0.3, 0.1, 0.0], 0.04)]),
        0.01,
    );
    let middle = [0.0, 0.04, 0.0];
    let halves = program(
        &canvas(vec![
            line([-0.2, 0.0, 0.0], middle, 0.04),
            line(middle, [0.3, 0.1, 0.0], 0.04),
        ]),
        0.01,
    );
    for i in 0..4000 {
        let a = i as f32;
        let p = Vec3::new(
            0.35 * (a * 0.37).sin(),
            0.05 + 0.1 * (a * 0.71).sin(),
            0.08 * (a * 0.53).sin(),
        );
        // φ is T − F in units of 0.0413 metres, as far as anything is felt.
        let f = |program: &Program| program.at(p).min(0.04125 * T);
        assert!((f(&whole) - f(&halves)).abs() < 1e-5 * 0.04125, "{p}");
    }
}

/// Across the plane of two strokes that meet, where they meet.
#[test]
fn a_joint_is_as_thick_as_its_strokes() {
    for degrees in [45.0f32, 90.0, 135.0] {
        let turn = Quat::from_rotation_z(degrees.to_radians());
        let end = turn * Vec3::X * 0.5;
        let strokes = vec![
            line([0.0; 3], [0.5, 0.0, 0.0], 0.04),
            line([0.0; 3], end.to_array(), 0.04),
        ];
        let p = program(&canvas(strokes), 0.01);
        let thick = reach(&p, Vec3::ZERO, Vec3::Z * 0.2);
        assert!((thick / 0.04 - 1.0).abs() < 0.08, "{degrees}: {thick}");
        let away = reach(&p, Vec3::X * 0.3, Vec3::Z * 0.2);
        assert!((away / 0.04 - 1.0).abs() < 0.08, "{degrees}: {away}");
    }
}

#[test]
fn a_polygon_is_a_plate() {
    let corners = [
        [-0.3, 0.0, -0.3],
        [0.3, 0.0, -0.3],
        [0.3, 0.0, 0.3],
        [-0.3, 0.0, 0.3],
    ];
    let plate = Skeleton::Polygon(corners.map(Vec3::from).into());
    let p = program(&canvas(vec![Stroke::new(plate, 0.03)]), 0.01);
    for at in [Vec3::ZERO, Vec3::new(0.2, 0.0, 0.1)] {
        assert!((reach(&p, at, Vec3::Y * 0.2) - 0.03).abs() < 1e-4);
        assert!((reach(&p, at, Vec3::NEG_Y * 0.2) - 0.03).abs() < 1e-4);
    }
}

#[test]
fn short_skeletons_are_fitted_to_their_radius() {
    let reach_of = |stroke: Stroke| {
        let weight = stroke.fitted_weight(1.75);
        let p = program(&canvas(vec![Stroke { weight, ..stroke }]), 0.01);
        reach(&p, Vec3::ZERO, Vec3::Y * 0.3)
    };
    for half in [0.01, 0.03, 0.2] {
        let r = reach_of(line([-half, 0.0, 0.0], [half, 0.0, 0.0], 0.04));
        assert!((r - 0.04).abs() < 1e-3, "{half}: {r}");
    }
}

#[test]
fn an_erase_takes_from_what_stands_before_it_and_from_nothing_after() {
    let body = Stroke::new(
        Skeleton::Volume(
            Primitive::Cuboid {
                half: Vec3::splat(0.2),
                rounding: 0.0,
            }
            .into(),
        ),
        0.02,
    );
    let hole = erasing(Stroke::point(Vec3::Y * 0.2, 0.06));
    let p = program(&canvas(vec![body.clone(), hole.clone()]), 0.01);
    // The hole has the eraser's radius, however full the body is.
    let depth = reach(&p, Vec3::ZERO, Vec3::Y * 0.2);
    assert!((depth - 0.14).abs() < 5e-4, "{depth}");
    let twice = program(
        &canvas(vec![body.clone(), body.clone(), hole.clone()]),
        0.01,
    );
    assert!((reach(&twice, Vec3::ZERO, Vec3::Y * 0.2) - depth).abs() < 5e-4);
    // What is painted afterwards is whole.
    let bead = Stroke::point(Vec3::Y * 0.24, 0.02);
    let after = program(&canvas(vec![body, hole, bead.clone()]), 0.01);
    let alone = program(&canvas(vec![bead]), 0.01);
    for d in [Vec3::X, Vec3::Y, Vec3::Z] {
        let (a, b) = (
            reach(&after, Vec3::Y * 0.24, d * 0.03),
            reach(&alone, Vec3::Y * 0.24, d * 0.03),
        );
        assert!((a - b).abs() < 1e-5);
    }
}

#[test]
fn the_exponent_goes_from_melting_to_uniting() {
    let pair = |blend| Canvas {
        blend,
        ..canvas(vec![
            Stroke::point(Vec3::X * -0.05, 0.05),
            Stroke::point(Vec3::X * 0.05, 0.05),
        ])
    };
    let waist = |blend| {
        let p = program(&pair(blend), 0.01);
        if p.at(Vec3::ZERO) < 0.0 {
            reach(&p, Vec3::ZERO, Vec3::Y * 0.2)
        } else {
            0.0
        }
    };
    let all: Vec<f32> = [1.0, 2.0, 4.0, 8.0, HARD].map(waist).to_vec();
    assert!(
        all.windows(2).all(|w| w[0] > w[1] || w == [0.0, 0.0]),
        "{all:?}"
    );
    assert!(all[0] > 0.03 && all[4] < 1e-3, "{all:?}");
}

#[test]
fn a_volume_keeps_its_surface_and_a_painting_its_own_potential() {
    let ball = Recipe::from(Primitive::Sphere { radius: 0.1 });
    let inner = canvas(vec![
        Stroke::point(Vec3::ZERO, 0.1),
        Stroke::point(Vec3::X * 0.14, 0.06),
    ]);
    let painted = Recipe::new(Node::Canvas(inner.clone()));
    let place = Placement {
        translation: Vec3::new(0.1, 0.2, 0.0),
        rotation: Quat::from_rotation_z(0.7),
        scale: Vec3::splat(0.5),
    };
    let on = |recipe: Recipe| Stroke {
        placement: place,
        ..Stroke::new(Skeleton::Volume(recipe), 0.02)
    };
    let p = program(&canvas(vec![on(ball)]), 0.01);
    assert!((reach(&p, place.translation, Vec3::Y * 0.3) - 0.05).abs() < 1e-4);
    let p = program(&canvas(vec![on(painted)]), 0.01);
    let own = program(&inner, 0.01);
    for i in 0..200 {
        let a = i as f32;
        let q = Vec3::new(
            (a * 0.7).sin() * 0.2,
            (a * 1.3).cos() * 0.15,
            (a * 0.9).sin() * 0.15,
        );
        let there = p.at(place.affine().transform_point3(q));
        let here = own.at(q);
        assert!(
            (there - 0.5 * here).abs() < 1e-5 || (here > 0.03 && there > 0.01),
            "{q} {there} {here}"
        );
    }
}

#[test]
fn impossible_strokes_are_refused() {
    let bad = [
        line([0.0; 3], [0.0; 3], 0.1),
        line([0.0; 3], [f32::NAN, 0.0, 0.0], 0.1),
        Stroke::point(Vec3::ZERO, 0.0),
        Stroke::point(Vec3::ZERO, f32::NAN),
        Stroke::new(Skeleton::Points(Arc::new([])), 0.1),
        Stroke::new(Skeleton::Polygon(Arc::new([Vec3::ONE; 4])), 0.1),
    ];
    for stroke in bad {
        let sound = Stroke::point(Vec3::ZERO, 0.1);
        let fault = canvas(vec![sound, stroke]).validate().unwrap_err();
        assert!(fault.to_string().starts_with("stroke 2"), "{fault}");
    }
    assert!(
        Canvas {
            blend: 0.5,
            ..Canvas::default()
        }
        .validate()
        .is_err()
    );
}

/// Twins are felt as much as the one of them that is felt most; others add up.
#[test]
fn twins_do_not_swell() {
    let led = |a: [f32; 3], b: [f32; 3], twin| Stroke {
        twin,
        ..Stroke::new(
            Skeleton::Points(Arc::new([
                Vec3::from(a).extend(1.0),
                Vec3::from(b).extend(1.0),
            ])),
            0.05,
        )
    };
    let of = |twins: [u32; 2]| {
        let strokes = vec![
            led([-0.1, 0.0, 0.0], [0.2, 0.0, 0.0], twins[0]),
            led([0.1, 0.0, 0.0], [-0.2, 0.0, 0.0], twins[1]),
        ];
        program(&canvas(strokes), 0.01)
    };
    let thick = |p: &Program| reach(p, Vec3::ZERO, Vec3::Y * 0.2);
    assert!((thick(&of([3, 3])) - 0.05).abs() < 1e-4);
    for others in [[0, 0], [3, 0], [3, 4]] {
        assert!(thick(&of(others)) > 0.06, "{others:?}");
    }
    let viewed = |twins| {
        let program = of(twins);
        let view = program.leaves[0].painting().unwrap().view();
        [view.strokes[0].twins, view.strokes[1].twins]
    };
    assert_eq!(viewed([3, 3]), [1, 1], "evaluators elsewhere are told");
    assert_eq!(viewed([3, 4]), [1, 2]);
    let grid = fuse(&of([3, 3]), &FuseOptions::default()).unwrap();
    assert!(grid.is_inside(IVec3::new(0, 4, 0)) && !grid.is_inside(IVec3::new(0, 6, 0)));
}

/// The same shape at any step.
#[test]
fn finer_is_the_same() {
    let strokes = vec![
        line([-0.2, 0.0, 0.0], [0.2, 0.0, 0.0], 0.05),
        Stroke::point(Vec3::new(0.0, 0.1, 0.0), 0.06),
        erasing(Stroke::point(Vec3::new(0.2, 0.03, 0.0), 0.04)),
    ];
    let painted = canvas(strokes);
    for step in [0.02, 0.01, 0.005] {
        let p = program(&painted, step);
        let exact = program(&painted, 0.001);
        let grid = fuse(&p, &FuseOptions::default()).unwrap();
        for (c, brick) in grid.bricks() {
            let Brick::Values { values, .. } = brick else {
                continue;
            };
            for (i, v) in values.iter().enumerate() {
                let i = i as i32;
                let n = c * 8 + IVec3::new(i & 7, i >> 3 & 7, i >> 6);
                let e = exact.at(n.as_vec3() * step);
                if e.abs() < 2.0 * step && v.abs() < 2.0 * step && e.abs() > 1e-3 * step {
                    assert!((v - e).abs() < 2e-5, "{n} {v} {e}");
                }
            }
        }
    }
    assert_eq!(T, 0.5);
}
