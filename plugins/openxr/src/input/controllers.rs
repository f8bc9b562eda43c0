//! What the runtime says of the controllers, for whoever draws them.

use bevy::prelude::*;
use midair_studio::hands::{Pose, Side};

/// One controller, in metres of the room.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Controller {
    /// Where it is held; the last place while its tracking is lost.
    pub grip: Option<Pose>,
    /// Where it aims from and to; the last place while its tracking is lost.
    pub aim: Option<Pose>,
    /// Whether both are fresh.
    pub tracked: bool,
    /// Whether it is on: a hand that never was has no poses.
    pub active: bool,
    /// Which one it is, below `/interaction_profiles/`; empty while none is.
    pub profile: &'static str,
    /// What people call it.
    pub name: &'static str,
    /// How far the trigger is pulled, 0 to 1.
    pub trigger: f32,
    /// How far the grip is squeezed, 0 to 1.
    pub squeeze: f32,
    /// Where the stick is.
    pub stick: Vec2,
    /// Where the pad is touched.
    pub pad: Option<Vec2>,
}

/// Both controllers.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Controllers {
    /// Left, right.
    pub hands: [Controller; 2],
}

impl Controllers {
    /// One of them.
    pub fn side(&self, side: Side) -> &Controller {
        &self.hands[side as usize]
    }

    /// They are where they were, and nothing is known of them.
    pub(crate) fn lose(&mut self) {
        for hand in &mut self.hands {
            hand.tracked = false;
            hand.active = false;
            hand.trigger = 0.0;
            hand.squeeze = 0.0;
            hand.stick = Vec2::ZERO;
            hand.pad = None;
        }
    }
}
