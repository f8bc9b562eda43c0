//! Scaffold: what is no drawing at all, bad input, and scenes too full for the eye.

use std::time::Instant;

use bevy::math::DVec3;
use bevy::prelude::*;
use midair_document::{ConstructionLine, DrawnStroke, Edit, Kind, Object, ObjectId};
use midair_scaffold::SCAFFOLD;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::project::Project;
use midair_studio::settings::Draws;

use crate::scaffold::{square, v};
use crate::studio::Studio;

const R: Side = Side::Right;

#[test]
fn what_is_no_drawing_changes_nothing_and_says_so() {
    let mut s = Studio::drawing();
    // A press on one spot in the air, and hundreds of frames at one spot.
    s.reach(R, v(0.0, 1.0, 0.0));
    s.click(R, Action::Act);
    s.draws(Draws::Stroke);
    s.scribble(std::iter::repeat_n(v(0.0, 1.0, 0.0), 400));
    s.click(R, Action::Act);
    assert!(s.document().is_empty());
    // The tracking goes wild in the middle of a stroke, and of a line.
    for draws in [Draws::Stroke, Draws::Line] {
        s.draws(draws);
        s.reach(R, v(0.0, 1.0, 0.0));
        s.press(R, Action::Act);
        s.carry_right(v(0.2, 1.1, 0.0));
        s.put(R, Pose::at(Vec3::NAN));
        s.frames(3);
        s.input().side(R).pose = None;
        s.frames(3);
        s.carry(None, Some(Pose::at(v(0.4, 1.0, 0.0))));
        s.let_go(R, Action::Act);
        s.frame();
    }
    assert_eq!(s.document().len(), 2, "{:?}", s.warnings());
    // Given up it leaves nothing; so does leaving the mode.
    s.reach(R, v(1.0, 1.0, 0.0));
    s.press(R, Action::Act);
    s.carry_right(v(1.5, 1.0, 0.0));
    s.press(R, Action::Cancel);
    s.let_go(R, Action::Act);
    s.let_go(R, Action::Cancel);
    s.press(R, Action::Act);
    s.ask(Command::Mode(crate::studio::ELSEWHERE));
    s.frames(2);
    s.let_go(R, Action::Act);
    assert_eq!(s.document().len(), 2);
    // The same line twice is one line.
    s.ask(Command::Mode(SCAFFOLD));
    s.frames(2);
    for _ in 0..2 {
        s.pull(v(1.0, 1.0, 0.0), v(1.5, 1.0, 0.0));
    }
    assert_eq!(s.document().len(), 3);
}

#[test]
fn each_bad_input_has_a_clear_outcome() {
    // A line of no length.
    let mut s = Studio::drawing();
    s.reach(R, v(0.0, 1.0, 0.0));
    s.click(R, Action::Act);
    assert!(s.document().is_empty() && s.said("Too short for a line"));
    // Two identical lines.
    for count in [1, 1] {
        s.pull(v(0.0, 1.0, 0.0), v(0.4, 1.0, 0.0));
        assert_eq!(s.lines().len(), count);
    }
    assert!(s.said("there already"));
    // A stroke with one point.
    let mut s = Studio::drawing();
    s.draws(Draws::Stroke);
    s.reach(R, v(0.0, 1.0, 0.0));
    s.click(R, Action::Act);
    assert!(s.document().is_empty() && s.said("That was a point"));
    // Hundreds of points at one spot.
    s.pass(4.4);
    s.scribble(std::iter::repeat_n(v(0.0, 1.0, 0.0), 400));
    assert!(s.document().is_empty() && s.said("That was a point"));
    // The same with a stroke going out of it: the hand rests at both ends.
    let rests = |at: Vec3| std::iter::repeat_n(at, 200);
    let (from, to) = (v(0.0, 1.0, 0.0), v(0.4, 1.1, 0.0));
    let way =
        (0..=40).map(|i| from.lerp(to, i as f32 / 40.0) + v(0.0, 0.002 * (i % 3) as f32, 0.0));
    s.scribble(rests(from).chain(way).chain(rests(to)));
    let stroke = &s.strokes()[0];
    assert!(stroke.raw.len() < 200 && stroke.reading.auto, "{stroke:?}");
    let points = stroke.points();
    let ends = [points[0], points[points.len() - 1]];
    assert!(ends[0].distance(from.as_dvec3()) < 0.02 && ends[1].distance(to.as_dvec3()) < 0.02);
    // A stroke near no keypoint keeps its own shape.
    let mut s = Studio::drawing();
    square(&mut s);
    s.draws(Draws::Stroke);
    let drawn: Vec<Vec3> = (0..=120)
        .map(|i| {
            let t = 0.05 * i as f32;
            v(1.0 + 0.06 * t, 1.0 + 0.1 * t.sin(), 0.3)
        })
        .collect();
    s.scribble(drawn.clone());
    let stroke = &s.strokes()[0];
    assert!(stroke.reading.auto && stroke.through.iter().all(|k| !k.of_scaffold));
    for p in stroke.points() {
        let near = drawn.iter().map(|q| q.as_dvec3().distance(p));
        assert!(near.fold(f64::INFINITY, f64::min) < 0.04, "{p}");
    }
    assert_eq!(s.warnings(), [] as [String; 0]);
}

#[test]
fn in_a_scene_in_which_everything_conflicts_no_line_is_thrown_across_the_room() {
    let mut s = Studio::drawing();
    let mut edits = Vec::new();
    for i in 0..120_u64 {
        // Ends all around both ends, directions all about.
        let f = i as f64;
        let off =
            |k: f64| 0.045 * DVec3::new((k * f).sin(), (1.7 * k * f).cos(), (2.3 * k * f).sin());
        let line = ConstructionLine::raw(
            DVec3::new(0.0, 1.0, 0.0) + off(1.3),
            DVec3::new(0.4, 1.1, 0.0) + off(2.9),
        );
        let object = Object::new(format!("Line {i}"), Kind::Line(line)).into();
        let id = ObjectId(s.document().next_id() + i);
        edits.push(Edit::Add { id, object });
    }
    s.ask(Command::Edit(Edit::Composite {
        name: "Set up".into(),
        edits,
    }));
    s.settle();
    let (from, to) = (v(0.0, 1.0, 0.0), v(0.4, 1.1, 0.0));
    s.pull(from, to);
    let lines = s.lines();
    assert_eq!(lines.len(), 121, "{:?}", s.warnings());
    let drawn = &lines[120];
    for (end, meant) in [(drawn.a, from), (drawn.b, to)] {
        assert!(end.distance(meant.as_dvec3()) < 0.11, "{drawn:?}");
    }
    // It was corrected, or the raw line was kept and that was said.
    assert!(drawn.reading.auto && !drawn.kept.is_empty() || s.said("stays as drawn"));
}

#[test]
fn three_hundred_lines_and_eighty_strokes_keep_the_frame() {
    let mut s = Studio::drawing();
    let mut edits = Vec::new();
    for i in 0..380_u64 {
        let f = i as f64;
        let at = DVec3::new(
            0.3 * (f % 19.0),
            0.4 + 0.2 * (f / 19.0).floor(),
            0.05 * (f % 7.0),
        );
        let kind = if i < 300 {
            Kind::Line(ConstructionLine::raw(
                at,
                at + DVec3::new(0.25, 0.01 * (f % 5.0), 0.1),
            ))
        } else {
            let points = (0..200).map(|k| {
                at + 0.1
                    * DVec3::new(
                        (0.1 * f64::from(k)).cos(),
                        0.01 * f64::from(k),
                        (0.1 * f64::from(k)).sin(),
                    )
            });
            Kind::Stroke(DrawnStroke::raw(points.collect(), 0.008).into())
        };
        let object = Object::new(format!("Drawn {i}"), kind).into();
        let id = ObjectId(s.document().next_id() + i);
        edits.push(Edit::Add { id, object });
    }
    s.ask(Command::Edit(Edit::Composite {
        name: "Set up".into(),
        edits,
    }));
    s.settle();
    assert_eq!(s.document().len(), 380);
    let file = s.home.path().join("large.midair");
    s.ask(Command::SaveAs(file.clone()));
    s.settle();
    // Drawing one more line costs frames no more than a fraction of their time.
    let mut times = Vec::new();
    s.reach(R, v(1.0, 1.0, 0.4));
    s.press(R, Action::Act);
    for i in 0..60 {
        s.put(R, Pose::at(v(1.0 + 0.005 * i as f32, 1.0, 0.4)));
        let since = Instant::now();
        s.app_update();
        times.push(since.elapsed().as_secs_f64() * 1e3);
    }
    s.let_go(R, Action::Act);
    times.sort_by(f64::total_cmp);
    println!(
        "a frame with 300 lines and 80 strokes while one draws: median {:.2} ms, 90 % {:.2} ms",
        times[30], times[54]
    );
    assert_eq!(s.document().len(), 381);
    s.ask(Command::Undo);
    let drawn = s.document().clone();
    s.ask(Command::Open(file));
    s.settle();
    let opened = s.world().resource::<Project>().document();
    assert_eq!(opened.len(), drawn.len());
    // Other work on the machine takes frames too: the faster ones say what the drawing costs.
    assert!(times[6] < 50.0, "{times:?}");
}
