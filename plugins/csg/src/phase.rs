use bevy::prelude::*;
use midair_studio::hands::Side;

/// Where one hand is in a gesture; what it holds is the studio's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Phase {
    /// Nothing open.
    #[default]
    Idle,
    /// SceneOperate is open on this hand: the cross marks what it touches.
    Operating,
}

/// What a cancelled gesture throws away.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct Draft {
    phases: [Phase; 2],
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
}
