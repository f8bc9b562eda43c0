//! What can be bound.

use midair_studio::hands::Action;

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

macro_rules! controls {
    ($($control:ident: $kind:ident $(=> $action:ident)?, $name:literal $title:literal;)*) => {
        /// What a line of a table is about.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Control {
            $(
                #[doc = $title]
                $control,
            )*
        }

        impl Control {
            /// Every one, in order.
            pub const ALL: &[Self] = &[$(Self::$control,)*];

            /// Its name in files, and that of its action in the runtime.
            pub fn name(self) -> &'static str {
                match self { $(Self::$control => $name,)* }
            }

            /// What a runtime's own menu calls it.
            pub fn title(self) -> &'static str {
                match self { $(Self::$control => $title,)* }
            }

            /// What it is made of.
            pub fn kind(self) -> Kind {
                match self { $(Self::$control => Kind::$kind,)* }
            }

            /// The action of the hand that it is, if it is one by itself.
            pub fn action(self) -> Option<Action> {
                match self { $(Self::$control => controls!(@action $($action)?),)* }
            }
        }
    };
    (@action) => { None };
    (@action $action:ident) => { Some(Action::$action) };
}

controls! {
    Stick: Plane, "stick" "Stick: marks, options";
    Pad: Plane, "pad" "Pad: marks, options, swipe";
    PadTouch: Button, "pad_touch" "Pad is touched";
    PadClick: Button, "pad_click" "Pad is pressed";
    Act: Axis => Act, "act" "Act, select, draw";
    Grab: Axis => Grab, "grab" "Grab";
    Finish: Button => Finish, "finish" "Finish";
    Cancel: Button => Cancel, "cancel" "Cancel";
    Undo: Button => Undo, "undo" "Undo";
    Redo: Button => Redo, "redo" "Redo";
    Library: Button => Library, "library" "Library";
    Modes: Button => Modes, "modes" "Ring of modes";
    Menu: Button => Menu, "menu" "Library; held, the ring of modes";
    Save: Button => Save, "save" "Save what the hand touches";
    Delete: Button => Delete, "delete" "Delete what the hand touches";
    Centre: Button => Centre, "centre" "Held, finish; pressed twice, delete";
    Free: Button => Free, "free" "No snaps while held";
    Cross: Choice, "cross" "Cross";
    Swipe: Choice, "swipe" "Swipe";
}

impl Control {
    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|c| c.name() == name)
    }
}
