use std::sync::Arc;

use bevy::prelude::*;
use midair_curve::{End, Lengths};
use midair_document::ObjectId;
use midair_studio::{hands::Side, tools::ToolId};
use midair_swept::Rib;

use crate::ends::{Rail, Spring};
use crate::solo::Solo;

/// Where one is in a sweep.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Phase {
    /// The curve hangs between the ends.
    #[default]
    Idle,
    /// The trigger is held: the curve leaves a surface behind.
    Sweeping {
        /// The sweep it goes on with, if it extends one.
        onto: Option<ObjectId>,
    },
    /// A sweep's own curves are bent.
    Editing {
        /// Which sweep.
        object: ObjectId,
        /// The curve nearest to the hand.
        at: usize,
        /// What holds it.
        grip: Option<Box<Grip>>,
    },
}

/// A curve of a sweep that is being bent.
#[derive(Clone, Debug, PartialEq)]
pub struct Grip {
    /// The curve as it was.
    pub from: Rib,
    /// Which ends are held, left and right.
    pub ends: [Option<Held>; 2],
    /// The curves as they are bent now, in the sweep's own frame.
    pub bent: Arc<[Rib]>,
}

/// One end of a curve in a hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Which hand.
    pub by: Side,
    /// The end in that hand's frame.
    pub offset: End,
}

/// Open surfaces were carried where only solids are of use: how they would be closed.
#[derive(Clone, Debug, PartialEq)]
pub struct Offer {
    /// Which.
    pub objects: Vec<ObjectId>,
    /// Metres, for those that are no tubes; a tube is capped.
    pub thickness: f32,
    /// Where they were carried.
    pub to: ToolId,
}

/// What a cancelled gesture throws away.
#[derive(Resource, Clone, Debug)]
pub struct Draft {
    /// Where one is.
    pub phase: Phase,
    /// The curve as the ends hold it now.
    pub live: Option<Rib>,
    /// The curves swept so far.
    pub ribs: Vec<Rib>,
    /// w₀ and w₁.
    pub slopes: [f32; 2],
    /// Where each end is.
    pub ends: [Option<End>; 2],
    /// Ends that stay where they are.
    pub pinned: [Option<End>; 2],
    /// Ends that follow a stroke.
    pub rails: [Option<Rail>; 2],
    /// The ends with one hand.
    pub solo: Solo,
    /// Whether the ends are placed with one hand.
    pub alone: bool,
    /// The sweep the next one goes on with.
    pub extends: Option<ObjectId>,
    /// How surfaces that were carried elsewhere would be closed.
    pub offer: Option<Offer>,
    pub(crate) lengths: Lengths,
    pub(crate) springs: [Spring; 2],
    pub(crate) swipes: [Option<f32>; 2],
    /// It is to be made a sweep in this frame.
    pub(crate) done: bool,
    /// The curve along which finish kept a row.
    pub(crate) kept: Option<Rib>,
    /// What the one hand touched when it was pressed.
    pub(crate) under: Option<ObjectId>,
    /// The act that is down began a sweep or a bend, and is not to begin another.
    pub(crate) fresh: bool,
}

impl Default for Draft {
    fn default() -> Self {
        Self {
            phase: Phase::Idle,
            live: None,
            ribs: Vec::new(),
            slopes: [1.0; 2],
            ends: [None; 2],
            pinned: [None; 2],
            rails: [None, None],
            solo: Solo::default(),
            alone: false,
            extends: None,
            offer: None,
            lengths: Lengths::default(),
            springs: [Spring::default(); 2],
            swipes: [None; 2],
            done: false,
            kept: None,
            under: None,
            fresh: true,
        }
    }
}

impl Draft {
    /// Whether the trigger is held.
    pub fn is_sweeping(&self) -> bool {
        matches!(self.phase, Phase::Sweeping { .. })
    }

    /// Gives up what was swept and not let go.
    pub fn drop_sweep(&mut self) {
        self.ribs.clear();
        self.done = false;
        if self.is_sweeping() {
            self.phase = Phase::Idle;
        }
    }

    /// Everything but what one set with the hands: slopes, rails and pins stay.
    pub fn leave(&mut self) {
        self.drop_sweep();
        self.phase = Phase::Idle;
        self.extends = None;
        self.offer = None;
        self.live = None;
        self.ends = [None; 2];
        self.solo = Solo::default();
        self.swipes = [None; 2];
        self.springs = [Spring::default(); 2];
        self.lengths = Lengths::default();
        self.fresh = true;
    }

    /// The twist of the moment before, radians.
    pub(crate) fn twist(&self) -> f64 {
        self.live.as_ref().map_or(0.0, |r| f64::from(r.twist))
    }
}
