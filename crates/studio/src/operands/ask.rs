use midair_document::ObjectId;
use midair_field::Op;
use serde::{Deserialize, Serialize};

/// Which operand: of the marked sequence, or of a solid that was made from some.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Of {
    /// The solid; the marked sequence where `None`.
    #[serde(default)]
    pub object: Option<ObjectId>,
    /// Its place, from 0: within the solid, then within that operand, and so on.
    #[serde(default)]
    pub path: Vec<usize>,
}

/// One thing asked of an operand, each a step that can be undone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum OperandAsk {
    /// It joins in another way.
    Join {
        /// Which.
        of: Of,
        /// How it joins from now on.
        op: Op,
    },
    /// It is kept but left out, or takes part again.
    Mute {
        /// Which.
        of: Of,
        /// Whether it is left out.
        muted: bool,
    },
    /// It is read earlier or later.
    Move {
        /// Which.
        of: Of,
        /// Its place from now on.
        to: usize,
    },
    /// It is no operand any more: unmarked, or dropped from the solid.
    Remove {
        /// Which.
        of: Of,
    },
    /// It becomes an object of its own again, where it stands.
    TakeOut {
        /// Which.
        of: Of,
    },
    /// All of them become objects again, marked as they were.
    Unfuse {
        /// The solid.
        object: ObjectId,
    },
}
