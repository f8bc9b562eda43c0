//! A window with mouse and keyboard: the pointer is the leading hand.
//!
//! Left acts and drags, middle (or Alt and left) orbits, Shift and middle pans, the wheel zooms, or
//! while something is dragged moves it nearer or farther. The other hand stays where it is and
//! keeps what it holds; Tab swaps them.

pub mod bindings;
mod keys;
mod labels;
mod orbit;
mod panels;
mod place;
mod pointer;
mod stretch;

use bevy::prelude::*;
use bevy_egui::{EguiPlugin, EguiPrimaryContextPass};
use midair_studio::{StudioSet, hands::AdvanceHands};

pub use keys::key_name;
pub use orbit::Orbit;
pub use pointer::Pointer;

/// The way in through a window.
pub struct FlatscreenPlugin;

impl Plugin for FlatscreenPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(EguiPlugin::default())
            .init_resource::<Pointer>()
            .init_resource::<panels::Screen>()
            .add_plugins(bindings::plugin)
            .add_systems(Startup, orbit::spawn)
            .add_systems(
                Update,
                (
                    orbit::steer,
                    // The hand follows the camera of this frame.
                    pointer::point,
                    stretch::stretch,
                    keys::commands,
                    attend,
                )
                    .chain()
                    .in_set(StudioSet::Gather)
                    .before(AdvanceHands),
            )
            .add_systems(
                Update,
                (orbit::frame, labels::hands, panels::title, panels::drop).in_set(StudioSet::Cue),
            )
            .add_systems(
                EguiPrimaryContextPass,
                (panels::style, panels::show, labels::objects, labels::empty).chain(),
            );
    }
}

/// Where keys go from the next frame on.
fn attend(
    screen: Res<panels::Screen>,
    pointer: Res<Pointer>,
    mut attention: ResMut<bindings::Attention>,
) {
    attention.set_if_neq(bindings::Attention {
        text: screen.is_typing(),
        stretching: pointer.stretching,
        ..*attention
    });
}
