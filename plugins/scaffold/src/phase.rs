use bevy::math::DVec3;
use bevy::prelude::*;
use midair_beautify::{LineOptions, StrokeOptions};
use midair_document::ObjectId;
use midair_studio::hands::{Hands, Side};
use midair_studio::settings::ScaffoldSettings;

use crate::read::Reading;

/// Where one is in a gesture.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Phase {
    /// Nothing is being drawn.
    #[default]
    Idle,
    /// An elastic line, from where the trigger went down to the tip of the hand.
    Line {
        /// Which hand.
        side: Side,
        /// Where it went down.
        from: DVec3,
        /// Where the tip is.
        to: DVec3,
        /// How far the tip has been from there.
        farthest: f64,
        /// It is to stay as drawn.
        raw: bool,
    },
    /// A free curve.
    Stroke {
        /// Which hand.
        side: Side,
        /// Where the tip was, and the eyes.
        points: Vec<Sample>,
        /// It is to stay as drawn.
        raw: bool,
    },
}

/// One place of the tip while a stroke is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The tip, in world metres.
    pub at: DVec3,
    /// The eyes, where they are known.
    pub eye: Option<DVec3>,
}

/// What was drawn last, and what else it could have been meant to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Last {
    /// The object that it became.
    pub id: ObjectId,
    /// The readings; the last one is what was drawn.
    pub readings: Vec<Reading>,
    /// Where each of them is picked while it is a ghost, in world metres.
    pub places: Vec<DVec3>,
    /// Which of them the object is.
    pub chosen: usize,
    /// Seconds since it was drawn or looked at.
    pub age: f32,
    /// It is not in the document: undone, or deleted.
    pub gone: bool,
}

/// What a cancelled gesture throws away, and what outlives it for a while.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Draft {
    /// Where one is.
    pub phase: Phase,
    /// What was drawn last.
    pub last: Option<Last>,
    /// What was drawn before it, and what undo took away, in the order of drawing.
    pub earlier: Vec<Last>,
    /// The ghost that a press would pick.
    pub over: Option<usize>,
    /// An angle at which lines are to meet others, in degrees, as it was asked for last; 0 for none.
    pub own_angle: f64,
    /// What the hand touched where it went down.
    pub under: Option<ObjectId>,
    /// The first of two points that are picked.
    pub picked: Option<DVec3>,
    /// What the line being drawn would become.
    pub preview: Option<Reading>,
}

impl Draft {
    /// Which hand draws.
    pub fn side(&self) -> Option<Side> {
        match self.phase {
            Phase::Idle => None,
            Phase::Line { side, .. } | Phase::Stroke { side, .. } => Some(side),
        }
    }
}

/// What the user sets, as the kernels take it, for one hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How lines are read.
    pub line: LineOptions,
    /// How strokes are read.
    pub stroke: StrokeOptions,
}

/// On a screen so many pixels count as the paper's 5 cm for lines, and as its 3 cm for strokes.
pub const PIXELS: [f64; 2] = [16.0, 10.0];

impl Options {
    /// For a hand, from what is set.
    pub fn of(settings: &ScaffoldSettings, hands: &Hands, side: Side) -> Self {
        let set = settings.sound();
        let usual = ScaffoldSettings::default();
        // Metres of world that the set distance is.
        let line = hands.reach(
            side,
            set.distance,
            PIXELS[0] * set.distance / usual.distance,
        );
        let stroke = hands.reach(
            side,
            set.stroke_distance,
            PIXELS[1] * set.stroke_distance / usual.stroke_distance,
        );
        let sound = |scale: f64| {
            if scale.is_finite() {
                scale.clamp(1e-4, 1e4)
            } else {
                1.0
            }
        };
        let line = LineOptions {
            distance: set.distance,
            angle: set.angle.to_radians(),
            length: set.length,
            part_turn: if set.part_turns {
                set.angle.to_radians()
            } else {
                0.0
            },
            own_angle: 0.0,
            vertical: set.vertical,
            metres_per_world: sound(set.distance / line),
        };
        let stroke = StrokeOptions {
            distance: set.stroke_distance,
            angle: set.stroke_angle.to_radians(),
            metres_per_world: sound(set.stroke_distance / stroke),
            ..StrokeOptions::default()
        };
        Self { line, stroke }.stronger(set.strength)
    }

    /// The same with an angle of one's own, in degrees.
    #[must_use]
    pub fn and_at(mut self, degrees: f64) -> Self {
        self.line.own_angle = degrees.to_radians();
        self
    }

    /// The same with thresholds that are so many times as wide.
    #[must_use]
    pub fn stronger(self, strength: f64) -> Self {
        Self {
            line: self.line.stronger(strength),
            stroke: StrokeOptions {
                distance: self.stroke.distance * strength,
                angle: (self.stroke.angle * strength).min(1.2),
                ..self.stroke
            },
        }
    }
}
