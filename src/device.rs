//! The graphics card goes away while one works: the app starts itself again, with the work as it stands.
//!
//! The engine can take up another card in place, but the ground grid and the panels keep buffers of the one that is gone
//! and nothing outside of them can take these away; so drawing begins anew with the whole app. Everything that was done is
//! in the journal before the next frame, so the window comes back with it, its undo list included.

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use bevy::app::AppExit;
use bevy::prelude::*;
use bevy::render::error_handler::{ErrorType, RenderError, RenderErrorHandler, RenderErrorPolicy};
use bevy::render::renderer::RenderDevice;
use bevy::render::{Render, RenderApp, RenderSystems};
use midair_studio::notice::Notices;
use midair_studio::project::Project;

use crate::start_again;

/// A card that goes away once more within this time is not worth a third start.
const SOON: Duration = Duration::from_secs(60);

/// What a start after a loss needs to know. Not a resource: a panic in the middle of a frame can ask no world.
struct Kept {
    /// Arguments that stay as they are.
    arguments: Vec<OsString>,
    /// Where the work is: to be taken up from the journal, or in a file.
    work: Work,
    /// When the card was lost before, in seconds since 1970.
    before: Option<u64>,
}

enum Work {
    Journal,
    File(PathBuf),
    None,
}

static KEPT: Mutex<Option<Kept>> = Mutex::new(None);

/// From here on a lost card starts the app again, with `arguments` beside the work. `before` is when that
/// happened the last time, in seconds since 1970.
pub(crate) fn watch(app: &mut App, arguments: Vec<OsString>, before: Option<u64>) {
    *KEPT.lock().unwrap_or_else(PoisonError::into_inner) = Some(Kept {
        arguments,
        work: Work::None,
        before,
    });
    if before.is_some() {
        app.world_mut().resource_mut::<Notices>().warn(
            "The graphics card was lost, so the window was opened anew. Your work is as it was. \
             If it happens again, look for a newer driver.",
        );
    }
    app.insert_resource(RenderErrorHandler(answer))
        .add_systems(Last, keep.run_if(resource_changed::<Project>));
}

fn keep(project: Res<Project>) {
    let work = match project.path() {
        _ if project.history().is_unsaved() => Work::Journal,
        Some(path) => Work::File(path.to_owned()),
        None => Work::None,
    };
    if let Some(kept) = KEPT.lock().unwrap_or_else(PoisonError::into_inner).as_mut() {
        kept.work = work;
    }
}

fn answer(error: &RenderError, main: &mut World, _: &mut World) -> RenderErrorPolicy {
    if matches!(error.ty, ErrorType::DeviceLost) {
        lost();
    }
    eprintln!(
        "midair: the graphics card stopped drawing ({:?}), so the window closes. Your work is kept: \
         start Midair again and press Restore it",
        error.ty
    );
    main.write_message(AppExit::error());
    RenderErrorPolicy::StopRendering
}

/// The card is lost: starts the app again, or says in one line why not. Does not come back.
pub(crate) fn lost() -> ! {
    let kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner).take();
    let Some(kept) = kept else {
        // Another thread has noticed first: it ends the program.
        loop {
            std::thread::sleep(SOON);
        }
    };
    let now = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .unwrap_or_default();
    let since = kept
        .before
        .map(|b| now.saturating_sub(Duration::from_secs(b)));
    if since.is_none_or(|since| since > SOON) {
        eprintln!(
            "midair: the graphics card was lost, so the window opens anew with your work as it is"
        );
        let mut arguments = kept.arguments;
        match kept.work {
            Work::Journal => arguments.push("--resume".into()),
            Work::File(path) => arguments.push(path.into()),
            Work::None => {}
        }
        arguments.push(format!("--card-lost={}", now.as_secs()).into());
        if start_again(&arguments).is_ok() {
            std::process::exit(0);
        }
    }
    eprintln!(
        "midair: the graphics card was lost again, so the window closes. Your work is kept: start Midair again \
         and press Restore it"
    );
    std::process::exit(1);
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
