//! A box of construction lines with a stroke round its top, by mouse and keyboard alone and by gamepad alone, recorded
//! and played back.

use std::path::Path;

use bevy::input::gamepad::GamepadButton as Button;
use bevy::math::DVec3;
use bevy::prelude::*;
use midair_document::{ConstructionLine, DrawnStroke};
use midair_scaffold::{Draft, SCAFFOLD};
use midair_studio::command::Command;
use midair_studio::hands::Side;

use crate::desk::Desk;

impl Desk {
    fn all_lines(&self) -> Vec<ConstructionLine> {
        let all = self.document().objects();
        all.filter_map(|(_, o)| o.line().cloned()).collect()
    }

    fn stroke(&self) -> DrawnStroke {
        let mut all = self.document().objects();
        all.find_map(|(_, o)| o.stroke().cloned())
            .expect("a stroke")
    }

    /// Where the next-best reading of what was drawn last is picked.
    fn ghost(&self) -> Vec3 {
        let draft = self.world().resource::<Draft>();
        let last = draft.last.as_ref().expect("something was drawn");
        assert!(last.readings.len() > 1 && last.chosen == 0, "{last:?}");
        last.places[1].as_vec3()
    }

    fn chosen(&self) -> usize {
        let draft = self.world().resource::<Draft>();
        draft.last.as_ref().expect("something was drawn").chosen
    }
}

fn recorded(path: &Path, title: &str) -> Desk {
    let mut desk = Desk::recorded(path, title);
    // As the mode's button on the bar asks.
    desk.app.world_mut().write_message(Command::Mode(SCAFFOLD));
    desk.wait(3);
    desk
}

const LOW: Vec3 = Vec3::new(-0.16, 0.0, -0.12);
const HIGH: Vec3 = Vec3::new(0.16, 0.2, 0.12);

/// The corners of the ground and those above them, both round in the same sense.
fn corners() -> [Vec3; 8] {
    let at = |x: bool, y: bool, z: bool| {
        let pick = |high, axis: usize| if high { HIGH[axis] } else { LOW[axis] };
        Vec3::new(pick(x, 0), pick(y, 1), pick(z, 2))
    };
    [
        at(false, false, true),
        at(true, false, true),
        at(true, false, false),
        at(false, false, false),
        at(false, true, true),
        at(true, true, true),
        at(true, true, false),
        at(false, true, false),
    ]
}

/// The edges in the order in which one draws them: the ground, the posts, the top.
const EDGES: [(usize, usize); 12] = [
    (0, 1),
    (1, 2),
    (2, 3),
    (3, 0),
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 7),
    (4, 5),
    (5, 6),
    (6, 7),
    (7, 4),
];

/// Where the corners are by what is drawn; those that no line has reached are where they were meant to be, seen from
/// the nearest that stands.
fn stands(lines: &[ConstructionLine]) -> [DVec3; 8] {
    let meant = corners().map(|c| c.as_dvec3());
    let mut at: [Option<DVec3>; 8] = [None; 8];
    for (line, (i, j)) in lines.iter().zip(EDGES) {
        at[i].get_or_insert(line.a);
        at[j].get_or_insert(line.b);
    }
    std::array::from_fn(|i| {
        at[i].unwrap_or_else(|| {
            let from = EDGES.iter().find_map(|&(a, b)| {
                let other = if a == i { b } else { a };
                at[other].filter(|_| a == i || b == i).map(|p| (p, other))
            });
            from.map_or(meant[i], |(p, other)| p + meant[i] - meant[other])
        })
    })
}

fn is_box(lines: &[ConstructionLine]) {
    let at = stands(lines);
    for (line, (i, j)) in lines.iter().zip(EDGES) {
        assert!(
            line.a.distance(at[i]) < 1e-6 && line.b.distance(at[j]) < 1e-6,
            "{lines:?}"
        );
    }
    let sides = [at[1] - at[0], at[4] - at[0], at[3] - at[0]];
    for i in 0..3 {
        let (a, b) = (sides[i].normalize(), sides[(i + 1) % 3].normalize());
        assert!(a.dot(b).abs() < 1e-6, "{sides:?}");
    }
    for (i, &(a, b)) in EDGES.iter().enumerate() {
        let side = sides[[0, 2, 0, 2, 1, 1, 1, 1, 0, 2, 0, 2][i]];
        let edge = at[b] - at[a];
        assert!(
            edge.distance(side).min((edge + side).length()) < 1e-6,
            "edge {i}: {edge} {side}"
        );
    }
}

/// A loop through the middles of the top's edges.
fn round_the_top(lines: &[ConstructionLine]) -> Vec<Vec3> {
    let at = stands(lines);
    let middle = (at[4] + at[6]) * 0.5;
    let (u, v) = ((at[5] - at[4]) * 0.5, (at[5] - at[6]) * 0.5);
    (0..=32)
        .map(|i| {
            let t = std::f64::consts::TAU * f64::from(i) / 32.0;
            (middle + u * t.cos() + v * t.sin()).as_vec3()
        })
        .collect()
}

fn is_fair_loop(desk: &Desk, lines: &[ConstructionLine]) {
    let stroke = desk.stroke();
    assert!(stroke.closed && stroke.reading.auto, "{stroke:?}");
    let height = stands(lines)[4].y;
    for p in stroke.points() {
        assert!((p.y - height).abs() < 1e-6, "it leaves the top: {p}");
    }
    for k in [8, 9, 10, 11] {
        let middle = lines[k].a.midpoint(lines[k].b);
        let points = stroke.points();
        let near = points.iter().map(|p| p.distance(middle));
        assert!(near.fold(f64::INFINITY, f64::min) < 1e-3, "edge {k}");
    }
}

#[test]
fn a_box_with_a_loop_by_mouse_alone_plays_back_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("box.ron");
    let mut desk = recorded(&recording, "A box with a loop, by mouse");
    // The ground goes on the work plane; everything else hangs on what is drawn.
    desk.strike_one(KeyCode::KeyP);
    for (n, (i, j)) in EDGES.into_iter().enumerate() {
        if n == 4 {
            desk.strike_one(KeyCode::KeyP);
        }
        let at = stands(&desk.all_lines());
        let [from, to] = [i, j].map(|k| desk.pixel(at[k].as_vec3()));
        // A hand is a few pixels off.
        let off = Vec2::new(2.0 - (n % 3) as f32, (n % 4) as f32 - 1.5);
        desk.drag(MouseButton::Left, from + off, to - off);
        assert_eq!(desk.all_lines().len(), n + 1, "{:?}", desk.warnings());
    }
    let lines = desk.all_lines();
    is_box(&lines);
    // One more, and of its readings that which the pointer picks.
    let at = stands(&lines);
    let from = desk.pixel(at[4].as_vec3());
    let to = desk.pixel((at[4] + DVec3::new(0.05, 0.12, 0.02)).as_vec3());
    desk.drag(MouseButton::Left, from, to);
    let place = desk.ghost();
    let place = desk.pixel(place);
    desk.glide(place);
    desk.click();
    assert_eq!(desk.chosen(), 1, "{:?}", desk.warnings());
    assert_eq!(desk.all_lines().len(), 13);
    // Also while strokes are drawn: the best is a ghost now.
    desk.strike_one(KeyCode::ArrowUp);
    let place = desk
        .world()
        .resource::<Draft>()
        .last
        .as_ref()
        .unwrap()
        .places[0]
        .as_vec3();
    let place = desk.pixel(place);
    desk.glide(place);
    desk.click();
    assert_eq!(desk.chosen(), 0, "{:?}", desk.warnings());
    assert_eq!(desk.document().len(), 13);
    // Strokes take their depth from what they cross.
    let path = round_the_top(&lines);
    let start = desk.pixel(path[0]);
    desk.glide(start);
    desk.mouse(MouseButton::Left, true);
    desk.wait(2);
    for p in &path[1..] {
        let to = desk.pixel(*p);
        desk.cursor(to);
        desk.wait(2);
    }
    desk.mouse(MouseButton::Left, false);
    desk.wait(3);
    is_fair_loop(&desk, &lines);
    let points = desk.stroke().points();
    let on = desk.pixel(points[points.len() / 8].as_vec3());
    desk.glide(on);
    desk.wait(2);
    desk.strike_one(KeyCode::KeyE);
    desk.settle();
    desk.plays_back(&recording, 14);
}

#[test]
fn a_box_with_a_loop_by_gamepad_alone_plays_back_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("box.ron");
    let mut desk = recorded(&recording, "A box with a loop, by gamepad");
    desk.plug();
    for (n, (i, j)) in EDGES.into_iter().enumerate() {
        let at = stands(&desk.all_lines());
        desk.aim(at[i].as_vec3());
        desk.down(Button::RightTrigger2);
        desk.aim(at[j].as_vec3());
        desk.up(Button::RightTrigger2);
        desk.wait(3);
        assert_eq!(desk.all_lines().len(), n + 1, "{:?}", desk.warnings());
    }
    let lines = desk.all_lines();
    is_box(&lines);
    let at = stands(&lines);
    desk.aim(at[4].as_vec3());
    desk.down(Button::RightTrigger2);
    desk.aim((at[4] + DVec3::new(0.05, 0.12, 0.02)).as_vec3());
    desk.up(Button::RightTrigger2);
    desk.wait(3);
    let place = desk.ghost();
    desk.aim(place);
    desk.tap(Button::RightTrigger2);
    assert_eq!(desk.chosen(), 1, "{:?}", desk.warnings());
    desk.tap(Button::DPadUp);
    let path = round_the_top(&lines);
    desk.aim(path[0]);
    desk.down(Button::RightTrigger2);
    for p in path[1..].iter().step_by(2).chain(&path[32..]) {
        desk.aim(*p);
    }
    desk.up(Button::RightTrigger2);
    desk.wait(3);
    is_fair_loop(&desk, &lines);
    let points = desk.stroke().points();
    desk.aim(points[points.len() / 8].as_vec3());
    let side = desk.pad_hands().leading();
    assert_eq!(side, Side::Right);
    desk.tap(Button::Select);
    desk.settle();
    desk.plays_back(&recording, 14);
}
