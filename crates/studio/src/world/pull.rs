//! Two hands that pull the world: what they hold stays between them.

use bevy::math::{Quat, Vec3};

use super::{RANGE, Similarity};

/// Hands nearer than this (physical metres) say nothing about scale or turn.
const LEAST_APART: f32 = 1e-3;
/// Of the distance of the hands: below this across the floor, they do not turn an upright world.
const LEVEL: f32 = 0.2;

/// Both hands on the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldPull {
    /// How the world stood when they took hold.
    start: Similarity,
    left: Vec3,
    right: Vec3,
}

impl WorldPull {
    /// Takes hold with hands at these points of the room.
    pub fn new(start: Similarity, left: Vec3, right: Vec3) -> Self {
        Self { start, left, right }
    }

    /// How the world stands when the hands are at these points of the room. Its scale stays within
    /// [`RANGE`]; unless it may `tilt`, it stays upright.
    pub fn world(&self, left: Vec3, right: Vec3, tilt: bool) -> Similarity {
        let (from, to) = (self.right - self.left, right - left);
        let far = from.length().max(LEAST_APART);
        let scale = (to.length().max(LEAST_APART) / far).clamp(
            RANGE.start() / self.start.scale,
            RANGE.end() / self.start.scale,
        );
        let rotation = if tilt {
            arc(from, to)
        } else {
            let (a, b) = (from.with_y(0.0), to.with_y(0.0));
            let level = |flat: Vec3, whole: Vec3| flat.length() > LEVEL * whole.length();
            if level(a, from) && level(b, to) {
                arc(a, b)
            } else {
                Quat::IDENTITY
            }
        };
        let pull = Similarity {
            scale,
            rotation,
            translation: left.midpoint(right) - rotation * (self.left.midpoint(self.right) * scale),
        };
        let world = pull.after(&self.start);
        if world.is_sound() { world } else { self.start }
    }
}

fn arc(from: Vec3, to: Vec3) -> Quat {
    match (from.try_normalize(), to.try_normalize()) {
        (Some(a), Some(b)) => Quat::from_rotation_arc(a, b),
        _ => Quat::IDENTITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const L: Vec3 = Vec3::new(-0.2, 1.0, -0.3);
    const R: Vec3 = Vec3::new(0.2, 1.0, -0.3);

    #[test]
    fn what_the_hands_hold_stays_in_them() {
        let pull = WorldPull::new(Similarity::IDENTITY, L, R);
        let (l, r) = (Vec3::new(-0.3, 1.2, 0.1), Vec3::new(0.1, 1.2, -0.3));
        let world = pull.world(l, r, false);
        assert!(world.point(L).distance(l) < 1e-5);
        assert!(world.point(R).distance(r) < 1e-5);
    }

    #[test]
    fn it_stays_upright_unless_it_may_tilt() {
        let pull = WorldPull::new(Similarity::IDENTITY, L, R);
        let (l, r) = (L + 0.15 * Vec3::Y, R - 0.15 * Vec3::Y);
        let world = pull.world(l, r, false);
        assert!((world.rotation * Vec3::Y).distance(Vec3::Y) < 1e-5);
        assert!(world.point(L.midpoint(R)).distance(l.midpoint(r)) < 1e-5);
        let tilted = pull.world(l, r, true);
        assert!((tilted.rotation * Vec3::Y).distance(Vec3::Y) > 0.3);
        assert!(tilted.point(L).distance(l) < 1e-5);
    }

    #[test]
    fn the_scale_stays_in_its_range() {
        let pull = WorldPull::new(Similarity::IDENTITY, L, R);
        let out = pull.world(
            L * Vec3::new(90.0, 1.0, 1.0),
            R * Vec3::new(90.0, 1.0, 1.0),
            false,
        );
        assert!((out.scale - 10.0).abs() < 1e-4);
        let again = WorldPull::new(out, L, R);
        let further = again.world(2.0 * L, 2.0 * R, false);
        assert!((further.scale - 10.0).abs() < 1e-4);
        let back = pull.world(L.midpoint(R), L.midpoint(R), false);
        assert!((back.scale - 0.1).abs() < 1e-4);
    }

    #[test]
    fn hands_that_are_nowhere_leave_it_as_it_was() {
        let pull = WorldPull::new(Similarity::IDENTITY, L, R);
        for nowhere in [Vec3::NAN, Vec3::INFINITY] {
            assert_eq!(pull.world(nowhere, R, true), Similarity::IDENTITY);
        }
        assert!(pull.world(L, L, false).is_sound());
    }
}
