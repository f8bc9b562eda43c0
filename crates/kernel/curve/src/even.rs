use glam::DVec3;

use crate::Hermite;

/// Straight pieces that a curve is measured in.
const PIECES: usize = 96;

/// Where along a curve a share of its length lies.
///
/// Eq. 10 gives a curve the same speed at its ends and in the middle, which is all that two lengths
/// can do. Between those s′ runs along a parabola: where the hands are turned so far that s′ swings
/// round by a right angle and more, it cuts through the sphere of that speed, and the curve slows
/// down there. So points that are to be even are counted along its length.
///
/// Exact at both ends and monotone; between them the length is measured in 96 chords.
#[derive(Clone, Debug, PartialEq)]
pub struct Even {
    /// The share of the length up to the end of each piece.
    along: [f64; PIECES + 1],
}

impl Even {
    /// Measures a curve. One without length is even as it is.
    pub fn new(curve: &Hermite) -> Self {
        let mut along = [0.0; PIECES + 1];
        let (mut before, mut length): (DVec3, f64) = (curve.points[0], 0.0);
        for (i, share) in along.iter_mut().enumerate().skip(1) {
            let here = curve.at(i as f64 / PIECES as f64);
            length += here.distance(before);
            *share = length;
            before = here;
        }
        if length > 1e-12 && length.is_finite() {
            along.iter_mut().for_each(|s| *s /= length);
        } else {
            for (i, share) in along.iter_mut().enumerate() {
                *share = i as f64 / PIECES as f64;
            }
        }
        Self { along }
    }

    /// u where the curve has run a share of its length, from 0 to 1.
    pub fn at(&self, share: f64) -> f64 {
        let after = self.along.partition_point(|&s| s < share);
        if after == 0 {
            return 0.0;
        }
        if after > PIECES {
            return 1.0;
        }
        let (from, to) = (self.along[after - 1], self.along[after]);
        let within = (share - from) / (to - from).max(f64::MIN_POSITIVE);
        (after as f64 - 1.0 + within) / PIECES as f64
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::Lengths;
    use crate::hermite::tests::end;

    proptest! {
        #[test]
        fn it_runs_forwards_over_even_steps(a in end(), b in end()) {
            let mut lengths = Lengths::default();
            lengths.settle(&a, &b);
            let curve = Hermite::between(&a, &b, lengths.0);
            let even = Even::new(&curve);
            prop_assert_eq!((even.at(0.0), even.at(1.0)), (0.0, 1.0));
            let us: Vec<f64> = (0..=400).map(|i| even.at(f64::from(i) / 400.0)).collect();
            prop_assert!(us.windows(2).all(|u| u[1] >= u[0]));
            let long = |from: f64, to: f64| -> f64 {
                let at = |i: usize| curve.at(from + (to - from) * i as f64 / 40.0);
                (1..=40).map(|i| at(i).distance(at(i - 1))).sum()
            };
            let whole = curve.length();
            for u in us.chunks_exact(50) {
                let is = long(u[0], u[49]) / whole;
                prop_assert!((is - 49.0 / 400.0).abs() < 4e-3, "{}", is);
            }
        }
    }

    #[test]
    fn a_curve_without_length_is_even_as_it_is() {
        let none = Hermite {
            points: [DVec3::ONE; 2],
            tangents: [DVec3::ZERO; 2],
        };
        let even = Even::new(&none);
        assert!((even.at(0.3) - 0.3).abs() < 1e-12);
    }
}
