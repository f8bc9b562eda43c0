//! A window with mouse, keyboard and gamepad: the pointer or a stick is the leading hand.
//!
//! Left acts and drags, on nothing it draws a box that selects; middle (or Alt and left) orbits, Shift and
//! middle pans, right looks around and flies, the wheel zooms towards the pointer, or while something is
//! dragged moves it nearer or farther. What is selected has handles to move, turn and scale it by. The
//! other hand stays where it is and keeps what it holds; Tab swaps them.

mod band;
pub mod bindings;
mod column;
mod controls_panel;
mod exact;
pub mod focus;
mod gamepad;
mod gizmo;
mod grip;
mod hints;
mod keys;
mod labels;
mod monitors;
mod names;
mod orbit;
mod panels;
mod passes;
mod place;
mod pointer;
mod projection;
mod reach;
mod ring;
mod stretch;
mod view;

use bevy::prelude::*;
use bevy_egui::{EguiGlobalSettings, EguiPlugin, EguiPreUpdateSet, EguiPrimaryContextPass};
use leafwing_input_manager::plugin::InputManagerSystem;
use midair_studio::{StudioSet, hands::WriteHands, panel::Host, snap::ClearGuides};

pub use gamepad::Pad;
pub use gizmo::{Gizmo, Mode};
pub use keys::key_name;
pub use orbit::Orbit;
pub use pointer::Pointer;

/// The way in through a window.
pub struct FlatscreenPlugin;

impl Plugin for FlatscreenPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(EguiPlugin::default());
        app.world_mut()
            .resource_mut::<EguiGlobalSettings>()
            .auto_create_primary_context = false;
        app.init_resource::<Pointer>()
            .init_resource::<Gizmo>()
            .init_resource::<Pad>()
            .init_resource::<focus::Typing>()
            .init_resource::<ring::Ring>()
            .init_resource::<panels::Screen>()
            .init_resource::<focus::Focus>()
            .add_systems(
                PreUpdate,
                (passes::divide, focus::drive)
                    .chain()
                    .after(InputManagerSystem::Update)
                    .after(EguiPreUpdateSet::ProcessInput)
                    .before(EguiPreUpdateSet::BeginPass),
            )
            .add_plugins((bindings::plugin, controls_panel::plugin, monitors::plugin))
            .add_observer(gizmo::put_away)
            .add_systems(Startup, orbit::spawn)
            .add_systems(
                Update,
                (
                    view::carry,
                    gamepad::lead,
                    gamepad::camera,
                    orbit::steer,
                    projection::follow,
                    // Handles come before what lies behind them.
                    gizmo::steer,
                    // The hand follows the camera of this frame.
                    (pointer::point, band::drag, stretch::stretch)
                        .chain()
                        .run_if(|pad: Res<Pad>| !pad.leads()),
                    gamepad::hands,
                    keys::commands,
                    exact::commands,
                    ring::turn.run_if(on_screen),
                    attend,
                )
                    .chain()
                    .in_set(WriteHands)
                    .after(ClearGuides),
            )
            .add_systems(
                Update,
                (
                    gamepad::rumble,
                    view::jump,
                    names::tell,
                    panels::title,
                    panels::drop,
                    panels::close_window,
                )
                    .in_set(StudioSet::Cue),
            )
            .add_systems(
                EguiPrimaryContextPass,
                (
                    panels::style,
                    panels::show,
                    focus::keyboard,
                    ring::show,
                    labels::objects,
                    labels::empty,
                    gizmo::draw,
                    labels::hands,
                    labels::readouts,
                    band::show,
                )
                    .chain(),
            );
    }
}

/// The panels are on the screen, not in the room of a headset.
fn on_screen(host: Res<Host>) -> bool {
    *host == Host::Screen
}

/// Where keys go from the next frame on.
fn attend(
    screen: Res<panels::Screen>,
    typing: Res<focus::Typing>,
    pointer: Res<Pointer>,
    mut attention: ResMut<bindings::Attention>,
) {
    attention.set_if_neq(bindings::Attention {
        text: screen.is_text(),
        panel: screen.is_typing(),
        keyboard: typing.open,
        stretching: pointer.stretching,
        ..*attention
    });
}
