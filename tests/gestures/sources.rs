//! What each mode makes by gesture, for tests that take it elsewhere.

use std::f32::consts::TAU;

use bevy::prelude::*;
use midair_brush::BRUSH;
use midair_csg::ASSEMBLE;
use midair_document::ObjectId;
use midair_field::Node;
use midair_mesh::check;
use midair_scaffold::SCAFFOLD;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::objects::{Ask, How};
use midair_studio::settings::{Draws, Settings, SweepItem, SweepShape};
use midair_studio::tools::ToolId;

use crate::studio::Studio;
use crate::sweep::{LEFT, RIGHT};

pub const R: Side = Side::Right;
/// Where nothing is.
pub const AWAY: Vec3 = Vec3::new(0.0, 4.0, 0.0);
/// Where things of other modes are made beside the source.
pub const BESIDE: Vec3 = Vec3::new(0.9, 1.0, 0.0);

/// What a mode makes, as far as the others tell it apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    Drawn,
    Loop,
    Open,
    Solid,
    Painting,
}

/// A thing that a mode makes by gesture, and a place on it.
pub struct Source {
    pub name: &'static str,
    pub what: What,
    pub make: fn(&mut Studio) -> (ObjectId, Vec3),
}

pub const SOURCES: [Source; 13] = [
    Source {
        name: "a component",
        what: What::Solid,
        make: component,
    },
    Source {
        name: "a boolean result",
        what: What::Solid,
        make: boolean,
    },
    Source {
        name: "a line",
        what: What::Drawn,
        make: line,
    },
    Source {
        name: "a stroke",
        what: What::Drawn,
        make: stroke,
    },
    Source {
        name: "a closed stroke",
        what: What::Loop,
        make: ring,
    },
    Source {
        name: "a filled loop",
        what: What::Solid,
        make: filled,
    },
    Source {
        name: "a surface",
        what: What::Open,
        make: surface,
    },
    Source {
        name: "an open tube",
        what: What::Open,
        make: open_tube,
    },
    Source {
        name: "a plate",
        what: What::Solid,
        make: plate,
    },
    Source {
        name: "a tube",
        what: What::Solid,
        make: tube,
    },
    Source {
        name: "a pipe",
        what: What::Solid,
        make: pipe,
    },
    Source {
        name: "a row of clones",
        what: What::Solid,
        make: clones,
    },
    Source {
        name: "a painting",
        what: What::Painting,
        make: painting,
    },
];

impl Studio {
    /// The mode in hand, the hands away from everything.
    pub fn mode(&mut self, id: ToolId) {
        self.ask(Command::Mode(id));
        self.reach(R, AWAY);
    }

    /// Taken in hand where it is.
    pub fn take(&mut self, id: ObjectId, at: Vec3) {
        self.reach(R, at);
        assert_eq!(
            self.touched(R),
            Some(id),
            "{} at {at}",
            self.object(id).name
        );
        self.press(R, Action::Grab);
    }

    /// Taken in hand where it is, let go over a mode, and the button let go after it.
    pub fn carried(&mut self, id: ObjectId, at: Vec3, to: ToolId) {
        self.take(id, at);
        assert_eq!(self.held().get(R), Some(id));
        let objects = Vec::new();
        self.ask(Command::Carry { objects, to });
        self.frames(2);
        self.let_go(R, Action::Grab);
        self.frames(3);
        self.settle();
    }

    /// Taken in hand and put down elsewhere.
    pub fn shifted(&mut self, id: ObjectId, at: Vec3, by: Vec3) {
        self.take(id, at);
        self.carry_right(at + by);
        self.let_go(R, Action::Grab);
        self.frames(2);
        self.settle();
    }

    pub fn dab(&mut self, at: Vec3) {
        self.reach(R, at);
        self.click(R, Action::Act);
        self.settle();
    }

    pub fn newest(&self) -> ObjectId {
        self.document().objects().next_back().expect("something").0
    }

    /// Written by itself, as a file that has no fault.
    pub fn written(&mut self, id: ObjectId) {
        let path = self.home.path().join("one.stl");
        let before = self.warnings().len();
        self.ask(Command::Export {
            path: path.clone(),
            step: None,
            unit: None,
            only: Some(id),
            up: None,
        });
        self.settle();
        assert_eq!(self.warnings().len(), before, "{:?}", self.warnings());
        let report = check(&midair_mesh::read(&path).unwrap().mesh);
        assert!(
            report.is_faultless(),
            "{}: {:?}",
            self.object(id).name,
            report.faults()
        );
    }

    /// Everything undone, and redone to the same document.
    pub fn back_and_forth(&mut self, from: usize) {
        let last = self.document().content_hash();
        let steps = self.undo_len();
        assert!(steps > from);
        while self.undo_len() > from {
            self.ask(Command::Undo);
        }
        assert!(self.document().is_empty(), "everything is taken back");
        while self.redo_len() > 0 {
            self.ask(Command::Redo);
        }
        assert_eq!(self.undo_len(), steps);
        assert_eq!(self.document().content_hash(), last);
        self.settle();
    }
}

pub fn component(s: &mut Studio) -> (ObjectId, Vec3) {
    s.mode(ASSEMBLE);
    let at = Vec3::new(0.0, 1.0, 0.0);
    let id = s.place("solid/cube", at);
    s.click(R, Action::Library);
    (id, at)
}

pub fn boolean(s: &mut Studio) -> (ObjectId, Vec3) {
    s.mode(ASSEMBLE);
    let (a, b) = (Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.15, 1.15, 0.12));
    s.place("solid/cube", a);
    s.place("solid/sphere", b);
    s.click(R, Action::Library);
    s.operate();
    s.mark(Vec3::new(-0.15, 0.85, -0.15), Action::Up);
    s.mark(Vec3::new(0.28, 1.25, 0.15), Action::Down);
    s.reach(R, AWAY);
    s.finish();
    // SceneOperate is put away.
    s.click(R, Action::Cancel);
    (s.only(), Vec3::new(-0.1, 0.9, -0.1))
}

pub fn draw(s: &mut Studio, draws: Draws) {
    s.mode(SCAFFOLD);
    s.draws(draws);
}

pub fn line(s: &mut Studio) -> (ObjectId, Vec3) {
    draw(s, Draws::Line);
    s.pull(Vec3::new(-0.2, 1.0, 0.1), Vec3::new(-0.2, 1.0, -0.3));
    (s.newest(), Vec3::new(-0.2, 1.0, -0.1))
}

pub fn stroke(s: &mut Studio) -> (ObjectId, Vec3) {
    draw(s, Draws::Stroke);
    let at = |t: f32| Vec3::new(-0.2, 1.0 + 0.06 * (t * 3.0).sin(), 0.1 - 0.4 * t);
    s.scribble((0..=40).map(|i| at(i as f32 / 40.0)));
    let id = s.newest();
    (id, on(s, id))
}

/// A place on what was drawn.
pub fn on(s: &Studio, id: ObjectId) -> Vec3 {
    let object = s.object(id);
    let points = object.stroke().expect("a stroke").points();
    let there = midair_document::affine(&object.placement);
    there.transform_point3(points[points.len() / 3]).as_vec3()
}

pub fn ring(s: &mut Studio) -> (ObjectId, Vec3) {
    draw(s, Draws::Stroke);
    let at = |t: f32| {
        let (y, x) = (t * TAU).sin_cos();
        Vec3::new(0.2 * x, 1.0, 0.2 * y)
    };
    s.scribble((0..=60).map(|i| at(i as f32 / 60.0)));
    let id = s.newest();
    assert!(s.object(id).stroke().unwrap().closed, "a ring closes");
    (id, on(s, id))
}

pub fn filled(s: &mut Studio) -> (ObjectId, Vec3) {
    let (id, _) = ring(s);
    s.ask(Command::Objects(Ask::Select {
        ids: vec![id],
        how: How::Set,
    }));
    s.ask(midair_scaffold::Ask::Fill.command());
    s.frames(2);
    s.settle();
    (s.newest(), Vec3::new(0.0, 1.0, 0.0))
}

/// A bow, swept away from the body.
pub fn bowed(s: &mut Studio, shape: SweepShape) -> ObjectId {
    s.sweeping(shape);
    s.both(LEFT, RIGHT, 0.7);
    s.frames(12);
    let id = s.swipe_away(Vec3::Z * -0.3, 0.7);
    s.reach(R, AWAY);
    s.put(Side::Left, Pose::at(Vec3::new(-1.0, 3.0, 0.0)));
    s.frames(2);
    id
}

/// A place on the curve in the middle of a sweep.
pub fn within(s: &Studio, id: ObjectId) -> Vec3 {
    let object = s.object(id);
    let sweep = object.sweep().expect("a sweep");
    let rib = &sweep.ribs[sweep.ribs.len() / 2];
    let mut points = Vec::new();
    rib.points_into(9, &mut points);
    object.placement.affine().transform_point3(points[4])
}

pub fn surface(s: &mut Studio) -> (ObjectId, Vec3) {
    let id = bowed(s, SweepShape::Surface);
    (id, within(s, id))
}

pub fn open_tube(s: &mut Studio) -> (ObjectId, Vec3) {
    s.set("caps", false);
    let id = bowed(s, SweepShape::Tube);
    assert!(s.object(id).sheet().is_some());
    (id, within(s, id))
}

pub fn plate(s: &mut Studio) -> (ObjectId, Vec3) {
    s.set("thickness", 0.03);
    let id = bowed(s, SweepShape::Surface);
    (id, within(s, id))
}

pub fn tube(s: &mut Studio) -> (ObjectId, Vec3) {
    let id = bowed(s, SweepShape::Tube);
    (id, within(s, id))
}

pub fn pipe(s: &mut Studio) -> (ObjectId, Vec3) {
    s.set("caps", false);
    s.set("thickness", 0.03);
    let id = bowed(s, SweepShape::Tube);
    (id, within(s, id))
}

pub fn clones(s: &mut Studio) -> (ObjectId, Vec3) {
    s.set("item", SweepItem::Component("solid/sphere".to_owned()));
    s.set("clones", 3);
    s.set("clone_size", 0.1);
    let id = bowed(s, SweepShape::Clones);
    let Some(Node::Clones { row, .. }) = s.object(id).recipe().map(|r| r.node()) else {
        panic!("a row of clones");
    };
    let at = row.places()[1].translation;
    (id, s.placement(id).affine().transform_point3(at))
}

pub fn brush(s: &mut Studio) {
    s.mode(BRUSH);
    s.ask(Settings::command("brush.radius", 0.08));
}

pub fn painting(s: &mut Studio) -> (ObjectId, Vec3) {
    brush(s);
    let at = Vec3::new(0.0, 1.0, 0.0);
    s.dab(at);
    (s.newest(), at)
}
