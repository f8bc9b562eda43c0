use bevy::math::{Vec2, Vec3};
use midair_studio::{
    command::Command,
    evaluate::Job,
    hands::{Action, Side},
};
use serde::{Deserialize, Serialize};

use crate::{Expectation, FrameRun, Turn};

/// One line of a session. Lengths in metres of world, times in seconds; `docs/session.md` shows
/// each in use.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Step {
    /// One hand goes somewhere, easing in and out, and ends there exactly.
    Move {
        /// Which.
        hand: Side,
        /// Where to, in the world.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to: Option<Vec3>,
        /// Where to, from where it is; instead of `to`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        by: Option<Vec3>,
        /// How it is turned at the end; as it was where `None`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        turn: Option<Turn>,
        /// Seconds; a calm pace where `None`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        over: Option<f32>,
    },
    /// Both hands go at once and arrive together.
    Both {
        /// The left one's end.
        #[serde(default)]
        left: Goal,
        /// The right one's end.
        #[serde(default)]
        right: Goal,
        /// Seconds; a calm pace where `None`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        over: Option<f32>,
    },
    /// One hand is somewhere else in the next frame, or nowhere sound: what a tracking fault does.
    Jump {
        /// Which.
        hand: Side,
        /// Where; may be `NaN`.
        to: Vec3,
        /// How turned; as it was where `None`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        turn: Option<Turn>,
    },
    /// The tracking of a hand is lost, until it is moved again.
    Lose(Side),
    /// A button goes down.
    Press(Side, Action),
    /// A button goes up.
    Release(Side, Action),
    /// Down for 0.1 s, then up.
    Click(Side, Action),
    /// Two clicks within the time of a double press.
    DoubleClick(Side, Action),
    /// Down for long enough to be a hold, then up.
    Hold(Side, Action),
    /// The pad is touched at a point, each axis in [−1, 1].
    Touch(Side, Vec2),
    /// The thumb slides over the pad to a point.
    Slide {
        /// Which hand.
        hand: Side,
        /// Where it ends.
        to: Vec2,
        /// Seconds.
        over: f32,
    },
    /// The pad is let go.
    Untouch(Side),
    /// The hands stay as they are for so many seconds.
    Wait(f32),
    /// Asks for something by name, as a panel would, and lets one frame pass.
    Ask(Command),
    /// Checks what there is now; makes the session a test.
    Expect(Expectation),
    /// Recorded frames.
    Frames(FrameRun),
    /// What was asked for in the frame that follows, in order; recorded.
    Asked(Vec<Command>),
    /// Which results of background work arrived in the frame that follows, in order; recorded.
    Ready(Vec<Job>),
}

impl Step {
    /// Its name in a file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Move { .. } => "Move",
            Self::Both { .. } => "Both",
            Self::Jump { .. } => "Jump",
            Self::Lose(_) => "Lose",
            Self::Press(..) => "Press",
            Self::Release(..) => "Release",
            Self::Click(..) => "Click",
            Self::DoubleClick(..) => "DoubleClick",
            Self::Hold(..) => "Hold",
            Self::Touch(..) => "Touch",
            Self::Slide { .. } => "Slide",
            Self::Untouch(_) => "Untouch",
            Self::Wait(_) => "Wait",
            Self::Ask(_) => "Ask",
            Self::Expect(_) => "Expect",
            Self::Frames(_) => "Frames",
            Self::Asked(_) => "Asked",
            Self::Ready(_) => "Ready",
        }
    }

    /// What it asks for, if anything.
    pub fn commands(&self) -> &[Command] {
        match self {
            Self::Ask(c) => std::slice::from_ref(c),
            Self::Asked(c) => c,
            _ => &[],
        }
    }

    /// Why its own numbers make no sense, or `None` where they do. Does not know what goes before.
    pub(crate) fn fault(&self) -> Option<String> {
        let goal = |hand: &str, g: &Goal| match (g.to, g.by) {
            (Some(_), Some(_)) => Some(format!("{hand}`to` and `by` exclude each other")),
            (None, None) if g.turn.is_none() => {
                Some(format!("{hand}says neither `to`, `by` nor `turn`"))
            }
            (to, by) if ![to, by].iter().flatten().all(|v| v.is_finite()) => {
                Some(format!("{hand}its goal is not finite (Jump can do that)"))
            }
            _ if g.turn.is_some_and(|t| t.rotation().is_none()) => {
                Some(format!("{hand}`turn` is not a rotation"))
            }
            _ => None,
        };
        let seconds = |name: &str, s: f32| {
            (!s.is_finite() || s < 0.0)
                .then(|| format!("{name} must be a number of seconds, not {s}"))
        };
        match self {
            Self::Move {
                to, by, turn, over, ..
            } => {
                let g = Goal {
                    to: *to,
                    by: *by,
                    turn: *turn,
                };
                goal("", &g).or_else(|| over.and_then(|s| seconds("`over`", s)))
            }
            Self::Both { left, right, over } => goal("left: ", left)
                .or_else(|| goal("right: ", right))
                .or_else(|| over.and_then(|s| seconds("`over`", s))),
            Self::Slide { to, over, .. } => on_pad(*to).or_else(|| seconds("`over`", *over)),
            Self::Touch(_, at) => on_pad(*at),
            Self::Wait(s) => seconds("Wait", *s),
            _ => None,
        }
    }
}

fn on_pad(at: Vec2) -> Option<String> {
    // NaN is not within either.
    let within = at.abs().cmple(Vec2::ONE).all();
    (!within).then(|| {
        format!(
            "({}, {}) is not on the pad: each axis is in [-1, 1]",
            at.x, at.y
        )
    })
}

/// Where a hand ends in [`Step::Both`]; a hand that says nothing stays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Goal {
    /// Where to, in the world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Vec3>,
    /// Where to, from where it is; instead of `to`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<Vec3>,
    /// How it is turned at the end; as it was where `None`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn: Option<Turn>,
}
