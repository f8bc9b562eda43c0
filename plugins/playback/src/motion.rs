//! How a hand gets from one pose to another.

use bevy::math::{Quat, Vec3};
use midair_studio::hands::Pose;

/// The part of a motion spent speeding up, and again slowing down.
const RAMP: f64 = 0.25;
/// Peak speed over mean speed.
const PEAK: f64 = 1.0 / (1.0 - RAMP);
/// The peak speed of a motion that names no time, in m/s and rad/s.
const CALM: f64 = 0.8;
const CALM_TURN: f64 = 3.0;
/// The shortest motion that names no time, in seconds.
const SHORTEST: f64 = 0.1;

/// How much of the way is done after `u` ∈ [0, 1] of the time: constant acceleration, constant
/// speed, constant braking. The peak speed is 4/3 of the mean.
pub(crate) fn ease(u: f64) -> f64 {
    if u < RAMP {
        PEAK * u * u / (2.0 * RAMP)
    } else if u > 1.0 - RAMP {
        1.0 - PEAK * (1.0 - u) * (1.0 - u) / (2.0 * RAMP)
    } else {
        PEAK * (u - RAMP / 2.0)
    }
}

/// The pose after `u` of the time from `a` to `b`; exactly `b` at 1.
pub(crate) fn between(a: &Pose, b: &Pose, u: f64) -> Pose {
    if u >= 1.0 {
        return *b;
    }
    let s = ease(u);
    let position = a
        .position
        .as_dvec3()
        .lerp(b.position.as_dvec3(), s)
        .as_vec3();
    // A turn that is not asked for keeps every bit.
    let rotation = if a.rotation == b.rotation {
        b.rotation
    } else {
        a.rotation.slerp(b.rotation, s as f32).normalize()
    };
    Pose { position, rotation }
}

/// Seconds for a motion that names none: at most 0.8 m/s and 3 rad/s.
pub(crate) fn calm_seconds(from: (Vec3, Quat), to: (Vec3, Quat)) -> f64 {
    let way = from.0.as_dvec3().distance(to.0.as_dvec3());
    let angle = f64::from(from.1.angle_between(to.1));
    (way * PEAK / CALM)
        .max(angle * PEAK / CALM_TURN)
        .max(SHORTEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn easing_is_smooth_monotonic_and_bounded() {
        assert_eq!(ease(0.0), 0.0);
        assert_eq!(ease(1.0), 1.0);
        let n = 1000;
        let mut last = 0.0;
        for i in 1..=n {
            let s = ease(f64::from(i) / f64::from(n));
            let speed = (s - last) * f64::from(n);
            assert!(speed > 0.0 && speed <= PEAK + 1e-9, "{speed} at {i}");
            last = s;
        }
    }
}
