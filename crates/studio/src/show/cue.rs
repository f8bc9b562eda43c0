use std::collections::BTreeMap;

use bevy::prelude::*;
use midair_document::ObjectId;

/// What the colour of an object says. Operand colours belong to operands alone; each also carries
/// its sign, so that colour is never the only cue (EasyVRModeling §4.2, Fig. 5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Tint {
    /// Nothing in particular.
    #[default]
    Plain,
    /// An operand to unite: blue, ∪.
    Union,
    /// An operand to intersect: green, ∩.
    Intersect,
    /// An operand to subtract: orange, −.
    Subtract,
    /// A fresh result: yellow.
    Fresh,
}

impl Tint {
    /// The colour, as the eye should see it.
    pub fn colour(self) -> Color {
        match self {
            Self::Plain => {
                let [r, g, b] = midair_solid::PLAIN;
                Color::srgb_u8(r, g, b)
            }
            Self::Union => Color::srgb_u8(0x3d, 0x7d, 0xe0),
            Self::Intersect => Color::srgb_u8(0x3f, 0xae, 0x5a),
            Self::Subtract => Color::srgb_u8(0xee, 0x86, 0x2c),
            Self::Fresh => Color::srgb_u8(0xf0, 0xc7, 0x3a),
        }
    }

    /// The sign an operand carries.
    pub fn sign(self) -> Option<&'static str> {
        match self {
            Self::Union => Some("∪"),
            Self::Intersect => Some("∩"),
            Self::Subtract => Some("−"),
            Self::Plain | Self::Fresh => None,
        }
    }
}

/// How one object is to look.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cue {
    /// What its colour says.
    pub tint: Tint,
    /// A hand touches it or points at it.
    pub touched: bool,
    /// It is selected.
    pub selected: bool,
    /// Only its shell is seen: what it becomes is shown in its place.
    pub ghost: bool,
    /// A short label beside it: an operand's sign and its place in the sequence.
    pub label: Option<String>,
}

/// How objects are to look in this frame: the active tool writes it in
/// [`StudioSet::Cue`](crate::StudioSet::Cue).
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Cues(pub BTreeMap<ObjectId, Cue>);

impl Cues {
    /// One object's cue, to be filled in.
    pub fn entry(&mut self, object: ObjectId) -> &mut Cue {
        self.0.entry(object).or_default()
    }
}
