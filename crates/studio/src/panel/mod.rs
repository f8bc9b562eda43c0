//! Panels: functions of what they show to the commands they ask for.
//!
//! A screen hosts them in its own windows, a headset on quads in the room; sessions record the
//! commands. None of them changes the document.

mod bar;
mod export;
mod files;
mod hints;
mod keyboard;
pub mod kit;
mod leave;
mod library;
mod materials;
mod notices;
mod objects;
mod operands;
mod outline;
mod palettes;
mod properties;
mod registry;
mod ring;
mod settings;
mod snaps;
mod style;
mod symmetry;

pub use bar::{Bar, bar};
pub use export::triangles;
pub use files::{Files, PICTURES, has_ending};
pub use hints::{KeyNames, hints};
pub use keyboard::{Key, Keyboard, keyboard};
pub use materials::{MaterialRows, choose};
pub use notices::{STAYS, notices};
pub use objects::operands;
pub use registry::{AddPanel, Dock, Panel, PanelInfo, Panels};
pub use ring::{ring, sector};
pub use style::{ACCENT, Palette, RADIUS, UNIT, apply_style, has_fonts, install_fonts, visuals};

/// Where panels, file dialogs and the ring of modes are hosted: in one place at a time.
#[derive(bevy::prelude::Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Host {
    /// In the window.
    #[default]
    Screen,
    /// In the room, for somebody who wears a headset; the window keeps its bar.
    Room,
}

pub use bevy_egui::egui;
/// The one set of icons that every panel uses.
pub use egui_phosphor::regular as icon;

fn turn(
    changed: bevy::prelude::On<crate::tools::ToolChanged>,
    tools: bevy::prelude::Res<crate::tools::Tools>,
    mut panels: bevy::prelude::ResMut<Panels>,
) {
    let is_mode = |id: &str| tools.all().iter().any(|t| t.id.as_str() == id);
    panels.turn_to(changed.active.as_str(), is_mode);
}

pub(crate) fn plugin(app: &mut bevy::prelude::App) {
    app.init_resource::<Panels>()
        .init_resource::<Host>()
        .add_observer(turn)
        .add_panel(
            PanelInfo {
                id: "library",
                title: "Library",
                icon: icon::BOOKS,
                dock: Dock::Left,
                order: 0,
                open: false,
                in_bar: true,
            },
            library::LibraryPanel::default(),
        )
        .add_panel(
            PanelInfo {
                id: "outline",
                title: "Outline",
                icon: icon::TREE_STRUCTURE,
                dock: Dock::Right,
                order: 10,
                open: false,
                in_bar: true,
            },
            outline::Outline::default(),
        )
        .add_panel(
            PanelInfo {
                id: "properties",
                title: "Properties",
                icon: icon::SLIDERS_HORIZONTAL,
                dock: Dock::Right,
                order: 11,
                open: false,
                in_bar: true,
            },
            properties::Properties::default(),
        )
        .add_panel(
            PanelInfo {
                id: "operands",
                title: "Operands",
                icon: icon::UNITE_SQUARE,
                dock: Dock::Right,
                order: 12,
                open: false,
                in_bar: true,
            },
            operands::Operands::default(),
        )
        .add_panel(
            PanelInfo {
                id: "export",
                title: "Export",
                icon: icon::EXPORT,
                dock: Dock::Window,
                order: 20,
                open: false,
                in_bar: false,
            },
            export::Export::default(),
        )
        .add_panel(
            PanelInfo {
                id: "snaps",
                title: "Snaps",
                icon: icon::MAGNET,
                dock: Dock::Window,
                order: 30,
                open: false,
                in_bar: true,
            },
            snaps::Snaps::default(),
        )
        .add_panel(
            PanelInfo {
                id: "symmetry",
                title: "Symmetry",
                icon: icon::FLIP_HORIZONTAL,
                dock: Dock::Window,
                order: 31,
                open: false,
                in_bar: true,
            },
            symmetry::Symmetry::default(),
        )
        .add_panel(
            PanelInfo {
                id: crate::project::LEAVE_PANEL,
                title: "Save your work?",
                icon: icon::FLOPPY_DISK,
                dock: Dock::Modal,
                order: 0,
                open: false,
                in_bar: false,
            },
            leave::Leave,
        )
        .add_panel(
            PanelInfo {
                id: "settings",
                title: "Settings",
                icon: icon::GEAR,
                dock: Dock::Window,
                order: 900,
                open: false,
                in_bar: true,
            },
            settings::SettingsPanel::default(),
        );
}
