//! What was drawn becomes part of the document: one gesture, one step.

use bevy::math::DVec3;
use midair_document::{Edit, Kind, Object, ObjectId, affine};
use midair_field::Placement;
use midair_studio::drawing::Drawing;
use midair_studio::notice::Notices;
use midair_studio::project::Project;

use crate::phase::{Draft, Last};
use crate::read::{Reading, carried};

/// Lines with ends nearer to each other than this, in metres, are one.
const SAME: f64 = 1e-7;

/// Puts a reading into the document and remembers the others. Says whether it did.
pub(crate) fn add(
    readings: Vec<Reading>,
    chosen: usize,
    drawing: &Drawing,
    project: &mut Project,
    notices: &mut Notices,
    draft: &mut Draft,
) -> bool {
    let Some(reading) = readings.get(chosen) else {
        return false;
    };
    if is_there(&reading.kind, drawing) {
        notices.info("That line is there already.");
        return false;
    }
    let id = ObjectId(project.document().next_id());
    let (name, step) = match reading.kind {
        Kind::Line(_) => (format!("Line {id}"), "Draw line"),
        _ => (format!("Stroke {id}"), "Draw stroke"),
    };
    let object = Object::new(name, reading.kind.clone()).into();
    if !project.commit_live(step, [Edit::Add { id, object }], notices) {
        return false;
    }
    let mut last = Last {
        id,
        readings,
        places: Vec::new(),
        chosen,
        age: 0.0,
        gone: false,
    };
    last.lay_out();
    draft.remember(last);
    true
}

fn is_there(kind: &Kind, drawing: &Drawing) -> bool {
    let Kind::Line(new) = kind else { return false };
    drawing.lines().iter().any(|old| {
        let same = |a: DVec3, b: DVec3| a.distance(new.a) < SAME && b.distance(new.b) < SAME;
        same(old.a, old.b) || same(old.b, old.a)
    })
}

/// Makes what was drawn last another of its readings; says which.
pub(crate) fn choose(
    to: usize,
    project: &mut Project,
    notices: &mut Notices,
    draft: &mut Draft,
) -> bool {
    let Some(last) = &mut draft.last else {
        notices.info("Draw something first: then there are other readings of it.");
        return false;
    };
    let Some(reading) = last.readings.get(to) else {
        notices.info(format!("There are {} readings of it.", last.readings.len()));
        return false;
    };
    let id = last.id;
    let Some(object) = project.document().object(id) else {
        draft.last = None;
        return false;
    };
    let kind = as_it_stands(&reading.kind, object);
    let words = reading.words.clone();
    let done = project.commit_live("Other reading", [Edit::SetKind { id, kind }], notices);
    if done {
        notices.info(format!("Read as {words}."));
        last.chosen = to;
        last.age = 0.0;
        last.lay_out();
    }
    done
}

/// A reading in the frame of the object that it becomes, with the tick marks and the width that this has.
pub(crate) fn as_it_stands(kind: &Kind, object: &Object) -> Kind {
    let mut kind = if object.placement == Placement::IDENTITY {
        kind.clone()
    } else {
        carried(kind, &affine(&object.placement).inverse())
    };
    match (&mut kind, &object.kind) {
        (Kind::Line(new), Kind::Line(old)) => new.ticks.clone_from(&old.ticks),
        (Kind::Stroke(new), Kind::Stroke(old)) if new.width != old.width => {
            std::sync::Arc::make_mut(new).width = old.width;
        }
        _ => {}
    }
    kind
}
