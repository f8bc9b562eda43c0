use std::ops::{BitOr, BitOrAssign};

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// What a hand can ask for, by name. Devices bind to these; tools read them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[repr(u32)]
pub enum Action {
    /// Do it, select it. The other hand's is *alt*.
    Act,
    /// Hold what the hand touches.
    Grab,
    /// Carry out what is pending.
    Finish,
    /// Give up the gesture.
    Cancel,
    /// One step back.
    Undo,
    /// One step forward again.
    Redo,
    /// Show or hide the library.
    Library,
    /// Show the ring of modes.
    Modes,
    /// Save what the hand touches as a mesh file.
    Save,
    /// Delete what the hand touches.
    Delete,
    /// The cross, up.
    Up,
    /// The cross, right.
    Right,
    /// The cross, down.
    Down,
    /// The cross, left.
    Left,
    /// The middle of the pad, as a button: held it is [`Action::Finish`], pressed twice
    /// [`Action::Delete`].
    Centre,
    /// The menu button: pressed it is [`Action::Library`], held [`Action::Modes`].
    Menu,
    /// Nothing snaps while it is held.
    Free,
}

impl Action {
    /// Every action, in order.
    pub const ALL: [Self; 17] = [
        Self::Act,
        Self::Grab,
        Self::Finish,
        Self::Cancel,
        Self::Undo,
        Self::Redo,
        Self::Library,
        Self::Modes,
        Self::Save,
        Self::Delete,
        Self::Up,
        Self::Right,
        Self::Down,
        Self::Left,
        Self::Centre,
        Self::Menu,
        Self::Free,
    ];
}

/// The four arms of a pad or stick; what each does is the active tool's to say, per phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Cross {
    /// ↑
    Up,
    /// →
    Right,
    /// ↓
    Down,
    /// ←
    Left,
}

impl Cross {
    /// Clockwise from the top.
    pub const ALL: [Self; 4] = [Self::Up, Self::Right, Self::Down, Self::Left];
}

impl From<Cross> for Action {
    fn from(c: Cross) -> Self {
        match c {
            Cross::Up => Self::Up,
            Cross::Right => Self::Right,
            Cross::Down => Self::Down,
            Cross::Left => Self::Left,
        }
    }
}

/// A set of actions; written in files as a list of names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ActionSet(u32);

impl ActionSet {
    /// Nothing is down.
    pub const NONE: Self = Self(0);

    /// Whether `action` is in it.
    pub fn has(self, action: Action) -> bool {
        self.0 & (1 << action as u32) != 0
    }

    /// Adds or takes away one action.
    pub fn set(&mut self, action: Action, down: bool) {
        let bit = 1 << action as u32;
        if down {
            self.0 |= bit;
        } else {
            self.0 &= !bit;
        }
    }

    /// The actions in it, in order.
    pub fn iter(self) -> impl Iterator<Item = Action> {
        Action::ALL.into_iter().filter(move |&a| self.has(a))
    }
}

impl FromIterator<Action> for ActionSet {
    fn from_iter<I: IntoIterator<Item = Action>>(actions: I) -> Self {
        let mut set = Self::NONE;
        for a in actions {
            set.set(a, true);
        }
        set
    }
}

impl BitOr for ActionSet {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for ActionSet {
    fn bitor_assign(&mut self, other: Self) {
        *self = *self | other;
    }
}

impl Serialize for ActionSet {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.collect_seq(self.iter())
    }
}

impl<'de> Deserialize<'de> for ActionSet {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        Vec::<Action>::deserialize(d).map(Self::from_iter)
    }
}
