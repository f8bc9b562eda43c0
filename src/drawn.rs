//! What drawing costs beside the main schedule: how long extraction takes, and the render world's own
//! processor time.
//!
//! Every frame is drawn into a small image, with a small map of shadows, so that a software renderer has little to do; what the render world
//! itself does for a frame (extraction, batching, uploads, encoding) does not depend on the number of
//! pixels. Its schedules run on one thread here, so that the processor time of that thread is all of it: the
//! driver's own threads are not in it.

use std::sync::{Arc, Mutex};
use std::time::Instant;

use bevy::camera::RenderTarget;
use bevy::ecs::schedule::{ScheduleLabel, Schedules, SingleThreadedExecutor};
use bevy::light::DirectionalLightShadowMap;
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy::render::{ExtractSchedule, Render, RenderApp, RenderScheduleOrder};
use midair_playback::{DrawnReport, FrameTimes};
use midair_studio::show::{Eye, camera};

/// Pixels of what is drawn.
const SIZE: [u32; 2] = [64, 36];
/// The first frames compile shaders and are not counted.
const WARM: usize = 90;

/// What was measured, frame by frame, in milliseconds.
#[derive(Default)]
struct Kept {
    extract: Vec<f32>,
    render: Vec<f32>,
    cpu: Vec<f32>,
}

/// What drawing has cost so far.
#[derive(Resource, Clone, Default)]
pub(crate) struct Costs(Arc<Mutex<Kept>>);

impl Costs {
    fn note(&self, note: impl FnOnce(&mut Kept)) {
        if let Ok(mut kept) = self.0.lock() {
            note(&mut kept);
        }
    }

    /// The figures, without the first frames.
    pub fn report(&self) -> DrawnReport {
        let mut report = DrawnReport::default();
        self.note(|kept| {
            let of = |ms: &[f32]| FrameTimes::of(ms.get(WARM..).unwrap_or_default().to_vec());
            report.extract_ms = of(&kept.extract);
            report.render_ms = of(&kept.render);
            report.render_cpu_ms = of(&kept.cpu);
        });
        report
    }
}

#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
struct Begins;

#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
struct Ends;

/// When the render world began with the frame, and its thread's processor time then.
#[derive(Resource)]
struct Began(Instant, Option<f64>);

/// Pixels across the map of shadows.
const SHADOWS: usize = 128;

/// Draws every frame from here on and measures it; to be called before the app is made ready.
pub(crate) fn draw_every_frame(app: &mut App) -> Costs {
    let costs = Costs::default();
    let [width, height] = SIZE;
    let target = {
        let mut images = app.world_mut().resource_mut::<Assets<Image>>();
        let image = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
        images.add(image)
    };
    app.insert_resource(DirectionalLightShadowMap { size: SHADOWS });
    let from = Transform::from_xyz(1.1, 1.2, 1.9).looking_at(Vec3::new(0.0, 0.3, 0.0), Vec3::Y);
    app.world_mut()
        .spawn((camera(Eye::Working), RenderTarget::from(target), from));
    let Some(render) = app.get_sub_app_mut(RenderApp) else {
        return costs;
    };
    if let Some(mut extract) = render.take_extract() {
        let costs = costs.clone();
        render.set_extract(move |main, render| {
            let since = Instant::now();
            extract(main, render);
            let took = since.elapsed().as_secs_f32() * 1e3;
            costs.note(|kept| kept.extract.push(took));
        });
    }
    render.insert_resource(costs.clone());
    render.add_schedule(Schedule::new(Begins));
    render.add_schedule(Schedule::new(Ends));
    render.add_systems(Begins, |mut commands: Commands| {
        commands.insert_resource(Began(Instant::now(), thread_seconds()));
    });
    render.add_systems(Ends, |began: Res<Began>, costs: Res<Costs>| {
        let took = began.0.elapsed().as_secs_f32() * 1e3;
        let cpu = thread_seconds().zip(began.1).map(|(now, then)| now - then);
        costs.note(|kept| {
            kept.render.push(took);
            kept.cpu.extend(cpu.map(|s| 1e3 * s as f32));
        });
    });
    if let Some(mut order) = render.world_mut().get_resource_mut::<RenderScheduleOrder>() {
        order.insert_before(First, Begins);
        order.insert_after(Render, Ends);
    }
    let mut schedules = render.world_mut().resource_mut::<Schedules>();
    let extract = ExtractSchedule.intern();
    for (_, schedule) in schedules.iter_mut() {
        // Extraction runs on the main thread, and leaves its commands for later.
        if schedule.label() != extract {
            schedule.set_executor(SingleThreadedExecutor::new());
        }
    }
    costs
}

/// Processor time of this thread so far; none where the system does not say.
fn thread_seconds() -> Option<f64> {
    // Linux: nanoseconds on a processor come first.
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = stat.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}
