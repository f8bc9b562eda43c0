//! What goes wrong in the middle of a gesture, and whose button is whose.

use bevy::prelude::*;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};

use crate::studio::{ELSEWHERE, Studio, near};

const HERE: Vec3 = Vec3::new(0.5, 1.0, 0.3);

/// Poses that are none: what a tracker may send.
fn broken() -> [Option<Pose>; 5] {
    let pose = |x: f32, w: f32| {
        Some(Pose {
            position: Vec3::new(x, 0.0, 0.0),
            rotation: Quat::from_xyzw(0.0, 0.0, 0.0, w),
        })
    };
    [
        None,
        pose(f32::NAN, 1.0),
        pose(f32::INFINITY, 1.0),
        pose(0.0, 0.0),
        pose(0.0, f32::NAN),
    ]
}

#[test]
fn lost_tracking_never_takes_a_held_object_to_the_origin() {
    for trouble in broken() {
        let mut s = Studio::new();
        let cube = s.place("solid/cube", HERE);
        s.press(Side::Right, Action::Grab);
        let there = HERE + Vec3::new(0.2, 0.1, 0.0);
        s.carry_right(there);
        for _ in 0..10 {
            s.input().side(Side::Right).pose = trouble;
            s.frame();
            near(s.shown(cube).translation, there, 1e-5);
        }
        // It goes on from where the hand is found again.
        s.carry_right(there + Vec3::Y * 0.1);
        near(s.shown(cube).translation, there + Vec3::Y * 0.1, 1e-5);
        s.input().side(Side::Right).pose = trouble;
        s.let_go(Side::Right, Action::Grab);
        near(s.placement(cube).translation, there + Vec3::Y * 0.1, 1e-5);
    }
}

#[test]
fn lost_tracking_never_spoils_a_stretch() {
    for trouble in broken() {
        let mut s = Studio::new();
        let cube = s.place("solid/cube", HERE);
        s.reach(Side::Left, HERE - Vec3::X * 0.1);
        s.reach(Side::Right, HERE + Vec3::X * 0.1);
        s.press(Side::Left, Action::Grab);
        s.press(Side::Right, Action::Grab);
        let [l, r] = [-0.15, 0.15].map(|x| Pose::at(HERE + Vec3::X * x));
        s.carry(Some(l), Some(r));
        for _ in 0..10 {
            s.input().side(Side::Left).pose = trouble;
            s.input().side(Side::Right).swipe = Some(Vec2::splat(f32::NAN));
            s.frame();
            near(s.shown(cube).translation, HERE, 1e-5);
            near(s.shown(cube).scale, Vec3::splat(1.5), 1e-4);
        }
        s.input().side(Side::Right).swipe = None;
        s.let_go(Side::Left, Action::Grab);
        s.let_go(Side::Right, Action::Grab);
        near(s.placement(cube).scale, Vec3::splat(1.5), 1e-4);
    }
}

#[test]
fn a_hand_that_was_never_tracked_grabs_nothing() {
    let mut s = Studio::new();
    s.place("solid/cube", HERE);
    let before = s.document().to_ron();
    for side in Side::BOTH {
        s.input().side(side).pose = None;
    }
    s.press(Side::Left, Action::Grab);
    s.frames(3);
    s.let_go(Side::Left, Action::Grab);
    assert_eq!(s.document().to_ron(), before);
}

#[test]
fn leaving_the_mode_gives_the_gesture_up() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    s.operate();
    s.mark(HERE, Action::Up);
    let before = s.document().to_ron();
    s.press(Side::Right, Action::Grab);
    s.carry_right(HERE + Vec3::X);
    s.ask(Command::Mode(ELSEWHERE));
    s.frames(2);
    assert!(s.drafted(cube).is_none());
    near(s.shown(cube).translation, HERE, 0.0);
    s.carry_right(HERE + Vec3::Y);
    s.let_go(Side::Right, Action::Grab);
    assert_eq!(
        s.document().to_ron(),
        before,
        "the marks stay, the move does not"
    );
    s.ask(Command::Mode(midair_csg::ASSEMBLE));
    s.frames(2);
    near(s.shown(cube).translation, HERE, 0.0);
    assert_eq!(s.document().to_ron(), before);
}

#[test]
fn leaving_the_mode_in_the_middle_of_a_stretch() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    let before = s.document().to_ron();
    for (side, x) in [(Side::Left, -0.1), (Side::Right, 0.1)] {
        s.reach(side, HERE + Vec3::X * x);
        s.press(side, Action::Grab);
    }
    let [l, r] = [-0.3, 0.3].map(|x| Pose::at(HERE + Vec3::X * x));
    s.carry(Some(l), Some(r));
    s.ask(Command::Mode(ELSEWHERE));
    s.frames(2);
    for side in Side::BOTH {
        s.let_go(side, Action::Grab);
    }
    assert_eq!(s.shown(cube).scale, Vec3::ONE);
    assert_eq!(s.document().to_ron(), before);
}

#[test]
fn undo_in_the_middle_of_a_grab_drops_what_is_held() {
    let mut s = Studio::new();
    s.place("solid/cube", HERE);
    s.press(Side::Right, Action::Grab);
    s.carry_right(HERE + Vec3::X);
    s.click(Side::Left, Action::Undo);
    assert!(s.document().is_empty(), "the placing is undone");
    s.carry_right(HERE + Vec3::Y);
    s.let_go(Side::Right, Action::Grab);
    assert!(s.document().is_empty());
    s.click(Side::Left, Action::Redo);
    near(s.placement(s.only()).translation, HERE, 0.0);
}

#[test]
fn a_thing_deleted_by_the_other_hand_leaves_this_one_empty() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    s.press(Side::Right, Action::Grab);
    s.carry_right(HERE + Vec3::X * 0.1);
    s.reach(Side::Left, HERE + Vec3::X * 0.1);
    assert_eq!(
        s.touched(Side::Left),
        Some(cube),
        "it is touched where it is shown"
    );
    s.click(Side::Left, Action::Delete);
    assert!(s.document().is_empty());
    assert_eq!(s.held().get(Side::Right), None);
    s.carry_right(HERE);
    s.let_go(Side::Right, Action::Grab);
    assert!(s.document().is_empty());
}

#[test]
fn a_double_click_of_the_middle_deletes_and_two_slow_clicks_do_not() {
    let mut s = Studio::new();
    s.place("solid/cube", HERE);
    for _ in 0..3 {
        s.click(Side::Right, Action::Centre);
    }
    assert_eq!(s.document().len(), 1);
    for _ in 0..2 {
        s.press(Side::Right, Action::Centre);
        s.frames(6);
        s.let_go(Side::Right, Action::Centre);
        s.frames(6);
    }
    assert!(s.document().is_empty());
    s.click(Side::Left, Action::Undo);
    s.settle();
    s.only();
    s.reach(Side::Left, HERE);
    s.click(Side::Left, Action::Delete);
    assert!(s.document().is_empty());
}

#[test]
fn the_library_is_the_right_hands() {
    let mut s = Studio::new();
    for action in [Action::Library, Action::Menu] {
        s.click(Side::Left, action);
        assert!(!s.library_open(), "the left hand does not open it");
        s.click(Side::Right, action);
        assert!(s.library_open());
        s.click(Side::Left, action);
        assert!(s.library_open(), "nor close it");
        s.click(Side::Right, action);
        assert!(!s.library_open());
    }
    // A closed library gives nothing.
    s.ask(Command::Place {
        component: "solid/cube".to_owned(),
        side: Side::Right,
    });
    assert!(s.document().is_empty());
    assert_eq!(s.warnings().len(), 1);
}

#[test]
fn saving_is_the_left_hands() {
    let mut s = Studio::new();
    s.place("solid/cube", HERE);
    let work = s.home.path().join("work");
    let files = || std::fs::read_dir(&work).map_or(0, Iterator::count);
    s.reach(Side::Right, HERE);
    s.click(Side::Right, Action::Save);
    s.settle();
    s.click(Side::Left, Action::Save);
    s.settle();
    assert_eq!(
        files(),
        0,
        "the right hand saves nothing, nor an empty left one"
    );
    s.reach(Side::Left, HERE);
    for name in ["Cube.stl", "Cube-2.stl"] {
        s.click(Side::Left, Action::Save);
        s.settle();
        let read = midair_mesh::read(&work.join(name)).unwrap();
        let report = midair_mesh::check(&read.mesh);
        assert!(report.is_faultless(), "{:?}", report.faults());
        assert!((report.volume - 0.064).abs() < 0.002, "in metres again");
    }
    assert_eq!(files(), 2);
    assert!(s.warnings().is_empty(), "{:?}", s.warnings());
}
