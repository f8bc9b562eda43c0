//! What cannot be swept, and what is said of it.

use bevy::prelude::*;
use midair_document::{Edit, Object, ObjectId};
use midair_field::{Node, Op, Operand, Placement, Primitive, Recipe};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::settings::{SweepItem, SweepShape};

use crate::studio::Studio;
use crate::sweep::{LEFT, RIGHT};

/// The one warning since `before`.
fn only(s: &Studio, before: usize) -> String {
    let lines = &s.warnings()[before..];
    assert_eq!(lines.len(), 1, "{lines:?}");
    lines[0].clone()
}

#[test]
fn hands_at_one_point_hold_a_curve_and_sweep_nothing() {
    let mut s = Studio::new();
    s.sweeping(SweepShape::Surface);
    for shape in [SweepShape::Surface, SweepShape::Tube] {
        s.set("shape", shape);
        s.both(LEFT, LEFT, 0.0);
        s.frames(20);
        let live = s.swinging().live.expect("a curve");
        assert!(live.is_sound() && live.curve().length() < 1e-3);
        let before = s.warnings().len();
        s.press(Side::Right, Action::Act);
        s.both(LEFT + Vec3::Y * 0.2, LEFT + Vec3::Y * 0.2, 0.0);
        s.let_go(Side::Right, Action::Act);
        s.settle();
        assert!(only(&s, before).contains("move the hands apart"));
        assert!(s.document().is_empty());
    }
    // And a row of clones has them all in one place, which is where it was asked for.
    s.set("shape", SweepShape::Clones);
    s.frames(5);
    let before = s.warnings().len();
    s.click(Side::Right, Action::Act);
    s.settle();
    assert_eq!(s.warnings().len(), before, "{:?}", s.warnings());
    assert_eq!(s.document().len(), 1);
}

#[test]
fn poses_that_are_no_numbers_leave_the_curve_as_it_was() {
    let mut s = Studio::new();
    s.sweeping(SweepShape::Surface);
    let odd = [
        Pose::at(Vec3::NAN),
        Pose::at(Vec3::new(0.0, f32::INFINITY, 0.0)),
        Pose {
            position: RIGHT,
            rotation: Quat::from_xyzw(0.0, 0.0, 0.0, 0.0),
        },
        Pose {
            position: RIGHT,
            rotation: Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0),
        },
    ];
    s.press(Side::Right, Action::Act);
    for (i, pose) in odd.into_iter().enumerate() {
        let at = Vec3::Z * (-0.03 * i as f32);
        s.both(LEFT + at, RIGHT + at, 0.2);
        let before = s.swinging().live.expect("a curve");
        for side in Side::BOTH {
            s.put(side, pose);
            s.frames(4);
            let live = s.swinging().live.expect("a curve");
            assert!(live.is_sound());
            assert!(live.points[1].distance(before.points[1]) < 0.1);
        }
    }
    s.both(LEFT - Vec3::Z * 0.2, RIGHT - Vec3::Z * 0.2, 0.2);
    s.let_go(Side::Right, Action::Act);
    s.settle();
    let ribs = &s.swept(s.only()).ribs;
    assert!(ribs.len() > 3 && ribs.iter().all(|r| r.is_sound()));
    assert_eq!(s.warnings(), [] as [String; 0]);
}

/// A solid of which nothing is left: a ball without a larger one.
fn nothing() -> Recipe {
    let ball = |op, radius| Operand {
        op,
        placement: Placement::IDENTITY,
        recipe: Primitive::Sphere { radius }.into(),
        muted: false,
    };
    let operands = vec![ball(Op::Union, 0.05), ball(Op::Subtract, 0.1)];
    Recipe::new(Node::Solid(operands))
}

#[test]
fn what_has_nothing_left_is_not_cloned() {
    let mut s = Studio::new();
    let id = ObjectId(s.document().next_id());
    let object = Object::solid("Nothing", nothing()).into();
    s.ask(Command::Edit(Edit::Add { id, object }));
    s.settle();
    s.sweeping(SweepShape::Clones);
    s.set("item", SweepItem::Object(id.0));
    s.frames(2);
    s.settle();
    s.frames(5);
    assert!(s.notices().contains("is empty"), "{}", s.notices());
    let before = s.warnings().len();
    s.swipe_away(Vec3::Z * -0.2, 0.3);
    assert!(only(&s, before).contains("to be cloned is empty"));
    assert_eq!(s.document().len(), 1);
}

#[test]
fn a_million_clones_are_refused_in_one_line() {
    let mut s = Studio::new();
    s.sweeping(SweepShape::Clones);
    s.set("spread", true);
    s.set("clones", 1_000_000);
    s.set("clone_size", 0.01);
    s.frames(20);
    let before = s.warnings().len();
    s.press(Side::Right, Action::Act);
    s.both(LEFT - Vec3::Z * 0.3, RIGHT - Vec3::Z * 0.3, 0.3);
    s.let_go(Side::Right, Action::Act);
    s.settle();
    let said = only(&s, before);
    assert!(
        said.contains("at most 131072 are possible") && said.contains("take fewer"),
        "{said}"
    );
    assert!(s.document().is_empty());
    // With fewer it goes on.
    s.set("clones", 8);
    s.frames(5);
    s.swipe_away(Vec3::Z * 0.3, 0.3);
    assert_eq!(s.document().len(), 1);
}
