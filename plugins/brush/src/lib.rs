//! Brush: painting with skeletons that melt into one convolution surface (3DBrushVR §3–4).
//!
//! Points, lines, polygons and volumes are painted with one hand; alt and the eraser take away. Each
//! stroke is one step, kept as what it was made from: it can be selected, moved, resized, weighed and
//! deleted later, and only what it reaches is evaluated again.

mod act;
mod ask;
mod carry;
mod cue;
mod easel;
mod follow;
mod ghost;
mod live;
mod panel;
mod phase;
mod start;
mod stroke;
mod work;

use bevy::prelude::*;
use midair_studio::{
    StudioSet,
    evaluate::Deliver,
    links::AddFollow,
    panel::{AddPanel, Dock, PanelInfo, icon},
    tools::{AddTool, Tool, ToolChanged, ToolId, tool_active},
};

pub use ask::Ask;
pub use easel::{Easel, canvas};
pub use ghost::Ghost;
pub use live::Sketchpad;
pub use midair_studio::settings::BrushSettings as Options;
pub use phase::{Draft, Phase};
pub(crate) use start::paint_on;
pub use stroke::{StrokeFault, called};

/// The tool's name in files.
pub const BRUSH: ToolId = ToolId::new("brush");

/// The Brush mode.
pub struct BrushPlugin;

impl Plugin for BrushPlugin {
    fn build(&self, app: &mut App) {
        app.add_tool(Tool {
            id: BRUSH,
            name: "Brush",
            about: "Paint with points, lines, areas and solids that melt together",
            order: 40,
        })
        .add_panel(
            PanelInfo {
                id: "brush",
                title: "Brush",
                icon: icon::PAINT_BRUSH,
                dock: Dock::Right,
                order: 5,
                open: false,
                in_bar: true,
            },
            panel::BrushPanel::default(),
        )
        .init_resource::<Draft>()
        .init_resource::<Easel>()
        .init_resource::<Sketchpad>()
        .init_resource::<Ghost>()
        .init_resource::<act::Holding>()
        .add_follow(follow::follow)
        .add_observer(changed)
        .add_observer(carry::take)
        .add_systems(
            Update,
            (
                start::ask.in_set(StudioSet::Ask),
                easel::follow.in_set(StudioSet::Pick),
                // A size that is set in this frame is that of the stroke begun in it.
                (act::cross, act::finish, act::paint)
                    .chain()
                    .in_set(StudioSet::Act),
                // What the document has is shown first; then what is being painted takes its place.
                (live::follow, ghost::show)
                    .chain()
                    .in_set(StudioSet::Cue)
                    .after(Deliver),
                (cue::aim, cue::hints, ghost::lines).in_set(StudioSet::Cue),
            )
                // Each asks anew: the mode may be left between the first of them and the last.
                .distributive_run_if(tool_active(BRUSH)),
        );
    }
}

/// Leaving the tool gives up what was begun; taking it opens its panel.
fn changed(
    change: On<ToolChanged>,
    mut draft: ResMut<Draft>,
    mut easel: ResMut<Easel>,
    mut pad: ResMut<Sketchpad>,
    mut ghost: ResMut<Ghost>,
    mut panels: ResMut<midair_studio::panel::Panels>,
    mut commands: Commands,
) {
    *draft = Draft::default();
    easel.mix = None;
    easel.picking = false;
    easel.selected = None;
    pad.clear(&mut commands);
    ghost.clear(&mut commands);
    if change.active == BRUSH {
        panels.set_open("brush", true);
    }
}
