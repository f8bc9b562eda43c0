//! Edits, transactions, undo and redo.

mod support;

use glam::{DVec3, Vec3};
use midair_document::{
    ConstructionLine, Document, DrawnStroke, Edit, EditError, Group, GroupId, History, Kind,
    LayerId, MeshStore, Object, ObjectId,
};
use midair_field::{Op, Placement};
use proptest::prelude::*;
use support::{ball, edit, fuse};

fn history() -> History {
    History::new(Document::new(), MeshStore::new())
}

fn at(x: f32) -> Placement {
    Placement::at(Vec3::X * x)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(48) })]

    #[test]
    fn any_edits_keep_the_document_sound_and_are_undone_exactly(
        dice in prop::collection::vec(any::<support::Dice>(), 1..60)
    ) {
        let meshes = MeshStore::new();
        let mut document = Document::new();
        let mut states = vec![document.to_ron()];
        let mut inverses = Vec::new();
        for dice in dice {
            let edit = edit(&document, &meshes, dice);
            let before = document.clone();
            match document.apply(&edit) {
                Ok(inverse) => {
                    inverses.push(inverse);
                    states.push(document.to_ron());
                }
                Err(_) => prop_assert_eq!(&document, &before),
            }
            prop_assert_eq!(document.check(), Vec::<String>::new());
            prop_assert_eq!(document.check_meshes(&meshes), Vec::<String>::new());
        }
        let mut forward = Vec::new();
        while let Some(inverse) = inverses.pop() {
            prop_assert_eq!(document.to_ron(), states.pop().unwrap());
            forward.push(document.apply(&inverse).unwrap());
            prop_assert_eq!(document.check(), Vec::<String>::new());
        }
        prop_assert_eq!(document.to_ron(), Document::new().to_ron());
        while let Some(redo) = forward.pop() {
            document.apply(&redo).unwrap();
        }
        let text = document.to_ron();
        let (again, unknown) = Document::from_ron(&text).unwrap();
        prop_assert_eq!(&again, &document);
        prop_assert!(unknown.is_empty());
        prop_assert_eq!(again.to_ron(), text);
    }

    #[test]
    fn transactions_of_any_edits_are_undone_exactly(
        dice in prop::collection::vec(any::<support::Dice>(), 1..60),
        cuts in any::<u64>(),
    ) {
        let mut history = history();
        let mut states = vec![history.document().to_ron()];
        for (i, dice) in dice.into_iter().enumerate() {
            let edit = edit(history.document(), history.meshes(), dice);
            if history.in_progress().is_none() {
                history.begin("Gesture").unwrap();
            }
            let _ = history.apply(edit);
            if cuts >> i & 1 == 1 && history.commit() {
                states.push(history.document().to_ron());
            }
        }
        history.abort();
        prop_assert_eq!(history.undo_len() + 1, states.len());
        for state in states.iter().rev() {
            prop_assert_eq!(&history.document().to_ron(), state);
            prop_assert_eq!(history.document().check(), Vec::<String>::new());
            history.undo();
        }
        while history.redo().is_some() {}
        prop_assert_eq!(Some(&history.document().to_ron()), states.last());
        prop_assert!(history.take_warnings().is_empty());
    }
}

#[test]
fn a_thousand_mixed_edits_undone_and_redone_are_the_same_bytes() {
    let mut history = history();
    let mut seed = 7_u64;
    let mut roll = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1);
        (seed >> 40) as u16
    };
    while history.undo_len() < 1000 {
        let dice = (roll() as u8, roll(), roll());
        let edit = edit(history.document(), history.meshes(), dice);
        let _ = history.apply(edit);
    }
    let folder = tempfile::tempdir().unwrap();
    let save = |history: &History, name: &str| {
        let path = folder.path().join(name);
        midair_document::save(&path, history.document(), history.meshes()).unwrap();
        std::fs::read(path).unwrap()
    };
    let full = save(&history, "full.midair");
    println!(
        "1,000 steps: {} bytes of edits, {} objects, file of {} bytes",
        history.bytes(),
        history.document().len(),
        full.len()
    );
    assert_eq!(history.dropped(), 0);
    let empty = midair_document::Document::new().to_ron();
    for _ in 0..2 {
        while history.undo().is_some() {}
        assert_eq!(history.redo_len(), 1000);
        assert_eq!(history.document().to_ron(), empty);
        while history.redo().is_some() {}
        assert_eq!(history.undo_len(), 1000);
        assert!(save(&history, "again.midair") == full);
    }
}

#[test]
fn refused_edits_change_nothing() {
    let mut history = history();
    let id = history.add(Object::solid("Ball", ball(0.1))).unwrap();
    let before = history.document().clone();
    let nowhere = Placement::at(Vec3::splat(f32::NAN));
    let unknown = ObjectId(77);
    let refused = [
        (
            Edit::SetPlacement {
                id,
                placement: nowhere,
            },
            EditError::Placement,
        ),
        (Edit::Remove { id: unknown }, EditError::NoObject(unknown)),
        (
            Edit::SetMark {
                id: unknown,
                op: Some(Op::Union),
            },
            EditError::NoObject(unknown),
        ),
        (
            Edit::SetLayer {
                id,
                layer: LayerId(5),
            },
            EditError::NoLayer(LayerId(5)),
        ),
        (
            Edit::SetGroup {
                id,
                group: Some(GroupId(5)),
            },
            EditError::NoGroup(GroupId(5)),
        ),
        (
            Edit::RemoveLayer { id: LayerId::BASE },
            EditError::BaseLayer,
        ),
        (
            Edit::SetPending {
                pending: vec![(id, Op::Union), (id, Op::Subtract)],
            },
            EditError::MarkedTwice(id),
        ),
        (
            Edit::Composite {
                name: "Half".into(),
                edits: vec![Edit::Remove { id }, Edit::Remove { id }],
            },
            EditError::NoObject(id),
        ),
    ];
    for (edit, error) in refused {
        assert_eq!(history.apply(edit), Err(error));
        assert_eq!(history.document(), &before);
    }
    assert!(history.apply(Edit::SetStep { step: f32::NAN }).is_err());
    assert!(history.add(Object::solid("Ball", ball(f32::NAN))).is_err());
    assert_eq!(history.undo_len(), 1);
}

#[test]
fn an_id_is_never_used_twice() {
    let mut history = history();
    let first = history.add(Object::solid("Ball", ball(0.1))).unwrap();
    history.apply(Edit::Remove { id: first }).unwrap();
    let second = history.add(Object::solid("Ball", ball(0.1))).unwrap();
    assert_ne!(first, second);
    let object = Object::solid("Ball", ball(0.1)).into();
    assert!(history.apply(Edit::Add { id: first, object }).is_err());
}

#[test]
fn a_removed_object_comes_back_with_its_mark() {
    let mut history = history();
    let ids: Vec<_> = (0..3)
        .map(|_| history.add(Object::solid("Ball", ball(0.1))).unwrap())
        .collect();
    for &id in &ids {
        let op = Some(Op::Subtract);
        history.apply(Edit::SetMark { id, op }).unwrap();
    }
    history.apply(Edit::Remove { id: ids[1] }).unwrap();
    assert_eq!(history.document().mark(ids[2]), Some((1, Op::Subtract)));
    history.undo().unwrap();
    assert_eq!(history.document().mark(ids[1]), Some((1, Op::Subtract)));
}

#[test]
fn a_drag_is_one_small_step() {
    let mut history = history();
    let a = history.add(Object::solid("A", ball(0.1))).unwrap();
    let b = history.add(Object::solid("B", ball(0.1))).unwrap();
    let before = history.document().clone();
    history.begin("Move two").unwrap();
    for i in 1..500 {
        for id in [a, b] {
            let placement = at(i as f32);
            history.apply(Edit::SetPlacement { id, placement }).unwrap();
        }
    }
    assert!(history.commit());
    assert!(history.bytes() < 4096, "{}", history.bytes());
    let after = history.document().clone();
    assert_eq!(history.undo().as_deref(), Some("Move two"));
    assert_eq!(history.document(), &before);
    history.redo().unwrap();
    assert_eq!(history.document(), &after);
}

#[test]
fn an_unchanged_gesture_vanishes_and_an_aborted_one_reverts() {
    let mut history = history();
    let id = history.add(Object::solid("A", ball(0.1))).unwrap();
    let before = history.document().clone();
    history.begin("There and back").unwrap();
    for x in [1.0, 0.0] {
        let placement = at(x);
        history.apply(Edit::SetPlacement { id, placement }).unwrap();
    }
    let passing = history.add(Object::solid("B", ball(0.1))).unwrap();
    history.apply(Edit::Remove { id: passing }).unwrap();
    assert!(!history.commit());
    assert_eq!(history.document(), &before);
    history.begin("Move").unwrap();
    assert!(history.begin("Another").is_err());
    let placement = at(3.0);
    history.apply(Edit::SetPlacement { id, placement }).unwrap();
    assert_eq!(history.undo(), None);
    history.abort();
    assert_eq!(history.document(), &before);
    assert_eq!(history.undo_len(), 1);
}

#[test]
fn the_oldest_steps_go_when_the_budget_is_spent() {
    let mut history = history();
    let id = history.add(Object::solid("A", ball(0.1))).unwrap();
    history.set_budget(20_000);
    for i in 0..1000 {
        let name = format!("{i:0>100}");
        history.apply(Edit::Rename { id, name }).unwrap();
    }
    assert!(history.bytes() <= 20_000);
    assert!(history.dropped() > 0);
    assert_eq!(history.dropped() as usize + history.undo_len(), 1001);
    while history.undo().is_some() {}
    assert_eq!(history.bytes() > 0, history.redo_len() > 0);
    assert_eq!(history.document().check(), Vec::<String>::new());
}

#[test]
fn groups_nest_and_never_in_a_circle() {
    let mut history = history();
    let a = history.add(Object::solid("A", ball(0.1))).unwrap();
    let inner = GroupId(history.document().next_id());
    let edit = history.document().group_edit("Inner", &[a]);
    history.apply(edit).unwrap();
    let outer = GroupId(history.document().next_id());
    let group = |name: &str, parent| Group {
        name: name.into(),
        parent,
    };
    history
        .apply(Edit::AddGroup {
            id: outer,
            group: group("Outer", None),
        })
        .unwrap();
    history
        .apply(Edit::ReplaceGroup {
            id: inner,
            group: group("Inner", Some(outer)),
        })
        .unwrap();
    assert_eq!(history.document().outermost_group(a), Some(outer));
    assert_eq!(history.document().members(outer), [a]);
    let circle = Edit::ReplaceGroup {
        id: outer,
        group: group("Outer", Some(inner)),
    };
    assert_eq!(history.apply(circle), Err(EditError::GroupCycle));
    let edit = history.document().ungroup_edit(inner);
    history.apply(edit).unwrap();
    assert_eq!(history.document().object(a).unwrap().group, Some(outer));
}

#[test]
fn a_solid_fused_with_itself_again_and_again_stays_small() {
    let mut recipe = ball(0.1);
    for _ in 0..14 {
        let part = |x| (Op::Union, at(x), recipe.clone());
        recipe = fuse([part(0.0), part(0.1)]);
    }
    let mut history = history();
    history.add(Object::solid("Tower", recipe)).unwrap();
    let text = history.document().to_ron();
    assert!(text.len() < 20_000, "{}", text.len());
    assert_eq!(&Document::from_ron(&text).unwrap().0, history.document());
}

#[test]
fn edits_are_readable_text() {
    let edit = Edit::Composite {
        name: "Fuse".into(),
        edits: vec![
            Edit::Add {
                id: ObjectId(1),
                object: Object::solid("Ball", ball(0.25)).into(),
            },
            Edit::SetStep { step: 0.005 },
        ],
    };
    let text = ron::to_string(&edit).unwrap();
    assert!(text.contains("Sphere(radius:0.25)"), "{text}");
    assert_eq!(ron::from_str::<Edit>(&text).unwrap(), edit);
}

#[test]
fn what_is_no_line_or_stroke_is_refused_with_one_line() {
    let mut history = history();
    for (kind, says) in [
        (support::line(0.2, 7), "not a place"),
        (support::stroke(0.2, 7), "not a place"),
        (
            Kind::Stroke(DrawnStroke::raw(vec![DVec3::ZERO], 0.01).into()),
            "2 to",
        ),
        (
            Kind::Stroke(DrawnStroke::raw(vec![DVec3::ZERO; 2], 0.0).into()),
            "width",
        ),
        (
            Kind::Line(ConstructionLine {
                ticks: vec![1.5],
                ..ConstructionLine::raw(DVec3::ZERO, DVec3::X)
            }),
            "tick mark",
        ),
    ] {
        let refused = history.add(Object::new("", kind)).unwrap_err().to_string();
        assert!(refused.contains(says), "{refused}");
    }
    assert!(history.document().is_empty());
}

#[test]
fn the_past_is_told_from_the_oldest_step_on() {
    let mut history = history();
    let line = history
        .add(Object::new("Line", support::line(0.2, 0)))
        .unwrap();
    history
        .apply(Edit::Rename {
            id: line,
            name: "Edge".into(),
        })
        .unwrap();
    history.apply(Edit::Remove { id: line }).unwrap();
    history.undo();
    let past = history.past();
    let names: Vec<&str> = past.iter().map(|(name, _)| &**name).collect();
    assert_eq!(names, ["", "Add", "Rename"]);
    assert!(past[0].1.is_empty() && past[1].1.object(line).unwrap().name == "Line");
    assert_eq!(&past[2].1, history.document());
}

#[test]
fn a_drawing_of_hundreds_is_counted_and_undone() {
    let mut history = history();
    for i in 0..300 {
        history
            .add(Object::new("Line", support::line(0.2, 8 * i)))
            .unwrap();
    }
    let points: Vec<DVec3> = (0..500).map(|i| DVec3::X * f64::from(i)).collect();
    for _ in 0..80 {
        let kind = Kind::Stroke(DrawnStroke::raw(points.clone(), 0.01).into());
        history.add(Object::new("Stroke", kind)).unwrap();
    }
    // Taking a stroke away keeps it for the undo: its points are in the count.
    let before = history.bytes();
    let last = history.document().objects().next_back().unwrap().0;
    history.apply(Edit::Remove { id: last }).unwrap();
    assert!(history.bytes() - before > 500 * 24);
    while history.undo().is_some() {}
    assert!(history.document().is_empty());
}
