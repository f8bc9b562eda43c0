//! What can be done with objects in every mode: select several, group, lock, hide, copy, place by
//! numbers, colour.
//!
//! Panels and shortcuts ask with an [`Ask`]; each is one step that can be undone. Where an ask
//! names no object it means what is selected.

mod ask;
mod carry;
mod copies;
mod dropper;
mod edits;
mod extent;
mod select;

use bevy::prelude::*;
use midair_document::{Edit, ObjectId};

pub use ask::{Ask, Axis, How};
pub use carry::{carried, companions};
pub use copies::{mirrored, turned};
pub use dropper::Dropper;
pub use extent::extent;
pub use select::picked;

use crate::StudioSet;
use crate::command::Command;
use crate::materials::{DialDraft, MaterialShelf};
use crate::notice::Notices;
use crate::project::{Project, Selection};
use crate::show::Drafts;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Update, carry_out.in_set(StudioSet::Ask));
    dropper::plugin(app);
}

fn carry_out(
    mut commands: MessageReader<Command>,
    mut project: ResMut<Project>,
    mut selection: ResMut<Selection>,
    mut drafts: ResMut<Drafts>,
    mut dropper: ResMut<Dropper>,
    materials: Res<MaterialShelf>,
    mut draft: ResMut<DialDraft>,
    mut notices: ResMut<Notices>,
) {
    for command in commands.read() {
        let Command::Objects(ask) = command else {
            continue;
        };
        if let Ask::Dropper { on } = ask {
            dropper.turn(*on && !selection.0.is_empty());
            if *on && selection.0.is_empty() {
                notices.info("Select first what is to get the colour, then take the eyedropper.");
            } else if *on {
                notices.info(
                    "Click what has the colour and the material; Cancel puts the eyedropper away.",
                );
            }
            continue;
        }
        if let Ask::Dial {
            ids,
            dial,
            value,
            done: false,
        } = ask
        {
            let ids = if ids.is_empty() { &selection.0 } else { ids };
            draft.set_if_neq(DialDraft {
                ids: ids.clone(),
                dial: Some((dial.clone(), *value)),
            });
            continue;
        }
        draft.set_if_neq(DialDraft::default());
        if let Some(next) = select::selected(ask, project.document(), &selection) {
            selection.set_if_neq(next);
            continue;
        }
        match edits::edits(ask, project.document(), materials.all(), &selection.0) {
            Ok((name, edits)) => {
                drafts.clear();
                let made: Vec<_> = edits.iter().filter_map(added).collect();
                let done = if ask.is_live() {
                    project.commit_live(name, edits, &mut notices)
                } else {
                    project.commit(name, edits, &mut notices)
                };
                // What has just been made is what one goes on with, and not its images.
                if done && ask.selects_new() {
                    selection.set_if_neq(Selection(made));
                }
            }
            Err(reason) => notices.info(reason.to_string()),
        }
    }
}

/// The object that an edit adds.
pub(crate) fn added(edit: &Edit) -> Option<ObjectId> {
    match edit {
        Edit::Add { id, .. } => Some(*id),
        _ => None,
    }
}
