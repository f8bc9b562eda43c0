//! What `--hands-only` refuses: what hands cannot do.

use std::{sync::Arc, time::Duration};

use bevy::math::DVec3;
use midair_studio::hands::{HandsInput, Side};

use crate::{Beat, Place, Session};

/// The fastest a hand may be, in physical metres per second.
pub const MAX_SPEED: f64 = 2.0;
/// What rounding to 32 bits may add to a speed, as a part of it and in metres.
const ROUNDING: (f64, f64) = (1e-3, 1e-6);

/// Why hands could not have done it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HandsOnlyFault {
    /// A document-level edit.
    #[error("{at}: edits the document by name, which --hands-only refuses: no hand asks for it")]
    NotByHand {
        /// The step.
        at: Place,
    },
    /// Faster than [`MAX_SPEED`], or a jump.
    #[error(
        "{at}: at {seconds:.3} s the {hand} hand moves {way:.3} m within {within:.4} s; --hands-only \
         allows {MAX_SPEED} m/s"
    )]
    TooFast {
        /// The step.
        at: Place,
        /// Which hand.
        hand: &'static str,
        /// When, in session time.
        seconds: f64,
        /// How far it came, in physical metres.
        way: f64,
        /// In how many seconds.
        within: f64,
    },
    /// A pose that is none.
    #[error(
        "{at}: at {seconds:.3} s the {hand} hand's pose is not one (not finite, or its rotation \
         has no length); --hands-only refuses it"
    )]
    NoPose {
        /// The step.
        at: Place,
        /// Which hand.
        hand: &'static str,
        /// When, in session time.
        seconds: f64,
    },
}

/// Follows both hands and says when one is too fast. A hand that was lost is measured from where it
/// was last, over the time since: it cannot come back elsewhere at once.
#[derive(Clone, Debug, Default)]
pub struct SpeedGate {
    /// Where each was last, and how long ago.
    last: [Option<(DVec3, f64)>; 2],
    seconds: f64,
}

impl SpeedGate {
    /// Takes in one frame of the step at `at`.
    pub fn check(
        &mut self,
        dt: Duration,
        input: &HandsInput,
        at: impl Fn() -> Place,
    ) -> Result<(), HandsOnlyFault> {
        self.seconds += dt.as_secs_f64();
        let seconds = self.seconds;
        for side in Side::BOTH {
            let hand = match side {
                Side::Left => "left",
                Side::Right => "right",
            };
            let last = &mut self.last[side as usize];
            if let Some((_, since)) = last {
                *since += dt.as_secs_f64();
            }
            let Some(pose) = input.frames[side as usize].pose else {
                continue;
            };
            let here = pose.position.as_dvec3();
            let scale = f64::from(input.metres_per_world);
            if !pose.is_sound() || !scale.is_finite() || scale <= 0.0 {
                return Err(HandsOnlyFault::NoPose {
                    at: at(),
                    hand,
                    seconds,
                });
            }
            if let Some((before, within)) = *last {
                let way = here.distance(before) * scale;
                let most = MAX_SPEED * within * (1.0 + ROUNDING.0)
                    + ROUNDING.1 * (1.0 + here.length() * scale);
                if way > most {
                    return Err(HandsOnlyFault::TooFast {
                        at: at(),
                        hand,
                        seconds,
                        way,
                        within,
                    });
                }
            }
            *last = Some((here, 0.0));
        }
        Ok(())
    }
}

/// Whether hands alone could do the whole of `session`: goes through every frame of it.
pub fn check_hands_only(session: &Arc<Session>) -> Result<(), HandsOnlyFault> {
    if let Some(step) = session
        .steps()
        .iter()
        .position(|s| s.commands().iter().any(|c| !c.by_hand()))
    {
        return Err(HandsOnlyFault::NotByHand {
            at: session.place(step),
        });
    }
    let mut gate = SpeedGate::default();
    // The hands rest where they start: the first frame counts as a motion from there.
    gate.check(Duration::ZERO, &session.start(), || session.place(0))?;
    for beat in session.cursor() {
        if let Beat::Frame(frame) = beat {
            gate.check(frame.dt, &frame.input, || session.place(frame.step))?;
        }
    }
    Ok(())
}
