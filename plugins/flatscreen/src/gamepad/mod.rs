//! The gamepad as two hands: one leads, the other stays where it is and keeps what it holds.
//!
//! | held | left stick | right stick |
//! |---|---|---|
//! | – | leading hand right and up | orbit around the leading hand |
//! | LT | its depth and roll | its yaw and pitch |
//! | LB | pan | orbit around the middle |
//!
//! In a mode that leads both hands at once ([`Aim::both`](midair_studio::tools::Aim::both)) the bare right
//! stick moves the other hand right and up instead, beginning beside the leading one.

mod camera;
mod hands;
mod lead;
mod rumble;

use bevy::prelude::*;
use midair_studio::{
    hands::{HOLD, Pose, Side},
    world::Similarity,
};

pub(crate) use camera::camera;
pub(crate) use hands::hands;
pub(crate) use lead::lead;
pub(crate) use rumble::rumble;

/// What the gamepad does with the two hands.
#[derive(Resource, Clone, Debug)]
pub struct Pad {
    /// Whether the hands are the gamepad's and not the pointer's.
    leads: bool,
    /// Which hand the sticks move.
    leading: Side,
    poses: [Pose; 2],
    /// The leading hand grips.
    grips: bool,
    /// Which hands hold on although no button is down.
    latched: [bool; 2],
    /// Which hands held on in the frame before: they let go where they are.
    held: [bool; 2],
    /// How the leading hand is turned against the camera while it is empty.
    turn: Quat,
    /// The other hand was moved by its own stick, and is where that left it.
    out: bool,
    swap: Swap,
    /// Components that were picked and not placed yet.
    pub(crate) picked: Vec<String>,
    /// The view is to show the work.
    pub(crate) frame: bool,
    /// There was a gamepad in the frame before.
    connected: bool,
}

impl Default for Pad {
    fn default() -> Self {
        Self {
            leads: false,
            leading: Side::Right,
            poses: [Pose::default(); 2],
            grips: false,
            latched: [false; 2],
            held: [false; 2],
            turn: Quat::IDENTITY,
            out: false,
            swap: Swap::default(),
            picked: Vec::new(),
            frame: false,
            connected: false,
        }
    }
}

impl Pad {
    /// Whether the hands are the gamepad's.
    pub fn leads(&self) -> bool {
        self.leads
    }

    /// Which hand the sticks move.
    pub fn leading(&self) -> Side {
        self.leading
    }

    /// Where a hand is.
    pub fn pose(&self, side: Side) -> Pose {
        self.poses[side as usize]
    }

    /// Whether a hand holds on although no button is down.
    pub fn is_latched(&self, side: Side) -> bool {
        self.latched[side as usize]
    }

    /// The world was moved: the hands stay where they are in the room.
    pub(crate) fn go_along(&mut self, by: &Similarity) {
        self.poses = self.poses.map(|pose| by.pose(&pose));
    }

    /// Whether a hand holds something, or has let go in this frame.
    pub fn holds(&self) -> bool {
        self.grips || self.latched.contains(&true) || self.held.contains(&true)
    }
}

/// One button that is tapped or held.
#[derive(Clone, Copy, Debug, Default)]
struct Swap {
    /// Seconds since it went down.
    down: Option<f32>,
}

/// What came of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pressed {
    Nothing,
    Tapped,
    Held,
}

impl Swap {
    fn advance(&mut self, down: bool, dt: f32) -> Pressed {
        match (self.down, down) {
            (None, true) => self.down = Some(0.0),
            (Some(before), true) => {
                self.down = Some(before + dt);
                // Once, in the frame in which it has been held for long enough.
                if before < HOLD && before + dt >= HOLD {
                    return Pressed::Held;
                }
            }
            (Some(held), false) => {
                self.down = None;
                if held < HOLD {
                    return Pressed::Tapped;
                }
            }
            (None, false) => {}
        }
        Pressed::Nothing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_button_is_tapped_or_held_at_any_frame_rate() {
        for dt in [1.0 / 30.0, 1.0 / 90.0, 0.2] {
            let mut swap = Swap::default();
            assert_eq!(swap.advance(true, dt), Pressed::Nothing);
            assert_eq!(swap.advance(false, dt), Pressed::Tapped);
            let mut held = 0;
            swap.advance(true, dt);
            for _ in 0..200 {
                held += usize::from(swap.advance(true, dt) == Pressed::Held);
            }
            assert_eq!(held, 1);
            assert_eq!(swap.advance(false, dt), Pressed::Nothing);
        }
    }
}
