//! The frame loop: waited for in the main world, begun, drawn and handed in by the render world.
//!
//! bevy_mod_openxr's own loop ends the app where a runtime dies (every call of it is unwrapped). Here a call that fails is
//! written down as [`Trouble`], the frame goes on without it, and the session's life decides what follows.

mod render;
mod trouble;
mod views;

use bevy::prelude::*;
use bevy::render::extract_resource::{ExtractResource, ExtractResourcePlugin};
use bevy_mod_openxr::render::{locate_views, update_cameras, update_views};
use bevy_mod_openxr::resources::{
    OxrCurrentSessionConfig, OxrFrameState, OxrFrameWaiter, OxrSwapchainImages, OxrViews,
};
use bevy_mod_xr::camera::{XrCamera, XrCameraPlugin};
use bevy_mod_xr::session::{XrFirst, XrHandleEvents};
use bevy_mod_xr::spaces::XrPrimaryReferenceSpace;

pub(crate) use render::{RenderParts, ToRender};
pub(crate) use trouble::Trouble;
pub use views::eye;
pub(crate) use views::{close_views, open_views};

/// Between two tries of a call that was refused and that sets the pace.
const PAUSE: std::time::Duration = std::time::Duration::from_millis(11);

/// Whether this frame was waited for: only such a frame is begun and handed in.
#[derive(Resource, ExtractResource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Turn {
    /// It was.
    pub waited: bool,
    /// Frames waited for so far.
    pub number: u64,
}

/// Needs the render app: added where [`RenderPlugin`](bevy::render::RenderPlugin) stands.
pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Turn>()
        .init_resource::<Trouble>()
        .init_resource::<ToRender>()
        .init_resource::<OxrViews>()
        .add_plugins((
            XrCameraPlugin,
            ExtractResourcePlugin::<Turn>::default(),
            ExtractResourcePlugin::<Trouble>::default(),
            ExtractResourcePlugin::<OxrFrameState>::default(),
            ExtractResourcePlugin::<OxrCurrentSessionConfig>::default(),
            ExtractResourcePlugin::<OxrSwapchainImages>::default(),
            ExtractResourcePlugin::<OxrViews>::default(),
            ExtractResourcePlugin::<XrPrimaryReferenceSpace>::default(),
        ))
        .add_systems(
            XrFirst,
            (
                rest.before(wait),
                wait.run_if(resource_exists::<OxrFrameWaiter>),
                update_cameras.run_if(waited).after(wait),
                // Without a frame of the runtime's there is no image to draw into.
                (close_eyes, idle).run_if(not(waited)).after(wait),
            )
                .in_set(XrHandleEvents::FrameLoop),
        )
        .add_systems(
            PostUpdate,
            (locate_views, update_views)
                .chain()
                // The cameras stand where the eyes are before anything is drawn from them.
                .before(TransformSystems::Propagate)
                .run_if(waited),
        );
    render::plugin(app);
}

/// The frame at hand was waited for.
pub(crate) fn waited(turn: Res<Turn>) -> bool {
    turn.waited
}

/// Where neither a headset nor a window sets the pace, nobody is waiting.
fn idle(windows: Query<(), With<Window>>) {
    if windows.is_empty() {
        std::thread::sleep(PAUSE);
    }
}

fn close_eyes(mut eyes: Query<&mut Camera, With<XrCamera>>) {
    for mut eye in &mut eyes {
        if eye.is_active {
            eye.is_active = false;
        }
    }
}

fn rest(mut turn: ResMut<Turn>) {
    if turn.waited {
        turn.waited = false;
    }
}

/// Waits until the runtime wants a frame: the app runs at the pace of the headset.
fn wait(
    mut waiter: ResMut<OxrFrameWaiter>,
    running: Res<crate::session::Link>,
    trouble: Res<Trouble>,
    mut turn: ResMut<Turn>,
    mut commands: Commands,
) {
    if !running.is_begun() {
        return;
    }
    if trouble.is_stuck() {
        // The frame that was waited for is tried again; a second wait would never end.
        std::thread::sleep(PAUSE);
        turn.waited = true;
        return;
    }
    match waiter.wait() {
        Ok(state) => {
            commands.insert_resource(OxrFrameState(state));
            turn.waited = true;
            turn.number += 1;
        }
        Err(code) => {
            trouble.note("xrWaitFrame", code);
            std::thread::sleep(PAUSE);
        }
    }
}
