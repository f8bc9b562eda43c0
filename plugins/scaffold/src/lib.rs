//! Scaffold: construction lines that come out right, strokes that come out fair (ScaffoldSketch).
//!
//! A hand pulls an elastic line from where the trigger goes down to where it is let go, or draws a free stroke; both
//! are corrected when they are let go, and what was drawn is kept beside what became of it. Lines and strokes are
//! objects of the document; what a hand is in the middle of lives here.

mod aim;
mod ask;
mod carry;
mod cue;
mod draw;
mod ghost;
mod history;
mod lift;
mod make;
mod memory;
mod panel;
mod phase;
pub mod read;
mod sheet;
mod show;

use bevy::gizmos::config::GizmoConfigStore;
use bevy::prelude::*;
use midair_studio::{
    StudioSet,
    drawing::FollowDrawing,
    panel::AddPanel,
    tools::{AddTool, Tool, ToolChanged, ToolId, tool_active},
};

pub use ask::Ask;
pub use history::told;
pub use lift::lift;
pub use phase::{Draft, Last, Options, Phase, Sample};
pub use sheet::sheet;

/// The tool's name in files.
pub const SCAFFOLD: ToolId = ToolId::new("scaffold");

/// The Scaffold mode.
pub struct ScaffoldPlugin;

impl Plugin for ScaffoldPlugin {
    fn build(&self, app: &mut App) {
        app.add_tool(Tool {
            id: SCAFFOLD,
            name: "Scaffold",
            about: "Draw lines that come out right and strokes that come out fair",
            order: 20,
        })
        .init_resource::<Draft>()
        .init_resource::<history::Writing>()
        .add_panel(panel::INFO, panel::ScaffoldPanel::default())
        .add_observer(abort)
        .add_observer(carry::carried)
        .add_systems(Update, history::collect.in_set(StudioSet::Gather))
        // What is asked by name is carried out whichever mode is in the hands: a plate can be filled from Assemble.
        .add_systems(Update, ask::ask.in_set(StudioSet::Ask).after(FollowDrawing))
        .add_systems(
            Update,
            (
                (draw::turn, draw::draw).chain().in_set(StudioSet::Act),
                (
                    aim::aim,
                    cue::hints,
                    show::words,
                    show::lines.run_if(resource_exists::<GizmoConfigStore>),
                )
                    .in_set(StudioSet::Cue),
            )
                .run_if(tool_active(SCAFFOLD)),
        );
    }
}

/// Leaving the tool gives up the line in the hand; what is drawn stays, and so does what was asked for.
fn abort(_: On<ToolChanged>, mut draft: ResMut<Draft>) {
    *draft = Draft {
        own_angle: draft.own_angle,
        ..Draft::default()
    };
}
