//! What can be done with objects in every mode: select several, group, lock, hide, copy, place by
//! numbers, colour.
//!
//! Panels and shortcuts ask with an [`Ask`]; each is one step that can be undone. Where an ask
//! names no object it means what is selected.

mod ask;
mod carry;
mod copies;
mod edits;
mod extent;
mod select;

use bevy::prelude::*;

pub use ask::{Ask, Axis, How};
pub use carry::{carried, companions};
pub use copies::{mirrored, turned};
pub use extent::extent;
pub use select::picked;

use crate::StudioSet;
use crate::command::Command;
use crate::notice::Notices;
use crate::project::{Project, Selection};
use crate::show::Drafts;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Update, carry_out.in_set(StudioSet::Ask));
}

fn carry_out(
    mut commands: MessageReader<Command>,
    mut project: ResMut<Project>,
    mut selection: ResMut<Selection>,
    mut drafts: ResMut<Drafts>,
    mut notices: ResMut<Notices>,
) {
    for command in commands.read() {
        let Command::Objects(ask) = command else {
            continue;
        };
        if let Some(next) = select::selected(ask, project.document(), &selection) {
            selection.set_if_neq(next);
            continue;
        }
        let before = project.document().next_id();
        match edits::edits(ask, project.document(), &selection.0) {
            Ok((name, edits)) => {
                drafts.clear();
                if project.commit(name, edits, &mut notices) && ask.selects_new() {
                    // What has just been made is what one goes on with.
                    let made = project.document().objects().map(|(id, _)| id);
                    let made: Vec<_> = made.filter(|id| id.0 >= before).collect();
                    selection.set_if_neq(Selection(made));
                }
            }
            Err(reason) => notices.info(reason.to_string()),
        }
    }
}
