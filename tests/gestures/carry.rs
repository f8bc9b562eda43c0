//! Things in the hands in every mode, and carried from one into another.

use bevy::prelude::*;
use midair_csg::ASSEMBLE;
use midair_field::Op;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Side};
use midair_studio::objects::{Ask, How};
use midair_studio::project::Selection;
use midair_studio::show::Cues;
use midair_studio::tools::Tools;

use crate::studio::{ELSEWHERE, Studio, near};

const HERE: Vec3 = Vec3::new(0.5, 1.0, 0.3);

fn active(s: &Studio) -> String {
    let tools = s.world().resource::<Tools>();
    tools.active().expect("a mode").id.to_string()
}

fn carry_to(id: midair_studio::tools::ToolId) -> Command {
    Command::Carry {
        objects: Vec::new(),
        to: id,
    }
}

#[test]
fn every_mode_moves_and_deletes_what_its_hands_touch() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    s.ask(Command::Mode(ELSEWHERE));
    s.reach(Side::Right, HERE);
    s.press(Side::Right, Action::Grab);
    assert_eq!(s.held().get(Side::Right), Some(cube));
    assert!(s.world().resource::<Cues>().0[&cube].touched);
    let steps = s.undo_len();
    s.carry_right(HERE + Vec3::X);
    s.let_go(Side::Right, Action::Grab);
    near(s.placement(cube).translation, HERE + Vec3::X, 1e-5);
    assert_eq!(s.undo_len(), steps + 1);
    s.frames(2);
    s.click(Side::Right, Action::Delete);
    assert!(s.document().is_empty());
    s.click(Side::Left, Action::Undo);
    assert_eq!(s.document().len(), 1);
}

#[test]
fn what_a_hand_holds_is_carried_and_stands_where_it_stood() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    s.ask(Command::Mode(ELSEWHERE));
    s.reach(Side::Right, HERE);
    s.press(Side::Right, Action::Grab);
    s.carry_right(HERE + Vec3::X);
    let steps = s.undo_len();
    s.ask(carry_to(ASSEMBLE));
    s.frames(2);
    assert_eq!(active(&s), ASSEMBLE.as_str());
    assert!(s.held().is_empty());
    assert_eq!(s.marks(), [(cube, Op::Union)]);
    near(s.placement(cube).translation, HERE, 0.0);
    assert_eq!(s.drafted(cube), None);
    s.let_go(Side::Right, Action::Grab);
    s.frames(2);
    assert_eq!(s.undo_len(), steps + 1, "one step, the mark");
    s.click(Side::Left, Action::Undo);
    assert_eq!(s.marks(), []);
}

#[test]
fn with_empty_hands_what_is_selected_is_carried() {
    let mut s = Studio::new();
    let a = s.place("solid/cube", HERE);
    let b = s.place("solid/sphere", -HERE);
    s.reach(Side::Right, Vec3::new(0.0, 4.0, 0.0));
    s.ask(Command::Objects(Ask::Select {
        ids: vec![a, b],
        how: How::Set,
    }));
    assert_eq!(s.world().resource::<Selection>().0, [a, b]);
    s.ask(carry_to(ASSEMBLE));
    s.frames(2);
    assert_eq!(s.marks(), [(a, Op::Union), (b, Op::Union)]);
    // Once more changes nothing: they are marked.
    let steps = s.undo_len();
    s.ask(carry_to(ASSEMBLE));
    s.frames(2);
    assert_eq!(s.undo_len(), steps);
}

#[test]
fn nothing_to_carry_and_a_mode_that_is_not_there_are_said() {
    let mut s = Studio::new();
    s.ask(carry_to(ELSEWHERE));
    assert!(s.warnings().last().unwrap().contains("Nothing to carry"));
    assert_eq!(active(&s), ASSEMBLE.as_str());
    let cube = s.place("solid/cube", HERE);
    s.ask(Command::Carry {
        objects: vec![cube],
        to: midair_studio::tools::ToolId::new("nowhere"),
    });
    assert!(s.warnings().last().unwrap().contains("nowhere"));
}
