//! From one mode into another: what is held or selected is let go over a mode and becomes what that
//! mode can use of it.
//!
//! [`Command::Carry`] takes the mode in hand and then triggers [`Carrying`] and [`Carried`]. Each mode
//! observes the second for its own id and takes the objects as one step that can be undone, or says in
//! one line why it cannot. One that has an answer to what another mode cannot use says so at the first. What was carried goes back to where it stood when it was taken in hand; a mode that makes
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

/// Objects are about to be carried into a mode, which is in the hands now. Whoever can make of one
/// what that mode has no use for as it is (close a surface, say) puts it into `answered`.
#[derive(Event, Clone, Debug, PartialEq)]
pub struct Carrying {
    /// What; never empty, and all of it there.
    pub objects: Vec<ObjectId>,
    /// Into which mode.
    pub to: ToolId,
    /// Those for which there is an offer.
    pub answered: Vec<ObjectId>,
}

/// Objects were carried into a mode, which is in the hands now.
#[derive(Event, Clone, Debug, PartialEq)]
pub struct Carried {
    /// What; never empty, and all of it there.
    pub objects: Vec<ObjectId>,
    /// Into which mode.
    pub to: ToolId,
    /// Those for which someone has an offer: the mode leaves them and need not say why.
    pub answered: Vec<ObjectId>,
}

impl Carried {
    /// What the mode is to take, or to say why not.
    pub fn taken(&self) -> impl Iterator<Item = ObjectId> + '_ {
        let left = |id: &ObjectId| !self.answered.contains(id);
        self.objects.iter().copied().filter(left)
    }
}

/// What was asked for in this frame and is announced once the mode has changed.
#[derive(Resource, Default)]
struct Asked(Vec<Carrying>);

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
        asked.0.push(Carrying {
            objects,
            to: to.clone(),
            answered: Vec::new(),
        });
    }
}

fn announce(mut asked: ResMut<Asked>, mut commands: Commands) {
    if !asked.0.is_empty() {
        for mut carrying in asked.0.drain(..) {
            commands.queue(move |world: &mut World| {
                world.trigger_ref(&mut carrying);
                let Carrying {
                    objects,
                    to,
                    answered,
                } = carrying;
                world.trigger(Carried {
                    objects,
                    to,
                    answered,
                });
            });
        }
    }
}
