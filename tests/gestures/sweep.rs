//! Sweep through the hands.

use std::f32::consts::PI;

use bevy::prelude::*;
use midair_document::{Kind, ObjectId};
use midair_field::{Node, Profile, Sweep};
use midair_mesh::check;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::notice::Notices;
use midair_studio::objects::{Ask, How};
use midair_studio::project::{Project, Selection};
use midair_studio::settings::{Settings, SweepHands, SweepItem, SweepShape};
use midair_studio::show::{Drafts, Readouts};
use midair_sweep::{Draft, Phase, SWEEP, Solo, SweepAsk};

use crate::studio::{Studio, near};

pub const LEFT: Vec3 = Vec3::new(-0.2, 1.0, 0.0);
pub const RIGHT: Vec3 = Vec3::new(0.2, 1.0, 0.0);

impl Studio {
    pub fn set<T: serde::Serialize>(&mut self, key: &str, value: T) {
        self.ask(Settings::command(&format!("sweep.{key}"), value));
    }

    pub fn sweeping(&mut self, shape: SweepShape) {
        self.ask(Command::Mode(SWEEP));
        self.set("hands", SweepHands::Two);
        self.set("shape", shape);
        self.both(LEFT, RIGHT, 0.0);
        self.frames(14);
    }

    /// Hands turned by `bend` against each other, so that the curve bows upwards.
    pub fn both(&mut self, left: Vec3, right: Vec3, bend: f32) {
        let pose = |position, by| Pose {
            position,
            rotation: Quat::from_rotation_z(by),
        };
        self.carry(Some(pose(left, bend)), Some(pose(right, -bend)));
    }

    pub fn swinging(&self) -> &Draft {
        self.world().resource::<Draft>()
    }

    pub fn swept(&self, id: ObjectId) -> &Sweep {
        self.object(id).sweep().expect("a sweep")
    }

    /// Forward by so much with the trigger held.
    pub fn swipe_away(&mut self, by: Vec3, bend: f32) -> ObjectId {
        let [l, r] = Side::BOTH.map(|s| self.pose(s).position);
        self.press(Side::Right, Action::Act);
        self.both(l + by, r + by, bend);
        self.let_go(Side::Right, Action::Act);
        self.settle();
        self.document()
            .objects()
            .next_back()
            .expect("something was made")
            .0
    }

    pub fn notices(&self) -> String {
        format!("{:?}", self.world().resource::<Notices>())
    }
}

#[test]
fn a_surface_is_swept_seen_and_taken_back() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Surface);
    let live = studio
        .swinging()
        .live
        .expect("a curve hangs between the hands");
    near(live.points[0], LEFT, 1e-5);
    near(live.points[1], RIGHT, 1e-5);
    let before = studio.undo_len();
    let id = studio.swipe_away(Vec3::Z * -0.3, 0.0);
    assert!(matches!(studio.object(id).kind, Kind::Sheet(_)));
    assert_eq!(studio.undo_len(), before + 1, "one sweep is one step");
    let ribs = studio.swept(id).ribs.len();
    assert!(
        (12..=31).contains(&ribs),
        "one curve for each centimetre: {ribs}"
    );
    near(
        studio.placement(id).translation,
        Vec3::new(0.0, 1.0, -0.15),
        2e-3,
    );
    let at = studio
        .world()
        .resource::<midair_studio::show::ObjectMap>()
        .get(id)
        .unwrap();
    assert!(studio.world().get::<Mesh3d>(at).is_some(), "it is drawn");
    studio.ask(Command::Undo);
    assert!(studio.document().is_empty());
    studio.ask(Command::Redo);
    assert_eq!(studio.swept(id).ribs.len(), ribs);
    assert_eq!(studio.warnings(), [] as [String; 0]);
}

#[test]
fn a_capped_tube_is_a_solid_that_cuts_and_is_written() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Tube);
    studio.both(LEFT, RIGHT, 0.9);
    let tube = studio.swipe_away(Vec3::Z * -0.3, 0.9);
    assert_eq!(studio.swept(tube).profile, Profile::Tube);
    let report = check(&studio.swept(tube).solid().unwrap().mesh);
    assert!(report.is_faultless(), "{:?}", report.faults());
    let file = studio.home.path().join("tube.stl");
    studio.ask(Command::Export {
        path: file.clone(),
        step: None,
        unit: None,
        only: None,
        up: None,
    });
    studio.settle();
    let written = midair_mesh::read(&file).unwrap().mesh;
    assert!(check(&written).is_faultless());
    // In Assemble it takes a piece out of a block.
    studio.ask(Command::Mode("csg".to_owned().into()));
    let cube = studio.place("solid/cube", Vec3::new(0.0, 1.0, -0.3));
    let before = check(&studio.mesh(cube, 0.01)).volume;
    let marks = vec![
        (cube, midair_field::Op::Union),
        (tube, midair_field::Op::Subtract),
    ];
    studio.ask(Command::Edit(midair_document::Edit::SetPending {
        pending: marks,
    }));
    studio.reach(Side::Right, Vec3::new(0.0, 4.0, 0.0));
    studio.finish();
    let cut = studio.only();
    let after = studio.faultless(cut, 0.01).volume;
    assert!(after < 0.98 * before && after > 0.0, "{before} {after}");
    assert_eq!(studio.warnings(), [] as [String; 0]);
}

#[test]
fn two_full_turns_are_counted() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Clones);
    for step in 1..=48 {
        let turned = 4.0 * PI * step as f32 / 48.0;
        studio.put(
            Side::Right,
            Pose {
                position: RIGHT,
                rotation: Quat::from_rotation_x(turned),
            },
        );
        studio.frame();
    }
    let twist = studio.swinging().live.unwrap().twist;
    assert!((twist - 4.0 * PI).abs() < 1e-3, "{twist}");
    let id = studio.swipe_away(Vec3::Z * -0.05, 0.0);
    let Some(Node::Clones { row, .. }) = studio.object(id).recipe().map(|r| r.node()) else {
        panic!("a row of clones");
    };
    assert!(row.ribs[0].twist > 3.5 * PI);
}

#[test]
fn a_row_of_clones_is_as_large_as_all_of_them() {
    let mut s = Studio::new();
    let (id, _) = crate::sources::clones(&mut s);
    s.settle();
    let selection = Selection(vec![id]);
    let project = s.world().resource::<Project>();
    let (low, high) =
        midair_studio::ruler::selected_box(project, &selection, &Drafts::default()).unwrap();
    s.ask(Command::Objects(Ask::Select {
        ids: selection.0,
        how: How::Set,
    }));
    let readouts = &s.world().resource::<Readouts>().0;
    let size = readouts.iter().find(|r| r.text.contains('×'));
    let longest = size
        .expect("its size")
        .text
        .split([' ', '×'])
        .filter_map(|word| word.parse::<f32>().ok())
        .fold(0.0, f32::max);
    let row = 1e3 * (high - low).max_element();
    assert!((longest / row - 1.0).abs() < 0.1, "{longest} of {row} mm");
}

#[test]
fn a_swipe_outwards_and_the_cross_raise_w() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Surface);
    for x in [0.0, 0.3, 0.6, 0.3, 0.0] {
        studio.swipe(Some(Vec2::new(x, 0.0)));
    }
    studio.swipe(None);
    let raised = studio.swinging().slopes[1];
    assert!(
        raised > 1.5,
        "outwards, and what springs back takes nothing back: {raised}"
    );
    studio.click(Side::Left, Action::Left);
    assert!(studio.swinging().slopes[0] < 1.0);
    for _ in 0..20 {
        studio.click(Side::Left, Action::Right);
    }
    assert_eq!(studio.swinging().slopes[0], 3.0);
    studio.click(Side::Right, Action::Up);
    assert_eq!(
        studio.world().resource::<Settings>().sweep.shape,
        SweepShape::Tube
    );
}

#[test]
fn alt_pins_the_other_end_and_cancel_gives_the_sweep_up() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Surface);
    studio.click(Side::Left, Action::Act);
    let id = studio.swipe_away(Vec3::Y * 0.2, 0.0);
    let sweep = studio.swept(id);
    let first = sweep.ribs[0].points[0];
    assert!(
        sweep
            .ribs
            .iter()
            .all(|r| r.points[0].distance(first) < 1e-6),
        "a fan"
    );
    assert!(sweep.ribs.last().unwrap().points[1].distance(sweep.ribs[0].points[1]) > 0.19);
    let before = studio.document().clone();
    studio.press(Side::Right, Action::Act);
    studio.carry_right(RIGHT);
    studio.click(Side::Right, Action::Cancel);
    studio.let_go(Side::Right, Action::Act);
    studio.frames(3);
    assert_eq!(studio.document(), &before);
    // Leaving the mode gives it up as well.
    studio.press(Side::Right, Action::Act);
    studio.carry_right(RIGHT + Vec3::Y * 0.2);
    studio.ask(Command::Mode("csg".to_owned().into()));
    studio.let_go(Side::Right, Action::Act);
    studio.frames(3);
    assert_eq!(studio.document(), &before);
}

#[test]
fn one_curve_hands_at_one_point_and_lost_hands_have_an_outcome() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Surface);
    studio.click(Side::Right, Action::Act);
    studio.frames(3);
    assert!(studio.document().is_empty());
    assert!(
        studio.warnings()[0].contains("one curve makes no surface"),
        "{:?}",
        studio.warnings()
    );
    for at in [LEFT, Vec3::NAN, RIGHT] {
        studio.press(Side::Right, Action::Act);
        studio.put(Side::Right, Pose::at(at));
        studio.frames(12);
        studio.let_go(Side::Right, Action::Act);
        studio.frames(3);
        assert!(studio.swinging().live.is_none_or(|r| r.is_sound()));
    }
    assert!(studio.document().check().is_empty());
}

#[test]
fn a_surface_gets_a_thickness_is_smoothed_cut_and_gone_on_with() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Surface);
    studio.set("thickness", 0.02);
    studio.both(LEFT, RIGHT, 0.5);
    let id = studio.swipe_away(Vec3::Z * -0.2, 0.1);
    assert!(studio.object(id).recipe().is_some(), "a plate");
    let ribs = studio.swept(id).ribs.clone();
    studio.click(Side::Right, Action::Down);
    assert_ne!(studio.swept(id).ribs, ribs, "smoothed");
    studio.ask(SweepAsk::Thickness(0.0).command());
    assert!(studio.object(id).sheet().is_some());
    studio.ask(SweepAsk::Count(96).command());
    assert_eq!(studio.swept(id).count, 96);
    studio.ask(SweepAsk::Extend.command());
    let more = studio.swipe_away(Vec3::Z * -0.1, 0.1);
    assert_eq!((more, studio.document().len()), (id, 1));
    let longer = studio.swept(id).ribs.len();
    assert!(longer > ribs.len() + 4);
    studio.ask(SweepAsk::Cut(5).command());
    assert_eq!(
        (studio.swept(id).ribs.len(), studio.document().len()),
        (6, 2)
    );
    for _ in 0..5 {
        studio.ask(Command::Undo);
    }
    assert_eq!(studio.swept(id).ribs, ribs);
    assert_eq!(studio.warnings(), [] as [String; 0]);
}

#[test]
fn a_curve_of_a_sweep_is_bent_by_hand() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Surface);
    let id = studio.swipe_away(Vec3::Z * -0.3, 0.0);
    let before = studio.swept(id).ribs.clone();
    studio.click(Side::Right, Action::Finish);
    assert!(matches!(studio.swinging().phase, Phase::Editing { .. }));
    // At the right end of the middle curve.
    studio.reach(Side::Right, Vec3::new(0.2, 1.0, -0.15));
    studio.press(Side::Right, Action::Act);
    studio.carry_right(Vec3::new(0.2, 1.1, -0.15));
    let steps = studio.undo_len();
    studio.let_go(Side::Right, Action::Act);
    studio.frames(2);
    assert_eq!(studio.undo_len(), steps + 1);
    let after = studio.swept(id).ribs.clone();
    let rise = |i: usize| after[i].points[1].y - before[i].points[1].y;
    let middle = before.len() / 2;
    assert!(
        rise(middle) > 0.08 && rise(middle) < 0.11,
        "{}",
        rise(middle)
    );
    assert!(rise(0).abs() < 1e-5 && rise(before.len() - 1).abs() < 1e-5);
    assert!((after[middle].points[0] - before[middle].points[0]).length() < 2e-3);
    studio.click(Side::Right, Action::Finish);
    assert_eq!(studio.swinging().phase, Phase::Idle);
}

#[test]
fn with_one_hand_the_ends_are_placed_and_moved_one_after_the_other() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Surface);
    studio.set("hands", SweepHands::One);
    let drag = |studio: &mut Studio, from: Vec3, to: Vec3| {
        studio.reach(Side::Right, from);
        studio.press(Side::Right, Action::Act);
        studio.carry_right(to);
        studio.let_go(Side::Right, Action::Act);
        studio.frames(2);
    };
    drag(&mut studio, LEFT, LEFT + Vec3::new(0.05, 0.1, 0.0));
    drag(&mut studio, RIGHT, RIGHT + Vec3::new(0.05, -0.1, 0.0));
    assert!(matches!(studio.swinging().solo, Solo::Ready { .. }));
    let live = studio
        .swinging()
        .live
        .expect("the curve hangs between the ends");
    near(live.points[1], RIGHT, 1e-5);
    drag(&mut studio, LEFT, LEFT + Vec3::Z * -0.2);
    assert!(studio.document().is_empty());
    drag(&mut studio, RIGHT, RIGHT + Vec3::new(0.0, 0.1, -0.2));
    assert_eq!(studio.document().len(), 1);
    let id = studio.only();
    let ribs = &studio.swept(id).ribs;
    let moved = |k: usize| ribs[ribs.len() - 1].points[k] - ribs[0].points[k];
    near(moved(0), Vec3::Z * -0.2, 0.02);
    near(moved(1), Vec3::new(0.0, 0.1, -0.2), 0.02);
    // Grab carries both.
    studio.reach(Side::Right, Vec3::new(0.0, 1.6, 0.3));
    studio.press(Side::Right, Action::Grab);
    studio.carry_right(Vec3::new(0.0, 1.8, 0.3));
    studio.let_go(Side::Right, Action::Grab);
    studio.frames(3);
    assert_eq!(studio.document().len(), 2);
    assert_eq!(studio.warnings(), [] as [String; 0]);
}

#[test]
fn clones_along_a_curve_drill_a_plate() {
    let mut studio = Studio::new();
    studio.ask(Command::Mode("csg".to_owned().into()));
    let plate = studio.place("solid/cube", Vec3::new(0.0, 1.0, 0.0));
    studio.sweeping(SweepShape::Clones);
    studio.set("item", SweepItem::Component("solid/sphere".to_owned()));
    studio.set("clones", 5);
    studio.set("clone_size", 0.06);
    studio.both(LEFT + Vec3::X * 0.05, RIGHT - Vec3::X * 0.05, 0.0);
    studio.frames(20);
    let row = studio.swipe_away(Vec3::ZERO, 0.0);
    assert_ne!(row, plate);
    assert_eq!(studio.object(row).recipe().unwrap().leaves() % 5, 0);
    let clones = {
        let world = studio.world();
        let at = world
            .resource::<midair_studio::show::ObjectMap>()
            .get(row)
            .unwrap();
        world.get::<Children>(at).map_or(0, |c| c.len())
    };
    assert_eq!(clones, 5, "drawn as copies of one mesh");
    studio.ask(Command::Mode("csg".to_owned().into()));
    let whole = check(&studio.mesh(plate, 0.01)).volume;
    let marks = vec![
        (plate, midair_field::Op::Union),
        (row, midair_field::Op::Subtract),
    ];
    studio.ask(Command::Edit(midair_document::Edit::SetPending {
        pending: marks,
    }));
    studio.reach(Side::Right, Vec3::new(0.0, 4.0, 0.0));
    studio.finish();
    let drilled = studio.only();
    let left = studio.faultless(drilled, 0.01).volume;
    assert!(left < whole, "{left} of {whole}");
}

#[test]
fn nothing_of_it_is_left_in_another_mode() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Clones);
    studio.settle();
    studio.frames(5);
    let drawn = |s: &mut Studio| s.count::<Mesh3d>();
    let with = drawn(&mut studio);
    assert!(studio.swinging().live.is_some() && with >= 12, "{with}");
    studio.ask(Command::Mode("csg".to_owned().into()));
    studio.frames(3);
    assert!(studio.swinging().live.is_none());
    assert!(
        drawn(&mut studio) <= with - 12,
        "the clones on the curve are gone"
    );
    let aim = studio.world().resource::<midair_studio::tools::Aim>();
    assert_eq!(*aim, midair_studio::tools::Aim::default());
}

#[test]
fn what_cannot_be_cloned_says_so() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Clones);
    studio.set("item", SweepItem::Component("solid/unheard-of".to_owned()));
    studio.press(Side::Right, Action::Act);
    studio.frames(4);
    studio.let_go(Side::Right, Action::Act);
    studio.frames(2);
    assert!(studio.document().is_empty());
    assert!(
        studio.notices().contains("unheard-of"),
        "{}",
        studio.notices()
    );
    studio.set("item", SweepItem::Object(99));
    studio.click(Side::Right, Action::Act);
    assert!(
        studio.notices().contains("99 is gone"),
        "{}",
        studio.notices()
    );
    assert!(studio.document().is_empty());
}

#[test]
fn a_surface_carried_into_assemble_is_offered_a_thickness() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Surface);
    studio.both(LEFT, RIGHT, 0.5);
    let id = studio.swipe_away(Vec3::Z * -0.2, 0.2);
    let carry = |to: &str| Command::Carry {
        objects: vec![id],
        to: to.to_owned().into(),
    };
    studio.ask(carry("csg"));
    studio.frames(3);
    assert!(studio.swinging().offer.is_some(), "{}", studio.notices());
    studio.click(Side::Right, Action::Cancel);
    assert!(studio.swinging().offer.is_none() && studio.object(id).sheet().is_some());
    studio.ask(carry("csg"));
    studio.frames(3);
    let steps = studio.undo_len();
    studio.click(Side::Right, Action::Finish);
    studio.frames(3);
    assert!(studio.object(id).recipe().is_some(), "a plate");
    assert_eq!((studio.marks().len(), studio.undo_len()), (1, steps + 1));
    // Back in Sweep the plate is what is cloned.
    studio.ask(carry("sweep"));
    studio.frames(2);
    let settings = &studio.world().resource::<Settings>().sweep;
    assert_eq!(settings.item, SweepItem::Object(id.0));
    assert_eq!(settings.shape, SweepShape::Clones);
}
