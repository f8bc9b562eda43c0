//! What is marked is shown before it is made, and changes nothing that is made.

use bevy::prelude::*;
use midair_csg::Preview;
use midair_field::{Node, Op, Operand, Placement, Recipe};
use midair_studio::evaluate::{Evaluations, Key};
use midair_studio::hands::{Action, Side};
use midair_studio::settings::Settings;

use crate::studio::Studio;

const CUBE: Vec3 = Vec3::new(0.0, 1.0, 0.0);
const SPHERE: Vec3 = Vec3::new(0.15, 1.15, 0.12);
const AT_CUBE: Vec3 = Vec3::new(-0.15, 0.85, -0.15);
const AT_SPHERE: Vec3 = Vec3::new(0.28, 1.25, 0.15);

fn preview(s: &Studio) -> &Preview {
    s.world().resource::<Preview>()
}

/// Frames until what is shown is of this recipe.
fn shows(s: &mut Studio, recipe: &Recipe) -> Key {
    let since = std::time::Instant::now();
    loop {
        s.frame();
        match preview(s).shown() {
            Some(key) if key.recipe == recipe.hash() => return key,
            _ => std::thread::sleep(std::time::Duration::from_millis(1)),
        }
        assert!(since.elapsed().as_secs() < 60, "it is never shown");
    }
}

fn subtracted() -> Studio {
    let mut s = Studio::new();
    s.place("solid/cube", CUBE);
    s.place("solid/sphere", SPHERE);
    s.operate();
    s.mark(AT_CUBE, Action::Up);
    assert!(!preview(&s).is_shown(), "one operand makes nothing");
    s.mark(AT_SPHERE, Action::Down);
    s
}

/// The sequence by hand, the second operand standing at `second`.
fn sequence(s: &Studio, second: Placement) -> Recipe {
    let [(a, _), (b, _)] = s.marks()[..] else {
        panic!("two marks")
    };
    let origin = s.placement(a).translation;
    let operand = |id, op, at: Placement| Operand {
        op,
        placement: Placement {
            translation: at.translation - origin,
            ..at
        },
        recipe: s.object(id).recipe().unwrap().clone(),
        muted: false,
    };
    Recipe::new(Node::Solid(vec![
        operand(a, Op::Union, s.placement(a)),
        operand(b, Op::Subtract, second),
    ]))
}

#[test]
fn marks_show_their_result_and_a_moving_hand_changes_it() {
    let mut s = subtracted();
    let (_, ball) = (s.marks()[0].0, s.marks()[1].0);
    let at_rest = sequence(&s, s.placement(ball));
    shows(&mut s, &at_rest);
    s.settle();
    let key = shows(&mut s, &at_rest);
    assert_eq!(
        key.step(),
        s.document().step(),
        "as fine as update makes it"
    );

    s.reach(Side::Right, AT_SPHERE);
    s.press(Side::Right, Action::Grab);
    s.carry_right(AT_SPHERE + Vec3::X * 0.1);
    let draft = s.drafted(ball).expect("it is held");
    let moved = sequence(&s, draft);
    let steps = s.undo_len();
    shows(&mut s, &moved);
    assert_eq!(s.undo_len(), steps);

    s.press(Side::Right, Action::Cancel);
    s.let_go(Side::Right, Action::Cancel);
    s.let_go(Side::Right, Action::Grab);
    shows(&mut s, &at_rest);
}

#[test]
fn what_is_made_does_not_depend_on_the_preview() {
    let run = |on: bool| {
        let mut s = Studio::new();
        s.ask(Settings::command("preview.on", on));
        s.place("solid/cube", CUBE);
        s.place("solid/sphere", SPHERE);
        s.operate();
        s.mark(AT_CUBE, Action::Up);
        s.mark(AT_SPHERE, Action::Down);
        if on {
            s.until("a preview", |s| preview(s).is_shown());
        } else {
            s.frames(30);
            assert!(!preview(&s).is_shown());
        }
        s.reach(Side::Right, AT_SPHERE);
        s.press(Side::Right, Action::Grab);
        s.carry_right(AT_SPHERE + Vec3::X * 0.05);
        s.let_go(Side::Right, Action::Grab);
        s.finish();
        let counted = |s: &Studio| s.world().resource::<Evaluations>().updates().len();
        s.until("the update is made", |s| counted(s) > 0);
        let updates = counted(&s);
        assert!(!preview(&s).is_shown(), "it is made: nothing is pending");
        (s.document().content_hash(), updates)
    };
    let (with, without) = (run(true), run(false));
    assert_eq!(with, without);
    assert_eq!(with.1, 1, "a preview is no update");
}

#[test]
fn it_goes_with_the_marks_and_comes_back_with_undo() {
    let mut s = subtracted();
    let ball = s.marks()[1].0;
    let recipe = sequence(&s, s.placement(ball));
    shows(&mut s, &recipe);
    s.mark(AT_SPHERE, Action::Left);
    s.frame();
    assert!(!preview(&s).is_shown() && !preview(&s).is_busy());
    s.ask(midair_studio::command::Command::Undo);
    shows(&mut s, &recipe);
}

#[test]
fn a_sketch_that_comes_after_the_solid_itself_leaves_nothing_busy() {
    let mut s = subtracted();
    let [_, (sphere, _)] = s.marks()[..] else {
        panic!("two marks")
    };
    let wanted = sequence(&s, s.placement(sphere));
    // The solid is made while a sketch of it is on its way.
    let fine = Key::new(&wanted, s.document().step());
    let since = std::time::Instant::now();
    while s.world().resource::<Evaluations>().made(&fine).is_none()
        || preview(&s).is_busy()
        || preview(&s).shown() != Some(fine)
    {
        s.frame();
        std::thread::sleep(std::time::Duration::from_millis(1));
        assert!(since.elapsed().as_secs() < 60, "it never rests");
    }
}
