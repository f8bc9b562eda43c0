//! Taking in hand, moving, turning, scaling (EasyVRModeling §4.3).

use std::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use midair_document::{Edit, ObjectId};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};

use crate::studio::{Studio, near};

const HERE: Vec3 = Vec3::new(0.5, 1.0, 0.3);

#[test]
fn a_hand_moves_and_turns_what_it_holds_in_one_step() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    let (steps, before) = (s.undo_len(), s.document().to_ron());
    s.press(Side::Right, Action::Grab);
    assert_eq!(s.held().get(Side::Right), Some(cube));
    let turn = Quat::from_rotation_y(FRAC_PI_2);
    let there = Pose {
        position: HERE + Vec3::new(0.3, 0.1, -0.2),
        rotation: turn,
    };
    s.carry(None, Some(there));
    assert_eq!(
        s.placement(cube).translation,
        HERE,
        "the draft moves, not the document"
    );
    near(s.shown(cube).translation, there.position, 1e-5);
    s.let_go(Side::Right, Action::Grab);
    let moved = s.placement(cube);
    near(moved.translation, there.position, 1e-5);
    assert!(moved.rotation.angle_between(turn) < 1e-3);
    assert_eq!(moved.scale, Vec3::ONE);
    assert_eq!(s.undo_len(), steps + 1);
    let after = s.document().to_ron();
    s.click(Side::Left, Action::Undo);
    assert_eq!(s.document().to_ron(), before);
    s.click(Side::Left, Action::Redo);
    assert_eq!(s.document().to_ron(), after);
}

#[test]
fn a_hand_that_holds_off_centre_swings_the_object_round_itself() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    s.reach(Side::Left, HERE + Vec3::new(0.15, 0.0, 0.0));
    s.press(Side::Left, Action::Grab);
    let hand = s.pose(Side::Left);
    s.carry(
        Some(Pose {
            rotation: Quat::from_rotation_y(FRAC_PI_2),
            ..hand
        }),
        None,
    );
    s.let_go(Side::Left, Action::Grab);
    // What lay 0.15 m to the left of the hand lies 0.15 m behind it.
    near(
        s.placement(cube).translation,
        HERE + Vec3::new(0.15, 0.0, 0.15),
        1e-5,
    );
}

#[test]
fn a_grab_that_moves_nothing_is_no_step() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    let steps = s.undo_len();
    s.press(Side::Right, Action::Grab);
    s.frames(5);
    s.let_go(Side::Right, Action::Grab);
    assert_eq!(s.undo_len(), steps);
    near(s.placement(cube).translation, HERE, 0.0);
}

#[test]
fn cancel_puts_a_held_object_back() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    let before = s.document().to_ron();
    s.press(Side::Right, Action::Grab);
    s.carry_right(HERE + Vec3::X);
    s.press(Side::Right, Action::Cancel);
    s.let_go(Side::Right, Action::Cancel);
    s.carry_right(HERE + Vec3::Y);
    s.let_go(Side::Right, Action::Grab);
    assert_eq!(s.document().to_ron(), before);
    near(s.shown(cube).translation, HERE, 0.0);
}

/// Both hands take the cube, `0.1` to either side, and move until they are `apart`.
fn stretch(s: &mut Studio, at: Vec3, quadrant: Option<Vec2>, apart: f32) {
    let hands = |half: f32| [-half, half].map(|x| Pose::at(at + Vec3::new(x, 0.0, 0.0)));
    let [left, right] = hands(0.1);
    s.put(Side::Left, left);
    s.put(Side::Right, right);
    s.frames(2);
    s.press(Side::Left, Action::Grab);
    s.press(Side::Right, Action::Grab);
    assert!(s.held().stretch().is_some(), "both hands hold it");
    s.swipe(quadrant);
    let [left, right] = hands(0.5 * apart);
    s.carry(Some(left), Some(right));
    s.swipe(None);
    s.let_go(Side::Left, Action::Grab);
    s.let_go(Side::Right, Action::Grab);
}

#[test]
fn both_hands_scale_along_the_axis_of_the_quadrant() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    let cases = [
        (None, Vec3::splat(2.0)),
        (Some(Vec2::new(-0.9, 0.1)), Vec3::splat(2.0)),
        (Some(Vec2::new(0.1, 0.9)), Vec3::new(2.0, 1.0, 1.0)),
        (Some(Vec2::new(0.9, -0.1)), Vec3::new(1.0, 2.0, 1.0)),
        (Some(Vec2::new(0.1, -0.9)), Vec3::new(1.0, 1.0, 2.0)),
    ];
    for (quadrant, factor) in cases {
        let steps = s.undo_len();
        stretch(&mut s, HERE, quadrant, 0.4);
        near(s.placement(cube).scale, factor, 1e-4);
        near(s.placement(cube).translation, HERE, 1e-5);
        assert_eq!(s.undo_len(), steps + 1, "one step however many hands");
        s.click(Side::Left, Action::Undo);
        assert_eq!(s.placement(cube).scale, Vec3::ONE);
        s.settle();
    }
}

#[test]
fn the_ratio_of_a_stretch_stays_between_two_fifths_and_four() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    for (apart, factor) in [(3.0, 4.0), (0.02, 0.4), (0.0, 0.4)] {
        for (quadrant, axes) in [
            (None, Vec3::ONE),
            (Some(Vec2::new(0.0, 1.0)), Vec3::X),
            (Some(Vec2::new(1.0, 0.0)), Vec3::Y),
            (Some(Vec2::new(0.0, -1.0)), Vec3::Z),
        ] {
            stretch(&mut s, HERE, quadrant, apart);
            let wanted = Vec3::ONE + (factor - 1.0) * axes;
            near(s.placement(cube).scale, wanted, 1e-4);
            s.click(Side::Left, Action::Undo);
            s.settle();
        }
    }
}

#[test]
fn the_hand_that_stays_goes_on_holding_what_was_scaled() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    let steps = s.undo_len();
    s.reach(Side::Left, HERE - Vec3::X * 0.1);
    s.reach(Side::Right, HERE + Vec3::X * 0.1);
    s.press(Side::Left, Action::Grab);
    s.press(Side::Right, Action::Grab);
    let [l, r] = [-0.2, 0.2].map(|x| Pose::at(HERE + Vec3::X * x));
    s.carry(Some(l), Some(r));
    s.let_go(Side::Left, Action::Grab);
    assert_eq!(s.undo_len(), steps, "it is still held");
    s.carry_right(HERE + Vec3::new(0.2, 0.5, 0.0));
    s.let_go(Side::Right, Action::Grab);
    near(s.placement(cube).scale, Vec3::splat(2.0), 1e-4);
    near(s.placement(cube).translation, HERE + Vec3::Y * 0.5, 1e-4);
    assert_eq!(s.undo_len(), steps + 1);
}

#[test]
fn two_hands_hold_two_things() {
    let mut s = Studio::new();
    let a = s.place("solid/cube", HERE - Vec3::X * 0.5);
    let b = s.place("solid/sphere", HERE + Vec3::X * 0.5);
    s.reach(Side::Left, HERE - Vec3::X * 0.5);
    s.reach(Side::Right, HERE + Vec3::X * 0.5);
    s.press(Side::Left, Action::Grab);
    s.press(Side::Right, Action::Grab);
    assert_eq!(s.held().get(Side::Left), Some(a));
    assert_eq!(s.held().get(Side::Right), Some(b));
    let up = |x: f32| Some(Pose::at(HERE + Vec3::new(x, 0.3, 0.0)));
    s.carry(up(-0.5), up(0.5));
    // Both let go in one frame.
    for side in Side::BOTH {
        s.input().side(side).down.set(Action::Grab, false);
    }
    s.frame();
    near(
        s.placement(a).translation,
        HERE + Vec3::new(-0.5, 0.3, 0.0),
        1e-5,
    );
    near(
        s.placement(b).translation,
        HERE + Vec3::new(0.5, 0.3, 0.0),
        1e-5,
    );
}

#[test]
fn a_thing_smaller_than_a_fingertip_can_be_grasped() {
    let mut s = Studio::new();
    let bead = s.place("solid/cube", HERE);
    let mut placement = s.placement(bead);
    placement.scale = Vec3::splat(0.05);
    s.ask(Command::Edit(Edit::SetPlacement {
        id: bead,
        placement,
    }));
    s.settle();
    // 0.018 m beside a cube of 0.02 m; the pick radius is 0.02 m.
    let beside = HERE + Vec3::new(0.028, 0.0, 0.0);
    s.reach(Side::Left, beside);
    assert_eq!(s.touched(Side::Left), Some(bead));
    s.press(Side::Left, Action::Grab);
    s.carry(Some(Pose::at(beside + Vec3::Y * 0.2)), None);
    s.let_go(Side::Left, Action::Grab);
    near(s.placement(bead).translation, HERE + Vec3::Y * 0.2, 1e-5);
    s.settle();
    s.reach(Side::Left, HERE + Vec3::new(0.035, 0.2, 0.0));
    assert_eq!(s.touched(Side::Left), None, "0.025 m beside it");
}

#[test]
fn of_two_things_at_the_hand_the_smaller_is_taken() {
    let mut s = Studio::new();
    let plate = s.place("solid/cube", HERE);
    let bead = s.place("solid/sphere", HERE + Vec3::X * 0.15);
    let mut placement = s.placement(bead);
    placement.scale = Vec3::splat(0.1);
    s.ask(Command::Edit(Edit::SetPlacement {
        id: bead,
        placement,
    }));
    s.settle();
    s.reach(Side::Left, HERE + Vec3::X * 0.15);
    assert_eq!(s.touched(Side::Left), Some(bead));
    s.reach(Side::Left, HERE);
    assert_eq!(s.touched(Side::Left), Some(plate));
}

fn set(s: &mut Studio, edit: Edit) {
    s.ask(Command::Edit(edit));
    s.settle();
}

/// Whatever a hand does there, nothing happens to `id`.
fn out_of_reach(s: &mut Studio, id: ObjectId) {
    let before = s.placement(id);
    s.reach(Side::Right, HERE);
    s.press(Side::Right, Action::Grab);
    assert_eq!(s.held().get(Side::Right), None);
    s.carry_right(HERE + Vec3::X);
    s.let_go(Side::Right, Action::Grab);
    assert_eq!(s.placement(id), before);
    s.reach(Side::Right, HERE);
    s.click(Side::Right, Action::Delete);
    assert!(s.document().object(id).is_some(), "hands pass through it");
}

#[test]
fn hands_pass_through_what_is_hidden_or_locked() {
    let mut s = Studio::new();
    let id = s.place("solid/cube", HERE);
    for hide in [true, false] {
        let edit = |on: bool| match hide {
            true => Edit::SetVisible { id, visible: !on },
            false => Edit::SetLocked { id, locked: on },
        };
        set(&mut s, edit(true));
        out_of_reach(&mut s, id);
        set(&mut s, edit(false));
        s.reach(Side::Right, HERE);
        assert_eq!(s.touched(Side::Right), Some(id));
    }
    // The same by way of the layer.
    let base = midair_document::LayerId::BASE;
    let layer = s.document().layer(base).unwrap().clone();
    for (visible, locked) in [(false, false), (true, true)] {
        let shut = midair_document::Layer {
            visible,
            locked,
            ..layer.clone()
        };
        set(
            &mut s,
            Edit::ReplaceLayer {
                id: base,
                layer: shut,
            },
        );
        out_of_reach(&mut s, id);
    }
}
