//! How objects look in the hands: touched, selected, marked as operands, fresh.

use bevy::prelude::*;
use midair_document::ObjectId;
use midair_field::Op;

use super::Held;
use crate::hands::Side;
use crate::pick::Touch;
use crate::project::{Project, Selection};
use crate::show::{Cues, Tint};

/// What is drawn as a shell only, since what it becomes is shown in its place.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Ghosted(pub Vec<ObjectId>);

/// Marks are the document's, so that they show in every mode.
pub(super) fn colours(
    project: Res<Project>,
    (touch, held): (Res<Touch>, Res<Held>),
    (selection, ghosted): (Res<Selection>, Res<Ghosted>),
    mut cues: ResMut<Cues>,
) {
    let document = project.document();
    let mut next = Cues::default();
    for (id, object) in document.objects() {
        if object.fresh {
            next.entry(id).tint = Tint::Fresh;
        }
        if object.dimmed {
            next.entry(id).ghost = true;
        }
    }
    for (i, &(id, op)) in document.pending().iter().enumerate() {
        // The first operand's operator is ignored: it is what the others join.
        let tint = match if i == 0 { Op::Union } else { op } {
            Op::Union => Tint::Union,
            Op::Intersect => Tint::Intersect,
            Op::Subtract => Tint::Subtract,
        };
        let cue = next.entry(id);
        cue.tint = tint;
        cue.label = tint.sign().map(|s| format!("{} {s}", i + 1));
    }
    for &id in &ghosted.0 {
        if document.object(id).is_some() {
            next.entry(id).ghost = true;
        }
    }
    for side in Side::BOTH {
        if let Some(object) = held.get(side).or(touch.get(side).map(|t| t.object)) {
            next.entry(object).touched = true;
        }
    }
    for &object in &selection.0 {
        next.entry(object).selected = true;
    }
    if *cues != next {
        *cues = next;
    }
}
