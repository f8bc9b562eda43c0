//! Scaffold through the hands: lines, tick marks, strokes and readings.

use bevy::math::DVec3;
use bevy::prelude::*;
use midair_document::{ConstructionLine, DrawnStroke, ObjectId, Relation};
use midair_field::Placement;
use midair_scaffold::{Ask, Draft, SCAFFOLD};
use midair_studio::command::Command;
use midair_studio::drawing::Drawing;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::notice::Notices;
use midair_studio::objects;
use midair_studio::project::Selection;
use midair_studio::settings::{Draws, LinesShown, Settings};

use crate::studio::Studio;

const R: Side = Side::Right;

impl Studio {
    /// Scaffold in hand.
    pub fn drawing() -> Self {
        let mut s = Self::new();
        s.ask(Command::Mode(SCAFFOLD));
        s.frames(2);
        s
    }

    pub fn pull(&mut self, from: Vec3, to: Vec3) {
        self.reach(R, from);
        self.press(R, Action::Act);
        self.carry_right(to);
        self.let_go(R, Action::Act);
        self.frame();
    }

    pub fn scribble(&mut self, points: impl IntoIterator<Item = Vec3>) {
        let mut points = points.into_iter();
        self.reach(R, points.next().unwrap());
        self.press(R, Action::Act);
        for p in points {
            self.put(R, Pose::at(p));
            self.frame();
        }
        self.let_go(R, Action::Act);
        self.frame();
    }

    pub fn draws(&mut self, draws: Draws) {
        self.ask(Settings::command("scaffold.draws", draws));
    }

    pub fn asked(&mut self, ask: Ask) {
        self.ask(ask.command());
        self.frame();
    }

    pub fn lines(&self) -> Vec<ConstructionLine> {
        let all = self.document().objects();
        all.filter_map(|(_, o)| o.line().cloned()).collect()
    }

    pub fn strokes(&self) -> Vec<DrawnStroke> {
        let all = self.document().objects();
        all.filter_map(|(_, o)| o.stroke().cloned()).collect()
    }

    pub fn last(&self) -> ObjectId {
        self.document().objects().next_back().unwrap().0
    }

    /// What was said in the last seconds.
    pub fn said(&self, part: &str) -> bool {
        let notices = self.world().resource::<Notices>();
        notices.recent(3.0).any(|n| n.text.contains(part))
    }
}

pub fn v(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Frames until a file is there that is written off the frame.
fn written(s: &mut Studio, file: &std::path::Path) {
    for _ in 0..200 {
        if file.exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
        s.frame();
    }
}

/// A square of 0.4 m in the plane z = 0, every end off by a centimetre.
pub fn square(s: &mut Studio) {
    let c = [
        v(-0.2, 0.8, 0.0),
        v(0.2, 0.8, 0.0),
        v(0.2, 1.2, 0.0),
        v(-0.2, 1.2, 0.0),
    ];
    let off = [
        v(0.008, -0.004, 0.003),
        v(-0.005, 0.006, -0.006),
        v(0.004, 0.008, 0.004),
        v(-0.007, -0.003, 0.005),
    ];
    for i in 0..4 {
        s.pull(c[i] + off[i], c[(i + 1) % 4] - off[(i + 2) % 4]);
    }
}

#[test]
fn four_lines_drawn_with_a_shaking_hand_are_a_square() {
    let mut s = Studio::drawing();
    let before = s.undo_len();
    square(&mut s);
    let lines = s.lines();
    assert_eq!(lines.len(), 4, "{:?}", s.warnings());
    let sides: Vec<DVec3> = lines.iter().map(|l| l.b - l.a).collect();
    for i in 0..4 {
        let (a, b) = (sides[i], sides[(i + 1) % 4]);
        assert!(a.normalize().dot(b.normalize()).abs() < 1e-6, "{lines:?}");
        assert!((a.length() - b.length()).abs() < 1e-6);
        assert!(lines[i].b.distance(lines[(i + 1) % 4].a) < 1e-6);
        assert!(lines[i].reading.auto);
        // What the hand drew is kept as it was drawn.
        assert!(lines[i].raw[0].distance(lines[i].a) > 1e-4);
    }
    let kept: Vec<Relation> = lines[3].kept.iter().map(|k| k.relation).collect();
    for relation in [
        Relation::Meets,
        Relation::Square,
        Relation::Parallel,
        Relation::Equal,
    ] {
        assert!(kept.contains(&relation), "{kept:?}");
    }
    assert_eq!(s.undo_len() - before, 4);
    for _ in 0..4 {
        s.ask(Command::Undo);
    }
    assert!(s.document().is_empty());
    s.ask(Command::Redo);
    assert_eq!(s.lines().len(), 1);
}

#[test]
fn the_other_trigger_and_the_switch_keep_a_line_as_drawn() {
    let mut s = Studio::drawing();
    let (a, b) = (v(0.0, 1.0, 0.0), v(0.02, 1.5, 0.01));
    s.reach(R, a);
    s.press(R, Action::Act);
    s.press(Side::Left, Action::Act);
    s.let_go(Side::Left, Action::Act);
    s.carry_right(b);
    s.let_go(R, Action::Act);
    s.click(R, Action::Down);
    assert!(!s.world().resource::<Settings>().scaffold.auto);
    s.pull(a + Vec3::X * 0.5, b + Vec3::X * 0.5);
    s.click(R, Action::Down);
    s.pull(a + Vec3::X, b + Vec3::X);
    let lines = s.lines();
    assert_eq!(lines.len(), 3);
    for line in &lines[..2] {
        assert_eq!([line.a, line.b], line.raw);
        assert!(line.kept.is_empty() && !line.reading.auto);
    }
    // Drawn alike, but corrected: into the two beside it, or upright.
    assert!(lines[2].reading.auto && !lines[2].kept.is_empty());
}

#[test]
fn other_readings_are_a_press_away_and_each_is_a_step() {
    let mut s = Studio::drawing();
    square(&mut s);
    // Nearly the diagonal's way, and an end near two keypoints.
    s.pull(v(-0.19, 0.81, 0.01), v(0.03, 1.22, -0.01));
    let best = s.lines()[4].clone();
    s.click(R, Action::Right);
    let next = s.lines()[4].clone();
    assert_ne!(best, next);
    // Backwards from the best is what was drawn.
    s.click(R, Action::Left);
    assert_eq!(s.lines()[4], best);
    s.click(R, Action::Left);
    let raw = s.lines()[4].clone();
    assert_eq!([raw.a, raw.b], raw.raw);
    let steps = s.undo_len();
    s.ask(Command::Undo);
    assert_eq!(
        (s.lines()[4].clone(), s.undo_len()),
        (best.clone(), steps - 1)
    );
    // After the undo it is known which reading it is.
    s.click(R, Action::Right);
    assert_eq!(s.lines()[4], next);
    // The left hand's arrows are not for that.
    s.click(Side::Left, Action::Right);
    assert_eq!(s.lines()[4], next);
    s.asked(Ask::Again(0.0));
    assert_eq!(s.lines()[4].raw, [s.lines()[4].a, s.lines()[4].b]);
    s.asked(Ask::Again(1.0));
    assert_eq!(s.lines()[4], best);
}

#[test]
fn a_ghost_is_picked_where_it_is_seen_whatever_is_drawn() {
    let mut s = Studio::drawing();
    square(&mut s);
    s.pull(v(-0.19, 0.81, 0.01), v(0.03, 1.22, -0.01));
    let best = s.lines()[4].clone();
    let last = |s: &Studio| s.world().resource::<Draft>().last.clone().unwrap();
    let [was, other] = [0, 1].map(|i| last(&s).places[i].as_vec3());
    assert!(was.distance(other) > 0.01, "{was} {other}");
    // Also while the trigger draws strokes.
    s.draws(Draws::Stroke);
    s.reach(R, other);
    assert_eq!(s.world().resource::<Draft>().over, Some(1));
    s.frames(3);
    s.click(R, Action::Act);
    assert_eq!(last(&s).chosen, 1, "{:?}", s.warnings());
    assert_ne!(s.lines()[4], best);
    // The best is a ghost now.
    s.draws(Draws::Line);
    let place = last(&s).places[0].as_vec3();
    s.reach(R, place);
    s.click(R, Action::Act);
    assert_eq!(s.lines()[4], best);
    assert_eq!((s.lines().len(), s.strokes().len()), (5, 0));
    // Long after it is an ordinary place again.
    let place = last(&s).places[1].as_vec3();
    s.reach(R, v(1.0, 1.5, 0.5));
    s.pass(7.0);
    s.reach(R, place);
    assert_eq!(s.world().resource::<Draft>().over, None);
}

#[test]
fn a_short_line_across_a_line_is_a_tick_mark_and_two_presses_join_two_points() {
    let mut s = Studio::drawing();
    s.pull(v(0.0, 1.0, 0.0), v(0.6, 1.0, 0.0));
    s.pull(v(0.15, 0.99, 0.0), v(0.15, 1.008, 0.0));
    let line = &s.lines()[0];
    assert_eq!(line.ticks.len(), 1);
    let at = line.a.lerp(line.b, line.ticks[0]);
    assert!(
        at.distance(DVec3::new(0.15, line.a.y, line.a.z)) < 2e-3,
        "{at}"
    );
    assert_eq!(s.world().resource::<Drawing>().keypoints().count(), 4);
    s.ask(Command::Undo);
    assert!(s.lines()[0].ticks.is_empty());
    s.ask(Command::Redo);
    // A second line beside it, then a press on an end of each.
    s.pull(v(0.0, 1.3, 0.2), v(0.6, 1.3, 0.2));
    for at in [v(0.005, 1.0, 0.0), v(0.603, 1.3, 0.2)] {
        s.reach(R, at);
        s.click(R, Action::Act);
        s.frame();
    }
    let lines = s.lines();
    assert_eq!(lines.len(), 3, "{:?}", s.warnings());
    assert!(lines[2].a.distance(lines[0].a) < 1e-9 && lines[2].b.distance(lines[1].b) < 1e-9);
}

#[test]
fn a_wobbling_circle_through_the_middles_is_round() {
    let mut s = Studio::drawing();
    square(&mut s);
    let middles: Vec<DVec3> = s.lines().iter().map(|l| l.a.midpoint(l.b)).collect();
    let centre = middles.iter().sum::<DVec3>() / 4.0;
    let radius = middles[0].distance(centre);
    s.click(R, Action::Up);
    let c = centre.as_vec3();
    s.scribble((0..=120).map(|i| {
        let t = std::f32::consts::TAU * i as f32 / 120.0;
        let wide = 0.2 + 0.008 * (5.0 * t).sin();
        c + v(wide * t.cos(), wide * t.sin(), 0.006 * (3.0 * t).cos())
    }));
    let strokes = s.strokes();
    assert_eq!(strokes.len(), 1, "{:?}", s.warnings());
    let stroke = &strokes[0];
    assert!(
        stroke.closed && stroke.segments.len() == 4,
        "{} {}",
        stroke.closed,
        stroke.segments.len()
    );
    for p in stroke.points() {
        assert!(
            (p.distance(centre) / radius - 1.0).abs() < 1e-3,
            "{}",
            p.distance(centre)
        );
    }
    assert!(stroke.raw.len() > 60);
    // It can be filled, and the plate is an operand like any other.
    s.asked(Ask::Fill);
    let plate = s.last();
    assert!(s.object(plate).recipe().is_some(), "{:?}", s.warnings());
    s.settle();
    let report = s.faultless(plate, 0.01);
    let volume = s.mesh(plate, 0.005).volume();
    let exact = std::f64::consts::PI * radius * radius * 0.01;
    assert!(
        (volume / exact - 1.0).abs() < 0.05,
        "{volume} {exact} {report:?}"
    );
    assert_eq!(s.world().resource::<Selection>().0, [plate]);
}

#[test]
fn a_drawing_is_saved_opened_and_exported_as_it_is() {
    let mut s = Studio::drawing();
    square(&mut s);
    s.draws(Draws::Stroke);
    s.scribble((0..=60).map(|i| {
        v(
            -0.2 + 0.4 * i as f32 / 60.0,
            0.8 + 0.01 * (i as f32 * 0.2).sin(),
            0.0,
        )
    }));
    s.asked(Ask::Width(0.02));
    let drawn = s.document().clone();
    let file = s.home.path().join("drawing.midair");
    s.ask(Command::SaveAs(file.clone()));
    s.settle();
    let home = s.home.path().to_owned();
    for name in ["drawing.obj", "drawing.glb", "drawing.stl"] {
        s.ask(Command::Export {
            path: home.join(name),
            step: None,
            unit: None,
            up: None,
            only: None,
        });
        s.settle();
        assert!(home.join(name).exists(), "{name}: {:?}", s.warnings());
    }
    let text = std::fs::read_to_string(home.join("drawing.obj")).unwrap();
    assert_eq!(text.lines().filter(|l| l.starts_with("l ")).count(), 5);
    s.asked(Ask::Sheet(Some(home.join("sheet.svg"))));
    s.settle();
    written(&mut s, &home.join("sheet.svg"));
    let sheet = std::fs::read_to_string(home.join("sheet.svg")).unwrap();
    // Four lines and a stroke in each of four views.
    assert_eq!(sheet.matches("<path").count(), 20);
    s.asked(Ask::History(Some(home.join("history.json"))));
    s.settle();
    written(&mut s, &home.join("history.json"));
    let told = std::fs::read_to_string(home.join("history.json")).unwrap();
    let told: serde_json::Value = serde_json::from_str(&told).unwrap();
    let steps = told["steps"].as_array().unwrap();
    assert_eq!(steps.len(), s.undo_len());
    let first = steps
        .iter()
        .find(|step| step["name"] == "Draw line")
        .unwrap();
    assert_eq!(first["drawn"][0]["kind"], "line");
    s.ask(Command::New);
    s.settle();
    assert!(s.document().is_empty());
    s.ask(Command::Open(file));
    s.settle();
    assert_eq!(s.document(), &drawn);
}

#[test]
fn lines_are_touched_moved_selected_and_deleted_like_any_object() {
    let mut s = Studio::drawing();
    s.pull(v(0.0, 1.0, 0.0), v(0.6, 1.0, 0.0));
    let line = s.last();
    s.reach(R, v(0.3, 1.01, 0.0));
    assert_eq!(s.touched(R), Some(line));
    // Moved by its placement it is found where it stands.
    s.ask(Command::Objects(objects::Ask::Place(vec![(
        line,
        Placement::at(v(0.0, 0.5, 0.0)),
    )])));
    s.frame();
    assert_eq!(s.touched(R), None);
    s.reach(R, v(0.3, 1.51, 0.0));
    assert_eq!(s.touched(R), Some(line));
    // A line beside it is corrected into it where it stands now.
    s.pull(v(0.01, 1.51, 0.01), v(0.01, 1.9, 0.0));
    let lines = s.lines();
    assert!(
        (lines[1].a - (lines[0].a + DVec3::Y * 0.5)).length() < 1e-9,
        "{lines:?}"
    );
    s.ask(Command::Objects(objects::Ask::Delete));
    s.ask(Command::Objects(objects::Ask::Select {
        ids: vec![line],
        how: objects::How::Set,
    }));
    s.ask(Command::Objects(objects::Ask::Delete));
    assert_eq!(s.lines().len(), 1);
}

#[test]
fn lengths_and_angles_are_set_and_lines_hidden_and_grouped() {
    let mut s = Studio::drawing();
    s.pull(v(0.0, 1.0, 0.0), v(0.6, 1.0, 0.0));
    s.asked(Ask::Length(0.5));
    s.asked(Ask::Angles {
        rise: 30.0,
        heading: 90.0,
    });
    let line = s.lines()[0].clone();
    let along = line.b - line.a;
    assert!((along.length() - 0.5).abs() < 1e-9);
    assert!(
        along.distance(DVec3::new(0.0, 0.25, -0.5 * 30.0_f64.to_radians().cos())) < 1e-9,
        "{along}"
    );
    s.pull(v(0.5, 1.0, 0.0), v(0.5, 1.4, 0.0));
    let ids: Vec<ObjectId> = s.document().objects().map(|(id, _)| id).collect();
    s.ask(Command::Objects(objects::Ask::Select {
        ids: ids.clone(),
        how: objects::How::Set,
    }));
    s.asked(Ask::Between(45.0));
    let lines = s.lines();
    let d: Vec<DVec3> = lines.iter().map(|l| (l.b - l.a).normalize()).collect();
    assert!((d[0].dot(d[1]).abs() - 45.0_f64.to_radians().cos()).abs() < 1e-9);
    // An angle of one's own: the next line that meets one at almost it meets it at just that.
    s.asked(Ask::OwnAngle(72.0));
    let (foot, base) = (lines[0].a, d[0]);
    let side = base.cross(DVec3::Y).normalize();
    let a = 74.5_f64.to_radians();
    let tip = foot + (base * a.cos() + side * a.sin()) * 0.37;
    s.pull(foot.as_vec3(), tip.as_vec3());
    let third = s.lines()[2].clone();
    let met = (third.b - third.a).normalize().dot(base);
    assert!(
        (met - 72.0_f64.to_radians().cos()).abs() < 1e-6,
        "{third:?}"
    );
    s.asked(Ask::OwnAngle(0.0));
    s.ask(Command::Undo);
    s.asked(Ask::Group);
    assert!(s.document().outermost_group(ids[0]).is_some());
    s.ask(Settings::command("scaffold.lines", LinesShown::Hidden));
    s.frame();
    assert!(s.world().resource::<Drawing>().lines().is_empty());
    s.asked(Ask::Length(f64::NAN));
    s.asked(Ask::Again(f64::NAN));
    s.ask(Command::Tool {
        tool: SCAFFOLD,
        ask: "dance".into(),
    });
    assert_eq!(s.warnings().len(), 1, "{:?}", s.warnings());
}
