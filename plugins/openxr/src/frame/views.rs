//! Two cameras, one for each eye.

use bevy::camera::{ManualTextureViewHandle, RenderTarget};
use bevy::prelude::*;
use bevy::render::texture::ManualTextureViews;
use bevy_mod_openxr::render::{XR_TEXTURE_INDEX, add_texture_view};
use bevy_mod_openxr::resources::{OxrCurrentSessionConfig, OxrSwapchainImages, OxrViews};
use bevy_mod_xr::camera::{XrCamera, XrProjection};
use midair_studio::show::headset;

/// Metres of the room: nearer than a hand is held to the face.
const NEAR: f32 = 0.03;

/// What is drawn into for one eye, the left one being 0, while the headset is worn.
pub fn eye(number: u32) -> ManualTextureViewHandle {
    ManualTextureViewHandle(XR_TEXTURE_INDEX + number)
}

/// Makes the cameras of a session that has begun to be.
pub(crate) fn open_views(world: &mut World) {
    let config = *world.resource::<OxrCurrentSessionConfig>();
    let images = *world.resource::<OxrSwapchainImages>();
    let Some(first) = images.first() else { return };
    for number in 0..2 {
        let mut views = world.resource_mut::<ManualTextureViews>();
        let view = add_texture_view(&mut views, first, &config, number);
        world.spawn((
            Name::new(if number == 0 { "left eye" } else { "right eye" }),
            headset(),
            RenderTarget::TextureView(view),
            XrCamera(number),
            Projection::custom(XrProjection {
                near: NEAR,
                ..default()
            }),
        ));
    }
}

/// Takes them away.
pub(crate) fn close_views(world: &mut World) {
    let mut eyes = world.query_filtered::<(Entity, &XrCamera), ()>();
    let found: Vec<_> = eyes.iter(world).map(|(e, c)| (e, c.0)).collect();
    for (entity, number) in found {
        world.despawn(entity);
        world
            .resource_mut::<ManualTextureViews>()
            .remove(&eye(number));
    }
    world.resource_mut::<OxrViews>().clear();
}
