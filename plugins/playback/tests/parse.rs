//! Every kind of fault in a session is one clear line with its place.

use midair_playback::{Beat, Session, Step, Turn};
use proptest::prelude::*;

fn fault(text: &str) -> String {
    let line = Session::parse(text, "a.ron").expect_err(text).to_string();
    assert!(!line.contains('\n'), "one line: {line}");
    line
}

fn steps(steps: &str) -> String {
    format!("(\n    format: 1,\n    title: \"t\",\n    steps: [\n        {steps}\n    ],\n)\n")
}

#[track_caller]
fn names(line: &str, parts: &[&str]) {
    for part in parts {
        assert!(line.contains(part), "`{part}` in: {line}");
    }
}

#[test]
fn an_unknown_step_names_its_place_and_what_there_is() {
    let line = fault(&steps(
        "Wait(1),\n        // a comment\n        Dance(Right),",
    ));
    names(
        &line,
        &["a.ron:7:", "step `Dance`", "Move, Both", "Click", "Ready"],
    );
}

#[test]
fn an_unknown_field_names_what_there_is() {
    let line = fault(&steps("Move(hand: Right, too: (0, 1, 0)),"));
    names(&line, &["a.ron:5:", "`too`", "hand, to, by, turn, over"]);
    names(
        &fault(&steps("Expect(object: 1),")),
        &["a.ron:5:", "`object`", "objects, closed"],
    );
    names(
        &fault("(format: 1, titel: \"\", steps: [])"),
        &["a.ron:1:", "`titel`", "title, dt, recorded"],
    );
}

#[test]
fn an_unknown_action_hand_and_command_name_what_there_is() {
    names(
        &fault(&steps("Click(Right, Jab),")),
        &["a.ron:5:", "action `Jab`", "Act, Grab"],
    );
    names(
        &fault(&steps("Click(Third, Act),")),
        &["hand `Third`", "Left, Right"],
    );
    names(
        &fault(&steps("Ask(Sing),")),
        &["command `Sing`", "Undo, Redo"],
    );
}

#[test]
fn a_newer_format_is_said_to_be_newer_whatever_it_holds() {
    let line = fault("(format: 2, tempo: 3, steps: {})");
    names(&line, &["a.ron", "format 2", "format 1", "newer"]);
    names(
        &fault("(title: \"t\", steps: [])"),
        &["`format`", "missing"],
    );
    names(&fault("(format: 1)"), &["`steps`", "missing"]);
}

#[test]
fn numbers_that_make_no_sense_name_the_step() {
    for (step, part) in [
        ("Wait(-1)", "seconds"),
        ("Wait(NaN)", "seconds"),
        ("Wait(inf)", "seconds"),
        ("Move(hand: Left)", "neither"),
        ("Move(hand: Left, to: (0, 0, 0), by: (0, 0, 0))", "exclude"),
        ("Move(hand: Left, to: (0, NaN, 0))", "finite"),
        ("Move(hand: Left, to: (0, 0, 0), over: -2)", "over"),
        ("Move(hand: Left, turn: (0, 0, 0, 0))", "rotation"),
        ("Touch(Right, (2, 0))", "pad"),
        ("Slide(hand: Right, to: (0, NaN), over: 1)", "pad"),
    ] {
        let line = fault(&steps(&format!("Wait(0.5), {step},")));
        let name = step.split('(').next().unwrap_or_default();
        names(&line, &["a.ron:5:20", &format!("step 2, {name}"), part]);
    }
    names(&fault("(format: 1, dt: 3, steps: [])"), &["`dt` is 3"]);
    names(&fault("(format: 1, dt: NaN, steps: [])"), &["`dt` is NaN"]);
    names(
        &fault("(format: 1, hands: (left: (inf, 0, 0)), steps: [])"),
        &["`hands`"],
    );
}

#[test]
fn a_session_without_end_is_refused_before_it_starts() {
    let line = fault(&steps("Wait(1), Wait(1e30),"));
    names(&line, &["step 2, Wait", "4 hours"]);
    let many = "Wait(3600),".repeat(5);
    names(&fault(&steps(&many)), &["step 5, Wait"]);
}

#[test]
fn broken_text_is_a_fault_with_a_place() {
    names(&fault(""), &["a.ron:1:1"]);
    names(&fault(&steps("Wait(1")), &["a.ron:"]);
    names(&fault("(format: 1, steps: [Wait(1),"), &["a.ron:1:"]);
    names(&fault(&steps("Frames(\"§\"),")), &["a.ron:5:", "base64"]);
    names(&fault(&steps("Frames(\"AQ\"),")), &["a.ron:5:", "frame"]);
    // Deep nesting ends with a line, not with the stack.
    let deep = format!("(format: 1, steps: [{}", "(".repeat(100_000));
    fault(&deep);
}

#[test]
fn hostile_runs_of_frames_are_refused_without_being_walked() {
    // One frame (dt 1 ns), then nearly 2⁶³ repeats of it.
    let run = "AQGA//////////9/";
    let line = fault(&steps(&format!("Frames(\"{run}\"),")));
    names(&line, &["step 1, Frames", "4000000 frames"]);
}

#[test]
fn optional_fields_and_turns_are_pleasant_to_write() {
    let session = Session::parse(
        &steps(
            "Move(hand: Right, to: (0, 1, -0.5), turn: (0, 90, 0), over: 0.5),
             Move(hand: Right, by: (0, 1, 0), turn: Some((0, 0, 0, 1))),
             Both(left: (by: (0.1, 0, 0)), right: (by: (-0.1, 0, 0))),
             Ask(Place(component: \"sphere\", side: Left)), Ask(Undo),
             Expect(objects: 1, closed: true, volume: (0.5, 0.6)),",
        ),
        "a.ron",
    )
    .expect("a session");
    assert_eq!(session.steps().len(), 6);
    assert!(matches!(
        session.steps()[0],
        Step::Move {
            turn: Some(Turn::Degrees(_)),
            ..
        }
    ));
    assert!(matches!(
        session.steps()[1],
        Step::Move {
            turn: Some(Turn::Quat(_)),
            over: None,
            ..
        }
    ));
    let place = session.place(3).to_string();
    assert_eq!(place, "a.ron:8:14: step 4, Ask");
}

#[test]
fn a_missing_file_is_named() {
    let e = Session::load(std::path::Path::new("no/such.ron")).expect_err("no file");
    names(&e.to_string(), &["no/such.ron", "cannot be read"]);
}

#[test]
fn a_file_that_is_not_text_is_refused() {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), b"(format: 1, \xff\xfe)").expect("written");
    let e = Session::load(file.path()).expect_err("not text");
    names(&e.to_string(), &["byte 12", "UTF-8"]);
}

#[test]
fn the_example_of_the_documentation_plays() {
    let doc = include_str!("../../../docs/session.md");
    let mut examples = 0;
    for block in doc.split("```ron\n").skip(1) {
        let text = block.split("```").next().unwrap_or_default();
        if text.contains("format:") {
            let session = Session::parse(text, "docs/session.md").expect("the example");
            let session = std::sync::Arc::new(session);
            midair_playback::check_hands_only(&session).expect("by hands");
            examples += 1;
        } else {
            let all = format!("(format: 1, steps: [{text}])");
            Session::parse(&all, "docs/session.md").expect(text);
        }
    }
    assert!(examples >= 1);
}

#[test]
fn the_documentation_names_every_step_field_and_action() {
    let doc = include_str!("../../../docs/session.md");
    for text in [
        steps("Dance(Right),"),
        steps("Click(Right, Jab),"),
        steps("Move(leg: Right),"),
        steps("Expect(leg: 1),"),
        "(formats: 1)".into(),
    ] {
        let line = fault(&text);
        let all = line.split("there are: ").nth(1).expect("a list");
        for name in all.split(", ") {
            assert!(doc.contains(name), "{name} is not documented");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Whatever happens to a file, reading it gives a session or one line.
    #[test]
    fn a_damaged_file_is_a_session_or_one_line(
        recorded: bool,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0u8..3), 1..6),
    ) {
        let text = if recorded {
            "(\nformat: 1,\ntitle: \"t\",\nrecorded: true,\nsteps: [\nFrames(\"AQGAAg\"),\n\
             Asked([Undo]),\nReady([5, 7]),\nFrames(\"AQGAAg\"),\n])\n"
                .to_owned()
        } else {
            steps("Move(hand: Right, to: (0, 1, 0), over: 0.5), /* so */ Click(Left, Act), // on\n\
                   Expect(objects: 0), Ask(Step(0.01)), Touch(Right, (0, 1)),")
        };
        let mut bytes = text.into_bytes();
        for (at, byte, how) in damage {
            if bytes.is_empty() {
                break;
            }
            let at = at.index(bytes.len());
            match how {
                0 => bytes[at] = byte,
                1 => drop(bytes.remove(at)),
                _ => bytes.truncate(at),
            }
        }
        let text = String::from_utf8_lossy(&bytes);
        match Session::parse(&text, "a.ron") {
            Ok(session) => {
                let session = std::sync::Arc::new(session);
                let frames = session.frames();
                if frames < 100_000 {
                    let walked = session.cursor().filter(|b| matches!(b, Beat::Frame(_))).count();
                    prop_assert_eq!(walked as u64, frames);
                }
            }
            Err(e) => {
                let line = e.to_string();
                prop_assert!(line.starts_with("a.ron") && !line.contains('\n'), "{}", line);
            }
        }
    }
}
