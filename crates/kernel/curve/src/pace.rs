/// Where along a curve its evenly counted points lie: v(u), a cubic with v(0) = 0, v(1) = 1 and the
/// given slopes at its ends (Hermite motion controller §3.1.9 Eq. 11, as in errata.md).
///
/// The curve keeps its shape. A slope below 1 gathers points at that end, one above thins them out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// w₀ and w₁, each in [`Pace::RANGE`].
    pub slopes: [f64; 2],
}

impl Default for Pace {
    /// w₀ = w₁ = 1: v(u) = u.
    fn default() -> Self {
        Self { slopes: [1.0; 2] }
    }
}

impl Pace {
    /// The slopes for which v never runs backwards.
    pub const RANGE: (f64, f64) = (0.0, 3.0);

    /// With slopes brought into their range; what is no number counts as 1.
    pub fn new(slopes: [f64; 2]) -> Self {
        let (low, high) = Self::RANGE;
        let fit = |w: f64| {
            if w.is_finite() {
                w.clamp(low, high)
            } else {
                1.0
            }
        };
        Self {
            slopes: slopes.map(fit),
        }
    }

    /// v(u).
    pub fn at(&self, u: f64) -> f64 {
        let [w0, w1] = self.slopes;
        let (u2, u3) = (u * u, u * u * u);
        w0 * (u3 - 2.0 * u2 + u) + (3.0 * u2 - 2.0 * u3) + w1 * (u3 - u2)
    }

    /// v′(u).
    pub fn derivative(&self, u: f64) -> f64 {
        let [w0, w1] = self.slopes;
        let u2 = u * u;
        w0 * (3.0 * u2 - 4.0 * u + 1.0) + 6.0 * (u - u2) + w1 * (3.0 * u2 - 2.0 * u)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn it_runs_forwards_from_0_to_1(w0 in -1.0..4.0f64, w1 in -1.0..4.0f64) {
            let pace = Pace::new([w0, w1]);
            prop_assert_eq!((pace.at(0.0), pace.at(1.0)), (0.0, 1.0));
            for i in 0..200 {
                let (a, b) = (f64::from(i) / 200.0, f64::from(i + 1) / 200.0);
                prop_assert!(pace.at(b) >= pace.at(a) - 1e-12, "{} {} {}", w0, w1, a);
                let slope = (pace.at(b) - pace.at(a)) * 200.0;
                prop_assert!((slope - pace.derivative(0.5 * (a + b))).abs() < 1e-3);
            }
        }
    }

    #[test]
    fn slopes_of_1_change_nothing() {
        for i in 0..=16 {
            let u = f64::from(i) / 16.0;
            assert!((Pace::default().at(u) - u).abs() < 1e-15);
        }
        assert_eq!(Pace::new([f64::NAN, 9.0]).slopes, [1.0, 3.0]);
    }
}
