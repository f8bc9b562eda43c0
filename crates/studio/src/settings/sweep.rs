use serde::{Deserialize, Serialize};

/// What a sweep becomes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum SweepShape {
    /// The surface the curve passes over.
    #[default]
    Surface,
    /// The tube that the closed curve passes over.
    Tube,
    /// A thing many times over, along the curve or over the surface.
    Clones,
}

impl SweepShape {
    /// All of them, in the order in which the cross goes through them.
    pub const ALL: [Self; 3] = [Self::Surface, Self::Tube, Self::Clones];

    /// What people read.
    pub fn name(self) -> &'static str {
        match self {
            Self::Surface => "surface",
            Self::Tube => "tube",
            Self::Clones => "clones",
        }
    }

    /// The one after it, and the first after the last.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Surface => Self::Tube,
            Self::Tube => Self::Clones,
            Self::Clones => Self::Surface,
        }
    }
}

/// With how many hands one sweeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum SweepHands {
    /// With both where both are in front of the eyes, else with one.
    #[default]
    Auto,
    /// An end in each hand.
    Two,
    /// The ends are placed, and moved one after the other.
    One,
}

/// What is cloned.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SweepItem {
    /// A component of the library, by its id.
    Component(String),
    /// An object of the document, by its number.
    Object(u64),
}

/// What a person sets for Sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SweepSettings {
    /// What a sweep becomes.
    pub shape: SweepShape,
    /// n: points along each curve, 2 to 1024.
    pub count: u32,
    /// Metres: of a surface, or of the wall of a tube without caps; 0 leaves it open.
    pub thickness: f32,
    /// Whether tubes are closed at their ends and full.
    pub caps: bool,
    /// With how many hands.
    pub hands: SweepHands,
    /// The ends hang on springs: they lag, swing and sink a little.
    pub springy: bool,
    /// How often a sweep is smoothed when it is let go (α = 0.1 each time).
    pub smooth: u32,
    /// What is cloned.
    pub item: SweepItem,
    /// How many clones stand on a curve.
    pub clones: u32,
    /// The longest side of a clone, metres.
    pub clone_size: f32,
    /// Whether clones that stand closer are smaller.
    pub paced: bool,
    /// Clones stand over the whole surface, and not on the last curve alone.
    pub spread: bool,
}

impl Default for SweepSettings {
    fn default() -> Self {
        Self {
            shape: SweepShape::default(),
            count: 48,
            thickness: 0.0,
            caps: true,
            hands: SweepHands::default(),
            springy: false,
            smooth: 0,
            item: SweepItem::Component("solid/sphere".to_owned()),
            clones: 12,
            clone_size: 0.04,
            paced: true,
            spread: false,
        }
    }
}
