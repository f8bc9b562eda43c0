//! One hand moves and turns what it holds.

use bevy::math::{Affine3A, Vec3};
use midair_field::Placement;

use crate::hands::Pose;

/// A rigid hold: the object keeps its place in the hand's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// The object in the hand's frame, without its scale.
    grip: Affine3A,
    scale: Vec3,
}

impl Hold {
    /// Takes hold of what stands at `placement` with a hand at `hand`.
    pub fn new(hand: &Pose, placement: &Placement) -> Self {
        let object = Affine3A::from_rotation_translation(placement.rotation, placement.translation);
        Self {
            grip: hand.affine().inverse() * object,
            scale: placement.scale,
        }
    }

    /// Where the object stands when the hand is at `hand`.
    pub fn placement(&self, hand: &Pose) -> Placement {
        let object = hand.affine() * self.grip;
        let (_, rotation, translation) = object.to_scale_rotation_translation();
        Placement {
            translation,
            // Products of many frames drift off the unit sphere.
            rotation: rotation.normalize(),
            scale: self.scale,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Quat;
    use std::f32::consts::FRAC_PI_2;

    #[test]
    fn a_held_object_keeps_its_place_in_the_hand() {
        let hand = Pose::at(Vec3::new(0.1, 1.0, 0.0));
        let placement = Placement {
            scale: Vec3::new(2.0, 1.0, 0.5),
            ..Placement::at(Vec3::new(0.1, 1.2, 0.0))
        };
        let hold = Hold::new(&hand, &placement);
        assert_eq!(hold.placement(&hand).scale, placement.scale);
        let turned = Pose {
            rotation: Quat::from_rotation_z(FRAC_PI_2),
            ..hand
        };
        let moved = hold.placement(&turned);
        assert!(moved.translation.distance(Vec3::new(-0.1, 1.0, 0.0)) < 1e-6);
        assert!(moved.rotation.angle_between(turned.rotation) < 1e-3);
    }
}
