//! What is done with several objects: selected, grouped, moved, copied, hidden.

use bevy::prelude::*;
use midair_document::{Colour, Document, Kind, LayerId, ObjectId};
use midair_studio::command::Command;
use midair_studio::evaluate::Delivery;
use midair_studio::hands::{Action, Side};
use midair_studio::objects::{Ask, Axis, How};
use midair_studio::project::Selection;
use midair_studio::show::{Arriving, ObjectMap};

use crate::studio::{Studio, near};

const A: Vec3 = Vec3::new(0.0, 0.5, 0.0);
const B: Vec3 = Vec3::new(0.6, 0.5, 0.0);
const C: Vec3 = Vec3::new(-0.8, 0.5, 0.3);

fn three() -> (Studio, [ObjectId; 3]) {
    let mut s = Studio::new();
    let ids = [A, B, C].map(|at| s.place("solid/cube", at));
    s.ask(Command::Objects(Ask::SelectNone));
    (s, ids)
}

fn selected(s: &Studio) -> Vec<ObjectId> {
    s.world().resource::<Selection>().0.clone()
}

fn select(s: &mut Studio, ids: &[ObjectId]) {
    s.ask(Command::Objects(Ask::Select {
        ids: ids.to_vec(),
        how: How::Set,
    }));
}

/// One step forward, checked back and forth.
fn one_step(s: &mut Studio, ask: Ask) -> Document {
    let (steps, before) = (s.undo_len(), s.document().clone());
    s.ask(Command::Objects(ask));
    assert_eq!(s.undo_len(), steps + 1, "{:?}", s.warnings());
    let after = s.document().clone();
    s.ask(Command::Undo);
    assert_eq!(*s.document(), before, "undone in one step");
    s.ask(Command::Redo);
    assert_eq!(*s.document(), after, "and done again");
    s.settle();
    after
}

#[test]
fn selecting_adds_toggles_and_takes_away() {
    let (mut s, [a, b, c]) = three();
    for (ids, how, then) in [
        (vec![a], How::Set, vec![a]),
        (vec![b], How::Add, vec![a, b]),
        (vec![a, c], How::Toggle, vec![a, b, c]),
        (vec![a], How::Toggle, vec![b, c]),
        (vec![c], How::Remove, vec![b]),
    ] {
        s.ask(Command::Objects(Ask::Select { ids, how }));
        assert_eq!(selected(&s), then);
    }
    s.ask(Command::Objects(Ask::SelectOthers));
    assert_eq!(selected(&s), [a, c]);
}

#[test]
fn a_hand_picks_and_moves_a_group_as_one() {
    let (mut s, [a, b, c]) = three();
    select(&mut s, &[a, b]);
    one_step(&mut s, Ask::Group);
    s.ask(Command::Objects(Ask::SelectNone));
    s.reach(Side::Right, A);
    s.click(Side::Right, Action::Act);
    assert_eq!(selected(&s), [a, b]);
    let steps = s.undo_len();
    s.press(Side::Right, Action::Grab);
    s.carry_right(A + Vec3::new(0.0, 0.4, 0.1));
    near(s.shown(b).translation, B + Vec3::new(0.0, 0.4, 0.1), 1e-5);
    s.let_go(Side::Right, Action::Grab);
    near(
        s.placement(a).translation,
        A + Vec3::new(0.0, 0.4, 0.1),
        1e-5,
    );
    near(
        s.placement(b).translation,
        B + Vec3::new(0.0, 0.4, 0.1),
        1e-5,
    );
    near(s.placement(c).translation, C, 1e-6);
    assert_eq!(s.undo_len(), steps + 1, "one gesture, one step");
    s.ask(Command::Undo);
    near(s.placement(b).translation, B, 1e-6);
}

#[test]
fn giving_up_puts_the_whole_group_back() {
    let (mut s, [a, b, _]) = three();
    select(&mut s, &[a, b]);
    s.reach(Side::Right, A);
    s.press(Side::Right, Action::Grab);
    s.carry_right(A + Vec3::Y);
    s.press(Side::Right, Action::Cancel);
    assert!(s.drafted(a).is_none() && s.drafted(b).is_none());
    near(s.shown(b).translation, B, 1e-6);
}

#[test]
fn every_ask_is_one_step() {
    let (mut s, [a, b, c]) = three();
    select(&mut s, &[a, b]);
    one_step(&mut s, Ask::Group);
    select(&mut s, &[a, c]);
    // A group within a group.
    one_step(&mut s, Ask::Group);
    let colour = Some(Colour([10, 200, 30]));
    for ask in [
        Ask::Colour {
            ids: vec![a, b],
            colour,
        },
        Ask::Material {
            ids: vec![],
            material: Some("metal".into()),
            dials: [("polish".to_owned(), 0.5)].into(),
        },
        Ask::Locked {
            ids: vec![c],
            locked: true,
        },
        Ask::Visible {
            ids: vec![a, b],
            visible: false,
        },
        Ask::ShowAll,
        Ask::NewLayer {
            name: "Above".into(),
        },
    ] {
        one_step(&mut s, ask);
    }
    let layer = s.document().layers().next_back().unwrap().0;
    one_step(
        &mut s,
        Ask::OnLayer {
            ids: vec![b],
            layer,
        },
    );
    let after = one_step(&mut s, Ask::RemoveLayer { id: layer });
    assert_eq!(after.object(b).unwrap().layer, LayerId::BASE);
    one_step(&mut s, Ask::Ground { ids: vec![a] });
    one_step(&mut s, Ask::Ungroup);
    one_step(&mut s, Ask::Duplicate);
    // What was copied went away when it was undone, and the selection with it.
    select(&mut s, &[a]);
    one_step(&mut s, Ask::Around { count: 5 });
    select(&mut s, &[a]);
    one_step(&mut s, Ask::Delete);
    assert!(s.document().object(a).is_none());
}

#[test]
fn a_deleted_group_leaves_nothing_behind() {
    let (mut s, [a, b, _]) = three();
    select(&mut s, &[a, b]);
    one_step(&mut s, Ask::Group);
    let after = one_step(&mut s, Ask::Delete);
    assert_eq!(after.groups().count(), 0);
}

#[test]
fn a_mirror_image_is_a_sound_solid_on_the_other_side() {
    let mut s = Studio::new();
    let at = Vec3::new(0.5, 0.4, 0.2);
    let id = s.place("solid/wedge", at);
    let volume = s.faultless(id, 0.01).volume;
    select(&mut s, &[id]);
    one_step(&mut s, Ask::Mirror { axis: Axis::X });
    let image = s.document().objects().next_back().unwrap().0;
    near(
        s.placement(image).translation,
        at * Vec3::new(-1.0, 1.0, 1.0),
        1e-6,
    );
    let mirrored = s.faultless(image, 0.01).volume;
    assert!(
        mirrored > 0.0 && (mirrored / volume - 1.0).abs() < 0.01,
        "{mirrored} {volume}"
    );
    // It is an operand like any other.
    assert!(matches!(s.object(image).kind, Kind::Solid(_)));
}

#[test]
fn what_is_locked_or_hidden_is_passed_through() {
    let (mut s, [a, b, _]) = three();
    s.ask(Command::Objects(Ask::Locked {
        ids: vec![a],
        locked: true,
    }));
    s.ask(Command::Objects(Ask::Visible {
        ids: vec![b],
        visible: false,
    }));
    s.frames(4);
    for at in [A, B] {
        s.reach(Side::Right, at);
        assert_eq!(s.touched(Side::Right), None);
    }
    s.ask(Command::Objects(Ask::SelectAll));
    assert_eq!(selected(&s).len(), 1);
}

#[test]
fn what_cannot_be_done_changes_nothing_and_says_why() {
    let (mut s, [a, ..]) = three();
    let before = s.document().clone();
    for ask in [
        Ask::Duplicate,
        Ask::Group,
        Ask::Ungroup,
        Ask::Delete,
        Ask::Rename {
            id: a,
            name: "  ".into(),
        },
        Ask::RemoveLayer { id: LayerId::BASE },
        Ask::Around { count: 1000 },
        Ask::Select {
            ids: vec![ObjectId(999)],
            how: How::Set,
        },
    ] {
        s.ask(Command::Objects(ask));
        assert_eq!(*s.document(), before);
    }
}

#[test]
fn many_that_arrive_at_once_come_a_few_in_a_frame_and_in_order() {
    let mut s = Studio::new();
    // A row as long as it may be, and the same again.
    let first = s.place("solid/cube", Vec3::new(0.6, 0.5, 0.0));
    select(&mut s, &[first]);
    s.ask(Command::Objects(Ask::Around { count: 64 }));
    s.settle();
    s.ask(Command::Objects(Ask::Duplicate));
    s.settle();
    let there = |s: &Studio| {
        let map = s.world().resource::<ObjectMap>();
        let ids = s.document().objects().map(|(id, _)| id);
        ids.map(|id| {
            let entity = map.get(id)?;
            Some(s.world().get::<Mesh3d>(entity).is_some())
        })
        .collect::<Vec<_>>()
    };
    let all = s.document().len();
    assert!(all > 65, "{all}");
    assert!(there(&s).iter().all(|t| *t == Some(true)));
    assert_eq!(s.world().resource::<Arriving>().count(), 0);

    // Everything is deleted, and comes back in one step.
    let ids: Vec<_> = s.document().objects().map(|(id, _)| id).collect();
    select(&mut s, &ids);
    s.ask(Command::Objects(Ask::Delete));
    s.settle();
    assert_eq!(s.document().len(), 0);
    let before = |s: &Studio| there(s).iter().filter(|t| t.is_some()).count();
    s.send(Command::Undo);
    let mut came = 0;
    let mut frames = 0;
    while came < all {
        s.frame();
        let now = before(&s);
        assert!(now - came <= 48, "{} came in one frame", now - came);
        // Those that were made first come first.
        let order = there(&s);
        assert!(order[..now].iter().all(Option::is_some), "{order:?}");
        came = now;
        frames += 1;
        assert!(frames < 20, "{came} of {all} came");
    }
    assert!(frames >= all.div_ceil(48));
    s.settle();
    assert!(there(&s).iter().all(|t| *t == Some(true)));

    // A player that waits takes in all at once.
    s.ask(Command::Redo);
    s.settle();
    s.world_mut().insert_resource(Delivery::All);
    s.send(Command::Undo);
    s.frame();
    s.frame();
    assert_eq!(before(&s), all);
}
