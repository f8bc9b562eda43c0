use bevy::prelude::*;
use midair_field::Stroke;
use midair_studio::hands::{Pose, Side};
use midair_studio::settings::BrushSkeleton;

/// Where one hand is in a gesture. Places are in the world, metres; w is a radius there.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Phase {
    /// Nothing begun.
    #[default]
    Idle,
    /// The trigger is down to turn what the other hand does around.
    Alt,
    /// A point is led.
    Leading {
        /// Where it was.
        way: Vec<Vec4>,
        /// Where it is.
        now: Vec4,
    },
    /// A line has its first end.
    Line {
        /// Where.
        from: Vec3,
    },
    /// A polygon has some corners.
    Polygon {
        /// Where.
        corners: Vec<Vec3>,
    },
    /// A solid is held where it will be.
    Stamping,
    /// A stroke of the painting is moved.
    Moving {
        /// Which.
        stroke: usize,
        /// As it was.
        before: Box<Stroke>,
        /// Where the hand was.
        from: Pose,
    },
}

/// What a cancelled gesture throws away.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Draft {
    phases: [Phase; 2],
    /// Whether what is begun takes away.
    pub erase: bool,
    /// Seconds since it was begun.
    pub age: f32,
    /// Where the hand was then, metres of the world.
    pub from: Vec3,
    /// The hand that did something last: its ghost is seen.
    pub leading: Option<Side>,
}

impl Draft {
    /// Where one hand is.
    pub fn phase(&self, side: Side) -> &Phase {
        &self.phases[side as usize]
    }

    /// The same, to be changed.
    pub fn phase_mut(&mut self, side: Side) -> &mut Phase {
        &mut self.phases[side as usize]
    }

    /// Takes one hand to another phase.
    pub fn set(&mut self, side: Side, phase: Phase) {
        self.phases[side as usize] = phase;
    }

    /// What a hand has begun to paint with, whatever has been chosen since.
    pub fn skeleton(&self, side: Side) -> Option<BrushSkeleton> {
        match self.phase(side) {
            Phase::Leading { .. } => Some(BrushSkeleton::Point),
            Phase::Line { .. } => Some(BrushSkeleton::Line),
            Phase::Polygon { .. } => Some(BrushSkeleton::Polygon),
            Phase::Stamping => Some(BrushSkeleton::Volume),
            Phase::Idle | Phase::Alt | Phase::Moving { .. } => None,
        }
    }

    /// The hand that has begun something.
    pub fn busy(&self) -> Option<Side> {
        Side::BOTH
            .into_iter()
            .find(|&s| !matches!(self.phase(s), Phase::Idle | Phase::Alt))
    }

    /// Whether what a hand has begun is where it was begun: its trigger may be meant to turn around what the other does.
    pub fn rests(&self, side: Side, now: Vec3, near: f32) -> bool {
        let one = match self.phase(side) {
            Phase::Leading { .. } | Phase::Line { .. } | Phase::Stamping => true,
            Phase::Polygon { corners } => corners.len() == 1,
            Phase::Idle | Phase::Alt | Phase::Moving { .. } => false,
        };
        one && self.from.distance(now) < near
    }

    /// Everything begun is given up.
    pub fn drop_all(&mut self) {
        let leading = self.leading;
        *self = Self {
            leading,
            ..Self::default()
        };
    }
}
