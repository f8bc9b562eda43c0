//! The render world's part: begin, take an image, late poses of the eyes, hand in.

use bevy::prelude::*;
use bevy::render::texture::ManualTextureViews;
use bevy::render::{ExtractSchedule, MainWorld, Render, RenderApp};
use bevy_mod_openxr::layer_builder::{LayerProvider, ProjectionLayer};
use bevy_mod_openxr::render::{add_texture_view, locate_views, update_views_render_world};
use bevy_mod_openxr::resources::{
    OxrCurrentSessionConfig, OxrFrameState, OxrFrameStream, OxrSwapchain, OxrSwapchainImages,
};
use bevy_mod_openxr::session::OxrSession;
use bevy_mod_xr::session::XrRenderSystems;

use super::{Trouble, Turn};

/// What a session draws with.
pub(crate) struct RenderParts {
    pub session: OxrSession,
    pub stream: OxrFrameStream,
    pub swapchain: OxrSwapchain,
    pub images: OxrSwapchainImages,
    pub config: OxrCurrentSessionConfig,
    pub blend: openxr::EnvironmentBlendMode,
}

/// What the render world takes over at the next extraction.
#[derive(Resource, Default)]
pub(crate) enum ToRender {
    /// Nothing new.
    #[default]
    Nothing,
    /// A session began.
    Take(Box<RenderParts>),
    /// The session is gone.
    Drop,
}

/// How the projection is laid over the room.
#[derive(Resource, Clone, Copy)]
struct Blend(openxr::EnvironmentBlendMode);

/// How far the frame has come: what was not begun is not ended.
#[derive(Resource, Default, Clone, Copy)]
struct Progress {
    begun: bool,
    /// An image that a refused call left in hand stays there for the next frame: taking another one would be out of
    /// order.
    image: Held,
}

/// The image that is drawn into.
#[derive(Default, Clone, Copy, PartialEq, Eq)]
enum Held {
    #[default]
    None,
    /// Acquired, and perhaps still read by the compositor.
    Taken(u32),
    /// Free to draw into.
    Ready(u32),
}

pub(super) fn plugin(app: &mut App) {
    let Some(render) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    render
        .init_resource::<Progress>()
        .add_systems(ExtractSchedule, take_over)
        .add_systems(
            Render,
            (
                begin,
                take_image,
                locate_views,
                update_views_render_world,
                wait_image,
            )
                .chain()
                .in_set(XrRenderSystems::PreRender)
                .run_if(in_turn),
        )
        .add_systems(
            Render,
            hand_in.in_set(XrRenderSystems::PostRender).run_if(in_turn),
        );
}

fn in_turn(turn: Option<Res<Turn>>, stream: Option<Res<OxrFrameStream>>) -> bool {
    turn.is_some_and(|t| t.waited) && stream.is_some()
}

fn take_over(mut commands: Commands, mut main: ResMut<MainWorld>) {
    let Some(mut slot) = main.get_resource_mut::<ToRender>() else {
        return;
    };
    if matches!(*slot, ToRender::Nothing) {
        return;
    }
    match std::mem::take(&mut *slot) {
        ToRender::Nothing => {}
        ToRender::Take(parts) => {
            commands.insert_resource(parts.session);
            commands.insert_resource(parts.stream);
            commands.insert_resource(parts.swapchain);
            commands.insert_resource(parts.images);
            commands.insert_resource(parts.config);
            commands.insert_resource(Blend(parts.blend));
            commands.insert_resource(Progress::default());
        }
        ToRender::Drop => {
            commands.remove_resource::<OxrFrameStream>();
            commands.remove_resource::<OxrSwapchain>();
            commands.remove_resource::<OxrSwapchainImages>();
            commands.remove_resource::<OxrSession>();
        }
    }
}

fn begin(
    mut stream: ResMut<OxrFrameStream>,
    mut progress: ResMut<Progress>,
    trouble: Res<Trouble>,
) {
    match stream.begin() {
        Ok(()) => {
            progress.begun = true;
            trouble.set_stuck(false);
        }
        Err(code) => {
            progress.begun = false;
            // A second wait would wait for ever for this frame to begin.
            trouble.set_stuck(true);
            trouble.note("xrBeginFrame", code);
        }
    }
}

fn take_image(
    images: Res<OxrSwapchainImages>,
    config: Res<OxrCurrentSessionConfig>,
    state: Res<OxrFrameState>,
    trouble: Res<Trouble>,
    mut swapchain: ResMut<OxrSwapchain>,
    mut views: ResMut<ManualTextureViews>,
    mut progress: ResMut<Progress>,
) {
    if !progress.begun || !state.should_render {
        return;
    }
    if progress.image == Held::None {
        match swapchain.acquire_image() {
            Ok(index) => progress.image = Held::Taken(index),
            Err(error) => trouble.note("xrAcquireSwapchainImage", code_of(&error)),
        }
    }
    if let Held::Taken(index) | Held::Ready(index) = progress.image
        && let Some(image) = images.get(index as usize)
    {
        for eye in 0..2 {
            add_texture_view(&mut views, image, &config, eye);
        }
    }
}

fn wait_image(
    trouble: Res<Trouble>,
    mut swapchain: ResMut<OxrSwapchain>,
    mut progress: ResMut<Progress>,
) {
    let Held::Taken(index) = progress.image else {
        return;
    };
    match swapchain.wait_image(openxr::Duration::INFINITE) {
        Ok(()) => progress.image = Held::Ready(index),
        Err(error) => trouble.note("xrWaitSwapchainImage", code_of(&error)),
    }
}

fn hand_in(world: &mut World) {
    let Progress { begun, image } = *world.resource::<Progress>();
    let trouble = world.resource::<Trouble>().clone();
    let mut drawn = false;
    if begun && matches!(image, Held::Ready(_)) {
        match world.resource_mut::<OxrSwapchain>().release_image() {
            Ok(()) => {
                drawn = true;
                world.resource_mut::<Progress>().image = Held::None;
            }
            Err(error) => trouble.note("xrReleaseSwapchainImage", code_of(&error)),
        }
    }
    if !begun {
        return;
    }
    world.resource_scope::<OxrFrameStream, ()>(|world, mut stream| {
        let (Some(state), Some(blend)) = (
            world.get_resource::<OxrFrameState>(),
            world.get_resource::<Blend>(),
        ) else {
            return;
        };
        // A frame without an image is handed in empty.
        let layer = drawn.then(|| ProjectionLayer.get(world)).flatten();
        let layers: Vec<_> = layer.iter().map(Box::as_ref).collect();
        if let Err(error) = stream.end(state.predicted_display_time, blend.0, &layers) {
            trouble.note("xrEndFrame", code_of(&error));
        }
    });
}

fn code_of(error: &bevy_mod_openxr::error::OxrError) -> openxr::sys::Result {
    match error {
        bevy_mod_openxr::error::OxrError::OpenXrError(code) => *code,
        _ => openxr::sys::Result::ERROR_VALIDATION_FAILURE,
    }
}
