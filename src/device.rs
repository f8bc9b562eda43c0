//! The graphics card goes away while one works: drawing begins anew, and the work is kept.

use bevy::app::AppExit;
use bevy::prelude::*;
use bevy::render::error_handler::{ErrorType, RenderError, RenderErrorHandler, RenderErrorPolicy};
use bevy::render::renderer::RenderDevice;
use bevy::render::settings::RenderCreation;
use bevy::render::{Render, RenderApp, RenderSystems};
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
    let Some(render) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    let mut frame = 0;
    let lose = move |device: Option<Res<RenderDevice>>| {
        frame += 1;
        if frame == frames
            && let Some(device) = &device
        {
            device.wgpu_device().destroy();
        }
    };
    render.add_systems(Render, lose.in_set(RenderSystems::PostCleanup));
}

/// A card that goes away in the middle of a frame makes the graphics library panic: whether a panic says so.
pub(crate) fn is_loss(said: &str) -> bool {
    let of_the_library = said.contains("Validation Error") || said.contains("wgpu error");
    let lost = [
        "is invalid",
        "has been destroyed",
        "device is lost",
        "Parent device",
    ];
    of_the_library && lost.iter().any(|sign| said.contains(sign))
}

#[cfg(test)]
mod tests {
    use super::is_loss;

    #[test]
    fn the_words_of_the_graphics_library_are_known() {
        let said = "Error in Buffer::get_mapped_range: Validation Error\n\nCaused by:\n  \
                    Buffer with 'LineGizmo Strip Position Buffer' label is invalid\n";
        assert!(is_loss(said));
        assert!(!is_loss(
            "index out of bounds: the len is 3 but the index is 7"
        ));
    }
}
