use std::sync::Arc;

use glam::{Quat, Vec3};
use midair_curve::Even;
use serde::{Deserialize, Serialize};

use crate::{Rib, SweepError};

/// The most clones of one row.
pub const MAX_CLONES: usize = 131_072;

/// Where clones stand: along one rib, or over all of them (§3.2.3).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The curves they stand on.
    pub ribs: Arc<[Rib]>,
    /// How many stand on each.
    pub count: u32,
    /// The factor on what is cloned.
    pub size: f32,
    /// Clones that stand closer are smaller: by v′(u).
    #[serde(default = "yes", skip_serializing_if = "Clone::clone")]
    pub paced: bool,
}

fn yes() -> bool {
    true
}

/// One clone's place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Metres.
    pub translation: Vec3,
    /// As the frame along the curve is turned there.
    pub rotation: Quat,
    /// The factor on what is cloned; never zero.
    pub scale: f32,
}

/// No clone is smaller than this part of its size.
const SMALLEST: f32 = 0.02;

impl Row {
    /// How many clones there are.
    pub fn len(&self) -> usize {
        self.ribs.len().saturating_mul(self.count as usize)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether its numbers are sound.
    ///
    /// # Errors
    /// [`SweepError`].
    pub fn validate(&self) -> Result<(), SweepError> {
        if self.ribs.is_empty() || self.count == 0 {
            return Err(SweepError::NoClones);
        }
        if self.len() > MAX_CLONES {
            return Err(SweepError::TooManyClones(self.len()));
        }
        if !(self.size.is_finite() && self.size > 0.0 && self.size <= 1.0e4) {
            return Err(SweepError::Size);
        }
        match self.ribs.iter().position(|r| !r.is_sound()) {
            Some(at) => Err(SweepError::Rib(at + 1)),
            None => Ok(()),
        }
    }

    /// Where they stand, rib by rib from left to right.
    pub fn places(&self) -> Vec<Place> {
        let mut places = Vec::with_capacity(self.len().min(MAX_CLONES));
        for rib in self.ribs.iter() {
            let (curve, pace, frames) = (rib.curve(), rib.pace(), rib.frames());
            let even = Even::new(&curve);
            for i in 0..self.count {
                let u = match self.count {
                    1 => 0.5,
                    n => f64::from(i) / f64::from(n - 1),
                };
                let v = even.at(pace.at(u));
                // Counted along its length the curve has one speed, and what is left of it is v′(u).
                let factor = if self.paced {
                    pace.derivative(u) as f32
                } else {
                    1.0
                };
                places.push(Place {
                    translation: curve.at(v).as_vec3(),
                    rotation: glam::DQuat::from_mat3(&frames.at(v)).as_quat().normalize(),
                    scale: self.size * factor.clamp(SMALLEST, 1.0e3),
                });
                if places.len() >= MAX_CLONES {
                    return places;
                }
            }
        }
        places
    }
}
