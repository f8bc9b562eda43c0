//! Assemble: booleans of library components on one signed distance field
//! (EasyVRModeling §3–4).
//!
//! Components are grabbed, moved, turned and scaled; marked as operands of one sequence, read left
//! to right; and fused by one press. The marks live in the document; what hands are in the middle
//! of lives here.

mod act;
mod cue;
mod fuse;
mod hold;
mod phase;
mod preview;

use bevy::prelude::*;
use midair_studio::{
    StudioSet,
    evaluate::Deliver,
    tools::{AddTool, Tool, ToolChanged, ToolId, tool_active},
};

pub use fuse::{Pending, fused_recipe};
pub use hold::{Axis, Hold, RATIO, Stretch};
pub use phase::{Draft, Options, Phase};
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
        .init_resource::<Options>()
        .init_resource::<Preview>()
        .add_observer(abort)
        .add_systems(
            Update,
            (
                act::ask.in_set(StudioSet::Ask),
                // Marks and deletes look at what is touched; grabs come last, so that a thing deleted
                // in this frame is not taken in hand.
                (
                    act::select,
                    act::operate,
                    act::delete,
                    act::finish,
                    act::save,
                    act::grab,
                )
                    .chain()
                    .in_set(StudioSet::Act),
                act::release.in_set(StudioSet::Commit),
                // What is made ahead is asked for first; then the preview finds it at rest.
                (fuse::anticipate, preview::follow)
                    .chain()
                    .in_set(StudioSet::Rebuild)
                    .after(Deliver),
                (cue::colours, cue::hints).in_set(StudioSet::Cue),
            )
                .run_if(tool_active(ASSEMBLE)),
        );
    }
}

/// Leaving the tool gives up what the hands are doing; marks are edits and stay.
fn abort(
    _: On<ToolChanged>,
    mut draft: ResMut<Draft>,
    mut drafts: ResMut<midair_studio::show::Drafts>,
    mut preview: ResMut<Preview>,
    mut commands: Commands,
) {
    *draft = Draft::default();
    drafts.clear();
    preview.clear(&mut commands);
}
