//! Controllers: what the runtime says of them becomes the hands of the studio.

mod actions;
pub mod bindings;
mod controllers;
mod gather;
mod keys;
mod names;
mod one_hand;
mod read;

pub use controllers::{Controller, Controllers};
pub(crate) use read::Input;

use bevy::prelude::*;
use midair_studio::StudioSet;
use midair_studio::hands::{FilterHands, WriteHands};

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<bindings::Bindings>()
        .init_resource::<Controllers>()
        .add_systems(PreStartup, bindings::read_own)
        .add_systems(
            Update,
            gather::gather
                // Whoever wears the headset has the hands, whatever the mouse does.
                .after(WriteHands)
                .before(FilterHands),
        )
        .add_systems(Update, names::tell.in_set(StudioSet::Cue));
}

/// A session is gone: its controllers are nowhere.
pub(crate) fn forget(world: &mut World) {
    world.remove_resource::<Input>();
    if let Some(mut controllers) = world.get_resource_mut::<Controllers>() {
        controllers.lose();
    }
}
