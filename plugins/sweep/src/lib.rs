//! Sweep: one Hermite curve between two hands, dragged into surfaces, tubes and rows of clones
//! (Hermite motion controller, §3).
//!
//! Each hand holds an end of the curve; the leading hand's trigger sweeps it. With one hand, or one
//! pointer, the ends are placed and then moved one after the other. What was swept can be bent, cut,
//! extended and smoothed afterwards.

mod act;
mod ask;
mod carry;
mod clones;
mod cue;
mod edit;
mod ends;
mod follow;
mod free;
mod panel;
mod phase;
mod solo;
mod wires;
mod write;

use bevy::prelude::*;
use midair_studio::{
    StudioSet,
    hold::Ghosted,
    links::AddFollow,
    panel::{AddPanel, Dock, PanelInfo, icon},
    tools::{AddTool, Tool, ToolChanged, ToolId, tool_active},
};

pub use ask::SweepAsk;
pub use phase::{Draft, Offer, Phase};
pub use solo::Solo;
pub use wires::Wires;

/// The tool's name in files.
pub const SWEEP: ToolId = ToolId::new("sweep");

/// ε of §3.2.1, metres: a curve is appended when a point of it has moved further than this.
pub const EPSILON: f32 = 0.01;

/// The Sweep mode.
pub struct SweepPlugin;

impl Plugin for SweepPlugin {
    fn build(&self, app: &mut App) {
        app.add_tool(Tool {
            id: SWEEP,
            name: "Sweep",
            about: "Bend a curve between your hands and drag it: surfaces, tubes, rows of clones",
            order: 30,
        })
        .add_panel(
            PanelInfo {
                id: "sweep",
                title: "Sweep",
                icon: icon::WAVES,
                dock: Dock::Right,
                order: 13,
                open: false,
                in_bar: true,
            },
            panel::SweepPanel::default(),
        )
        .init_resource::<Draft>()
        .init_resource::<Wires>()
        .init_resource::<clones::Row>()
        .init_resource::<write::Looks>()
        .init_resource::<carry::Ghost>()
        .add_follow(follow::follow)
        .add_observer(abort)
        .add_observer(carry::answer)
        .add_observer(carry::take)
        .add_systems(
            Update,
            (
                ask::ask.in_set(StudioSet::Ask),
                (act::cross, act::ends, act::sweep, edit::bend)
                    .chain()
                    .in_set(StudioSet::Act),
                act::commit.in_set(StudioSet::Commit),
                (wires::draw, clones::draw).in_set(StudioSet::Rebuild),
                (cue::curve, cue::ghosts, cue::hints).in_set(StudioSet::Cue),
            )
                // Each asks anew: the mode may be left between the first of them and the last.
                .distributive_run_if(tool_active(SWEEP)),
        )
        // Looked for off the frame, and told whatever mode one is in by then.
        .add_systems(Update, write::tell.in_set(StudioSet::Commit))
        // A thickness is offered in the mode that a surface was carried into.
        .add_systems(
            Update,
            (
                carry::claim.in_set(StudioSet::Pick),
                carry::accept.in_set(StudioSet::Act).before(act::ends),
                carry::ghost.in_set(StudioSet::Rebuild),
                // After the mode has said what its buttons do.
                carry::say.after(StudioSet::Cue),
            ),
        );
    }
}

/// Leaving the tool gives up the sweep in progress.
fn abort(
    changed: On<ToolChanged>,
    mut draft: ResMut<Draft>,
    mut wires: ResMut<Wires>,
    mut row: ResMut<clones::Row>,
    mut ghosted: ResMut<Ghosted>,
    mut commands: Commands,
) {
    if changed.active != SWEEP {
        draft.leave();
        wires.clear(&mut commands);
        row.clear(&mut commands);
        ghosted.set_if_neq(Ghosted::default());
    }
}
