use glam::{DQuat, DVec3};

use crate::CubicBezier;

/// Where one end of a curve is held: a controller's pose, in metres.
///
/// The curve runs along the controller's own x axis (Hermite motion controller §3.1.1 Eq. 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// z of Eq. 1: where it is.
    pub position: DVec3,
    /// How it is turned; a unit quaternion.
    pub rotation: DQuat,
}

impl End {
    /// The unit direction the curve has there: Eq. 1's r.
    pub fn along(&self) -> DVec3 {
        self.rotation * DVec3::X
    }

    /// Whether every number is finite and the rotation is one.
    pub fn is_sound(&self) -> bool {
        self.position.is_finite() && self.rotation.is_finite() && self.rotation.is_normalized()
    }
}

/// A cubic Hermite curve: two points and the derivatives there (§3.1.2 Eq. 2–3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hermite {
    /// p₀ and p₁, metres.
    pub points: [DVec3; 2],
    /// m₀ and m₁, metres.
    pub tangents: [DVec3; 2],
}

impl Hermite {
    /// The curve between two controllers, its tangents of the given lengths (Eq. 9).
    pub fn between(left: &End, right: &End, lengths: [f64; 2]) -> Self {
        Self {
            points: [left.position, right.position],
            tangents: [left.along() * lengths[0], right.along() * lengths[1]],
        }
    }

    /// The curve that closes this one to a tube's profile: the same ends, tangents turned round
    /// (§3.2.2).
    #[must_use]
    pub fn closing(&self) -> Self {
        Self {
            tangents: self.tangents.map(|m| -m),
            ..*self
        }
    }

    /// s(u), metres, u in [0, 1].
    pub fn at(&self, u: f64) -> DVec3 {
        let [p0, p1] = self.points;
        let [m0, m1] = self.tangents;
        let (u2, u3) = (u * u, u * u * u);
        // As in errata.md: the paper's H₂ and H₃ are printed the other way round.
        p0 * (2.0 * u3 - 3.0 * u2 + 1.0)
            + m0 * (u3 - 2.0 * u2 + u)
            + p1 * (3.0 * u2 - 2.0 * u3)
            + m1 * (u3 - u2)
    }

    /// s′(u), metres.
    pub fn derivative(&self, u: f64) -> DVec3 {
        let [p0, p1] = self.points;
        let [m0, m1] = self.tangents;
        let u2 = u * u;
        (p1 - p0) * (6.0 * u - 6.0 * u2)
            + m0 * (3.0 * u2 - 4.0 * u + 1.0)
            + m1 * (3.0 * u2 - 2.0 * u)
    }

    /// Its length in metres, by Gauss and Legendre's rule on 16 pieces.
    pub fn length(&self) -> f64 {
        const PIECES: usize = 16;
        // Nodes and weights for three points on [−1, 1].
        let node = 0.6_f64.sqrt();
        let h = 1.0 / PIECES as f64;
        (0..PIECES)
            .map(|i| {
                let middle = (i as f64 + 0.5) * h;
                let speed = |x: f64| self.derivative(middle + 0.5 * h * x).length();
                0.5 * h * (5.0 * (speed(-node) + speed(node)) + 8.0 * speed(0.0)) / 9.0
            })
            .sum()
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        let all = self.points.iter().chain(&self.tangents);
        all.into_iter().all(|v| v.is_finite())
    }
}

impl From<Hermite> for CubicBezier {
    fn from(h: Hermite) -> Self {
        let [p0, p1] = h.points;
        let [m0, m1] = h.tangents;
        Self([p0, p0 + m0 / 3.0, p1 - m1 / 3.0, p1])
    }
}

/// The lengths of both tangents, adapted once a frame so that the curve's speed is nearly the same
/// everywhere (§3.1.8 Eq. 9–10).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lengths(pub [f64; 2]);

/// A tangent is never shorter than this, metres: without a direction there is no frame.
const SHORTEST: f64 = 1e-3;

impl Default for Lengths {
    /// c₀ = c₁ = 1, where the paper begins.
    fn default() -> Self {
        Self([1.0; 2])
    }
}

impl Lengths {
    /// Eq. 10, once: each length is multiplied by the speed in the middle over that at its end.
    ///
    /// At an end the speed is the length itself, so each becomes the speed in the middle; a change
    /// of one changes that by at most a quarter, so the lengths converge, whatever the hands do.
    pub fn adapt(&mut self, left: &End, right: &End) {
        let middle = Hermite::between(left, right, self.0)
            .derivative(0.5)
            .length();
        if middle.is_finite() {
            self.0 = [middle.max(SHORTEST); 2];
        }
    }

    /// Adapted until they no longer change, for hands that appear somewhere at once.
    pub fn settle(&mut self, left: &End, right: &End) {
        for _ in 0..40 {
            self.adapt(left, right);
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use proptest::prelude::*;

    use super::*;

    pub(crate) fn end() -> impl Strategy<Value = End> {
        let position = [-0.6..0.6f64, -0.6..0.6f64, -0.6..0.6f64];
        let turn = [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, 0.05..1.0f64];
        (position, turn).prop_map(|(p, [x, y, z, w])| End {
            position: DVec3::from_array(p),
            rotation: DQuat::from_xyzw(x, y, z, w).normalize(),
        })
    }

    proptest! {
        #[test]
        fn it_runs_from_hand_to_hand_along_their_axes(a in end(), b in end()) {
            let s = Hermite::between(&a, &b, [0.3, 0.7]);
            prop_assert!(s.at(0.0).distance(a.position) < 1e-12);
            prop_assert!(s.at(1.0).distance(b.position) < 1e-12);
            prop_assert!(s.derivative(0.0).distance(a.along() * 0.3) < 1e-12);
            prop_assert!(s.derivative(1.0).distance(b.along() * 0.7) < 1e-12);
            let bezier = CubicBezier::from(s);
            for i in 0..=8 {
                let u = f64::from(i) / 8.0;
                prop_assert!(s.at(u).distance(bezier.at(u)) < 1e-12);
                prop_assert!(s.derivative(u).distance(bezier.derivative(u)) < 1e-12);
            }
        }

        #[test]
        fn lengths_converge_whatever_the_hands_do(a in end(), b in end(), c in 0.0..9.0f64) {
            let mut lengths = Lengths([c, 1.0]);
            lengths.settle(&a, &b);
            let before = lengths;
            lengths.adapt(&a, &b);
            prop_assert!((lengths.0[0] - before.0[0]).abs() < 1e-9);
        }
    }

    #[test]
    fn level_hands_have_a_straight_line_of_even_speed_between_them() {
        let at = |x| End {
            position: DVec3::X * x,
            rotation: DQuat::IDENTITY,
        };
        let mut lengths = Lengths::default();
        lengths.settle(&at(-0.2), &at(0.3));
        let s = Hermite::between(&at(-0.2), &at(0.3), lengths.0);
        for i in 0..=10 {
            let u = f64::from(i) / 10.0;
            assert!((s.at(u).x - (0.5 * u - 0.2)).abs() < 1e-9);
        }
        assert!((s.length() - 0.5).abs() < 1e-9);
    }

    #[test]
    fn hands_at_one_point_keep_their_directions() {
        let here = End {
            position: DVec3::ONE,
            rotation: DQuat::IDENTITY,
        };
        let mut lengths = Lengths::default();
        lengths.settle(&here, &here);
        assert_eq!(lengths.0, [SHORTEST; 2]);
    }
}
