//! Opening a session with everything that draws and listens in it, and letting go of it.

use bevy::math::{Isometry3d, UVec2};
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy::render::renderer::RenderDevice;
use bevy_mod_openxr::resources::{OxrCurrentSessionConfig, OxrFrameWaiter, OxrSwapchainImages};
use bevy_mod_openxr::session::{OxrSession, OxrSessionCreateNextChain};
use bevy_mod_openxr::types::{SwapchainCreateFlags, SwapchainCreateInfo, SwapchainUsageFlags};
use bevy_mod_xr::spaces::XrPrimaryReferenceSpace;
use midair_studio::settings::Settings;
use openxr::{
    EnvironmentBlendMode, ReferenceSpaceType, ViewConfigurationType, ViewConfigurationView,
};

use super::Link;
use crate::frame::{RenderParts, ToRender, Trouble, close_views, open_views};
use crate::input::{self, Input};
use crate::runtime::{Card, Connection, RuntimeFault};

/// Formats of the eyes' images, the best first.
const FORMATS: [TextureFormat; 2] = [TextureFormat::Rgba8UnormSrgb, TextureFormat::Bgra8UnormSrgb];

/// Eyes above the floor in metres, where a runtime knows no floor.
const EYES: f32 = 1.6;

/// Opens a session on the connection at hand.
pub(super) fn session(world: &mut World) -> Result<(), RuntimeFault> {
    let Some(connection) = world.resource::<Link>().connection().cloned() else {
        return Ok(());
    };
    let Some(card) = world.get_non_send::<Card>().cloned() else {
        return Ok(());
    };
    let (parts, waiter) = make(world, &connection, card)?;
    let input = Input::open(world, &connection, &parts.session)?;
    let (space, floor) = room(&connection, &parts.session)?;
    if let Some(line) = floor {
        world
            .resource_mut::<midair_studio::notice::Notices>()
            .info(line);
    }
    world.insert_resource(XrPrimaryReferenceSpace(space));
    world.insert_resource(parts.session.clone());
    world.insert_resource(waiter);
    world.insert_resource(parts.images);
    world.insert_resource(parts.config);
    world.insert_resource(input);
    world.resource::<Trouble>().set_stuck(false);
    world.insert_resource(ToRender::Take(Box::new(parts)));
    open_views(world);
    Ok(())
}

/// Lets go of it in both worlds.
pub(super) fn close(world: &mut World) {
    close_views(world);
    input::forget(world);
    world.remove_resource::<OxrSession>();
    world.remove_resource::<OxrFrameWaiter>();
    world.remove_resource::<OxrSwapchainImages>();
    world.remove_resource::<OxrCurrentSessionConfig>();
    world.remove_resource::<XrPrimaryReferenceSpace>();
    let mut to_render = world.resource_mut::<ToRender>();
    // What the render world has not taken over yet is let go of here.
    *to_render = ToRender::Drop;
}

fn make(
    world: &World,
    connection: &Connection,
    card: Card,
) -> Result<(RenderParts, OxrFrameWaiter), RuntimeFault> {
    let refused = |call| move |code| RuntimeFault::refused(&connection.runtime, call, code);
    let wrapped = |call| move |error| RuntimeFault::of(&connection.runtime, call, error);
    let stereo = ViewConfigurationType::PRIMARY_STEREO;
    let instance = &connection.instance;
    let mut chain = OxrSessionCreateNextChain::default();
    // SAFETY: the handles of the card are those of the device that Bevy draws with.
    let (session, waiter, stream) =
        unsafe { instance.create_session(connection.system, card.0, &mut chain) }
            .map_err(wrapped("xrCreateSession"))?;
    let eyes = instance
        .enumerate_view_configuration_views(connection.system, stereo)
        .map_err(refused("xrEnumerateViewConfigurationViews"))?;
    let Some(eye) = eyes.first().filter(|_| eyes.len() >= 2) else {
        return Err(RuntimeFault::NoGraphics {
            runtime: connection.runtime.clone(),
            reason: "it offers no view for two eyes".to_owned(),
        });
    };
    let offered = session
        .enumerate_swapchain_formats()
        .map_err(wrapped("xrEnumerateSwapchainFormats"))?;
    let Some(format) = FORMATS.into_iter().find(|f| offered.contains(f)) else {
        return Err(RuntimeFault::NoGraphics {
            runtime: connection.runtime.clone(),
            reason: "it offers no image format with 8 bits a colour".to_owned(),
        });
    };
    let sharpness = world.get_resource::<Settings>();
    let config = OxrCurrentSessionConfig {
        resolution: resolution(eye, sharpness.map_or(1.0, |s| s.comfort.sharpness)),
        format,
    };
    let swapchain = session
        .create_swapchain(SwapchainCreateInfo {
            create_flags: SwapchainCreateFlags::EMPTY,
            usage_flags: SwapchainUsageFlags::COLOR_ATTACHMENT | SwapchainUsageFlags::SAMPLED,
            format,
            sample_count: 1,
            width: config.resolution.x,
            height: config.resolution.y,
            face_count: 1,
            array_size: 2,
            mip_count: 1,
        })
        .map_err(wrapped("xrCreateSwapchain"))?;
    let device = world.resource::<RenderDevice>();
    let images = swapchain
        .enumerate_images(device.wgpu_device(), format, config.resolution)
        .map_err(wrapped("xrEnumerateSwapchainImages"))?;
    let blends = instance
        .enumerate_environment_blend_modes(connection.system, stereo)
        .map_err(refused("xrEnumerateEnvironmentBlendModes"))?;
    let blend = if blends.contains(&EnvironmentBlendMode::OPAQUE) {
        EnvironmentBlendMode::OPAQUE
    } else {
        blends
            .first()
            .copied()
            .unwrap_or(EnvironmentBlendMode::OPAQUE)
    };
    info!(
        target: "midair_openxr::life",
        "a session with {} on {}, {} x {} for each eye",
        connection.headset, connection.runtime, config.resolution.x, config.resolution.y
    );
    let parts = RenderParts {
        session,
        stream,
        swapchain,
        images,
        config,
        blend,
    };
    Ok((parts, waiter))
}

/// Pixels of one eye: so many times what the runtime asks for along each edge, as far as it allows.
fn resolution(eye: &ViewConfigurationView, sharpness: f32) -> UVec2 {
    let times = if sharpness.is_finite() {
        sharpness.clamp(0.25, 4.0)
    } else {
        1.0
    };
    let most = [eye.max_image_rect_width, eye.max_image_rect_height];
    let asked = [
        eye.recommended_image_rect_width,
        eye.recommended_image_rect_height,
    ];
    // A runtime that names no bound gets what it asks for and no more.
    let of = |i: usize| ((asked[i] as f32 * times) as u32).clamp(1, most[i].max(asked[i]).max(1));
    UVec2::new(of(0), of(1))
}

/// The room one stands in: its floor where the runtime knows it, otherwise one that is guessed.
fn room(
    connection: &Connection,
    session: &OxrSession,
) -> Result<(bevy_mod_xr::spaces::XrReferenceSpace, Option<String>), RuntimeFault> {
    let refused = |code| RuntimeFault::refused(&connection.runtime, "xrCreateReferenceSpace", code);
    let known = session.enumerate_reference_spaces().unwrap_or_default();
    if known.contains(&ReferenceSpaceType::STAGE) {
        let space = session
            .create_reference_space(ReferenceSpaceType::STAGE, Isometry3d::IDENTITY)
            .map_err(refused)?;
        return Ok((space, None));
    }
    let space = session
        .create_reference_space(ReferenceSpaceType::LOCAL, below_the_eyes())
        .map_err(refused)?;
    let line = format!(
        "{} knows no floor: it is taken to be {EYES} m below your eyes. Set up the room in {} to have the real one.",
        connection.runtime, connection.runtime
    );
    Ok((space, Some(line)))
}

/// Where a floor is guessed, in the space that begins at the eyes.
pub(crate) fn below_the_eyes() -> Isometry3d {
    Isometry3d::from_translation(Vec3::new(0.0, -EYES, 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_eye_is_as_sharp_as_is_wished_and_as_the_runtime_allows() {
        let eye = ViewConfigurationView {
            recommended_image_rect_width: 1000,
            max_image_rect_width: 1500,
            recommended_image_rect_height: 1200,
            max_image_rect_height: 4000,
            recommended_swapchain_sample_count: 1,
            max_swapchain_sample_count: 1,
        };
        assert_eq!(resolution(&eye, 1.0), UVec2::new(1000, 1200));
        assert_eq!(resolution(&eye, 2.0), UVec2::new(1500, 2400));
        assert_eq!(resolution(&eye, 0.5), UVec2::new(500, 600));
        assert_eq!(resolution(&eye, f32::NAN), UVec2::new(1000, 1200));
        let bare = ViewConfigurationView {
            max_image_rect_width: 0,
            ..eye
        };
        assert_eq!(resolution(&bare, 2.0).x, 1000);
    }
}
