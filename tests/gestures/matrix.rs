//! The four modes as one instrument: what each of them makes is carried into each of the others, used
//! there, changed at its source, undone, redone, and written without a fault. docs/between-the-modes.md is this
//! table in words.

use bevy::prelude::*;
use midair_brush::{BRUSH, canvas};
use midair_csg::ASSEMBLE;
use midair_document::{Document, Object, ObjectId};
use midair_field::{Op, Skeleton};
use midair_mesh::check;
use midair_scaffold::SCAFFOLD;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose};
use midair_studio::settings::{SweepHands, SweepShape};
use midair_studio::tools::ToolId;
use midair_sweep::{Phase, SWEEP};

use crate::sources::{AWAY, BESIDE, R, SOURCES, Source, What};
use crate::studio::{Studio, near};
use crate::sweep::{LEFT, RIGHT};

/// United with a ball where it is, and that taken from a block: a cutter.
fn assembled(s: &mut Studio, id: ObjectId, at: Vec3) {
    let result = {
        let ball = s.place("solid/sphere", at);
        s.click(R, Action::Library);
        assert_eq!(
            s.marks()
                .iter()
                .filter(|(o, _)| *o == id || *o == ball)
                .count(),
            1
        );
        s.ask(Command::Carry {
            objects: vec![ball],
            to: ASSEMBLE,
        });
        s.frames(2);
        s.reach(R, AWAY);
        s.finish();
        s.newest()
    };
    s.written(result);
    let block = s.place("solid/cube", at + Vec3::new(0.12, 0.05, 0.04));
    s.click(R, Action::Library);
    let whole = check(&s.mesh(block, 0.02)).volume;
    for (object, op) in [(block, Op::Union), (result, Op::Subtract)] {
        s.ask(Command::Carry {
            objects: vec![object],
            to: ASSEMBLE,
        });
        s.frames(2);
        if op == Op::Subtract {
            s.operate();
            s.reach(R, at);
            // Two things are in one place: which of them the hand touches decides.
            if s.touched(R) == Some(result) {
                s.click(R, Action::Down);
            } else {
                let pending = vec![(block, Op::Union), (result, op)];
                s.ask(Command::Edit(midair_document::Edit::SetPending { pending }));
            }
        }
    }
    assert_eq!(s.marks(), [(block, Op::Union), (result, Op::Subtract)]);
    s.reach(R, AWAY);
    s.finish();
    s.click(R, Action::Cancel);
    let cut = s.newest();
    s.written(cut);
    let left = check(&s.mesh(cut, 0.02)).volume;
    assert!(left < whole, "{left} of {whole}");
}

/// Painted with beside itself.
fn stamped(s: &mut Studio) -> ObjectId {
    s.dab(BESIDE);
    let id = s.newest();
    assert!(
        canvas(s.object(id)).is_some(),
        "a painting: {}",
        s.notices()
    );
    s.written(id);
    id
}

/// The hands go where a row, or a surface, is swept beside the source.
fn sweep_beside(s: &mut Studio) -> ObjectId {
    s.set("hands", SweepHands::Two);
    let level = |x: f32| Pose {
        position: BESIDE + Vec3::X * x,
        rotation: Quat::from_rotation_z(if x < 0.0 { 0.6 } else { -0.6 }),
    };
    s.carry(Some(level(-0.25)), Some(level(0.25)));
    s.frames(12);
    s.swipe_away(Vec3::Z * -0.2, 0.6)
}

/// The only line that was said since.
fn said(s: &Studio, before: usize, word: &str) {
    let lines = &s.warnings()[before..];
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert!(lines[0].contains(word), "{lines:?}");
}

/// What comes of a cell; whether the source may be changed afterwards.
fn cell(s: &mut Studio, source: &Source, id: ObjectId, at: Vec3, to: &ToolId) {
    let before = s.warnings().len();
    s.carried(id, at, to.clone());
    match (source.what, to.as_str()) {
        // Assemble.
        (What::Drawn, "csg") => {
            said(s, before, "was not filled");
            assert_eq!(s.marks(), []);
        }
        (What::Loop, "csg") => {
            let made = s.newest();
            assert_eq!(s.marks(), [(made, Op::Union)]);
            assembled(s, made, Vec3::new(0.0, 1.0, 0.0));
        }
        (What::Open, "csg") => {
            assert_eq!(
                s.warnings().len(),
                before,
                "one line, and that an offer: {}",
                s.notices()
            );
            assert!(s.swinging().offer.is_some(), "{}", s.notices());
            s.reach(R, AWAY);
            s.click(R, Action::Finish);
            s.settle();
            assert_eq!(s.marks(), [(id, Op::Union)]);
            assembled(s, id, at);
        }
        (What::Solid | What::Painting, "csg") => {
            assert_eq!(s.marks(), [(id, Op::Union)]);
            assembled(s, id, at);
        }
        // Scaffold.
        (What::Drawn | What::Loop, "scaffold") => said(s, before, "Scaffold's already"),
        (_, "scaffold") => {
            let lines = s.document().objects().filter(|(_, o)| o.line().is_some());
            assert_eq!(lines.count(), 12, "the box around it");
            assert!(s.object(id).dimmed);
        }
        // Sweep.
        (What::Drawn | What::Loop, "sweep") => {
            s.set("shape", SweepShape::Surface);
            s.set("thickness", 0.02);
            s.both(LEFT, RIGHT, 0.3);
            s.frames(12);
            let made = s.swipe_away(Vec3::Z * -0.25, 0.3);
            let ends = s.swept(made).ribs.iter().map(|r| r.points[0]);
            let to_world = s.placement(made).affine();
            let rail = s.swinging().rails[0].as_ref().expect("a rail").line.clone();
            for end in ends {
                let there = to_world.transform_point3(end).as_dvec3();
                let on = rail.at(rail.nearest(there)).unwrap();
                assert!(on.distance(there) < 1e-4, "{there} is not on the rail");
            }
            s.written(made);
        }
        (What::Open, "sweep") => {
            assert!(matches!(s.swinging().phase, Phase::Editing { object, .. } if object == id));
            let ribs = s.swept(id).ribs.clone();
            s.reach(R, at);
            s.press(R, Action::Act);
            s.carry_right(at + Vec3::Y * 0.05);
            s.let_go(R, Action::Act);
            s.frames(2);
            assert_ne!(s.swept(id).ribs, ribs, "bent");
            s.click(R, Action::Finish);
        }
        (_, "sweep") => {
            s.set("clones", 3);
            s.set("clone_size", 0.12);
            s.set("spread", false);
            let made = sweep_beside(s);
            assert_ne!(made, id);
            s.written(made);
        }
        // Brush.
        (What::Drawn | What::Loop, "brush") => {
            let made = s.newest();
            assert_eq!(canvas(s.object(made)).map(|c| c.strokes.len()), Some(1));
            assert!(s.object(id).dimmed);
            s.written(made);
        }
        (What::Open, "brush") => {
            assert_eq!(
                s.warnings().len(),
                before,
                "one line, and that an offer: {}",
                s.notices()
            );
            s.reach(R, AWAY);
            s.click(R, Action::Finish);
            s.settle();
            assert!(s.object(id).recipe().is_some(), "closed");
            stamped(s);
        }
        (What::Painting, "brush") => {
            s.dab(at + Vec3::X * 0.1);
            assert_eq!(canvas(s.object(id)).unwrap().strokes.len(), 2);
            s.written(id);
        }
        (What::Solid, "brush") => {
            stamped(s);
        }
        other => panic!("{other:?}"),
    }
}

/// What follows a source that was moved by so much: a sweep's rail, a painting's skeleton. What is painted
/// with a solid follows its shape, and that is as it was.
fn followed(was: &Object, is: &Object, by: Vec3) {
    if let (Some(was), Some(is)) = (canvas(was), canvas(is)) {
        for (a, b) in is.strokes.iter().zip(&was.strokes) {
            match (&a.skeleton, &b.skeleton) {
                (Skeleton::Points(a), Skeleton::Points(b)) => {
                    for (a, b) in a.iter().zip(b.iter()) {
                        near(a.truncate(), b.truncate() + by, 1e-4);
                    }
                }
                (Skeleton::Line(a, c), Skeleton::Line(b, d)) => {
                    near(*a, *b + by, 1e-4);
                    near(*c, *d + by, 1e-4);
                }
                _ => assert_eq!(a, b),
            }
        }
        return;
    }
    let ribs = |o: &Object| o.sweep().expect("a sweep").ribs.clone();
    for (a, b) in ribs(is).iter().zip(ribs(was).iter()) {
        near(a.points[0], b.points[0] + by, 1e-4);
        assert_eq!(a.points[1], b.points[1], "the other end stays");
    }
}

/// The source is moved by hand, where it is still there; what follows it does so in the same step. Whether
/// that was done.
fn edited(s: &mut Studio, source: &Source, id: ObjectId, at: Vec3) -> bool {
    if s.document().object(id).is_none() {
        return false;
    }
    s.mode(ASSEMBLE);
    let follows: Vec<ObjectId> = {
        let all = s.document().objects();
        let linked = all.filter(|(_, o)| o.links.iter().any(|l| l.source == id));
        linked.map(|(id, _)| id).collect()
    };
    let others = |d: &Document| -> Vec<_> {
        let rest = d
            .objects()
            .filter(|(o, _)| *o != id && !follows.contains(o));
        rest.map(|(o, x)| (o, x.clone())).collect()
    };
    let (rest, steps) = (others(s.document()), s.undo_len());
    let before: Vec<_> = follows.iter().map(|&o| s.object(o).clone()).collect();
    s.reach(R, at);
    if s.touched(R) != Some(id) {
        // Something that was made of it is in front.
        return false;
    }
    let by = Vec3::new(-0.05, 0.06, 0.0);
    s.shifted(id, at, by);
    assert_eq!(s.undo_len(), steps + 1, "{}", source.name);
    assert!(
        others(s.document()) == rest,
        "what holds it by value is as it was"
    );
    for (&object, was) in follows.iter().zip(&before) {
        followed(was, s.object(object), by);
        s.written(object);
    }
    true
}

/// One column of the table; how many sources were moved afterwards.
fn column(to: &ToolId) -> usize {
    let mut moved = Vec::new();
    for source in &SOURCES {
        let mut s = Studio::new();
        let from = s.undo_len();
        let (id, at) = (source.make)(&mut s);
        s.settle();
        cell(&mut s, source, id, at, to);
        if edited(&mut s, source, id, at) {
            moved.push(source.name);
        }
        s.back_and_forth(from);
    }
    println!("into {to}: moved afterwards {moved:?}");
    moved.len()
}

#[test]
fn everything_that_is_made_is_carried_into_assemble() {
    assert!(column(&ASSEMBLE) >= 2);
}

#[test]
fn everything_that_is_made_is_carried_into_scaffold() {
    assert!(column(&SCAFFOLD) >= 9);
}

#[test]
fn everything_that_is_made_is_carried_into_sweep() {
    assert!(column(&SWEEP) >= 9);
}

#[test]
fn everything_that_is_made_is_carried_into_brush() {
    assert!(column(&BRUSH) >= 9);
}
