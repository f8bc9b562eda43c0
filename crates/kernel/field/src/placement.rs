use glam::{Affine3A, Quat, Vec3};
use midair_swept::Place;
use serde::{Deserialize, Serialize};

/// Where a thing stands: scaled, then turned, then moved. Scale may differ per axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Placement {
    /// Metres.
    pub translation: Vec3,
    /// A unit quaternion.
    pub rotation: Quat,
    /// Factors along the thing's own axes; never zero.
    pub scale: Vec3,
}

impl Placement {
    /// Leaves everything where it is.
    pub const IDENTITY: Self = Self {
        translation: Vec3::ZERO,
        rotation: Quat::IDENTITY,
        scale: Vec3::ONE,
    };

    /// Moved only.
    pub const fn at(translation: Vec3) -> Self {
        Self {
            translation,
            ..Self::IDENTITY
        }
    }

    /// As a matrix.
    pub fn affine(&self) -> Affine3A {
        Affine3A::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }

    /// Whether every number is finite and no scale is zero.
    pub fn is_sound(&self) -> bool {
        self.translation.is_finite()
            && self.rotation.is_finite()
            && self.rotation.is_normalized()
            && self.scale.is_finite()
            && self.scale.cmpne(Vec3::ZERO).all()
    }
}

/// Where a clone of a row stands.
impl From<&Place> for Placement {
    fn from(place: &Place) -> Self {
        Self {
            translation: place.translation,
            rotation: place.rotation,
            scale: Vec3::splat(place.scale),
        }
    }
}

impl Default for Placement {
    fn default() -> Self {
        Self::IDENTITY
    }
}
