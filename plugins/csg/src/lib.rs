//! Assemble: booleans of library components on one signed distance field
//! (EasyVRModeling §3–4).
//!
//! Components are taken in hand as in every mode, marked as operands of one sequence, read left
//! to right; and fused by one press. The marks live in the document; what hands are in the middle
//! of lives here.

mod act;
mod carry;
mod cue;
mod fuse;
mod phase;
mod preview;

use bevy::prelude::*;
use midair_studio::{
    StudioSet,
    evaluate::Deliver,
    hold::Ghosted,
    tools::{AddTool, Tool, ToolChanged, ToolId, tool_active},
};

pub use fuse::{Pending, fused_recipe};
pub use phase::{Draft, Phase};
pub use preview::Preview;

/// The tool's name in files.
pub const ASSEMBLE: ToolId = ToolId::new("csg");

/// The Assemble mode.
pub struct AssemblePlugin;

impl Plugin for AssemblePlugin {
    fn build(&self, app: &mut App) {
        app.add_tool(Tool {
            id: ASSEMBLE,
            name: "Assemble",
            about: "Put components together: unite, intersect, subtract",
            order: 10,
        })
        .init_resource::<Draft>()
        .init_resource::<Preview>()
        .add_observer(abort)
        .add_observer(carry::take)
        .add_systems(
            Update,
            (
                // What is marked is what is touched by now, what is fused what was marked in the same frame as well.
                (act::ask, act::select, act::operate, act::finish)
                    .chain()
                    .in_set(StudioSet::Act),
                // What is made ahead is asked for first; then the preview finds it at rest.
                (fuse::anticipate, preview::follow, preview::ghost)
                    .chain()
                    .in_set(StudioSet::Rebuild)
                    .after(Deliver),
                cue::hints.in_set(StudioSet::Cue),
            )
                // Each asks anew: the mode may be left between the first of them and the last.
                .distributive_run_if(tool_active(ASSEMBLE)),
        );
    }
}

/// Leaving the tool gives up what the hands are doing; marks are edits and stay.
fn abort(
    _: On<ToolChanged>,
    mut draft: ResMut<Draft>,
    mut preview: ResMut<Preview>,
    mut ghosted: ResMut<Ghosted>,
    mut commands: Commands,
) {
    *draft = Draft::default();
    preview.clear(&mut commands);
    ghosted.0.clear();
}
