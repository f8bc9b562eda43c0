//! What a person sets once and finds again: look, snaps, hands, units, comfort.
//!
//! [`Settings`] is a plain value; each part belongs to the room it is about. Only
//! [`Command::Set`](crate::command::Command::Set) changes it, so that a session which changes a setting plays back. A
//! session begins with the defaults, a person with what is kept in `settings.ron`.

mod brush;
mod comfort;
mod compute;
mod files;
mod hands;
mod help;
mod keep;
mod look;
mod palettes;
mod patch;
mod preview;
mod scaffold;
mod shelf;
mod snap;
mod sweep;
mod symmetry;
mod units;
mod world;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

pub use brush::{BrushSettings, BrushSkeleton};
pub use comfort::{ComfortSettings, Desktop};
pub use compute::{Backend, ComputeSettings};
pub use files::FileSettings;
pub use hands::HandsSettings;
pub use help::{HelpSettings, Lesson, Progress};
pub use keep::{KeepSettingsPlugin, replace_file};
pub use look::{LookSettings, RoomKind};
pub use palettes::{OwnPalette, PaletteSettings, Swatch};
pub use patch::SettingFault;
pub use preview::PreviewSettings;
pub use scaffold::{Draws, LinesShown, ScaffoldSettings};
pub use shelf::ShelfSettings;
pub use snap::{AngleSnap, GridSnap, SnapSettings, SurfaceSnap};
pub use sweep::{SweepHands, SweepItem, SweepSettings, SweepShape};
pub use symmetry::{MirrorPlane, SymmetrySettings};
pub use units::UnitSettings;
pub use world::WorldSettings;

/// Everything a person can set. A field that a file lacks has its default.
#[derive(Resource, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// The room and how it is drawn.
    pub look: LookSettings,
    /// Which hand leads.
    pub hands: HandsSettings,
    /// In what lengths are read and written.
    pub units: UnitSettings,
    /// What a person likes and used of the library.
    pub shelf: ShelfSettings,
    /// The colours a person has kept.
    pub palettes: PaletteSettings,
    /// What is remembered of files.
    pub files: FileSettings,
    /// Whether results are shown ahead.
    pub preview: PreviewSettings,
    /// What pulls at things that hands move.
    pub snap: SnapSettings,
    /// What is made is made on other sides too.
    pub symmetry: SymmetrySettings,
    /// What sweeps become.
    pub sweep: SweepSettings,
    /// How two hands move the world.
    pub world: WorldSettings,
    /// What one wants in a headset.
    pub comfort: ComfortSettings,
    /// Where solids are made.
    pub compute: ComputeSettings,
    /// How what is drawn is read.
    pub scaffold: ScaffoldSettings,
    /// How far one is with learning.
    pub help: HelpSettings,
    /// What is set on the panel of Brush.
    pub brush: BrushSettings,
}

impl Settings {
    /// What a person finds who has set nothing yet; a session begins with the defaults instead.
    pub fn of_a_person() -> Self {
        Self {
            snap: SnapSettings::of_a_person(),
            ..Self::default()
        }
    }
}

/// The parts that change what hands make: a recording begins with those that are not the default.
const SHAPING: &[&str] = &[
    "snap", "hands", "symmetry", "world", "scaffold", "sweep", "brush",
];

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Settings>();
}
