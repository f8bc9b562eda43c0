//! The operands of a sequence: marked ones before they are fused, and those of a solid afterwards.
//!
//! A solid is the ordered list of its operations, so any of them can be changed later: its sign, its
//! place in the order, whether it takes part. Each change is one edit.

mod ask;
mod edits;
mod place;

use bevy::prelude::*;

pub use ask::{Of, OperandAsk};
pub use edits::{listed, name};

use crate::StudioSet;
use crate::command::Command;
use crate::notice::Notices;
use crate::objects::added;
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
        let Command::Operand(ask) = command else {
            continue;
        };
        match edits::edits(ask, project.document()) {
            Ok((name, edits)) => {
                drafts.clear();
                let made: Vec<_> = edits.iter().filter_map(added).collect();
                if project.commit_live(name, edits, &mut notices) && !made.is_empty() {
                    selection.set_if_neq(Selection(made));
                }
            }
            Err(reason) => notices.warn(reason.to_string()),
        }
    }
}
