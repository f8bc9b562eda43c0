//! Things in the hands, the same in every mode: taken, moved, turned, scaled by two hands, put down,
//! deleted, saved (EasyVRModeling §4.3).
//!
//! It runs after the active tool, in [`StudioSet::Hold`] and [`StudioSet::Commit`]; a tool that
//! needs one of these buttons for itself claims it in [`Reserved`]. One gesture is one step to undo.

mod act;
mod cue;
mod grip;
mod release;
mod stretch;

use bevy::prelude::*;
use midair_document::ObjectId;

pub use cue::Ghosted;
pub use grip::Hold;
pub use stretch::{Axis, RATIO, Stretch};

use crate::StudioSet;
use crate::command::Command;
use crate::hands::{Action, ActionSet, Side};
use crate::show::Drafts;
use crate::snap::ClearGuides;
use crate::tools::ToolChanged;

/// What the hands hold. Thrown away when the gesture is given up.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct Held {
    hands: [Option<(ObjectId, Hold)>; 2],
    stretch: Option<(ObjectId, Stretch)>,
}

impl Held {
    /// What one hand holds.
    pub fn get(&self, side: Side) -> Option<ObjectId> {
        self.hands[side as usize].map(|(object, _)| object)
    }

    /// Whether any hand holds `object`.
    pub fn holds(&self, object: ObjectId) -> bool {
        Side::BOTH.iter().any(|&s| self.get(s) == Some(object))
    }

    /// Whether both hands are empty.
    pub fn is_empty(&self) -> bool {
        self.hands.iter().all(Option::is_none)
    }

    /// What both hands hold and scale, and how.
    pub fn stretch(&self) -> Option<&(ObjectId, Stretch)> {
        self.stretch.as_ref()
    }

    fn hold(&self, side: Side) -> Option<(ObjectId, Hold)> {
        self.hands[side as usize]
    }

    fn take(&mut self, side: Side, object: ObjectId, hold: Hold) {
        self.hands[side as usize] = Some((object, hold));
    }

    fn empty(&mut self, side: Side) {
        self.hands[side as usize] = None;
    }

    /// No hand holds `object` any longer.
    fn drop(&mut self, object: ObjectId) {
        for side in Side::BOTH {
            if self.get(side) == Some(object) {
                self.empty(side);
            }
        }
        if self.stretch.is_some_and(|(o, _)| o == object) {
            self.stretch = None;
        }
    }
}

/// The buttons that mean something of the active tool's own in this frame; [`Action::Grab`],
/// [`Action::Delete`] and [`Action::Save`] are otherwise the same in every mode. A tool claims them
/// in [`StudioSet::Act`], every frame anew.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct Reserved([ActionSet; 2]);

impl Reserved {
    /// This hand's `action` is the tool's own in this frame.
    pub fn claim(&mut self, side: Side, action: Action) {
        self.0[side as usize].set(action, true);
    }

    /// Whether the tool has claimed it.
    pub fn has(&self, side: Side, action: Action) -> bool {
        self.0[side as usize].has(action)
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Held>()
        .init_resource::<Reserved>()
        .init_resource::<Ghosted>()
        .add_observer(left)
        .add_systems(
            Update,
            (
                begin.in_set(StudioSet::Gather).in_set(ClearGuides),
                forget.in_set(StudioSet::Ask),
                // A thing deleted in this frame is not taken in hand.
                (act::delete, act::save, act::grab)
                    .chain()
                    .in_set(StudioSet::Hold),
                release::release.in_set(StudioSet::Commit),
                cue::colours.in_set(StudioSet::Cue),
            ),
        );
}

fn begin(mut reserved: ResMut<Reserved>) {
    reserved.set_if_neq(Reserved::default());
}

/// Leaving a tool puts back what the hands hold.
fn left(_: On<ToolChanged>, mut held: ResMut<Held>, mut drafts: ResMut<Drafts>) {
    held.set_if_neq(Held::default());
    drafts.clear();
}

/// The document changes under the hands: what they are in the middle of is given up.
fn forget(mut commands: MessageReader<Command>, mut held: ResMut<Held>) {
    let changes = |c: &Command| {
        matches!(
            c,
            Command::Undo | Command::Redo | Command::New | Command::Open(_) | Command::Restore
        )
    };
    if commands.read().any(changes) {
        held.set_if_neq(Held::default());
    }
}
