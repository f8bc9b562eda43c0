//! Paintings: five hundred strokes of all kinds, undone, redone, changed in the middle.

use glam::{Quat, Vec3, Vec4};
use midair_document::{Document, Edit, EditError, History, Kind, MeshStore, Object, ObjectId};
use midair_field::{Canvas, Node, Placement, Primitive, Recipe, Skeleton, Stroke};

/// The i-th of a mixed lot.
fn stroke(i: usize) -> Stroke {
    let t = i as f32 * 0.37;
    let at = Vec3::new(t.sin(), (1.3 * t).cos(), (0.7 * t).sin()) * 0.4;
    let skeleton = match i % 5 {
        0 => Skeleton::Points([at.extend(1.0)].into()),
        1 => {
            let way = (0..30).map(|k| Vec4::new(at.x + 0.01 * k as f32, at.y, at.z, 1.0));
            Skeleton::Points(way.collect())
        }
        2 => Skeleton::Line(at, at + Vec3::X * 0.2),
        3 => {
            let corners = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Z, Vec3::Z];
            Skeleton::Polygon(corners.map(|c| at + 0.1 * c).into())
        }
        _ => Skeleton::Volume(Primitive::Sphere { radius: 0.05 }.into()),
    };
    Stroke {
        erase: i % 7 == 3,
        placement: Placement {
            rotation: Quat::from_rotation_y(t).normalize(),
            ..Placement::IDENTITY
        },
        ..Stroke::new(skeleton, 0.03)
    }
}

fn begin() -> (History, ObjectId) {
    let mut history = History::new(Document::new(), MeshStore::new());
    let recipe = Recipe::new(Node::Canvas(Canvas::default()));
    let id = history.add(Object::solid("Painting", recipe)).unwrap();
    (history, id)
}

fn paint(history: &mut History, id: ObjectId, at: usize, strokes: Vec<Stroke>) {
    let edit = Edit::SetStrokes {
        id,
        at,
        gone: 0,
        strokes,
    };
    history.step("Paint", vec![edit]).unwrap();
}

fn canvas(history: &History, id: ObjectId) -> Canvas {
    let object = history.document().object(id).unwrap();
    let Kind::Solid(recipe) = &object.kind else {
        panic!("a solid")
    };
    let Node::Canvas(canvas) = recipe.node() else {
        panic!("a painting")
    };
    canvas.clone()
}

#[test]
fn five_hundred_strokes_are_undone_and_redone_alike() {
    let (mut history, id) = begin();
    let mut states = vec![canvas(&history, id)];
    for i in 0..500 {
        paint(&mut history, id, i, vec![stroke(i)]);
        states.push(canvas(&history, id));
    }
    assert_eq!(history.undo_len(), 501);
    for state in states.iter().rev().skip(1) {
        assert_eq!(history.undo().as_deref(), Some("Paint"));
        assert_eq!(&canvas(&history, id), state);
    }
    for state in &states[1..] {
        assert_eq!(history.redo().as_deref(), Some("Paint"));
        assert_eq!(&canvas(&history, id), state);
    }
    let text = history.document().to_ron();
    assert_eq!(Document::from_ron(&text).unwrap().0.to_ron(), text);
}

#[test]
fn a_stroke_taken_out_of_the_middle_leaves_the_painting_made_without_it() {
    let (mut history, id) = begin();
    let (mut without, other) = begin();
    for i in 0..40 {
        paint(&mut history, id, i, vec![stroke(i)]);
    }
    for (at, i) in (0..40).filter(|&i| i != 17).enumerate() {
        paint(&mut without, other, at, vec![stroke(i)]);
    }
    let edit = Edit::SetStrokes {
        id,
        at: 17,
        gone: 1,
        strokes: Vec::new(),
    };
    history.step("Delete stroke", vec![edit]).unwrap();
    let of = |h: &History, id| h.document().object(id).unwrap().recipe().unwrap().hash();
    assert_eq!(of(&history, id), of(&without, other));
}

#[test]
fn strokes_that_are_not_there_or_not_sound_are_refused() {
    let (mut history, id) = begin();
    paint(&mut history, id, 0, vec![stroke(0)]);
    let before = history.document().to_ron();
    let set = |id, at, gone, strokes| Edit::SetStrokes {
        id,
        at,
        gone,
        strokes,
    };
    let line = Stroke::new(Skeleton::Line(Vec3::ONE, Vec3::ONE), 0.1);
    for edit in [
        set(id, 0, 2, Vec::new()),
        set(id, usize::MAX, 1, Vec::new()),
        set(id, 1, 0, vec![line]),
        set(ObjectId(99), 0, 0, vec![stroke(1)]),
    ] {
        assert!(history.step("Paint", vec![edit]).is_err());
        assert_eq!(history.document().to_ron(), before);
    }
    let ball = Object::solid("Ball", Primitive::Sphere { radius: 0.1 });
    let ball = history.add(ball).unwrap();
    let refused = history.step("Paint", vec![set(ball, 0, 0, vec![stroke(0)])]);
    assert_eq!(refused, Err(EditError::NoPainting(ball)));
}
