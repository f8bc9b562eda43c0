//! Marks, update, copy (EasyVRModeling §4.4, §5.4).

use bevy::prelude::*;
use midair_field::{Node, Op};
use midair_studio::hands::{Action, Pose, Side};

use crate::studio::{Studio, near};

const CUBE: Vec3 = Vec3::new(0.0, 1.0, 0.0);
const SPHERE: Vec3 = Vec3::new(0.15, 1.15, 0.12);
/// Where a hand touches only the one or the other.
const AT_CUBE: Vec3 = Vec3::new(-0.15, 0.85, -0.15);
const AT_SPHERE: Vec3 = Vec3::new(0.28, 1.25, 0.15);

fn pair() -> (Studio, [midair_document::ObjectId; 2]) {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", CUBE);
    let sphere = s.place("solid/sphere", SPHERE);
    (s, [cube, sphere])
}

#[test]
fn the_cross_opens_scene_operate_and_then_marks() {
    let (mut s, [cube, sphere]) = pair();
    s.reach(Side::Right, AT_CUBE);
    s.click(Side::Right, Action::Up);
    assert_eq!(s.marks(), [], "the first click only opens it");
    s.mark(AT_CUBE, Action::Up);
    s.mark(AT_SPHERE, Action::Down);
    assert_eq!(s.marks(), [(cube, Op::Union), (sphere, Op::Subtract)]);
    let steps = s.undo_len();
    s.mark(AT_CUBE, Action::Right);
    assert_eq!(
        s.marks(),
        [(cube, Op::Intersect), (sphere, Op::Subtract)],
        "marked again it keeps its place"
    );
    s.mark(AT_CUBE, Action::Right);
    assert_eq!(s.undo_len(), steps + 1, "the same mark again is no step");
    s.mark(AT_CUBE, Action::Left);
    assert_eq!(s.marks(), [(sphere, Op::Subtract)]);
    s.mark(AT_CUBE, Action::Left);
    assert_eq!(
        s.marks(),
        [(sphere, Op::Subtract)],
        "there is nothing to cancel"
    );
    // On nothing, ← puts SceneOperate away; then a click opens it again and marks nothing.
    s.mark(Vec3::new(0.0, 4.0, 0.0), Action::Left);
    s.mark(AT_CUBE, Action::Up);
    assert_eq!(s.marks(), [(sphere, Op::Subtract)]);
    s.mark(AT_CUBE, Action::Up);
    assert_eq!(s.marks(), [(sphere, Op::Subtract), (cube, Op::Union)]);
    s.press(Side::Right, Action::Cancel);
    s.let_go(Side::Right, Action::Cancel);
    assert_eq!(
        s.marks().len(),
        2,
        "marks stay when SceneOperate is given up"
    );
}

#[test]
fn either_hand_operates() {
    let (mut s, [cube, _]) = pair();
    s.reach(Side::Left, AT_CUBE);
    s.click(Side::Left, Action::Down);
    s.click(Side::Left, Action::Down);
    assert_eq!(s.marks(), [(cube, Op::Subtract)]);
}

#[test]
fn the_first_operators_sign_counts_for_nothing() {
    let mut volumes = Vec::new();
    for first in [Action::Up, Action::Right, Action::Down] {
        let (mut s, _) = pair();
        s.operate();
        s.mark(AT_CUBE, first);
        s.mark(AT_SPHERE, Action::Up);
        s.finish();
        let id = s.only();
        volumes.push(s.mesh(id, 0.01).volume());
        let Node::Solid(operands) = s.object(id).recipe().unwrap().node() else {
            panic!("a fused solid");
        };
        assert_eq!(operands[0].op, Op::Union);
    }
    assert!(volumes.iter().all(|v| *v == volumes[0]), "{volumes:?}");
}

#[test]
fn two_operands_unite_intersect_and_subtract() {
    let mut volumes = Vec::new();
    for arm in [Action::Up, Action::Right, Action::Down] {
        let (mut s, _) = pair();
        let steps = s.undo_len();
        s.operate();
        s.mark(AT_CUBE, Action::Up);
        s.mark(AT_SPHERE, arm);
        s.finish();
        assert_eq!(s.undo_len(), steps + 3, "two marks and one fusion");
        let id = s.only();
        assert!(s.marks().is_empty());
        assert!(s.object(id).fresh);
        volumes.push(s.faultless(id, 0.005).volume);
    }
    let [union, intersection, difference] = volumes[..] else {
        panic!("three")
    };
    let (cube, sphere) = (0.064, 4.0 / 3.0 * std::f64::consts::PI * 0.008);
    assert!((union + intersection - cube - sphere).abs() < 5e-4);
    assert!((difference + intersection - cube).abs() < 5e-4);
}

#[test]
fn one_operand_is_copied() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", CUBE);
    let original = s.object(cube).clone();
    s.operate();
    s.mark(CUBE, Action::Up);
    let before = s.document().to_ron();
    s.finish();
    assert_eq!(s.document().len(), 2);
    assert!(s.marks().is_empty());
    assert_eq!(*s.object(cube), original);
    let (twin, copy) = s.document().objects().next_back().unwrap();
    assert_eq!(copy.recipe(), original.recipe());
    assert!(copy.fresh);
    assert!(copy.placement.translation.x > CUBE.x + 0.4, "beside it");
    s.reach(Side::Left, s.placement(twin).translation);
    assert_eq!(s.touched(Side::Left), Some(twin));
    s.click(Side::Left, Action::Undo);
    assert_eq!(s.document().to_ron(), before);
}

#[test]
fn eight_operands_in_one_update() {
    let mut s = Studio::new();
    let at = |i: usize| Vec3::new(0.3 * i as f32, 1.0, 0.0);
    for i in 0..8 {
        s.place(
            if i % 2 == 0 {
                "solid/cube"
            } else {
                "solid/sphere"
            },
            at(i),
        );
    }
    s.operate();
    let mut apart: f64 = 0.0;
    for i in 0..8 {
        // The third and the sixth are taken away.
        let away = i == 2 || i == 5;
        let aside = if i % 2 == 0 {
            Vec3::new(0.0, 0.18, 0.18)
        } else {
            Vec3::ZERO
        };
        s.mark(at(i) + aside, if away { Action::Down } else { Action::Up });
        apart += if i % 2 == 0 { 0.064 } else { 0.0335 };
    }
    assert_eq!(s.marks().len(), 8);
    let ids: Vec<_> = s.document().objects().map(|(id, _)| id).collect();
    let marked: Vec<_> = s.marks().iter().map(|&(id, _)| id).collect();
    assert_eq!(marked, ids, "each was marked by the hand at its place");
    let before = s.document().to_ron();
    s.finish();
    let report = s.faultless(s.only(), 0.01);
    assert!(report.volume > 0.1 && report.volume < apart);
    s.click(Side::Left, Action::Undo);
    assert_eq!(s.document().to_ron(), before);
}

#[test]
fn a_result_is_an_operand_four_levels_deep() {
    let mut s = Studio::new();
    s.place("solid/cube", CUBE);
    let grow = |s: &mut Studio, factor: f32| {
        let id = s.only();
        let at = s.placement(id).translation;
        for (side, x) in [(Side::Left, -0.1), (Side::Right, 0.1)] {
            s.reach(side, at + Vec3::X * x);
            s.press(side, Action::Grab);
        }
        let apart = 0.1 * factor;
        let [l, r] = [-apart, apart].map(|x| Pose::at(at + Vec3::X * x));
        s.carry(Some(l), Some(r));
        s.let_go(Side::Left, Action::Grab);
        s.let_go(Side::Right, Action::Grab);
        s.settle();
        s.reach(Side::Left, Vec3::new(-1.0, 3.0, 0.0));
    };
    for level in 1..=4 {
        let result = s.only();
        let at = s.placement(result).translation;
        let corner = at + Vec3::splat(0.2) * s.placement(result).scale;
        let other = s.place("solid/sphere", corner);
        s.operate();
        s.mark(at, Action::Up);
        s.mark(
            corner + Vec3::splat(0.1),
            if level % 2 == 0 {
                Action::Up
            } else {
                Action::Down
            },
        );
        assert_eq!(s.marks().len(), 2, "level {level}");
        assert_eq!(s.marks()[1].0, other);
        s.finish();
        let id = s.only();
        assert!(s.object(id).recipe().unwrap().depth() > level);
        grow(&mut s, if level % 2 == 0 { 0.7 } else { 1.3 });
    }
    let id = s.only();
    near(s.placement(id).scale, Vec3::splat(0.7), 1e-3);
    let report = s.faultless(id, 0.01);
    let finer = s.faultless(id, 0.005);
    assert!((report.volume / finer.volume - 1.0).abs() < 0.01);
}

#[test]
fn update_waits_until_the_hands_let_go() {
    let (mut s, _) = pair();
    s.operate();
    s.mark(AT_CUBE, Action::Up);
    s.mark(AT_SPHERE, Action::Up);
    s.reach(Side::Left, AT_CUBE);
    s.press(Side::Left, Action::Grab);
    s.finish();
    assert_eq!(s.document().len(), 2, "one of them is in hand");
    s.let_go(Side::Left, Action::Grab);
    s.finish();
    s.only();
}

#[test]
fn an_empty_result_is_a_step_like_any_other() {
    let mut s = Studio::new();
    s.place("solid/cube", CUBE);
    s.place("solid/sphere", CUBE + Vec3::X);
    s.operate();
    s.mark(CUBE, Action::Up);
    s.mark(CUBE + Vec3::X, Action::Right);
    let before = s.document().to_ron();
    s.finish();
    assert!(s.mesh(s.only(), 0.01).triangles.is_empty());
    s.click(Side::Left, Action::Undo);
    s.settle();
    assert_eq!(s.document().to_ron(), before);
}
