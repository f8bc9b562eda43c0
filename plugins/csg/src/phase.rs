use bevy::prelude::*;
use midair_document::ObjectId;
use midair_studio::hands::Side;

use crate::hold::{Hold, Stretch};

/// Where one hand is in a gesture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Phase {
    /// Nothing held, nothing open.
    #[default]
    Idle,
    /// SceneOperate is open on this hand: the cross marks what it touches.
    Operating,
    /// This hand holds an object.
    Holding {
        /// Which.
        object: ObjectId,
        /// How.
        hold: Hold,
    },
}

/// What a cancelled gesture throws away.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct Draft {
    phases: [Phase; 2],
    /// Both hands hold one object and scale it.
    pub stretch: Option<(ObjectId, Stretch)>,
}

impl Draft {
    /// Where one hand is.
    pub fn phase(&self, side: Side) -> Phase {
        self.phases[side as usize]
    }

    /// Takes one hand to another phase.
    pub fn set(&mut self, side: Side, phase: Phase) {
        self.phases[side as usize] = phase;
    }

    /// What one hand holds.
    pub fn held(&self, side: Side) -> Option<ObjectId> {
        match self.phase(side) {
            Phase::Holding { object, .. } => Some(object),
            Phase::Idle | Phase::Operating => None,
        }
    }

    /// Whether any hand holds `object`.
    pub fn holds(&self, object: ObjectId) -> bool {
        Side::BOTH.iter().any(|&s| self.held(s) == Some(object))
    }
}

/// What the user sets.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Options {
    /// The ending of files that *save* writes: stl, 3mf, glb, obj, ply.
    pub save_as: String,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            save_as: "stl".to_owned(),
        }
    }
}
