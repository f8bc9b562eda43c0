//! From one mode into another: what is held or selected is let go over a mode and becomes what that
//! mode can use of it.
//!
//! [`Command::Carry`] takes the mode in hand and then triggers [`Carried`]. Each mode observes it for
//! its own id and takes the objects as one step that can be undone, or says in one line why it
//! cannot. What was carried goes back to where it stood when it was taken in hand; a mode that makes
//! something of it dims it with [`Edit::SetDimmed`](midair_document::Edit::SetDimmed) in the same step.

use bevy::prelude::*;
use midair_document::ObjectId;

use crate::StudioSet;
use crate::command::Command;
use crate::hands::Side;
use crate::hold::Held;
use crate::notice::Notices;
use crate::project::{Project, Selection};
use crate::show::Drafts;
use crate::tools::{Announce, ToolId, Tools};

/// Objects were carried into a mode, which is in the hands now.
#[derive(Event, Clone, Debug, PartialEq)]
pub struct Carried {
    /// What; never empty, and all of it there.
    pub objects: Vec<ObjectId>,
    /// Into which mode.
    pub to: ToolId,
}

/// What was asked for in this frame and is announced once the mode has changed.
#[derive(Resource, Default)]
struct Asked(Vec<Carried>);

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Asked>()
        .add_systems(Update, ask.in_set(StudioSet::Ask))
        // The mode left before hears of that first, and gives up what it was doing.
        .add_systems(Update, announce.in_set(StudioSet::Pick).after(Announce));
}

/// What the hands hold at the moment, each once.
pub fn in_hands(held: &Held) -> Vec<ObjectId> {
    let mut objects: Vec<_> = Side::BOTH.iter().filter_map(|&s| held.get(s)).collect();
    objects.dedup();
    objects
}

fn ask(
    mut commands: MessageReader<Command>,
    project: Res<Project>,
    selection: Res<Selection>,
    (mut held, mut drafts): (ResMut<Held>, ResMut<Drafts>),
    mut tools: ResMut<Tools>,
    mut asked: ResMut<Asked>,
    mut notices: ResMut<Notices>,
) {
    for command in commands.read() {
        let Command::Carry { objects, to } = command else {
            continue;
        };
        let mut objects = match objects.as_slice() {
            [] if held.is_empty() => selection.0.clone(),
            [] => in_hands(&held),
            named => named.to_vec(),
        };
        objects.retain(|&id| project.document().object(id).is_some());
        if objects.is_empty() {
            notices.warn("Nothing to carry: take something in hand or select it first.");
            continue;
        }
        if !tools.activate(to.as_str()) {
            notices.warn(format!(
                "No mode \"{to}\" is plugged in. Add its plugin and start Midair again."
            ));
            continue;
        }
        *held = Held::default();
        drafts.clear();
        asked.0.push(Carried {
            objects,
            to: to.clone(),
        });
    }
}

fn announce(mut asked: ResMut<Asked>, mut commands: Commands) {
    if !asked.0.is_empty() {
        for carried in asked.0.drain(..) {
            commands.trigger(carried);
        }
    }
}
