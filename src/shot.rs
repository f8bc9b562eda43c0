//! Pictures of the work.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use bevy::camera::{ClearColorConfig, RenderTarget, Viewport};
use bevy::prelude::*;
use bevy::render::render_resource::{PipelineCache, TextureFormat};
use bevy::render::renderer::RenderDevice;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::render::{Render, RenderApp, RenderSystems};
use midair_csg::Preview;
use midair_space::Stance;
use midair_space::room::Root;
use midair_studio::command::Command;
use midair_studio::evaluate::{Delivery, Evaluations};
use midair_studio::objects::extent;
use midair_studio::project::{Project, Thumbnails};
use midair_studio::show::{Eye, Unhurried, camera, headset};

/// How long a picture may take: a software renderer compiles its shaders first.
const PATIENCE: Duration = Duration::from_secs(120);

/// A picture that has come back.
#[derive(Resource, Default)]
struct Taken(Option<Image>);

/// How many pipelines are still made: what needs one of them is not seen until then.
#[derive(Resource, Clone)]
struct Making(Arc<AtomicUsize>);

impl Making {
    fn any(&self) -> bool {
        self.0.load(Ordering::Relaxed) > 0
    }
}

/// Watches over what is still made. To be added before the app is finished: what renders then leaves it for a thread of its own.
pub(crate) struct MakingPlugin;

impl Plugin for MakingPlugin {
    fn build(&self, app: &mut App) {
        // Not looked at yet is not done.
        let making = Making(Arc::new(AtomicUsize::new(1)));
        if let Some(render) = app.get_sub_app_mut(RenderApp) {
            let count = making.0.clone();
            let note = move |cache: Res<PipelineCache>| {
                count.store(cache.waiting_pipelines().count(), Ordering::Relaxed);
            };
            render.add_systems(Render, note.in_set(RenderSystems::Cleanup));
        }
        app.insert_resource(making);
    }
}

/// Who looks at what is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SeenBy {
    /// A camera that frames the work, in a picture of so many pixels across and down.
    Camera(u32, u32),
    /// Two eyes of somebody who wears a headset, side by side.
    Headset,
}

/// Frames with nothing left to make before a picture is taken: what a frame asks for is known in the next, and shadows settle.
const SETTLED: u32 = 6;
/// Frames in which panels open.
const PANELS: u32 = 40;
/// Of the eyes, in metres.
const APART: f32 = 0.064;
/// Of the view of one eye, in pixels and radians of its height.
const ONE_EYE: UVec2 = UVec2::new(1280, 1280);
const HEADSET_VIEW: f32 = 1.45;

/// Draws what the session made, without a window, and saves it.
pub(crate) fn picture(app: &mut App, file: &Path, seen_by: SeenBy) -> Result<()> {
    if app.world().get_resource::<RenderDevice>().is_none() {
        bail!(
            "{} was not drawn: no graphics driver was found. Install Mesa's software one \
             (mesa-vulkan-drivers), or play without --shot",
            file.display()
        );
    }
    let size = match seen_by {
        SeenBy::Camera(width, height) => UVec2::new(width, height),
        SeenBy::Headset => ONE_EYE * UVec2::new(2, 1),
    };
    let target = {
        let mut images = app.world_mut().resource_mut::<Assets<Image>>();
        images.add(Image::new_target_texture(
            size.x,
            size.y,
            TextureFormat::Rgba8UnormSrgb,
            None,
        ))
    };
    match seen_by {
        SeenBy::Camera(..) => {
            let view = frame_all(app.world(), size.as_vec2());
            app.world_mut().spawn((
                camera(Eye::Picture),
                RenderTarget::from(target.clone()),
                view,
            ));
        }
        SeenBy::Headset => {
            // Panels open and are drawn before anybody looks.
            for _ in 0..PANELS {
                app.update();
            }
            eyes(app.world_mut(), &target);
        }
    }
    // What is marked is drawn as a person would see it. Shadows and pipelines settle in the first frames.
    app.insert_resource(Delivery::AsTheyCome);
    let began = Instant::now();
    let mut settled = 0;
    while settled < SETTLED && began.elapsed() < PATIENCE {
        app.update();
        let world = app.world();
        let busy = world.resource::<Making>().any() || world.resource::<Preview>().is_busy();
        settled = if busy { 0 } else { settled + 1 };
    }
    app.init_resource::<Taken>();
    app.world_mut().spawn(Screenshot::image(target)).observe(
        |shot: On<ScreenshotCaptured>, mut taken: ResMut<Taken>| {
            taken.0 = Some(shot.image.clone());
        },
    );
    let started = Instant::now();
    loop {
        app.update();
        if let Some(image) = app.world_mut().resource_mut::<Taken>().0.take() {
            return store(image, file);
        }
        if started.elapsed() > PATIENCE {
            bail!(
                "{} was not drawn within {} s. Play without --shot",
                file.display(),
                PATIENCE.as_secs()
            );
        }
    }
}

/// Two eyes where the head is.
fn eyes(world: &mut World, target: &Handle<Image>) {
    let stance = *world.resource::<Stance>();
    let root = world
        .query_filtered::<Entity, With<Root>>()
        .single(world)
        .ok();
    for (i, side) in [-0.5, 0.5].into_iter().enumerate() {
        let at = stance.head.position + stance.head.rotation * (side * APART * Vec3::X);
        let mut eye = world.spawn((
            Camera3d::default(),
            headset(),
            Camera {
                order: i as isize,
                viewport: Some(Viewport {
                    physical_position: UVec2::new(i as u32 * ONE_EYE.x, 0),
                    physical_size: ONE_EYE,
                    ..default()
                }),
                clear_color: if i == 0 {
                    ClearColorConfig::Default
                } else {
                    ClearColorConfig::None
                },
                ..default()
            },
            Projection::Perspective(PerspectiveProjection {
                fov: HEADSET_VIEW,
                near: 0.05,
                ..default()
            }),
            RenderTarget::from(target.clone()),
            Transform {
                translation: at,
                rotation: stance.head.rotation,
                scale: Vec3::ONE,
            },
        ));
        // As a headset's: it goes through the world with the room.
        if let Some(root) = root {
            eye.insert(ChildOf(root));
        }
    }
}

fn store(image: Image, file: &Path) -> Result<()> {
    let picture = image.try_into_dynamic()?.to_rgb8();
    picture
        .save(file)
        .map_err(|e| anyhow::anyhow!("{} was not written: {e}", file.display()))
}

/// Looks at everything from the front, from above and a little from the right, so near that it fills the picture.
fn frame_all(world: &World, size: Vec2) -> Transform {
    let document = world.resource::<Project>().document();
    let mut corners: Vec<Vec3> = Vec::new();
    for (id, object) in document.objects() {
        // A box around what is drawn, which stands anywhere in its own frame.
        let bounds = object.shown().map(|r| r.bounds());
        if let Some(b) = bounds.filter(|b| !b.is_empty()) {
            let there = object.placement.affine();
            corners.extend(box_corners(b.min, b.max).map(|p| there.transform_point3(p)));
        } else if let Some((low, high)) = extent(document, [id]) {
            corners.extend(box_corners(low, high));
        }
    }
    if corners.is_empty() {
        corners.extend(box_corners(
            Vec3::new(-0.3, -0.1, -0.3),
            Vec3::new(0.3, 0.5, 0.3),
        ));
    }
    let low = corners.iter().fold(Vec3::INFINITY, |m, p| m.min(*p));
    let high = corners.iter().fold(Vec3::NEG_INFINITY, |m, p| m.max(*p));
    let from = Vec3::new(0.55, 0.62, 1.0).normalize();
    let turn = Transform::IDENTITY.looking_to(-from, Vec3::Y).rotation;
    // The view's own middle and half of what it sees of a metre away, upwards and to the side.
    let tall = (0.5 * PerspectiveProjection::default().fov).tan() * FILLED;
    let wide = tall * size.x / size.y.max(1.0);
    let mut centre = low.midpoint(high);
    let mut away = 0.0f32;
    // What is near looks larger: the middle of what is seen is not that of the box.
    for _ in 0..4 {
        let seen = corners.iter().map(|p| turn.inverse() * (*p - centre));
        away = seen
            .clone()
            .map(|p| p.z + (p.x.abs() / wide).max(p.y.abs() / tall))
            .fold(0.02, f32::max);
        let ends = seen.fold([Vec2::INFINITY, Vec2::NEG_INFINITY], |[a, b], p| {
            let on = p.truncate() / (away - p.z).max(1e-4);
            [a.min(on), b.max(on)]
        });
        centre += turn * (ends[0].midpoint(ends[1]) * away).extend(0.0);
    }
    Transform::from_translation(centre + from * away).looking_at(centre, Vec3::Y)
}

/// How much of a picture is filled, at most.
const FILLED: f32 = 0.86;

fn box_corners(low: Vec3, high: Vec3) -> [Vec3; 8] {
    std::array::from_fn(|k| {
        let side = |bit: usize, a: f32, b: f32| if k >> bit & 1 == 0 { a } else { b };
        Vec3::new(
            side(0, low.x, high.x),
            side(1, low.y, high.y),
            side(2, low.z, high.z),
        )
    })
}

/// Frames between two things that are asked for: panels take their places.
const BEAT: u32 = 4;
/// Frames at rest before the room is drawn.
const LOOKED: u32 = 12;

/// In a window: asks for `asks`, saves a picture once everything is made and drawn, and ends the app.
pub(crate) fn window(app: &mut App, file: PathBuf, size: Option<(u32, u32)>, asks: Vec<Command>) {
    if let Some((width, height)) = size {
        for mut window in app
            .world_mut()
            .query::<&mut Window>()
            .iter_mut(app.world_mut())
        {
            window.resolution.set_physical_resolution(width, height);
        }
    }
    let mut asks = asks.into_iter();
    app.add_plugins(MakingPlugin);
    let began = Instant::now();
    let mut frame = 0;
    let mut settled = 0;
    app.insert_resource(Unhurried);
    app.init_resource::<Taken>().add_systems(
        // Before the end of the frame, where a clean end is seen.
        PostUpdate,
        move |evaluations: Res<Evaluations>,
              thumbnails: Res<Thumbnails>,
              preview: Res<Preview>,
              making: Res<Making>,
              mut taken: ResMut<Taken>,
              mut cameras: Query<&mut Camera, With<Eye>>,
              mut ask: MessageWriter<Command>,
              mut commands: Commands,
              mut exit: MessageWriter<AppExit>| {
            if let Some(image) = taken.0.take() {
                let done = store(image, &file);
                if let Err(error) = &done {
                    eprintln!("midair: {error:#}");
                }
                exit.write(if done.is_ok() {
                    AppExit::Success
                } else {
                    AppExit::error()
                });
            }
            frame += 1;
            let next = if frame % BEAT == 0 { asks.next() } else { None };
            settled = if let Some(next) = next {
                ask.write(next);
                0
            } else if asks.len() == 0
                && evaluations.outstanding() == 0
                && !thumbnails.is_busy()
                && !preview.is_busy()
            {
                // What the room needs is made once the room is drawn.
                let waits = settled == LOOKED + 4 && making.any() && began.elapsed() < PATIENCE;
                settled + u32::from(!waits)
            } else {
                0
            };
            // The room is drawn for the last frames alone: nobody sees the others.
            let drawn = settled >= LOOKED;
            for mut camera in &mut cameras {
                if camera.is_active != drawn {
                    camera.is_active = drawn;
                }
            }
            if settled == LOOKED + 8 {
                commands.spawn(Screenshot::primary_window()).observe(
                    |shot: On<ScreenshotCaptured>, mut taken: ResMut<Taken>| {
                        taken.0 = Some(shot.image.clone());
                    },
                );
            }
        },
    );
}
