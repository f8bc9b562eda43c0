//! The graphics card goes away while one works: drawing begins anew, and the work is kept.

use bevy::app::AppExit;
use bevy::prelude::*;
use bevy::render::error_handler::{ErrorType, RenderError, RenderErrorHandler, RenderErrorPolicy};
use bevy::render::renderer::RenderDevice;
use bevy::render::settings::RenderCreation;
use midair_studio::notice::Notices;

/// So often is drawing begun anew within [`WHILE`] seconds before it is given up.
const TRIES: usize = 3;
const WHILE: f64 = 60.0;

/// When the card went away, in seconds since the start.
#[derive(Resource, Default)]
struct Losses(Vec<f64>);

/// Goes on after the card was lost; closes the window with one line where that does not help.
pub(crate) fn watch(app: &mut App) {
    app.init_resource::<Losses>()
        .insert_resource(RenderErrorHandler(answer));
}

fn answer(error: &RenderError, main: &mut World, _: &mut World) -> RenderErrorPolicy {
    let now = main.resource::<Time<Real>>().elapsed_secs_f64();
    let mut losses = main.get_resource_or_init::<Losses>();
    losses.0.retain(|at| now - at < WHILE);
    if matches!(error.ty, ErrorType::DeviceLost) && losses.0.len() < TRIES {
        losses.0.push(now);
        main.resource_mut::<Notices>().warn(
            "The graphics card was lost, so drawing begins anew. Your work is kept. \
             If it happens again, save, and look for a newer driver.",
        );
        return RenderErrorPolicy::Recover(RenderCreation::default());
    }
    eprintln!(
        "midair: the graphics card stopped drawing ({:?}), so the window closes. Your work is kept: \
         start Midair again and press Restore it",
        error.ty
    );
    main.write_message(AppExit::error());
    RenderErrorPolicy::StopRendering
}

/// Takes the card away after so many frames, as a test.
pub(crate) fn lose_after(app: &mut App, frames: u32) {
    let mut frame = 0;
    app.add_systems(Update, move |device: Option<Res<RenderDevice>>| {
        frame += 1;
        if frame == frames
            && let Some(device) = &device
        {
            device.wgpu_device().destroy();
        }
    });
}
