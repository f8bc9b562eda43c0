//! Operands changed after they were fused: sign, order, whether they take part.

use bevy::prelude::*;
use midair_document::ObjectId;
use midair_field::{Node, Op, Operand, Recipe};
use midair_studio::command::Command;
use midair_studio::hands::Action;
use midair_studio::operands::{Of, OperandAsk};

use crate::studio::{Studio, near};

const CUBE: Vec3 = Vec3::new(0.0, 1.0, 0.0);
const SPHERE: Vec3 = Vec3::new(0.15, 1.15, 0.12);
const AT_CUBE: Vec3 = Vec3::new(-0.15, 0.85, -0.15);
const AT_SPHERE: Vec3 = Vec3::new(0.28, 1.25, 0.15);

fn marked() -> Studio {
    let mut s = Studio::new();
    s.place("solid/cube", CUBE);
    s.place("solid/sphere", SPHERE);
    s.operate();
    s.mark(AT_CUBE, Action::Up);
    s.mark(AT_SPHERE, Action::Down);
    s
}

fn fused() -> (Studio, ObjectId) {
    let mut s = marked();
    s.finish();
    let id = s.only();
    (s, id)
}

fn of(object: ObjectId, path: &[usize]) -> Of {
    Of {
        object: Some(object),
        path: path.to_vec(),
    }
}

fn operands(s: &Studio, id: ObjectId) -> Vec<Operand> {
    match s.object(id).recipe().unwrap().node() {
        Node::Solid(operands) => operands.clone(),
        other => panic!("{other:?} has no operands"),
    }
}

/// One step, undone and done again to the bit.
fn step(s: &mut Studio, ask: OperandAsk) {
    let (before, steps) = (s.document().content_hash(), s.undo_len());
    s.ask(Command::Operand(ask));
    s.settle();
    assert_eq!(s.undo_len(), steps + 1, "{:?}", s.warnings());
    let after = s.document().content_hash();
    assert_ne!(after, before);
    s.ask(Command::Undo);
    // Ids that were handed out stay so; all else is as it was.
    s.ask(Command::Redo);
    assert_eq!(s.document().content_hash(), after);
    s.settle();
}

#[test]
fn a_muted_operand_is_kept_and_left_out() {
    let (mut s, id) = fused();
    let both = s.mesh(id, 0.02);
    step(
        &mut s,
        OperandAsk::Mute {
            of: of(id, &[1]),
            muted: true,
        },
    );
    let list = operands(&s, id);
    assert!(list[1].muted && list.len() == 2);
    let alone = Recipe::new(Node::Solid(vec![list[0].clone()]));
    let by_hand = {
        let volumes = &s
            .world()
            .resource::<midair_studio::evaluate::Evaluations>()
            .volumes;
        let go = std::sync::atomic::AtomicBool::new(false);
        let at = s.placement(id);
        midair_solid::Solid::make(&alone, &at, 0.02, &**volumes, &go)
            .unwrap()
            .crisp()
    };
    assert_eq!(s.mesh(id, 0.02), by_hand);
    // The base muted, the next one is what stands there, whatever its sign.
    step(
        &mut s,
        OperandAsk::Mute {
            of: of(id, &[1]),
            muted: false,
        },
    );
    assert_eq!(s.mesh(id, 0.02), both);
    step(
        &mut s,
        OperandAsk::Mute {
            of: of(id, &[0]),
            muted: true,
        },
    );
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 0.008;
    assert!((s.mesh(id, 0.005).volume() - ball).abs() < 3e-4);
}

#[test]
fn the_last_operand_that_takes_part_stays() {
    let (mut s, id) = fused();
    step(
        &mut s,
        OperandAsk::Mute {
            of: of(id, &[0]),
            muted: true,
        },
    );
    let before = s.document().clone();
    for ask in [
        OperandAsk::Mute {
            of: of(id, &[1]),
            muted: true,
        },
        OperandAsk::Remove { of: of(id, &[1]) },
        OperandAsk::TakeOut { of: of(id, &[1]) },
        OperandAsk::Remove { of: of(id, &[7]) },
        OperandAsk::Remove {
            of: of(id, &[0, 0]),
        },
    ] {
        let warned = s.warnings().len();
        s.ask(Command::Operand(ask));
        assert_eq!(s.document(), &before);
        assert_eq!(s.warnings().len(), warned + 1);
    }
}

#[test]
fn signs_and_order_can_be_changed() {
    let (mut s, id) = fused();
    let at = s.placement(id);
    let difference = s.mesh(id, 0.01).volume();
    step(
        &mut s,
        OperandAsk::Join {
            of: of(id, &[1]),
            op: Op::Union,
        },
    );
    let union = s.mesh(id, 0.01).volume();
    assert!(union > difference);
    step(
        &mut s,
        OperandAsk::Join {
            of: of(id, &[1]),
            op: Op::Subtract,
        },
    );
    step(
        &mut s,
        OperandAsk::Move {
            of: of(id, &[1]),
            to: 0,
        },
    );
    let list = operands(&s, id);
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 0.008;
    // Read from the left the ball is the base now, and the cube is united with it as it was.
    assert!((s.mesh(id, 0.01).volume() - union).abs() < 1e-3);
    assert!(list[0].recipe.bounds().size().x > 0.3 && ball < union);
    assert_eq!(s.placement(id), at, "nothing moves");
}

#[test]
fn what_is_taken_out_stands_where_it_stood() {
    let (mut s, id) = fused();
    step(&mut s, OperandAsk::TakeOut { of: of(id, &[1]) });
    assert_eq!(operands(&s, id).len(), 1);
    let (out, object) = s.document().objects().next_back().unwrap();
    assert_ne!(out, id);
    near(object.placement.translation, SPHERE, 1e-5);
    assert_eq!(object.name, "Sphere");
}

#[test]
fn unfused_operands_are_marked_as_they_were() {
    let (mut s, id) = fused();
    let before = s.mesh(id, 0.02);
    step(&mut s, OperandAsk::Unfuse { object: id });
    let marks = s.marks();
    assert_eq!(
        marks.iter().map(|m| m.1).collect::<Vec<_>>(),
        [Op::Union, Op::Subtract]
    );
    near(s.placement(marks[0].0).translation, CUBE, 1e-5);
    near(s.placement(marks[1].0).translation, SPHERE, 1e-5);
    // Fused again it is the same solid.
    s.finish();
    let again = s.only();
    assert_eq!(s.mesh(again, 0.02), before);
}

#[test]
fn marks_are_reordered_and_removed_by_the_same_asks() {
    let mut s = marked();
    let marks = s.marks();
    let pending = |at| Of {
        object: None,
        path: vec![at],
    };
    step(
        &mut s,
        OperandAsk::Move {
            of: pending(0),
            to: 1,
        },
    );
    assert_eq!(s.marks(), [marks[1], marks[0]]);
    step(
        &mut s,
        OperandAsk::Join {
            of: pending(1),
            op: Op::Intersect,
        },
    );
    assert_eq!(s.marks()[1].1, Op::Intersect);
    step(&mut s, OperandAsk::Remove { of: pending(0) });
    assert_eq!(s.marks(), [(marks[0].0, Op::Intersect)]);
}

#[test]
fn a_solid_within_a_solid_is_changed_by_its_path() {
    let (mut s, first) = fused();
    let other = s.place("solid/cube", Vec3::new(0.8, 1.0, 0.0));
    s.ask(Command::Edit(midair_document::Edit::SetPending {
        pending: vec![(other, Op::Union), (first, Op::Union)],
    }));
    s.settle();
    s.reach(midair_studio::hands::Side::Right, Vec3::new(0.0, 4.0, 0.0));
    s.finish();
    let whole = s.only();
    let before = s.mesh(whole, 0.02).volume();
    step(
        &mut s,
        OperandAsk::Mute {
            of: of(whole, &[1, 1]),
            muted: true,
        },
    );
    assert!(
        s.mesh(whole, 0.02).volume() > before,
        "the ball is not cut out any more"
    );
    step(
        &mut s,
        OperandAsk::TakeOut {
            of: of(whole, &[1, 1]),
        },
    );
    let (_, ball) = s.document().objects().next_back().unwrap();
    near(ball.placement.translation, SPHERE, 1e-5);
}
