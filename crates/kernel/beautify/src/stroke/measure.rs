//! Samples of a curve, evenly by arc length, its curvatures there, and how both follow the tangent
//! magnitudes.

use glam::DVec3;
use midair_curve::CubicBezier;
use nalgebra::{DMatrix, DVector};

use super::curvature::menger;
use super::fit::Curve;

/// Straight pieces of each segment, along which lengths are measured.
const PIECES: usize = 24;

/// What is computed once for a curve, and room to work in.
pub(super) struct Measure<'a> {
    curve: &'a Curve,
    /// Samples over the whole curve.
    count: usize,
    /// Bernstein polynomials at the ends of the pieces.
    basis: [[f64; 4]; PIECES + 1],
    points: Vec<DVec3>,
    along: Vec<f64>,
    segments: Vec<CubicBezier>,
    samples: Vec<DVec3>,
    /// The derivative of each sample by its place on its piece.
    speeds: Vec<DVec3>,
    /// The piece each sample lies on, and where on it.
    on: Vec<(usize, f64)>,
}

impl<'a> Measure<'a> {
    pub fn new(curve: &'a Curve, count: usize) -> Self {
        let basis = std::array::from_fn(|i| {
            let t = i as f64 / PIECES as f64;
            let s = 1.0 - t;
            [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
        });
        let pieces = PIECES * curve.segments();
        Self {
            curve,
            count,
            basis,
            points: vec![DVec3::ZERO; pieces + 1],
            along: vec![0.0; pieces + 1],
            segments: vec![CubicBezier([DVec3::ZERO; 4]); curve.segments()],
            samples: vec![DVec3::ZERO; count],
            speeds: vec![DVec3::ZERO; count],
            on: vec![(0, 0.0); count],
        }
    }

    /// How many differences of neighbouring curvatures there are.
    pub fn residuals(&self) -> usize {
        if self.curve.closed {
            self.count - 1
        } else {
            self.count - 3
        }
    }

    fn sample(&mut self, x: &[f64]) {
        let Curve {
            points: q,
            tangents: d,
            ..
        } = self.curve;
        let mut length = 0.0;
        for i in 0..self.curve.segments() {
            let p = [
                q[i],
                q[i] + d[i] * x[2 * i],
                q[i + 1] - d[i + 1] * x[2 * i + 1],
                q[i + 1],
            ];
            self.segments[i] = CubicBezier(p);
            for (t, b) in self.basis.iter().enumerate().skip(usize::from(i > 0)) {
                let at = PIECES * i + t;
                let point = p[0] * b[0] + p[1] * b[1] + p[2] * b[2] + p[3] * b[3];
                self.points[at] = point;
                if at > 0 {
                    length += point.distance(self.points[at - 1]);
                }
                self.along[at] = length;
            }
        }
        let pieces = self.points.len() - 1;
        let mut piece = 0;
        let places = self
            .samples
            .iter_mut()
            .zip(&mut self.speeds)
            .zip(&mut self.on);
        for (k, ((sample, speed), on)) in places.enumerate() {
            let wanted = length * k as f64 / (self.count - 1) as f64;
            while piece + 1 < pieces && self.along[piece + 1] < wanted {
                piece += 1;
            }
            let long = (self.along[piece + 1] - self.along[piece]).max(1e-300);
            let f = ((wanted - self.along[piece]) / long).clamp(0.0, 1.0);
            // On the curve itself and not on its chords, whose corners would count as curvature.
            let segment = &self.segments[piece / PIECES];
            let t = ((piece % PIECES) as f64 + f) / PIECES as f64;
            *sample = segment.at(t);
            *speed = segment.derivative(t) / PIECES as f64;
            *on = (piece, f);
        }
    }

    /// The three samples whose curvature is the `k`-th.
    fn triple(&self, k: usize) -> [usize; 3] {
        if self.curve.closed {
            // The last sample is the first one again.
            let round = self.count - 1;
            [(k + round - 1) % round, k % round, (k + 1) % round]
        } else {
            [k, k + 1, k + 2]
        }
    }

    fn curvatures(&self) -> usize {
        if self.curve.closed {
            self.count - 1
        } else {
            self.count - 2
        }
    }

    /// The objective, Eq. 9.
    pub fn value(&mut self, x: &[f64]) -> f64 {
        self.sample(x);
        let n = self.curvatures();
        let at = |k: usize| {
            let [a, b, c] = self.triple(k);
            menger(self.samples[a], self.samples[b], self.samples[c]).0
        };
        let first = at(0);
        let (mut before, mut sum) = (first, 0.0);
        for k in 1..n {
            let now = at(k);
            sum += (now - before) * (now - before);
            before = now;
        }
        if self.curve.closed {
            sum += (first - before) * (first - before);
        }
        sum
    }

    /// The differences cᵢ₊₁ − cᵢ and their derivative by each magnitude.
    pub fn linearised(&mut self, x: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        self.sample(x);
        let n = self.curvatures();
        let curvatures: Vec<_> = (0..n)
            .map(|k| {
                let t = self.triple(k);
                (
                    t,
                    menger(self.samples[t[0]], self.samples[t[1]], self.samples[t[2]]),
                )
            })
            .collect();
        let rows = self.residuals();
        let mut values = DVector::zeros(rows);
        for r in 0..rows {
            values[r] = curvatures[(r + 1) % n].1.0 - curvatures[r].1.0;
        }
        let mut jacobian = DMatrix::zeros(rows, x.len());
        let mut moved = vec![DVec3::ZERO; self.count];
        let mut changes = vec![0.0; n];
        for j in 0..x.len() {
            self.samples_by(j, &mut moved);
            for (change, (t, (_, gradient))) in changes.iter_mut().zip(&curvatures) {
                *change = (0..3).map(|i| gradient[i].dot(moved[t[i]])).sum();
            }
            for r in 0..rows {
                jacobian[(r, j)] = changes[(r + 1) % n] - changes[r];
            }
        }
        (values, jacobian)
    }

    /// The derivative of every sample by the `j`-th magnitude.
    fn samples_by(&self, j: usize, moved: &mut [DVec3]) {
        let segment = j / 2;
        let (direction, which) = if j.is_multiple_of(2) {
            (self.curve.tangents[segment], 1)
        } else {
            (-self.curve.tangents[segment + 1], 2)
        };
        let start = PIECES * segment;
        // How the ends of its pieces move, and the lengths up to them change.
        let mut points = [DVec3::ZERO; PIECES + 1];
        let mut lengths = [0.0; PIECES + 1];
        for t in 0..=PIECES {
            points[t] = direction * self.basis[t][which];
            if t > 0 {
                let piece = self.points[start + t] - self.points[start + t - 1];
                let unit = piece / piece.length().max(1e-300);
                lengths[t] = lengths[t - 1] + unit.dot(points[t] - points[t - 1]);
            }
        }
        let whole = lengths[PIECES];
        for (k, (out, &(piece, f))) in moved.iter_mut().zip(&self.on).enumerate() {
            let wanted = whole * k as f64 / (self.count - 1) as f64;
            let along = self.speeds[k];
            let long = (self.along[piece + 1] - self.along[piece]).max(1e-300);
            *out = if piece < start {
                along * (wanted / long)
            } else if piece >= start + PIECES {
                along * ((wanted - whole) / long)
            } else {
                let t = piece - start;
                let change = wanted - lengths[t] - f * (lengths[t + 1] - lengths[t]);
                let u = (t as f64 + f) / PIECES as f64;
                let basis = 3.0 * u * (1.0 - u) * if which == 1 { 1.0 - u } else { u };
                direction * basis + along * (change / long)
            };
        }
    }
}
