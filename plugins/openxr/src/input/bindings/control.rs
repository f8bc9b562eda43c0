//! What can be bound.

use midair_studio::hands::Action;

/// What a line of a table is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Control {
    /// Where the stick is.
    Stick,
    /// Where the pad is.
    Pad,
    /// Whether the pad is touched.
    PadTouch,
    /// Whether the pad is pressed.
    PadClick,
    /// What acts, as far as it is pulled.
    Act,
    /// What grabs, as far as it is squeezed.
    Grab,
    /// Finish.
    Finish,
    /// Cancel.
    Cancel,
    /// Undo.
    Undo,
    /// Redo.
    Redo,
    /// The library.
    Library,
    /// The ring of modes.
    Modes,
    /// Pressed the library, held the ring.
    Menu,
    /// Save what is touched.
    Save,
    /// Delete what is touched.
    Delete,
    /// Held finish, pressed twice delete.
    Centre,
    /// Nothing snaps.
    Free,
    /// The four arms: of a stick that is flicked, of a pad that is pressed.
    Cross,
    /// What the hand's swipe is read from.
    Swipe,
}

/// What a control is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Two axes.
    Plane,
    /// One axis.
    Axis,
    /// A button, or an arm.
    Button,
    /// Names a stick or pad and nothing of its own.
    Choice,
}

impl Control {
    /// Every one, in order.
    pub const ALL: [Self; 19] = [
        Self::Stick,
        Self::Pad,
        Self::PadTouch,
        Self::PadClick,
        Self::Act,
        Self::Grab,
        Self::Finish,
        Self::Cancel,
        Self::Undo,
        Self::Redo,
        Self::Library,
        Self::Modes,
        Self::Menu,
        Self::Save,
        Self::Delete,
        Self::Centre,
        Self::Free,
        Self::Cross,
        Self::Swipe,
    ];

    /// Its name in files, and that of its action in the runtime.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::Pad => "pad",
            Self::PadTouch => "pad_touch",
            Self::PadClick => "pad_click",
            Self::Act => "act",
            Self::Grab => "grab",
            Self::Finish => "finish",
            Self::Cancel => "cancel",
            Self::Undo => "undo",
            Self::Redo => "redo",
            Self::Library => "library",
            Self::Modes => "modes",
            Self::Menu => "menu",
            Self::Save => "save",
            Self::Delete => "delete",
            Self::Centre => "centre",
            Self::Free => "free",
            Self::Cross => "cross",
            Self::Swipe => "swipe",
        }
    }

    /// What a runtime's own menu calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Stick => "Stick: marks, options",
            Self::Pad => "Pad: marks, options, swipe",
            Self::PadTouch => "Pad is touched",
            Self::PadClick => "Pad is pressed",
            Self::Act => "Act, select, draw",
            Self::Grab => "Grab",
            Self::Finish => "Finish",
            Self::Cancel => "Cancel",
            Self::Undo => "Undo",
            Self::Redo => "Redo",
            Self::Library => "Library",
            Self::Modes => "Ring of modes",
            Self::Menu => "Library; held, the ring of modes",
            Self::Save => "Save what the hand touches",
            Self::Delete => "Delete what the hand touches",
            Self::Centre => "Held, finish; pressed twice, delete",
            Self::Free => "No snaps while held",
            Self::Cross => "Cross",
            Self::Swipe => "Swipe",
        }
    }

    /// What it is made of.
    pub fn kind(self) -> Kind {
        match self {
            Self::Stick | Self::Pad => Kind::Plane,
            Self::Act | Self::Grab => Kind::Axis,
            Self::Cross | Self::Swipe => Kind::Choice,
            _ => Kind::Button,
        }
    }

    /// The action of the hand that it is, if it is one by itself.
    pub fn action(self) -> Option<Action> {
        Some(match self {
            Self::Act => Action::Act,
            Self::Grab => Action::Grab,
            Self::Finish => Action::Finish,
            Self::Cancel => Action::Cancel,
            Self::Undo => Action::Undo,
            Self::Redo => Action::Redo,
            Self::Library => Action::Library,
            Self::Modes => Action::Modes,
            Self::Menu => Action::Menu,
            Self::Save => Action::Save,
            Self::Delete => Action::Delete,
            Self::Centre => Action::Centre,
            Self::Free => Action::Free,
            Self::Stick
            | Self::Pad
            | Self::PadTouch
            | Self::PadClick
            | Self::Cross
            | Self::Swipe => {
                return None;
            }
        })
    }

    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.name() == name)
    }
}
