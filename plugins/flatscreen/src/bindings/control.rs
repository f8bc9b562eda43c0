//! Everything mouse, keyboard and gamepad can ask for, by name.

use bevy::reflect::Reflect;
use leafwing_input_manager::Actionlike;

/// When a control is listened to. Two controls may share a key where they are never heard at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Context {
    /// Always.
    Everywhere,
    /// In the view: hands, camera, document.
    View,
    /// While both hands pull at one thing.
    Stretch,
    /// While the focus is in a panel.
    Panel,
    /// While the keyboard on the screen is up.
    Typing,
}

impl Context {
    /// Whether both can be heard in one moment.
    pub fn meets(self, other: Self) -> bool {
        self == other || self == Self::Everywhere || other == Self::Everywhere
    }
}

/// How the list of controls is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// What hands do.
    Hands,
    /// Signs of operands and the four arms of the cross.
    Marks,
    /// Moving the view.
    View,
    /// Gizmo, snaps, work plane, ruler.
    Exact,
    /// Steps and selection.
    Edit,
    /// Files.
    Files,
    /// Modes and panels.
    Panels,
}

impl Group {
    /// All, in the order in which people read them.
    pub const ALL: [Self; 7] = [
        Self::Hands,
        Self::Marks,
        Self::View,
        Self::Exact,
        Self::Edit,
        Self::Files,
        Self::Panels,
    ];

    /// What people read.
    pub fn title(self) -> &'static str {
        match self {
            Self::Hands => "Hands",
            Self::Marks => "Marks and the cross",
            Self::View => "View",
            Self::Exact => "Exact work",
            Self::Edit => "Edit",
            Self::Files => "Files",
            Self::Panels => "Modes and panels",
        }
    }
}

macro_rules! controls {
    ($($group:ident in $context:ident { $($(#[$kind:meta])? $control:ident = $name:literal $words:literal,)* })*) => {
        /// One thing that keys, buttons and sticks can ask for.
        #[derive(Actionlike, Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Reflect)]
        pub enum Control {
            $($(
                #[doc = $words]
                $(#[$kind])?
                $control,
            )*)*
        }

        impl Control {
            /// All of them, in the order in which they are listed.
            pub const ALL: &'static [Self] = &[$($(Self::$control,)*)*];

            /// Its name in files, never changed.
            pub fn name(self) -> &'static str {
                match self { $($(Self::$control => $name,)*)* }
            }

            /// What people read.
            pub fn words(self) -> &'static str {
                match self { $($(Self::$control => $words,)*)* }
            }

            /// Where it stands in the list.
            pub fn group(self) -> Group {
                match self { $($(Self::$control => Group::$group,)*)* }
            }

            /// When it is listened to.
            pub fn context(self) -> Context {
                match self { $($(Self::$control => Context::$context,)*)* }
            }
        }
    };
}

controls! {
    Hands in View {
        Act = "act" "Select, place, draw",
        Grab = "grab" "Take and move what is touched (drag)",
        Finish = "finish" "Finish",
        Alt = "alt" "The other way: the other hand's trigger",
        Cancel = "cancel" "Cancel",
        SwapHands = "swap_hands" "Swap hands; what is held stays held",
        Turn = "turn" "Turn what is held (hold)",
        Stretch = "stretch" "Scale with both hands",
        Erase = "erase" "Brush: paint or erase",
        SnapOff = "snap_off" "Hold snapping off (hold)",
        Delete = "delete" "Delete",
        Centre = "centre" "Middle of the pad: twice to delete, held to finish",
        SaveObject = "save_object" "Save what the hand touches as a mesh",
        #[actionlike(DualAxis)]
        HandStick = "hand_stick" "Stick of the leading hand",
        Deep = "deep" "Sticks: depth, roll, yaw and pitch (hold)",
        Roam = "roam" "Sticks: pan and orbit (hold)",
    }
    Hands in Stretch {
        AxisX = "axis_x" "Scale along X",
        AxisY = "axis_y" "Scale along Y",
        AxisZ = "axis_z" "Scale along Z",
        AxisAll = "axis_all" "Scale along all axes",
    }
    Marks in View {
        MarkUnion = "mark_union" "Mark: unite",
        MarkIntersect = "mark_intersect" "Mark: intersect",
        MarkSubtract = "mark_subtract" "Mark: subtract",
        Unmark = "unmark" "Take the mark away",
        CrossUp = "cross_up" "Cross, up",
        CrossRight = "cross_right" "Cross, right",
        CrossDown = "cross_down" "Cross, down",
        CrossLeft = "cross_left" "Cross, left",
    }
    View in View {
        Orbit = "orbit" "Orbit (drag)",
        Look = "look" "Look around (drag)",
        Pan = "pan" "Pan (drag)",
        #[actionlike(DualAxis)]
        ViewStick = "view_stick" "Stick of the view",
        ZoomIn = "zoom_in" "Nearer",
        ZoomOut = "zoom_out" "Farther",
        FlyForward = "fly_forward" "Fly forward",
        FlyBack = "fly_back" "Fly back",
        FlyLeft = "fly_left" "Fly left",
        FlyRight = "fly_right" "Fly right",
        FlyUp = "fly_up" "Fly up",
        FlyDown = "fly_down" "Fly down",
        FlyFast = "fly_fast" "Fly faster (hold)",
        FrameSelection = "frame_selection" "Show what is selected, or everything",
        FrameAll = "frame_all" "Show everything",
        ResetView = "reset_view" "The view as at the start",
        ViewFront = "view_front" "View from the front",
        ViewRight = "view_right" "View from the right",
        ViewTop = "view_top" "View from above",
        ViewCorner = "view_corner" "View across the corner",
        ResetWorld = "reset_world" "The world at its own size and place",
        Wireframe = "wireframe" "Wireframe on or off",
        Orthographic = "orthographic" "Perspective on or off",
    }
    Exact in View {
        GizmoMove = "gizmo_move" "Handles to move by",
        GizmoTurn = "gizmo_turn" "Handles to turn by",
        GizmoScale = "gizmo_scale" "Handles to scale by",
        Symmetry = "symmetry" "Live symmetry on or off",
        SnapGrid = "snap_grid" "Snap to the grid, on or off",
        SnapAngle = "snap_angle" "Snap to angles, on or off",
        SnapSurface = "snap_surface" "Snap to surfaces, on or off",
        Plane = "plane" "Work plane: show or hide",
        PlaneFace = "plane_face" "Work plane onto the face under the pointer",
        PlaneUp = "plane_up" "Work plane one step along its normal",
        PlaneDown = "plane_down" "Work plane one step back",
        Ruler = "ruler" "Ruler",
    }
    Edit in View {
        SelectMore = "select_more" "Add to what is selected (hold)",
        Undo = "undo" "Undo",
        Redo = "redo" "Redo",
        SelectAll = "select_all" "Select everything",
        Duplicate = "duplicate" "Duplicate",
        Group = "group" "Group",
        Ungroup = "ungroup" "Ungroup",
        Eyedropper = "eyedropper" "Eyedropper: take the look of another object",
        Hide = "hide" "Hide or show what is selected",
        ShowAll = "show_all" "Show what is hidden",
    }
    Files in View {
        New = "new" "New document",
        Open = "open" "Open",
        Save = "save" "Save",
        SaveAs = "save_as" "Save as",
        Export = "export" "Export a mesh",
        Import = "import" "Import meshes",
        Reference = "reference" "Reference images",
    }
    Panels in View {
        Library = "library" "Library",
        Menu = "menu" "Menu button: library; held: modes",
        Modes = "modes" "Ring of modes (hold)",
        Mode1 = "mode_1" "First mode",
        Mode2 = "mode_2" "Second mode",
        Mode3 = "mode_3" "Third mode",
        Mode4 = "mode_4" "Fourth mode",
        Carry1 = "carry_1" "Carry what is held or selected into the first mode",
        Carry2 = "carry_2" "Carry it into the second mode",
        Carry3 = "carry_3" "Carry it into the third mode",
        Carry4 = "carry_4" "Carry it into the fourth mode",
        Outline = "outline" "Objects",
        Snaps = "snaps" "Snaps",
        Settings = "settings" "Settings",
        Controls = "controls" "Controls",
    }
    Panels in Everywhere {
        Help = "help" "Help",
        PanelNext = "panel_next" "Into the panels, to the next one",
        PanelPrevious = "panel_previous" "Into the panels, to the one before",
    }
    Panels in Panel {
        PanelUp = "panel_up" "In a panel: up",
        PanelRight = "panel_right" "In a panel: right",
        PanelDown = "panel_down" "In a panel: down",
        PanelLeft = "panel_left" "In a panel: left",
        PanelPress = "panel_press" "In a panel: press",
        PanelLeave = "panel_leave" "In a panel: close or leave",
        PanelTabLeft = "panel_tab_left" "In a panel: the tab or panel before",
        PanelTabRight = "panel_tab_right" "In a panel: the next tab or panel",
    }
    Panels in Typing {
        TypeUp = "type_up" "Keyboard on the screen: up",
        TypeRight = "type_right" "Keyboard on the screen: right",
        TypeDown = "type_down" "Keyboard on the screen: down",
        TypeLeft = "type_left" "Keyboard on the screen: left",
        TypeKey = "type_key" "Keyboard on the screen: type",
        TypeErase = "type_erase" "Keyboard on the screen: erase",
        TypeSpace = "type_space" "Keyboard on the screen: space",
        TypeShift = "type_shift" "Keyboard on the screen: capitals",
        TypeDone = "type_done" "Keyboard on the screen: done",
        TypeCancel = "type_cancel" "Keyboard on the screen: close",
    }
}

impl Control {
    /// The control of that name in files.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|c| c.name() == name)
    }

    /// Whether it is a stick and not a button.
    pub fn is_stick(self) -> bool {
        matches!(self, Self::HandStick | Self::ViewStick)
    }

    /// Whether it is heard whatever else of Ctrl, Alt and Shift is down: what one holds while doing
    /// something else.
    pub(super) fn is_loose(self) -> bool {
        matches!(
            self,
            Self::Act
                | Self::Grab
                | Self::Turn
                | Self::SnapOff
                | Self::Deep
                | Self::Roam
                | Self::FlyForward
                | Self::FlyBack
                | Self::FlyLeft
                | Self::FlyRight
                | Self::FlyUp
                | Self::FlyDown
                | Self::FlyFast
                | Self::SelectMore
        )
    }

    /// Whether it waits until its button goes up where that button also begins a chord.
    pub(super) fn is_patient(self) -> bool {
        self == Self::Finish
    }

    /// Whether both may have one key: the pointer acts on and grabs what it is over; one flies with the
    /// button down that does not select.
    pub(super) fn shares_with(self, other: Self) -> bool {
        matches!(
            (self, other),
            (Self::Act, Self::Grab)
                | (Self::Grab, Self::Act)
                | (Self::FlyFast, Self::SelectMore)
                | (Self::SelectMore, Self::FlyFast)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_one_control_each() {
        for &control in Control::ALL {
            assert_eq!(Control::named(control.name()), Some(control));
        }
    }
}
