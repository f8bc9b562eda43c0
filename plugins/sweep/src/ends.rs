//! Where the two ends of the curve are: in hands, pinned, on rails, on springs.

use bevy::math::{DQuat, DVec3, Vec3};
use bevy::prelude::Quat;
use midair_curve::{End, Polyline};
use midair_document::ObjectId;
use midair_studio::hands::{Hand, Pose};

/// As the curve sees a hand.
pub(crate) fn end(pose: &Pose) -> End {
    End {
        position: pose.position.as_dvec3(),
        rotation: pose.rotation.as_dquat().normalize(),
    }
}

/// As a hand would be that holds this end.
pub(crate) fn pose(end: &End) -> Pose {
    Pose {
        position: end.position.as_vec3(),
        rotation: end.rotation.as_quat().normalize(),
    }
}

/// Whether a hand holds anything: one at rest hangs behind the eyes.
pub(crate) fn is_there(hand: &Hand, head: Option<Pose>) -> bool {
    let ahead = |h: Pose| (h.rotation * Vec3::NEG_Z).dot(hand.pose.position - h.position) > 0.0;
    hand.tracked && head.is_none_or(ahead)
}

/// A stroke that an end follows: what it was when it was taken, beside what it is called.
#[derive(Clone, Debug, PartialEq)]
pub struct Rail {
    /// The stroke it was taken from.
    pub object: ObjectId,
    /// Its points in the world.
    pub line: Polyline,
}

impl Rail {
    /// The end brought onto the stroke, as the hand turns it.
    pub fn onto(&self, end: &End) -> End {
        let nearest = self.line.at(self.line.nearest(end.position));
        End {
            position: nearest.unwrap_or(end.position),
            ..*end
        }
    }
}

/// An end that hangs on a spring from its hand, so that it lags, swings and sinks a little.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spring {
    at: Option<(End, DVec3)>,
}

/// Per second squared: with it an end swings three times a second.
const STIFF: f64 = 380.0;
/// Per second: it comes to rest within a second.
const DAMPING: f64 = 9.0;
/// Metres per second squared.
const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);
/// Seconds of one step of its motion.
const STEP: f64 = 1.0 / 480.0;

impl Spring {
    /// Where the end is `dt` seconds later with its hand at `to`; `scale` is metres of world in a
    /// physical one.
    pub fn follow(&mut self, to: &End, dt: f64, scale: f64) -> End {
        let (mut end, mut speed) = self.at.unwrap_or((*to, DVec3::ZERO));
        let dt = if dt.is_finite() {
            dt.clamp(0.0, 0.1)
        } else {
            0.0
        };
        let steps = (dt / STEP).ceil().max(1.0);
        let h = dt / steps;
        for _ in 0..steps as usize {
            let pull = (to.position - end.position) * STIFF - speed * DAMPING + GRAVITY * scale;
            speed += pull * h;
            end.position += speed * h;
        }
        // It turns after the hand without swinging: a curve whose ends reel cannot be aimed.
        let share = 1.0 - (-dt * 14.0).exp();
        end.rotation = DQuat::slerp(end.rotation, to.rotation, share).normalize();
        if !end.is_sound() {
            end = *to;
            speed = DVec3::ZERO;
        }
        self.at = Some((end, speed));
        end
    }
}

/// An end at `position` from which the curve runs along `direction`, upright as far as that goes.
pub(crate) fn aimed(position: Vec3, direction: Vec3) -> End {
    let x = direction.normalize_or(Vec3::X);
    let up = if x.y.abs() > 0.99 { Vec3::Z } else { Vec3::Y };
    let z = x.cross(up).normalize_or(Vec3::Z);
    let y = z.cross(x);
    let turned = Quat::from_mat3(&bevy::math::Mat3::from_cols(x, y, z)).normalize();
    End {
        position: position.as_dvec3(),
        rotation: turned.as_dquat().normalize(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_runs_along_its_rail() {
        let rail = Rail {
            object: ObjectId(1),
            line: Polyline::new([DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y]),
        };
        let held = |p: DVec3| End {
            position: p,
            rotation: DQuat::IDENTITY,
        };
        let on = |p: DVec3| rail.onto(&held(p)).position;
        let near = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-12, "{a} is not {b}");
        near(on(DVec3::new(0.4, 0.3, 0.2)), DVec3::X * 0.4);
        near(on(DVec3::new(2.0, 0.5, 0.0)), DVec3::new(1.0, 0.5, 0.0));
        assert_eq!(on(DVec3::splat(-1.0)), DVec3::ZERO);
    }

    #[test]
    fn a_spring_comes_to_rest_a_little_below_the_hand() {
        let mut spring = Spring::default();
        let at = |y: f64| End {
            position: DVec3::Y * y,
            rotation: DQuat::IDENTITY,
        };
        spring.follow(&at(0.0), 1.0 / 90.0, 1.0);
        let lags = spring.follow(&at(0.3), 1.0 / 90.0, 1.0).position.y;
        assert!(lags < 0.1, "{lags}");
        let mut end = at(0.3);
        for _ in 0..900 {
            end = spring.follow(&at(0.3), 1.0 / 90.0, 1.0);
        }
        let below = 0.3 - end.position.y;
        assert!((below - 9.81 / STIFF).abs() < 1e-4, "{below}");
        assert!(spring.follow(&at(f64::NAN), 1.0, 1.0).position.is_nan());
    }

    #[test]
    fn an_aimed_end_runs_where_it_is_aimed() {
        for d in [Vec3::X, Vec3::Y, Vec3::NEG_Y, Vec3::new(1.0, 2.0, -0.5)] {
            let end = aimed(Vec3::ONE, d);
            assert!(end.along().as_vec3().distance(d.normalize()) < 1e-6);
            assert!(end.is_sound());
        }
    }
}
