//! Samples of a curve, evenly by arc length, its curvatures there, and how both follow the tangent
//! magnitudes.

use std::ops::Range;

use glam::DVec3;
use midair_curve::CubicBezier;
use nalgebra::{DMatrix, DVector};

use super::curvature::{bent, menger};
use super::fit::Curve;

/// Straight pieces of each segment, along which lengths are measured.
const PIECES: usize = 24;

/// What is computed once for a curve, and room to work in.
pub(super) struct Measure<'a> {
    curve: &'a Curve,
    /// Samples over the whole curve.
    count: usize,
    along_what: Along,
    /// Bernstein polynomials at the ends of the pieces.
    basis: [[f64; 4]; PIECES + 1],
    points: Vec<DVec3>,
    /// How long each piece is, and all up to its end.
    long: Vec<f64>,
    along: Vec<f64>,
    /// The magnitudes that each segment was laid out with.
    laid: Vec<[f64; 2]>,
    segments: Vec<CubicBezier>,
    samples: Vec<DVec3>,
    on: Vec<On>,
}

impl<'a> Measure<'a> {
    pub fn new(curve: &'a Curve, count: usize, along_what: Along) -> Self {
        let basis = std::array::from_fn(|i| {
            let t = i as f64 / PIECES as f64;
            let s = 1.0 - t;
            [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
        });
        let pieces = PIECES * curve.segments();
        Self {
            curve,
            count,
            along_what,
            basis,
            points: vec![DVec3::ZERO; pieces + 1],
            long: vec![0.0; pieces],
            along: vec![0.0; pieces + 1],
            laid: vec![[f64::NAN; 2]; curve.segments()],
            segments: vec![CubicBezier([DVec3::ZERO; 4]); curve.segments()],
            samples: vec![DVec3::ZERO; count],
            on: vec![On::default(); count],
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

    /// The ends of the pieces, and the lengths up to them. Segments whose magnitudes are those of the last time stay.
    fn lay(&mut self, x: &[f64]) -> f64 {
        let Curve {
            points: q,
            tangents: d,
            ..
        } = self.curve;
        for i in 0..self.curve.segments() {
            let own = [x[2 * i], x[2 * i + 1]];
            if self.laid[i] == own {
                continue;
            }
            self.laid[i] = own;
            let p = [
                q[i],
                q[i] + d[i] * own[0],
                q[i + 1] - d[i + 1] * own[1],
                q[i + 1],
            ];
            self.segments[i] = CubicBezier(p);
            let mut before = p[0];
            for (t, b) in self.basis.iter().enumerate() {
                let at = PIECES * i + t;
                let point = p[0] * b[0] + p[1] * b[1] + p[2] * b[2] + p[3] * b[3];
                self.points[at] = point;
                if t > 0 {
                    self.long[at - 1] = point.distance(before);
                }
                before = point;
            }
        }
        let mut length = 0.0;
        for (along, long) in self.along[1..].iter_mut().zip(&self.long) {
            length += long;
            *along = length;
        }
        length
    }

    /// The samples, with how they move along their pieces where that is asked for.
    fn sample(&mut self, x: &[f64], with_speeds: bool) {
        let length = self.lay(x);
        let pieces = self.points.len() - 1;
        let mut piece = 0;
        for k in 0..self.count {
            let wanted = length * self.share(k);
            while piece + 1 < pieces && self.along[piece + 1] < wanted {
                piece += 1;
            }
            let long = (self.along[piece + 1] - self.along[piece]).max(1e-300);
            let share = ((wanted - self.along[piece]) / long).clamp(0.0, 1.0);
            let (sample, speed) = match self.along_what {
                // Their corners count as curvature.
                Along::Chords => {
                    let chord = self.points[piece + 1] - self.points[piece];
                    (self.points[piece] + chord * share, chord)
                }
                Along::Curve => {
                    let segment = &self.segments[piece / PIECES];
                    let t = ((piece % PIECES) as f64 + share) / PIECES as f64;
                    let speed = if with_speeds {
                        segment.derivative(t) / PIECES as f64
                    } else {
                        DVec3::ZERO
                    };
                    (segment.at(t), speed)
                }
            };
            self.samples[k] = sample;
            self.on[k] = On {
                piece,
                share,
                speed,
            };
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
        self.sample(x, false);
        let n = self.curvatures();
        let at = |k: usize| {
            let [a, b, c] = self.triple(k);
            bent(self.samples[a], self.samples[b], self.samples[c])
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
        self.sample(x, true);
        let n = self.curvatures();
        let bends: Vec<Bend> = (0..n).map(|k| self.bend(k)).collect();
        let rows = self.residuals();
        let values = DVector::from_fn(rows, |r, _| bends[(r + 1) % n].value - bends[r].value);
        let mut jacobian = DMatrix::zeros(rows, x.len());
        let mut own = vec![DVec3::ZERO; self.count];
        let mut changes = vec![0.0; n];
        for j in 0..x.len() {
            let (whole, within) = self.samples_by(j, &mut own);
            for (change, bend) in changes.iter_mut().zip(&bends) {
                *change = whole * bend.by_pace;
                let [low, high] = bend.span;
                if low >= within.end {
                    *change -= whole * bend.by_slide;
                } else if high >= within.start {
                    for (i, at) in bend.samples.into_iter().enumerate() {
                        if within.contains(&at) {
                            *change += bend.gradient[i].dot(own[at]);
                        } else if at >= within.end {
                            *change -= whole * bend.gradient[i].dot(self.pace(at));
                        }
                    }
                }
            }
            let mut column = jacobian.column_mut(j);
            for r in 0..rows {
                column[r] = changes[(r + 1) % n] - changes[r];
            }
        }
        (values, jacobian)
    }

    /// How a sample moves by the length of the curve up to it.
    fn pace(&self, k: usize) -> DVec3 {
        let on = &self.on[k];
        let long = self.along[on.piece + 1] - self.along[on.piece];
        on.speed / long.max(1e-300)
    }

    fn bend(&self, k: usize) -> Bend {
        let samples = self.triple(k);
        let [a, b, c] = samples.map(|s| self.samples[s]);
        let (value, gradient) = menger(a, b, c);
        let (mut by_pace, mut by_slide) = (0.0, 0.0);
        for (g, &s) in gradient.iter().zip(&samples) {
            let slide = g.dot(self.pace(s));
            by_slide += slide;
            by_pace += slide * self.share(s);
        }
        Bend {
            value,
            gradient,
            span: [
                samples[0].min(samples[1]).min(samples[2]),
                samples[0].max(samples[1]).max(samples[2]),
            ],
            samples,
            by_pace,
            by_slide,
        }
    }

    /// How far along the curve a sample is.
    fn share(&self, k: usize) -> f64 {
        k as f64 / (self.count - 1) as f64
    }

    /// The derivative by the `j`-th magnitude of the whole length, and of the samples on its own segment what is
    /// left when they keep their share of that; and which samples those are. All before them only keep their
    /// share, all behind them slide back by the length as well.
    fn samples_by(&self, j: usize, own: &mut [DVec3]) -> (f64, Range<usize>) {
        let segment = j / 2;
        let (direction, which) = if j.is_multiple_of(2) {
            (self.curve.tangents[segment], 1)
        } else {
            (-self.curve.tangents[segment + 1], 2)
        };
        let start = PIECES * segment;
        // How the ends of its pieces move, and the lengths up to them change.
        let mut lengths = [0.0; PIECES + 1];
        for t in 1..=PIECES {
            let piece = self.points[start + t] - self.points[start + t - 1];
            let long = (self.along[start + t] - self.along[start + t - 1]).max(1e-300);
            let moved = self.basis[t][which] - self.basis[t - 1][which];
            lengths[t] = lengths[t - 1] + moved * piece.dot(direction) / long;
        }
        let first = self.on.partition_point(|on| on.piece < start);
        let last = self.on.partition_point(|on| on.piece < start + PIECES);
        for (k, own) in own.iter_mut().enumerate().take(last).skip(first) {
            let on = &self.on[k];
            let t = on.piece - start;
            let before = lengths[t] + on.share * (lengths[t + 1] - lengths[t]);
            let basis = match self.along_what {
                Along::Chords => {
                    let [from, to] = [t, t + 1].map(|t| self.basis[t][which]);
                    from + (to - from) * on.share
                }
                Along::Curve => {
                    let u = (t as f64 + on.share) / PIECES as f64;
                    3.0 * u * (1.0 - u) * if which == 1 { 1.0 - u } else { u }
                }
            };
            *own = direction * basis - self.pace(k) * before;
        }
        (lengths[PIECES], first..last)
    }
}

/// What the samples of the curvature lie on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The curve itself.
    Curve,
    /// The 24 chords of each segment, as the paper's own code has it.
    Chords,
}

/// Where a sample lies.
#[derive(Clone, Copy, Default)]
struct On {
    /// Its piece.
    piece: usize,
    /// How far along that.
    share: f64,
    /// The derivative of the sample by that.
    speed: DVec3,
}

/// One curvature, and how it follows its three samples.
struct Bend {
    value: f64,
    gradient: [DVec3; 3],
    samples: [usize; 3],
    /// The first and the last of them along the curve.
    span: [usize; 2],
    /// By the whole length, when its samples keep their share of it.
    by_pace: f64,
    /// When they slide along the curve together.
    by_slide: f64,
}
