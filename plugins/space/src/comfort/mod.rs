//! What keeps a person well in a headset: turns in steps, a narrower view while the world moves, the time of a frame.

mod budget;
mod steer;
mod vignette;

pub(crate) use budget::{Pace, begin, end, tell};
pub(crate) use steer::{Grips, steer};
pub(crate) use vignette::darken;
