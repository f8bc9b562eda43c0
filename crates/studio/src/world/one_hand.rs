//! One hand that pulls the world: it goes along and turns about the vertical.

use bevy::math::Quat;

use super::Similarity;
use crate::hands::Pose;

/// One hand on the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneHandPull {
    /// How the world stood when it took hold, seen from the hand.
    hand_from_world: Similarity,
    start: Similarity,
}

impl OneHandPull {
    /// Takes hold with a hand at this pose of the room.
    pub fn new(start: Similarity, hand: Pose) -> Self {
        Self {
            hand_from_world: upright(hand).inverse().after(&start),
            start,
        }
    }

    /// How the world stands when the hand is at this pose of the room: upright as it was, at its size.
    pub fn world(&self, hand: Pose) -> Similarity {
        // Scaled by the stick meanwhile or not: the size is the start's.
        let world = upright(hand).after(&self.hand_from_world);
        if hand.is_sound() && world.is_sound() {
            world
        } else {
            self.start
        }
    }
}

/// The hand's place, turned as it is about the vertical alone.
fn upright(hand: Pose) -> Similarity {
    let twist = Quat::from_xyzw(0.0, hand.rotation.y, 0.0, hand.rotation.w);
    Similarity {
        scale: 1.0,
        // A hand that is upside down says nothing of the vertical.
        rotation: if twist.length_squared() > 1e-6 {
            twist.normalize()
        } else {
            Quat::IDENTITY
        },
        translation: hand.position,
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::{EulerRot, Vec3};

    use super::*;

    fn hand(at: Vec3, yaw: f32, pitch: f32) -> Pose {
        Pose {
            position: at,
            rotation: Quat::from_euler(EulerRot::YXZ, yaw, pitch, 0.0),
        }
    }

    #[test]
    fn what_the_hand_holds_stays_in_it_and_the_world_stays_upright() {
        let from = hand(Vec3::new(0.1, 1.0, -0.3), 0.2, 0.1);
        let pull = OneHandPull::new(Similarity::IDENTITY, from);
        let to = hand(Vec3::new(-0.2, 1.3, 0.1), 1.0, -0.4);
        let world = pull.world(to);
        assert!(world.point(from.position).distance(to.position) < 1e-5);
        assert!((world.rotation * Vec3::Y).distance(Vec3::Y) < 1e-5);
        assert!((world.rotation * Vec3::X).distance(Vec3::X) > 0.3);
        assert_eq!(pull.world(hand(Vec3::NAN, 0.0, 0.0)), Similarity::IDENTITY);
    }
}
