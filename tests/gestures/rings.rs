//! The ring of modes in a room: a thing in the hand goes along with the mode that the hand chooses there. For every pair of
//! modes what the one makes is taken, carried through the ring, used by the other, and taken back.

use std::f32::consts::TAU;

use bevy::prelude::*;
use midair::wear;
use midair_brush::{BRUSH, Easel, canvas};
use midair_csg::ASSEMBLE;
use midair_document::ObjectId;
use midair_field::Op;
use midair_scaffold::SCAFFOLD;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::settings::{Settings, SweepItem};
use midair_studio::tools::{ToolId, Tools};
use midair_sweep::SWEEP;

use crate::sources;
use crate::studio::{Studio, near};

const R: Side = Side::Right;
const EYES: Vec3 = Vec3::new(0.0, 1.6, 1.5);

impl Studio {
    fn active(&self) -> ToolId {
        let tools = self.world().resource::<Tools>();
        tools.active().expect("a mode").id.clone()
    }

    /// Which way from the middle of the ring a mode lies, for who looks at it from [`EYES`].
    fn towards(&self, at: Vec3, to: &ToolId) -> Vec3 {
        let all = self.world().resource::<Tools>().all();
        let place = all.iter().position(|t| t.id == *to).expect("a mode");
        let (x, y) = (TAU * place as f32 / all.len() as f32).sin_cos();
        let facing = Transform::IDENTITY.looking_to(at - EYES, Vec3::Y);
        facing.rotation * Vec3::new(x, y, 0.0)
    }

    /// Taken in hand, the ring held open with the same hand, moved over a mode and let go there.
    fn through_the_ring(&mut self, id: ObjectId, at: Vec3, to: &ToolId) {
        self.take(id, at);
        self.press(R, Action::Menu);
        self.pass(0.44);
        self.carry_right(at + 0.08 * self.towards(at, to));
        assert_eq!(self.held().get(R), Some(id), "it comes along");
        self.let_go(R, Action::Menu);
        self.frames(3);
        assert!(self.held().is_empty(), "the mode has it");
        assert_eq!(self.active(), *to);
        self.let_go(R, Action::Grab);
        self.frames(3);
        self.settle();
    }
}

/// What a mode makes, and where to take it.
type Made = (ToolId, fn(&mut Studio) -> (ObjectId, Vec3));

const MADE: [Made; 4] = [
    (ASSEMBLE, sources::component),
    (SCAFFOLD, sources::ring),
    (SWEEP, sources::plate),
    (BRUSH, sources::painting),
];

/// What the other mode has of it now.
fn used(s: &Studio, id: ObjectId, to: &ToolId, before: usize) {
    match to.as_str() {
        "csg" => {
            let marks = s.marks();
            let [(marked, Op::Union)] = marks[..] else {
                panic!("{marks:?}")
            };
            assert!(marked == id || s.object(id).stroke().is_some());
        }
        "scaffold" => {
            let lines = s.document().objects().filter(|(_, o)| o.line().is_some());
            assert_eq!(lines.count(), 12, "the box around it");
        }
        "sweep" if s.object(id).stroke().is_some() => {
            let rail = s.swinging().rails[0].as_ref().expect("a rail");
            assert_eq!(rail.object, id);
        }
        "sweep" => {
            let item = &s.world().resource::<Settings>().sweep.item;
            assert_eq!(*item, SweepItem::Object(id.0));
        }
        "brush" if s.object(id).stroke().is_some() => {
            assert_eq!(s.document().len(), before + 1);
            let (_, painting) = s.document().objects().next_back().unwrap();
            assert_eq!(canvas(painting).map(|c| c.strokes.len()), Some(1));
        }
        "brush" => {
            let carried = s.world().resource::<Easel>().carried.as_ref();
            assert!(carried.is_some(), "{}", s.notices());
        }
        other => panic!("{other}"),
    }
}

#[test]
fn whatever_is_in_the_hand_goes_through_the_ring_into_every_other_mode() {
    for (from, make) in MADE {
        let mut s = Studio::with(wear);
        s.input().head = Some(Pose::at(EYES));
        let (id, at) = make(&mut s);
        s.settle();
        for to in [ASSEMBLE, SCAFFOLD, SWEEP, BRUSH] {
            if to == from {
                continue;
            }
            let (was, steps) = (s.document().content_hash(), s.undo_len());
            let (place, count) = (s.placement(id), s.document().len());
            s.mode(from.clone());
            s.through_the_ring(id, at, &to);
            used(&s, id, &to, count);
            near(s.placement(id).translation, place.translation, 0.0);
            s.reach(R, sources::AWAY);
            assert!(s.undo_len() <= steps + 1, "one step");
            while s.undo_len() > steps {
                s.click(Side::Left, Action::Undo);
                s.settle();
            }
            assert_eq!(s.document().content_hash(), was, "{from} into {to}");
        }
        assert_eq!(s.warnings(), [] as [String; 0]);
    }
}

#[test]
fn a_ring_that_is_cancelled_or_let_go_in_its_middle_carries_nothing() {
    let mut s = Studio::with(wear);
    s.input().head = Some(Pose::at(EYES));
    let (id, at) = sources::component(&mut s);
    s.settle();
    for cancelled in [true, false] {
        s.take(id, at);
        s.press(R, Action::Menu);
        s.pass(0.44);
        if cancelled {
            s.carry_right(at + 0.08 * s.towards(at, &BRUSH));
            s.press(R, Action::Cancel);
        }
        s.let_go(R, Action::Menu);
        s.frames(3);
        s.let_go(R, Action::Cancel);
        s.let_go(R, Action::Grab);
        s.frames(3);
        assert_eq!(s.active(), ASSEMBLE);
        while s.placement(id).translation != at {
            s.click(Side::Left, Action::Undo);
        }
    }
    assert!(s.world().resource::<Easel>().carried.is_none());
}
