//! What panels, shortcuts and sessions ask for, by name.
//!
//! A panel is a function of what it shows to the commands it asks for; a session records the
//! commands and not where the pointer was. They are carried out in [`StudioSet::Ask`](crate::StudioSet::Ask); reading and
//! writing files goes on off the frame ([`Errands`]).

mod errand;
mod handle;

use std::path::PathBuf;

use bevy::prelude::*;
use midair_document::{Edit, ObjectId};
use midair_mesh::{Unit, Up};
use serde::{Deserialize, Serialize};

pub use errand::{Errands, Row};

use crate::{
    hands::Side,
    plane::PlaneAsk,
    project::{Answer, Then},
    ruler::MeasureAsk,
    tools::ToolId,
    world::WorldAsk,
};

/// One thing asked for.
#[derive(Message, Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// One step back.
    Undo,
    /// One step forward again.
    Redo,
    /// Shows or hides the library.
    ToggleLibrary,
    /// The wand picks a component from the open library: it appears at that hand.
    Place {
        /// Its id in the library.
        component: String,
        /// At which hand.
        side: Side,
    },
    /// Takes another tool in hand.
    Mode(ToolId),
    /// Carries objects into a mode; those in the hands, or else the selected ones, where none is named.
    Carry {
        /// Which.
        #[serde(default)]
        objects: Vec<ObjectId>,
        /// Into which mode.
        to: ToolId,
    },
    /// Sets the document's S_global, in metres.
    Step(f32),
    /// An empty document.
    New,
    /// Opens a document.
    Open(PathBuf),
    /// Saves under the name it has, or in the work folder.
    Save,
    /// Saves under a name.
    SaveAs(PathBuf),
    /// Writes the visible solids as a mesh file.
    Export {
        /// Where; the ending says the format.
        path: PathBuf,
        /// Grid step in metres; the document's own where `None`.
        #[serde(default)]
        step: Option<f32>,
        /// The file's unit; the format's own where `None`.
        #[serde(default)]
        unit: Option<Unit>,
        /// The axis that points up in the file; the format's own where `None`.
        #[serde(default)]
        up: Option<Up>,
        /// Only this object; all that are visible where `None`.
        #[serde(default)]
        only: Option<ObjectId>,
    },
    /// Writes one object as a mesh file.
    ExportObject {
        /// Which.
        object: ObjectId,
        /// Where; the ending says the format.
        path: PathBuf,
    },
    /// Brings meshes into the user's library.
    Import(Vec<PathBuf>),
    /// Keeps solids in the user's library, each as a component under its name.
    Keep {
        /// Which; those that are selected where none is named.
        #[serde(default)]
        objects: Vec<ObjectId>,
    },
    /// Takes a component of the user's own out of the library; its file is kept aside.
    TakeAway {
        /// Its id in the library.
        component: String,
    },
    /// Brings meshes into the user's library and, where they are few, into the scene as well.
    Bring {
        /// The files.
        paths: Vec<PathBuf>,
        /// Where the first is to stand on its foot, in metres; the others stand beside it.
        at: Vec3,
    },
    /// Brings pictures into the scene to work from: PNG or JPEG.
    Reference {
        /// The files.
        paths: Vec<PathBuf>,
        /// Where the first is to stand on its lower edge, in metres, the others beside it; behind the
        /// work where `None`.
        #[serde(default)]
        at: Option<Vec3>,
    },
    /// Gives up the files that are being read or written.
    CancelErrands,
    /// Gives up one of them, by its number on the screen.
    CancelErrand(u64),
    /// Leaves the work at hand for something else; asks first where it is not saved.
    Leave(Then),
    /// The answer to that question.
    Answer(Answer),
    /// Asks the person for a file.
    Dialog(Dialog),
    /// Takes up the work that an earlier run left behind.
    Restore,
    /// Leaves that work aside for good.
    Dismiss,
    /// Something done with objects: selected, grouped, hidden, copied, placed, coloured.
    Objects(crate::objects::Ask),
    /// Something done with one operand of a sequence: joined otherwise, muted, moved, taken out.
    Operand(crate::operands::OperandAsk),
    /// Changes one of the [`Settings`](crate::settings::Settings) by its dotted name.
    Set {
        /// For instance `look.room`.
        key: String,
        /// As JSON: `true`, `0.05`, `"Day"`.
        value: String,
    },
    /// Shows or hides a panel.
    Panel {
        /// Its id.
        id: String,
        /// Whether it is to be seen.
        open: bool,
    },
    /// Sets the work plane.
    Plane(PlaneAsk),
    /// Measures.
    Measure(MeasureAsk),
    /// Scales the world or puts it back.
    World(WorldAsk),
    /// Goes into the headset, or out of it. A session has none, and leaves it be.
    Headset(bool),
    /// Something only one tool understands: its options, its panel's buttons.
    Tool {
        /// Which tool.
        tool: ToolId,
        /// What, in the tool's own words.
        ask: String,
    },
    /// An edit of the document by name, to set a scene up. Not a gesture: `--hands-only` refuses it.
    Edit(Edit),
}

/// A file that a person is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Dialog {
    /// A document to open.
    Open,
    /// Where to save it.
    SaveAs,
    /// Meshes for the library.
    Import,
    /// Pictures to work from.
    Reference,
}

/// The file dialog asked for last, numbered so that each is shown once.
#[derive(Resource, Debug, Default)]
pub struct Dialogs {
    asked: Option<(u64, Dialog)>,
}

impl Dialogs {
    /// The latest, if it is later than `seen`.
    pub fn after(&self, seen: u64) -> Option<(u64, Dialog)> {
        self.asked.filter(|(number, _)| *number > seen)
    }

    fn ask(&mut self, dialog: Dialog) {
        let number = self.asked.map_or(0, |(n, _)| n) + 1;
        self.asked = Some((number, dialog));
    }
}

impl Command {
    /// Whether a person's hands could have asked for it (a panel or a button does).
    pub fn by_hand(&self) -> bool {
        !matches!(self, Self::Edit(_))
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.add_message::<Command>().init_resource::<Dialogs>();
    handle::plugin(app);
    errand::plugin(app);
}
