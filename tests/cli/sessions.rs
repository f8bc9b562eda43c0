//! Sessions that cannot be played.

use crate::place::{CUBE, Place};

#[test]
fn a_session_that_cannot_be_read_says_where() {
    let place = Place::new();
    for steps in [
        "Dance(Right)",
        "Press(Right, Grab",
        "Press(Middle, Grab)",
        "Move(hand: Right, to: (1, 2))",
        "Wait(-1)",
        "Wait(1e9)",
        "Ask(Place(component: 7, side: Right))",
    ] {
        place.session(steps);
        place.refused(&["play", "session.ron"], &["session.ron"]);
    }
    for text in [
        "",
        "()",
        "(format: 99, steps: [])",
        "(steps: [])",
        "\u{0}\u{1}",
    ] {
        place.write("session.ron", text);
        place.refused(&["play", "session.ron"], &["session.ron"]);
    }
    place.write("session.ron", [0xff, 0xfe, 0x00]);
    place.refused(&["play", "session.ron"], &["session.ron"]);
    place.refused(&["play", "none.ron"], &["none.ron"]);
    place.refused(&["play", "home"], &["home"]);
}

#[test]
fn hands_only_refuses_what_hands_cannot_do() {
    let place = Place::new();
    for (steps, words) in [
        (
            "Ask(Edit(SetStep(step: 0.02)))",
            ["session.ron", "edits the document"],
        ),
        (
            "Move(hand: Right, by: (1, 0, 0), over: 0.4)",
            ["session.ron", "2 m/s"],
        ),
        (
            "Jump(hand: Left, to: (0.4, 1, 0))",
            ["session.ron", "2 m/s"],
        ),
        ("Jump(hand: Left, to: (NaN, 0, 0))", ["session.ron", "pose"]),
    ] {
        place.session(steps);
        place.refused(&["play", "session.ron", "--hands-only"], &words);
        place.done(&["play", "session.ron"]);
    }
    // Up to that speed it is a hand: 4/3 of the mean is the highest.
    place.session("Move(hand: Right, by: (0.59, 0, 0), over: 0.4)");
    place.done(&["play", "session.ron", "--hands-only"]);
}

#[test]
fn what_was_expected_and_is_not_fails() {
    let place = Place::new();
    place.session(&format!("{CUBE} Expect(objects: 2)"));
    place.refused(
        &["play", "session.ron", "--export", "a.stl"],
        &["session.ron", "objects"],
    );
    assert!(!place.path("a.stl").exists());
    place.session(&format!(
        "{CUBE} Expect(volume: (0.06, 0.07), undo: 1, redo: 0)"
    ));
    place.done(&["play", "session.ron"]);
}

#[test]
fn what_the_library_has_not_is_a_warning() {
    let place = Place::new();
    place.session(r#"Click(Right, Library), Ask(Place(component: "solid/unicorn", side: Right))"#);
    let said = place.midair(&["play", "session.ron"]);
    assert_eq!(said.status, 0);
    assert_eq!(said.err.lines().count(), 1, "{}", said.err);
    assert!(said.err.contains("solid/unicorn"));
}
