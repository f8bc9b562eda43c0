//! A motion that may also scale.

use bevy::math::{Quat, Vec3};

use crate::hands::Pose;

/// Scaled, turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    /// The factor, above 0.
    pub scale: f32,
    /// A unit quaternion.
    pub rotation: Quat,
    /// Metres.
    pub translation: Vec3,
}

impl Similarity {
    /// Leaves everything where it is.
    pub const IDENTITY: Self = Self {
        scale: 1.0,
        rotation: Quat::IDENTITY,
        translation: Vec3::ZERO,
    };

    /// Where a point goes.
    pub fn point(&self, point: Vec3) -> Vec3 {
        self.rotation * (point * self.scale) + self.translation
    }

    /// Where a pose goes.
    pub fn pose(&self, pose: &Pose) -> Pose {
        Pose {
            position: self.point(pose.position),
            rotation: (self.rotation * pose.rotation).normalize(),
        }
    }

    /// The way back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.inverse();
        let scale = 1.0 / self.scale;
        Self {
            scale,
            rotation,
            translation: rotation * (-self.translation * scale),
        }
    }

    /// First `first`, then this one.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self {
            scale: self.scale * first.scale,
            rotation: (self.rotation * first.rotation).normalize(),
            translation: self.point(first.translation),
        }
    }

    /// Whether every number is one to work with.
    pub fn is_sound(&self) -> bool {
        self.scale.is_finite()
            && self.scale > 0.0
            && self.rotation.is_normalized()
            && self.translation.is_finite()
    }
}
