use std::f32::consts::{FRAC_PI_2, PI, TAU};

use super::round::{greater, lesser};

/// A tube around the curve (R cos t, c·t, R sin t), |t| ≤ `end`.
///
/// The squared distance to the curve is (ρ − R)² + 4ρR sin²((t − θ)/2) + c²(t − t₀)² for a point at
/// (ρ, θ, y) with t₀ = y/c. Its least value lies between the two angles t ≡ θ on either side of t₀;
/// from each of them the stationarity condition is concave, so that Newton's method rises to its
/// first root and never passes it. Where there is none, the iterate stops at an upper bound that
/// loses against the other side or an end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Helix {
    major: f32,
    minor: f32,
    /// Rise per radian.
    rise: f32,
    /// −1 winds the other way.
    hand: f32,
    end: f32,
}

impl Helix {
    pub fn new(major: f32, minor: f32, pitch: f32, turns: f32) -> Self {
        Self {
            major,
            minor,
            rise: pitch.abs() / TAU,
            hand: pitch.signum(),
            end: PI * turns,
        }
    }

    /// Major and minor radius, rise per radian, hand, end.
    pub fn numbers(&self) -> [f32; 5] {
        [self.major, self.minor, self.rise, self.hand, self.end]
    }

    #[inline(always)]
    pub fn at(&self, x: f32, y: f32, z: f32) -> f32 {
        let z = z * self.hand;
        let away = super::round::hypot(x, z);
        let angle = libm::atan2f(z, x);
        let (c2, pull) = (self.rise * self.rise, away * self.major);
        let level = y / self.rise;
        // The last turn of the angle below the level, or the last that touches the curve.
        let turn = |t: f32| ((t - angle) / TAU).floor();
        let k = lesser(greater(turn(level), turn(-self.end)), turn(self.end));
        let below = angle + k * TAU;
        let gap = level - below;
        let near = (away - self.major) * (away - self.major);
        let square = |u: f32| {
            // u is measured from an angle θ, so that nothing cancels.
            let u = lesser(greater(u, -self.end - below), self.end - below);
            let s = sin_half(u);
            near + 4.0 * pull * s * s + c2 * (u - gap) * (u - gap)
        };
        let up = square(root(gap, pull, c2));
        let down = square(TAU - root(TAU - gap, pull, c2));
        let ends = lesser(square(-self.end - below), square(self.end - below));
        lesser(lesser(up, down), ends).sqrt() - self.minor
    }
}

/// The first root in 0..π of pull·sin u − c²(s − u), or where the search stopped.
#[inline(always)]
fn root(s: f32, pull: f32, c2: f32) -> f32 {
    let mut u = 0.0f32;
    for _ in 0..8 {
        // sin u = cos v, cos u = −sin v.
        let v = u - FRAC_PI_2;
        let value = pull * cosine(v) - c2 * (s - u);
        let slope = c2 - pull * sine(v);
        let step = -value / greater(slope, 1.0e-12);
        u = lesser(greater(u + step, 0.0), PI);
    }
    u
}

/// |sin(u/2)| for |u| up to 2π and more: exact enough and the same on every machine.
#[inline(always)]
fn sin_half(u: f32) -> f32 {
    // Folded to −π/2..π/2 by the nearest multiple of π.
    let h = 0.5 * u;
    let n = (h * (1.0 / PI)).round_ties_even();
    sine(h - n * PI)
}

/// sin v for |v| ≤ π/2, to 2e-7.
#[inline(always)]
fn sine(v: f32) -> f32 {
    let q = v * v;
    let p = 2.604_1e-6;
    let p = p * q - 1.980_742e-4;
    let p = p * q + 8.333_025e-3;
    let p = p * q - 1.666_665_7e-1;
    v + v * q * p
}

/// cos v for |v| ≤ π/2, to 4e-7.
#[inline(always)]
fn cosine(v: f32) -> f32 {
    let q = v * v;
    let p = -2.605e-7;
    let p = p * q + 2.476_09e-5;
    let p = p * q - 1.388_839_7e-3;
    let p = p * q + 4.166_664e-2;
    1.0 - 0.5 * q + q * q * p
}
