//! A board as a picture on a sheet: drawn by a camera of its own, which sleeps while nothing on it changes.

use std::mem;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{ClearColorConfig, RenderTarget};
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use bevy::render::render_resource::{CachedPipelineState, PipelineCache, TextureFormat};
use bevy::render::renderer::RenderDevice;
use bevy::render::{Render, RenderApp, RenderSystems};
use bevy_egui::render::systems::EguiPipelines;
use bevy_egui::{EguiGlobalSettings, EguiOutput, EguiPlugin, EguiRenderOutput};
use bevy_mod_outline::OutlineStencil;
use midair_studio::panel::egui;

use super::content::TALLEST;
use super::{Board, BoardId};
use crate::ink::{Ink, Over, sheet};
use crate::room::Root;

/// Texels per point: at arm's length about as many as a headset shows.
pub(crate) const TEXELS: f32 = 2.0;
/// Frames for which a picture is drawn: what it needs is on the graphics card by the second.
const FRAMES: u8 = 2;
/// Of a board's corners, in metres at a scale of a millimetre per point.
const RADIUS: f32 = 10.0;

/// Whether the renderer has what it draws boards with: it makes that off the frame, and draws nothing until then.
#[derive(Resource, Clone, Default)]
pub(crate) struct Painted(Arc<AtomicBool>);

pub(crate) fn plugin(app: &mut App) {
    let painted = app.world_mut().get_resource_or_init::<Painted>().clone();
    if app.get_sub_app(RenderApp).is_none() {
        return;
    }
    if !app.is_plugin_added::<EguiPlugin>() {
        app.add_plugins(EguiPlugin::default());
        // There is no screen for one.
        app.world_mut()
            .resource_mut::<EguiGlobalSettings>()
            .auto_create_primary_context = false;
    }
    if let Some(render) = app.get_sub_app_mut(RenderApp) {
        render
            .insert_resource(painted)
            .add_systems(Render, notice.in_set(RenderSystems::Cleanup));
    }
}

fn notice(painted: Res<Painted>, pipelines: Option<Res<EguiPipelines>>, cache: Res<PipelineCache>) {
    if painted.0.load(Ordering::Relaxed) {
        return;
    }
    let ready = pipelines.is_some_and(|p| {
        p.0.values().any(|&id| {
            matches!(
                cache.get_render_pipeline_state(id),
                CachedPipelineState::Ok(_)
            )
        })
    });
    if ready {
        painted.0.store(true, Ordering::Relaxed);
    }
}

/// The picture of one board.
#[derive(Default)]
pub(super) struct Sheet {
    camera: Option<Entity>,
    pub(super) quad: Option<Entity>,
    mesh: Handle<Mesh>,
    /// What the mesh was made for: points across and down, metres per point.
    shape: Option<(egui::Vec2, f32)>,
    jobs: Vec<egui::ClippedPrimitive>,
    delta: egui::TexturesDelta,
    /// Frames that are still to be drawn.
    frames: u8,
}

impl Sheet {
    /// Takes in what a pass made: textures always, shapes where they differ from those before.
    pub fn take(
        &mut self,
        ctx: &egui::Context,
        delta: egui::TexturesDelta,
        shapes: Option<Vec<egui::epaint::ClippedShape>>,
    ) {
        if !delta.is_empty() {
            self.frames = FRAMES;
        }
        self.delta.append(delta);
        if let Some(shapes) = shapes {
            self.jobs = ctx.tessellate(shapes, TEXELS);
            self.frames = FRAMES;
        }
    }
}

impl Drop for Sheet {
    fn drop(&mut self) {
        // Nobody draws them any more.
        self.delta.clear();
    }
}

/// Hands the board's picture to the renderer.
pub(super) fn update(world: &mut World, board: &mut Board) {
    quad(world, board);
    let ready = world.resource::<Painted>().0.load(Ordering::Relaxed);
    let sheet = &mut board.picture;
    let Some(camera) = sheet.camera else {
        sheet.delta.clear();
        return;
    };
    let paints = sheet.frames > 0;
    if paints && ready {
        sheet.frames -= 1;
    }
    let Ok(mut camera) = world.get_entity_mut(camera) else {
        return;
    };
    if let Some(mut camera) = camera.get_mut::<Camera>()
        && camera.is_active != paints
    {
        camera.is_active = paints;
    }
    if paints && let Some(mut output) = camera.get_mut::<EguiRenderOutput>() {
        // The renderer takes it away each frame.
        output.paint_jobs = sheet.jobs.clone();
        output.textures_delta.append(mem::take(&mut sheet.delta));
    }
}

/// The sheet in the room, and where there is a renderer its camera.
fn quad(world: &mut World, board: &mut Board) {
    let shape = (board.size, board.scale);
    if board.picture.shape == Some(shape) {
        return;
    }
    board.picture.shape = Some(shape);
    let whole = texture_size(board.id, board.size);
    let uv = Vec2::new(board.size.x / whole.x, board.size.y / whole.y);
    let mesh = sheet(board.metres(), RADIUS * board.scale, uv);
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    board.picture.mesh = mesh.clone();
    if let Some(quad) = board.picture.quad {
        if let Some(mut shown) = world.get_mut::<Mesh3d>(quad) {
            shown.0 = mesh;
        }
        return;
    }
    let Ok(root) = world.query_filtered::<Entity, With<Root>>().single(world) else {
        return;
    };
    let [width, height] = [whole.x, whole.y].map(|points| (points * TEXELS) as u32);
    let image = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
    let image = world.resource_mut::<Assets<Image>>().add(image);
    let ink = Ink {
        page: image.clone(),
        over: Over::Opaque,
    };
    let ink = world.resource_mut::<Assets<Ink>>().add(ink);
    let name = format!("{:?}", board.id);
    let quad = world.spawn((
        Name::new(name.clone()),
        Mesh3d(mesh),
        MeshMaterial3d(ink),
        NotShadowCaster,
        NotShadowReceiver,
        // Lines around what is selected behind it do not show through.
        OutlineStencil::default(),
        Transform::default(),
        ChildOf(root),
    ));
    board.picture.quad = Some(quad.id());
    if world.get_resource::<RenderDevice>().is_none() {
        return;
    }
    let camera = world.spawn((
        Name::new(format!("{name}'s picture")),
        Camera2d,
        Camera {
            // Before every eye.
            order: -100,
            clear_color: ClearColorConfig::Custom(Color::BLACK),
            is_active: false,
            ..default()
        },
        RenderTarget::from(image),
        RenderLayers::none(),
        Msaa::Off,
        EguiOutput {
            platform_output: egui::PlatformOutput::default(),
            pixels_per_point: TEXELS,
        },
        EguiRenderOutput::default(),
    ));
    board.picture.camera = Some(camera.id());
}

/// Points that the picture has room for: a board that grows needs no other.
fn texture_size(id: BoardId, size: egui::Vec2) -> egui::Vec2 {
    match id {
        BoardId::Files | BoardId::Ring => size,
        _ => egui::vec2(size.x, TALLEST.max(size.y)),
    }
}
