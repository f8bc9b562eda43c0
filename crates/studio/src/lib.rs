//! The Bevy heart every mode stands on: hands, tools, the project, what is shown and picked.
//!
//! One frame runs [`StudioSet`] in order. Ways in write hands and commands in
//! [`StudioSet::Gather`]; the active tool reads them and applies edits in [`StudioSet::Act`];
//! the entities follow the document in [`StudioSet::Rebuild`].

pub mod bound;
mod bounded;
pub mod carry;
pub mod command;
pub mod drawing;
pub mod evaluate;
pub mod hands;
pub mod help;
pub mod hold;
pub mod links;
pub mod materials;
pub mod notice;
pub mod objects;
pub mod operands;
pub mod panel;
pub mod pick;
pub mod plane;
pub mod project;
pub mod reference;
pub mod ruler;
pub mod settings;
pub mod show;
pub mod snap;
pub mod symmetry;
pub mod tools;
pub mod units;
pub mod world;

use bevy::prelude::*;

pub use midair_document as document;

/// The parts of a frame, in order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StudioSet {
    /// Ways in write what the hands do and what panels asked for.
    Gather,
    /// What was asked for is carried out: files, undo, modes.
    Ask,
    /// What each hand touches is found.
    Pick,
    /// The active tool moves from phase to phase.
    Act,
    /// What the hands take, move, delete and save in every mode alike, where the tool leaves it to them.
    Hold,
    /// Finished gestures become edits of the document.
    Commit,
    /// Entities follow the document; solids are evaluated off the frame.
    Rebuild,
    /// Colours, hints and pulses follow the phase.
    Cue,
}

/// Everything above, without a window and without any way in.
pub struct StudioPlugin;

impl Plugin for StudioPlugin {
    fn build(&self, app: &mut App) {
        app.configure_sets(
            Update,
            (
                StudioSet::Gather,
                StudioSet::Ask,
                StudioSet::Pick,
                StudioSet::Act,
                StudioSet::Hold,
                StudioSet::Commit,
                StudioSet::Rebuild,
                StudioSet::Cue,
            )
                .chain(),
        )
        .add_plugins((
            settings::plugin,
            panel::plugin,
            hands::plugin,
            tools::plugin,
            notice::plugin,
            command::plugin,
            project::plugin,
            objects::plugin,
            operands::plugin,
            drawing::plugin,
            evaluate::plugin,
            pick::plugin,
            materials::plugin,
            show::plugin,
            help::plugin,
        ))
        .add_plugins((hold::plugin, carry::plugin, links::plugin))
        .add_plugins((
            plane::plugin,
            reference::plugin,
            ruler::plugin,
            snap::plugin,
            symmetry::plugin,
            world::plugin,
        ));
    }

    fn finish(&self, app: &mut App) {
        // Once, before the first frame: the project is there when anything asks for it.
        project::begin(app.world_mut());
    }
}
