//! How the room stands in the world: eyes and whatever hangs on them follow the world that was moved.

use bevy::prelude::*;
use bevy::window::{PresentMode, PrimaryWindow};
use bevy::winit::WinitSettings;
use bevy_mod_xr::session::XrTrackingRoot;
use midair_studio::panel::Host;
use midair_studio::world::WorldView;

use crate::session::Life;

/// The room's place in the world of this frame.
pub(crate) fn stand(view: Res<WorldView>, mut root: Query<&mut Transform, With<XrTrackingRoot>>) {
    let world = view.world_from_room();
    if !world.is_sound() {
        return;
    }
    for mut place in &mut root {
        place.set_if_neq(Transform {
            translation: world.translation,
            rotation: world.rotation,
            scale: Vec3::splat(world.scale),
        });
    }
}

/// Panels are where the person is.
pub(crate) fn host(life: Res<Life>, mut host: ResMut<Host>) {
    host.set_if_neq(if life.is_worn() {
        Host::Room
    } else {
        Host::Screen
    });
}

/// The headset sets the pace while it is worn; otherwise the window does, as on the flat screen.
pub(crate) fn pace(
    life: Res<Life>,
    settings: Option<ResMut<WinitSettings>>,
    mut windows: Query<&mut Window, With<PrimaryWindow>>,
) {
    let (mode, modes) = if life.is_worn() {
        (PresentMode::AutoNoVsync, WinitSettings::continuous())
    } else {
        (PresentMode::AutoVsync, WinitSettings::game())
    };
    if let Some(mut settings) = settings {
        *settings = modes;
    }
    for mut window in &mut windows {
        if window.present_mode != mode {
            window.present_mode = mode;
        }
    }
}
