//! Live symmetry through the hands: what happens on one side happens on the others, as one step.

use bevy::prelude::*;
use midair_document::{Colour, ObjectId};
use midair_field::Op;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Side};
use midair_studio::objects::{Ask, How};
use midair_studio::project::Selection;
use midair_studio::settings::Settings;

use crate::desk::Desk;
use crate::studio::{Studio, near};

const THERE: Vec3 = Vec3::new(0.5, 0.5, 0.2);
const FLIP: Vec3 = Vec3::new(-1.0, 1.0, 1.0);

fn set(s: &mut Studio, key: &str, value: impl serde::Serialize) {
    s.ask(Settings::command(key, value));
    s.frame();
}

/// The component appears at `at` with its images: all ids that are new.
fn place(s: &mut Studio, component: &str, at: Vec3) -> Vec<ObjectId> {
    if !s.library_open() {
        s.click(Side::Right, Action::Library);
    }
    s.reach(Side::Right, at);
    let before = s.document().next_id();
    s.ask(Command::Place {
        component: component.to_owned(),
        side: Side::Right,
    });
    s.settle();
    let new = s.document().objects().map(|(id, _)| id);
    new.filter(|id| id.0 >= before).collect()
}

fn mirrored() -> (Studio, ObjectId, ObjectId) {
    let mut s = Studio::new();
    set(&mut s, "symmetry.mirror", "X");
    let ids = place(&mut s, "solid/cube", THERE);
    assert_eq!(ids.len(), 2);
    (s, ids[0], ids[1])
}

#[test]
fn what_is_placed_appears_on_both_sides_and_undoes_as_one() {
    let (mut s, one, other) = mirrored();
    near(s.placement(one).translation, THERE, 1e-5);
    near(s.placement(other).translation, THERE * FLIP, 1e-5);
    assert_eq!(s.undo_len(), 2, "the step of the grid, and this");
    s.ask(Command::Undo);
    assert!(s.document().is_empty());
}

#[test]
fn the_image_moves_along_while_the_hand_moves_and_lands_in_the_same_step() {
    let (mut s, one, other) = mirrored();
    for (held, follows) in [(one, other), (other, one)] {
        let from = s.placement(held).translation;
        s.reach(Side::Right, from);
        s.press(Side::Right, Action::Grab);
        let to = from + Vec3::new(0.1, 0.15, -0.1);
        s.carry_right(to);
        near(s.shown(held).translation, to, 1e-5);
        near(s.shown(follows).translation, to * FLIP, 1e-4);
        let steps = s.undo_len();
        s.let_go(Side::Right, Action::Grab);
        s.frames(2);
        assert_eq!(s.undo_len(), steps + 1);
        near(s.placement(follows).translation, to * FLIP, 1e-4);
        assert!(s.drafted(follows).is_none());
        s.ask(Command::Undo);
        near(s.placement(follows).translation, from * FLIP, 1e-4);
        near(s.shown(follows).translation, from * FLIP, 1e-4);
        s.ask(Command::Redo);
        assert_eq!(s.document().len(), 2);
    }
}

#[test]
fn a_gesture_that_is_given_up_leaves_both_where_they_were() {
    let (mut s, one, other) = mirrored();
    let before = s.document().to_ron();
    s.reach(Side::Right, THERE);
    s.press(Side::Right, Action::Grab);
    s.carry_right(THERE + Vec3::Y * 0.3);
    s.press(Side::Right, Action::Cancel);
    s.let_go(Side::Right, Action::Cancel);
    s.let_go(Side::Right, Action::Grab);
    s.frames(2);
    assert_eq!(s.document().to_ron(), before);
    for (id, at) in [(one, THERE), (other, THERE * FLIP)] {
        assert!(s.drafted(id).is_none());
        near(s.shown(id).translation, at, 1e-5);
    }
}

#[test]
fn marks_colours_copies_and_deletions_are_both_sides() {
    let (mut s, one, other) = mirrored();
    s.operate();
    s.mark(THERE, Action::Down);
    assert_eq!(s.marks(), [(one, Op::Subtract), (other, Op::Subtract)]);
    s.mark(THERE, Action::Left);
    assert_eq!(s.marks(), []);
    s.reach(Side::Right, Vec3::new(0.0, 4.0, 0.0));
    s.click(Side::Right, Action::Left);
    s.ask(Command::Objects(Ask::Select {
        ids: vec![other],
        how: How::Set,
    }));
    let colour = Some(Colour([9, 90, 200]));
    s.ask(Command::Objects(Ask::Colour {
        ids: Vec::new(),
        colour,
    }));
    assert_eq!(s.object(one).colour, colour);
    s.ask(Command::Objects(Ask::Duplicate));
    s.settle();
    assert_eq!(s.document().len(), 4);
    // One goes on with the copy itself.
    assert_eq!(s.world().resource::<Selection>().0.len(), 1);
    s.ask(Command::Objects(Ask::Delete));
    assert_eq!(s.document().len(), 2);
    s.ask(Command::Undo);
    assert_eq!(s.document().len(), 4);
}

#[test]
fn what_is_fused_on_both_sides_is_one_solid() {
    let (mut s, one, other) = mirrored();
    let bar = place(&mut s, "solid/cube", Vec3::new(0.0, 0.5, 0.2));
    assert_eq!(bar.len(), 1, "in the plane there is one");
    s.operate();
    s.mark(Vec3::new(0.0, 0.5, 0.2), Action::Up);
    s.mark(THERE, Action::Up);
    assert_eq!(s.marks().len(), 3);
    s.finish();
    let solid = s.only();
    let report = s.faultless(solid, 0.02);
    assert!(report.volume > 0.0);
    for gone in [one, other, bar[0]] {
        assert!(s.document().object(gone).is_none());
    }
}

#[test]
fn what_leaves_the_plane_gets_its_image() {
    let mut s = Studio::new();
    set(&mut s, "symmetry.mirror", "X");
    let ids = place(&mut s, "solid/sphere", Vec3::Y * 0.5);
    assert_eq!(ids.len(), 1);
    s.reach(Side::Right, Vec3::Y * 0.5);
    s.press(Side::Right, Action::Grab);
    s.carry_right(Vec3::new(0.4, 0.5, 0.0));
    assert_eq!(
        s.document().len(),
        1,
        "while it is held there is a shade of it"
    );
    s.let_go(Side::Right, Action::Grab);
    s.settle();
    assert_eq!(s.document().len(), 2);
    s.ask(Command::Undo);
    assert_eq!(s.document().len(), 1);
}

#[test]
fn around_the_vertical_there_are_as_many_as_were_asked_for() {
    let mut s = Studio::new();
    set(&mut s, "symmetry.count", 6);
    let ids = place(&mut s, "solid/cube", THERE);
    assert_eq!(ids.len(), 6);
    let radius = THERE.with_y(0.0).length();
    for id in ids {
        let at = s.placement(id).translation;
        assert!((at.with_y(0.0).length() - radius).abs() < 1e-4);
    }
    s.reach(Side::Right, THERE);
    s.press(Side::Right, Action::Grab);
    s.carry_right(THERE + Vec3::Y * 0.4);
    s.let_go(Side::Right, Action::Grab);
    assert_eq!(s.document().len(), 6);
    for (_, object) in s.document().objects() {
        assert!((object.placement.translation.y - 0.9).abs() < 1e-3);
    }
    // Put off, only what is in the hand moves.
    set(&mut s, "symmetry.count", 1);
    s.reach(Side::Right, THERE + Vec3::Y * 0.4);
    s.press(Side::Right, Action::Grab);
    s.carry_right(THERE);
    s.let_go(Side::Right, Action::Grab);
    let low = s
        .document()
        .objects()
        .filter(|(_, o)| o.placement.translation.y < 0.6);
    assert_eq!(low.count(), 1);
}

#[test]
fn a_key_puts_it_on_and_off_and_the_panel_sets_it() {
    let mut desk = Desk::new();
    let on = |d: &Desk| d.world().resource::<Settings>().symmetry.is_on();
    desk.hold(KeyCode::ShiftLeft, true);
    desk.strike_one(KeyCode::KeyM);
    desk.hold(KeyCode::ShiftLeft, false);
    assert!(on(&desk));
    desk.hold(KeyCode::ShiftLeft, true);
    desk.strike_one(KeyCode::KeyM);
    desk.hold(KeyCode::ShiftLeft, false);
    assert!(!on(&desk));
    for wrong in ["0", "-3", "\"many\""] {
        desk.app.world_mut().write_message(Command::Set {
            key: "symmetry.count".into(),
            value: wrong.into(),
        });
        desk.wait(3);
        assert!(desk.document().check().is_empty());
    }
}
