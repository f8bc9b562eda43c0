//! Help: the names of keys, a tutorial that checks what one does, the list of keys.
//!
//! The tutorial is a list of steps in `assets/tutorial`, each with what to do and when it is done. It never
//! stands in the way: a step is done however one does it.

mod about;
mod card;
mod course;
mod goal;
mod keys;
mod tutorial;

use bevy::prelude::*;

pub use keys::{KeyLine, Keys, Way};
pub use tutorial::Tutorial;

use crate::StudioSet;
use crate::panel::{AddPanel, Dock, PanelInfo, icon};

pub(crate) fn plugin(app: &mut App) {
    tutorial::plugin(app);
    app.init_resource::<Keys>()
        .add_panel(
            PanelInfo {
                id: tutorial::TUTORIAL_PANEL,
                title: "Tutorial",
                icon: icon::GRADUATION_CAP,
                dock: Dock::Corner,
                order: 910,
                open: false,
                in_bar: true,
            },
            card::Card,
        )
        .add_panel(
            PanelInfo {
                id: "help",
                title: "Keys and help",
                icon: icon::QUESTION,
                dock: Dock::Window,
                order: 920,
                open: false,
                in_bar: true,
            },
            about::Help::default(),
        );
}

/// Offers the tutorial at the first start and points at what it speaks of; added where a person works.
pub struct GuidePlugin;

impl Plugin for GuidePlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Startup, tutorial::offer)
            .add_systems(Update, tutorial::point.in_set(StudioSet::Cue));
    }
}
