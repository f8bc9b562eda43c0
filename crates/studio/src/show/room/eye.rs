//! What every camera of the room has.

use bevy::anti_alias::smaa::Smaa;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::ShadowFilteringMethod;
use bevy::pbr::{ScreenSpaceAmbientOcclusion, ScreenSpaceAmbientOcclusionQualityLevel};
use bevy::prelude::*;
use bevy::render::renderer::RenderAdapterInfo;

use super::is_software;

/// Of the height of the view, in radians.
pub const FIELD_OF_VIEW: f32 = 0.75;

/// Who looks, and how much a frame may cost.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Eye {
    /// Somebody works: a frame in time is worth more than a smooth edge.
    Working,
    /// A picture is taken: it has the time.
    Picture,
    /// An eye of a headset: ninety frames a second, and nothing that shimmers between two eyes.
    Headset,
}

/// What an eye of a headset has beside its projection, which is the runtime's.
pub fn headset() -> impl Bundle {
    (
        Eye::Headset,
        Tonemapping::KhronosPbrNeutral,
        // Four samples hold still when the head moves; smoothing afterwards and shade from depths do not.
        Msaa::Sample4,
    )
}

/// A window of which only a picture is taken: a software renderer draws in it what a graphics card would.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Unhurried;

/// A camera of the room; where it stands is to be added.
pub fn camera(eye: Eye) -> impl Bundle {
    (
        eye,
        Camera3d::default(),
        Projection::Perspective(PerspectiveProjection {
            fov: FIELD_OF_VIEW,
            near: 0.02,
            ..default()
        }),
        // The one curve that leaves base colours as they are: an operand's blue stays that blue.
        Tonemapping::KhronosPbrNeutral,
        Msaa::Off,
    )
}

/// Each camera gets the edges and the shade that its renderer can afford. Shade in corners is computed from
/// depths that several samples per pixel do not have, so it goes with edges that are smoothed afterwards. In
/// a headset it is four samples and no shade.
pub(super) fn afford(
    (adapter, unhurried): (Option<Res<RenderAdapterInfo>>, Option<Res<Unhurried>>),
    cameras: Query<(Entity, &Eye), Added<Eye>>,
    mut commands: Commands,
) {
    let software = unhurried.is_none() && adapter.is_none_or(|a| is_software(&a));
    for (entity, eye) in &cameras {
        let mut camera = commands.entity(entity);
        if *eye == Eye::Headset {
            // Soft: near to the eyes every step of a shadow's edge is seen.
            camera.insert(ShadowFilteringMethod::Gaussian);
        } else if software && *eye == Eye::Working {
            camera.insert(ShadowFilteringMethod::Hardware2x2);
        } else {
            camera.insert((
                Smaa::default(),
                ScreenSpaceAmbientOcclusion {
                    quality_level: ScreenSpaceAmbientOcclusionQualityLevel::High,
                    // Things here are a few decimetres large.
                    constant_object_thickness: 0.08,
                },
                ShadowFilteringMethod::Gaussian,
            ));
        }
    }
}
