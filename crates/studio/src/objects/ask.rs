use bevy::math::Vec3;
use midair_document::{Colour, Dials, GroupId, Layer, LayerId, ObjectId};
use midair_field::Placement;
use serde::{Deserialize, Serialize};

/// How an ask joins what is selected already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum How {
    /// In its place.
    #[default]
    Set,
    /// As well.
    Add,
    /// What is selected no longer is, and the other way about.
    Toggle,
    /// No longer.
    Remove,
}

fn yes() -> bool {
    true
}

/// An axis of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Axis {
    /// To the right.
    X,
    /// Up.
    Y,
    /// Towards the viewer.
    Z,
}

impl Axis {
    /// Its unit vector.
    pub fn unit(self) -> Vec3 {
        match self {
            Self::X => Vec3::X,
            Self::Y => Vec3::Y,
            Self::Z => Vec3::Z,
        }
    }
}

/// One thing asked of objects. An empty list of objects stands for what is selected.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Ask {
    /// Selects objects; whole groups where one of a group is named.
    Select {
        /// Which.
        ids: Vec<ObjectId>,
        /// How they join.
        #[serde(default)]
        how: How,
    },
    /// Selects everything that can be seen and is not locked.
    SelectAll,
    /// Selects nothing.
    SelectNone,
    /// Selects what is not selected.
    SelectOthers,
    /// Copies what is selected, beside it.
    Duplicate,
    /// Puts what is selected into a group.
    Group,
    /// Dissolves the groups that are selected.
    Ungroup,
    /// Deletes.
    Delete,
    /// Calls an object something else.
    Rename {
        /// Which.
        id: ObjectId,
        /// Its name from now on.
        name: String,
    },
    /// Calls a group something else.
    RenameGroup {
        /// Which.
        id: GroupId,
        /// Its name from now on.
        name: String,
    },
    /// Shows or hides.
    Visible {
        /// Which.
        #[serde(default)]
        ids: Vec<ObjectId>,
        /// Whether they are drawn.
        visible: bool,
    },
    /// Shows every object and every layer.
    ShowAll,
    /// Locks or unlocks.
    Locked {
        /// Which.
        #[serde(default)]
        ids: Vec<ObjectId>,
        /// Whether hands pass through them.
        locked: bool,
    },
    /// Puts objects into a group, or out of theirs.
    Into {
        /// Which.
        #[serde(default)]
        ids: Vec<ObjectId>,
        /// The group.
        group: Option<GroupId>,
    },
    /// Puts objects on a layer.
    OnLayer {
        /// Which.
        #[serde(default)]
        ids: Vec<ObjectId>,
        /// The layer.
        layer: LayerId,
    },
    /// Makes a layer.
    NewLayer {
        /// Its name.
        name: String,
    },
    /// Renames, shows, hides, locks a layer.
    ChangeLayer {
        /// Which.
        id: LayerId,
        /// What it is from now on.
        layer: Layer,
    },
    /// Removes a layer; what lies on it goes to the base layer.
    RemoveLayer {
        /// Which.
        id: LayerId,
    },
    /// Moves, turns, scales objects, each to its own place.
    Place(Vec<(ObjectId, Placement)>),
    /// Puts objects on the ground.
    Ground {
        /// Which.
        #[serde(default)]
        ids: Vec<ObjectId>,
    },
    /// Gives a colour, or takes it.
    Colour {
        /// Which.
        #[serde(default)]
        ids: Vec<ObjectId>,
        /// The colour.
        colour: Option<Colour>,
    },
    /// Gives a material by its id, or takes it.
    Material {
        /// Which.
        #[serde(default)]
        ids: Vec<ObjectId>,
        /// Its id.
        material: Option<String>,
        /// What is set of it; the rest is as usual.
        #[serde(default)]
        dials: Dials,
    },
    /// Sets a number of the material that things have.
    Dial {
        /// Which.
        #[serde(default)]
        ids: Vec<ObjectId>,
        /// Its name in the material's file.
        dial: String,
        /// What it is to be, within the material's bounds.
        value: f32,
        /// Whether this is what stays: otherwise it is only shown.
        #[serde(default = "yes")]
        done: bool,
    },
    /// Gives a colour and a material together.
    Look {
        /// Which.
        #[serde(default)]
        ids: Vec<ObjectId>,
        /// The colour.
        colour: Option<Colour>,
        /// The material's id.
        material: Option<String>,
    },
    /// Gives what is selected, or `ids`, the colour and the material of another object.
    Like {
        /// Which.
        #[serde(default)]
        ids: Vec<ObjectId>,
        /// Whose.
        of: ObjectId,
    },
    /// Takes the eyedropper in hand, or puts it away: with it the next object that is acted on gives its
    /// colour and material to what is selected.
    Dropper {
        /// Whether it is in hand.
        on: bool,
    },
    /// Changes a picture to work from.
    Picture {
        /// Which.
        id: ObjectId,
        /// Its width in the room, in metres; its height goes along.
        #[serde(default)]
        width: Option<f32>,
        /// From 0, not seen, to 1.
        #[serde(default)]
        opacity: Option<f32>,
    },
    /// Makes a mirror image of what is selected, on the other side of the plane through the origin.
    Mirror {
        /// The plane's normal.
        axis: Axis,
    },
    /// Makes copies of what is selected, evenly around the vertical through the origin.
    Around {
        /// How many there are then, the first included: 2 to 64.
        count: u32,
    },
}

impl Ask {
    /// Whether live symmetry does it to the images too: what makes copies of its own does not.
    pub(super) fn is_live(&self) -> bool {
        !matches!(self, Self::Mirror { .. } | Self::Around { .. })
    }

    /// Whether what it makes is selected afterwards.
    pub(super) fn selects_new(&self) -> bool {
        matches!(
            self,
            Self::Duplicate | Self::Mirror { .. } | Self::Around { .. }
        )
    }
}
