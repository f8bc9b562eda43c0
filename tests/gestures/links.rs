//! Live links across the modes: what is painted follows what it was painted with, what is swept its rails, in the
//! step that changes those; and what was freed does not.

use bevy::prelude::*;
use midair_brush::{Ask as BrushAsk, BRUSH, canvas};
use midair_document::{Edit, ObjectId};
use midair_field::{Node, Recipe, Skeleton, Stroke};
use midair_mesh::check;
use midair_scaffold::SCAFFOLD;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::objects::{Ask, How};
use midair_studio::project::Selection;
use midair_studio::settings::{Draws, Settings, SweepHands, SweepItem, SweepShape};
use midair_sweep::{SWEEP, SweepAsk};

use crate::sources::{AWAY, BESIDE};
use crate::studio::{Studio, near};
use crate::sweep::{LEFT, RIGHT};

const R: Side = Side::Right;

impl Studio {
    fn selected(&self) -> Vec<ObjectId> {
        self.world().resource::<Selection>().0.clone()
    }

    fn select(&mut self, id: ObjectId) {
        let (ids, how) = (vec![id], How::Set);
        self.ask(Command::Objects(Ask::Select { ids, how }));
    }

    fn painted(&self, id: ObjectId) -> Vec<Stroke> {
        canvas(self.object(id)).expect("a painting").strokes.clone()
    }

    /// A stroke drawn from place to place, bowed by so much.
    fn drawn(&mut self, from: Vec3, to: Vec3, bow: f32) -> ObjectId {
        self.mode(SCAFFOLD);
        self.draws(Draws::Stroke);
        let at = |t: f32| from.lerp(to, t) + Vec3::Y * (bow * 4.0 * t * (1.0 - t));
        self.scribble((0..=40).map(|i| at(i as f32 / 40.0)));
        self.settle();
        self.newest()
    }

    fn brought_into(&mut self, id: ObjectId, to: midair_studio::tools::ToolId) {
        let objects = vec![id];
        self.ask(Command::Carry { objects, to });
        self.frames(3);
        self.settle();
    }

    fn moved_by(&mut self, id: ObjectId, by: Vec3) {
        let mut placement = self.placement(id);
        placement.translation += by;
        self.ask(Command::Edit(Edit::SetPlacement { id, placement }));
        self.settle();
    }
}

/// Its points, in the painting.
fn points(stroke: &Stroke) -> Vec<Vec3> {
    match &stroke.skeleton {
        Skeleton::Points(points) => points.iter().map(|p| p.truncate()).collect(),
        Skeleton::Line(a, b) => vec![*a, *b],
        other => panic!("{other:?}"),
    }
}

fn volume(stroke: &Stroke) -> &Recipe {
    match &stroke.skeleton {
        Skeleton::Volume(recipe) => recipe,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_skeleton_follows_its_stroke_in_the_same_step() {
    let mut s = Studio::new();
    let (from, to) = (Vec3::new(-0.2, 1.0, 0.0), Vec3::new(0.2, 1.0, 0.0));
    let source = s.drawn(from, to, 0.05);
    let other = s.drawn(from - Vec3::Y * 0.5, to - Vec3::Y * 0.3, 0.12);
    s.brought_into(source, BRUSH);
    let painting = s.newest();
    assert!(canvas(s.object(painting)).is_some(), "{}", s.notices());
    // A dab before it is in the list, one after it too.
    s.mode(BRUSH);
    s.ask(Settings::command("brush.radius", 0.05));
    s.dab(from + Vec3::new(0.0, 0.3, 0.0));
    assert_eq!(s.painted(painting).len(), 2);
    let before = s.painted(painting);
    let steps = s.undo_len();
    let by = Vec3::new(0.03, 0.1, -0.02);
    s.moved_by(source, by);
    let after = s.painted(painting);
    assert_eq!(s.undo_len(), steps + 1, "one step");
    assert_eq!(after[1], before[1], "the dab follows nothing");
    for (a, b) in points(&after[0]).into_iter().zip(points(&before[0])) {
        near(a, b + by, 1e-5);
    }
    // Drawn otherwise.
    let kind = s.object(other).kind.clone();
    let placement = s.placement(other);
    let together = Edit::Composite {
        name: "Redraw".to_owned(),
        edits: vec![
            Edit::SetKind { id: source, kind },
            Edit::SetPlacement {
                id: source,
                placement,
            },
        ],
    };
    s.ask(Command::Edit(together));
    s.settle();
    let way = s.object(other).stroke().unwrap().points();
    let there = midair_document::affine(&placement);
    let stands = s.placement(painting).translation;
    let now = points(&s.painted(painting)[0]);
    assert_eq!(now.len(), way.len());
    for (p, q) in now.into_iter().zip(way) {
        near(p + stands, there.transform_point3(q).as_vec3(), 1e-4);
    }
    s.written(painting);
    s.ask(Command::Undo);
    assert_eq!(s.painted(painting), after, "both are taken back at once");
    // Without the stroke before it the link goes with its own.
    s.ask(BrushAsk::Select(Some(1)).command());
    s.ask(BrushAsk::Delete(1).command());
    s.moved_by(source, -by);
    let back = points(&s.painted(painting)[0]);
    for (a, b) in back.into_iter().zip(points(&before[0])) {
        near(a, b, 1e-5);
    }
    // Moved together they stand to each other as before.
    let held = s.painted(painting);
    let places = [source, painting].map(|id| {
        let mut placement = s.placement(id);
        placement.translation += by;
        Edit::SetPlacement { id, placement }
    });
    let (name, edits) = ("Both".to_owned(), places.to_vec());
    s.ask(Command::Edit(Edit::Composite { name, edits }));
    assert_eq!(s.painted(painting), held);
    // Freed, and then its source gone: it stays.
    s.ask(BrushAsk::Free.command());
    s.moved_by(source, by);
    assert_eq!(s.painted(painting), held);
    s.ask(Command::Edit(Edit::Remove { id: source }));
    assert_eq!(s.painted(painting), held);
    assert_eq!(s.warnings(), [] as [String; 0]);
}

#[test]
fn what_is_painted_with_a_sweep_follows_it_and_that_its_rail() {
    let mut s = Studio::new();
    let rail = s.drawn(LEFT, LEFT + Vec3::Z * -0.4, 0.0);
    s.brought_into(rail, SWEEP);
    s.set("hands", SweepHands::Two);
    s.set("shape", SweepShape::Surface);
    s.set("thickness", 0.04);
    s.both(LEFT, RIGHT, 0.4);
    s.frames(12);
    let plate = s.swipe_away(Vec3::Z * -0.3, 0.4);
    assert_eq!(s.object(plate).links.len(), 1, "{}", s.notices());
    s.brought_into(plate, BRUSH);
    s.reach(R, AWAY);
    s.dab(BESIDE);
    s.dab(BESIDE + Vec3::X * 0.4);
    let painting = s.newest();
    assert_eq!(s.painted(painting).len(), 2, "{}", s.notices());
    let is_plate = |s: &Studio| {
        let now = s.object(plate).operand().unwrap();
        let strokes = s.painted(painting);
        assert!(strokes.iter().all(|p| *volume(p) == now), "as the plate is");
    };
    is_plate(&s);
    let (first, steps) = (s.painted(painting), s.undo_len());
    // The plate is made thicker.
    s.mode(SWEEP);
    s.select(plate);
    s.ask(SweepAsk::Thickness(0.06).command());
    s.settle();
    is_plate(&s);
    assert_ne!(s.painted(painting), first);
    assert_eq!(s.undo_len(), steps + 1);
    s.written(painting);
    // Its rail is moved: the plate follows it, and what is painted with that.
    let thicker = s.painted(painting);
    s.moved_by(rail, Vec3::Y * 0.08);
    is_plate(&s);
    assert_ne!(s.painted(painting), thicker);
    assert_eq!(s.undo_len(), steps + 2);
    // The plate moved as it is is still the same brush.
    let bent = s.painted(painting);
    s.moved_by(plate, Vec3::Y * 0.5);
    assert_eq!(s.painted(painting), bent);
    // Opened it is no brush: what is painted stays.
    s.select(plate);
    s.ask(SweepAsk::Thickness(0.0).command());
    assert_eq!(s.painted(painting), bent);
    for _ in 0..4 {
        s.ask(Command::Undo);
    }
    assert_eq!(s.painted(painting), first);
    assert_eq!(s.warnings(), [] as [String; 0]);
}

#[test]
fn a_row_of_clones_is_freed_from_its_rail_and_taken_apart() {
    let mut s = Studio::new();
    let rail = s.drawn(LEFT, LEFT + Vec3::Z * -0.4, 0.0);
    s.brought_into(rail, SWEEP);
    s.set("hands", SweepHands::Two);
    s.set("shape", SweepShape::Clones);
    s.set("item", SweepItem::Component("solid/cube".to_owned()));
    s.set("clones", 5);
    s.set("clone_size", 0.05);
    s.both(LEFT, RIGHT, 0.4);
    s.frames(12);
    let row = s.swipe_away(Vec3::Z * -0.1, 0.4);
    let recipe = |s: &Studio| s.object(row).recipe().unwrap().clone();
    let before = recipe(&s);
    s.moved_by(rail, Vec3::Y * 0.05);
    let followed = recipe(&s);
    assert_ne!(followed, before, "it follows");
    s.ask(Command::Mode(SWEEP));
    s.select(row);
    let steps = s.undo_len();
    s.ask(SweepAsk::Free.command());
    assert_eq!(s.undo_len(), steps + 1);
    assert!(s.object(row).links.is_empty());
    s.moved_by(rail, Vec3::Y * 0.05);
    assert_eq!(recipe(&s), followed, "it is free");
    // Turned and larger, it comes apart where its clones stand.
    let mut placement = s.placement(row);
    placement.rotation = Quat::from_rotation_y(0.7);
    placement.scale = Vec3::splat(1.5);
    s.ask(Command::Edit(Edit::SetPlacement { id: row, placement }));
    s.settle();
    let whole = check(&s.mesh(row, 0.01));
    let Node::Clones { row: places, .. } = followed.node() else {
        panic!("a row")
    };
    let there = places.places().into_iter();
    let there: Vec<Vec3> = there
        .map(|p| placement.affine().transform_point3(p.translation))
        .collect();
    let (was, count) = (s.document().content_hash(), s.document().len());
    s.select(row);
    s.ask(SweepAsk::Apart.command());
    s.settle();
    assert_eq!(s.document().len(), count + 4);
    let own: Vec<ObjectId> = s.selected();
    assert_eq!(own.len(), 5);
    let mut volume = 0.0;
    for (id, at) in own.iter().zip(there) {
        near(s.placement(*id).translation, at, 1e-5);
        volume += check(&s.mesh(*id, 0.01)).volume;
    }
    assert!(
        (volume / whole.volume - 1.0).abs() < 0.03,
        "{volume} of {}",
        whole.volume
    );
    // Each is on its own.
    let rest = s.placement(own[1]);
    s.moved_by(own[0], Vec3::Y);
    assert_eq!(s.placement(own[1]), rest);
    s.ask(Command::Undo);
    s.ask(Command::Undo);
    assert_eq!(s.document().content_hash(), was);
    // A row of very many is left as it is.
    s.set("spread", true);
    s.set("clones", 200);
    s.set("clone_size", 0.01);
    s.put(Side::Left, Pose::at(LEFT));
    s.both(LEFT, RIGHT, 0.4);
    let many = s.swipe_away(Vec3::Z * -0.3, 0.4);
    s.select(many);
    let steps = s.undo_len();
    s.ask(SweepAsk::Apart.command());
    assert_eq!(s.undo_len(), steps);
    assert!(
        s.warnings().last().unwrap().contains("at most 1000"),
        "{:?}",
        s.warnings()
    );
    s.click(Side::Right, Action::Cancel);
}
