//! Strokes that end where they begin: a ring has no ends, so where the hand began must not show.

use glam::DVec3;
use midair_curve::Polyline;

use super::keypoints::{self, Keypoint};
use crate::line::Scaffold;

/// Ends that run past each other are cut within so many times the reach of a keypoint …
const OVERLAP: f64 = 1.5;
/// … and within this share of the stroke.
const OVERLAP_SHARE: f64 = 0.125;
/// A point of the drawing is what the ring does within this share of it to each side, and within reach.
const LOCAL: f64 = 1.0 / 16.0;
/// One segment turns by no more than this, radians: a cubic is no fair half circle (§4.2.2 counts on 90°).
const MOST_TURN: f64 = 0.75 * std::f64::consts::PI;
/// Segments are halved no further than to so many samples.
const FEWEST: usize = 2;

/// What was drawn, closed.
pub(super) struct Ring {
    /// Even samples all the way round, the first one repeated at the end.
    samples: Vec<DVec3>,
    /// Metres between them.
    spacing: f64,
    /// Metres within which it goes through a keypoint.
    reach: f64,
    /// How many samples to each side a point of the drawing is taken from.
    around: usize,
    /// With which sample of the stroke it begins, and how many pieces of that it is.
    begun: usize,
    drawn: usize,
}

impl Ring {
    /// The ring of a stroke of `samples`, `spacing` apart, whose ends lie within `reach` of each other.
    pub fn new(samples: &[DVec3], spacing: f64, reach: f64) -> Self {
        let (begun, end) = cut(samples, spacing, reach);
        let mut points = samples[begun..=end].to_vec();
        meet(&mut points);
        points.push(points[0]);
        let samples = Polyline::new(points).spaced(spacing);
        let count = samples.len() - 1;
        let around = (LOCAL * count as f64).min(reach / spacing).round() as usize;
        Self {
            samples,
            spacing,
            reach,
            around: around.max(2),
            begun,
            drawn: end - begun,
        }
    }

    /// Its samples, the first one repeated at the end.
    pub fn samples(&self) -> &[DVec3] {
        &self.samples
    }

    /// How many different ones there are.
    fn count(&self) -> usize {
        self.samples.len() - 1
    }

    /// The `i`-th sample, counted on and on round the ring.
    fn sample(&self, i: isize) -> DVec3 {
        self.samples[i.rem_euclid(self.count() as isize) as usize]
    }

    /// Where the ring is and where it goes `at` samples along it: the parabola of least squares through the samples around.
    fn local(&self, at: f64) -> (DVec3, DVec3) {
        let middle = at.round() as isize;
        let around = self.around.min((self.count() - 1) / 2) as isize;
        // Sums of powers of the way from there, and of those with the samples.
        let mut powers = [0.0; 5];
        let mut with = [DVec3::ZERO; 3];
        for i in middle - around..=middle + around {
            let (t, p) = (i as f64 - at, self.sample(i));
            let powers_of = [1.0, t, t * t, t * t * t, t * t * t * t];
            for (sum, power) in powers.iter_mut().zip(powers_of) {
                *sum += power;
            }
            for (sum, power) in with.iter_mut().zip(powers_of) {
                *sum += p * power;
            }
        }
        let [a, b, c, d, e] = powers;
        let sums = nalgebra::Matrix3::new(a, b, c, b, c, d, c, d, e);
        let drawn = || {
            let (from, to) = (self.sample(middle - 1), self.sample(middle + 1));
            (self.sample(middle), (to - from).normalize_or(DVec3::X))
        };
        let Some(inverse) = sums.try_inverse() else {
            return drawn();
        };
        let row = |r: usize| {
            with[0] * inverse[(r, 0)] + with[1] * inverse[(r, 1)] + with[2] * inverse[(r, 2)]
        };
        match row(1).try_normalize() {
            Some(direction) => (row(0), direction),
            None => drawn(),
        }
    }

    /// A point of the drawing itself.
    pub fn free(&self, sample: usize) -> Keypoint {
        let (point, tangent) = self.local(sample as f64);
        Keypoint {
            point,
            tangent,
            of_scaffold: false,
            along_line: false,
            sample,
        }
    }

    /// How many samples along it the point nearest to `p` lies, within `reach` samples of the `near`-th.
    fn nearest(&self, p: DVec3, near: usize, reach: usize) -> f64 {
        let (near, reach) = (near as isize, reach as isize);
        (near - reach..near + reach)
            .map(|i| {
                let (a, b) = (self.sample(i), self.sample(i + 1));
                let along = b - a;
                let t = (p - a).dot(along) / along.length_squared().max(1e-300);
                let t = t.clamp(0.0, 1.0);
                (i as f64 + t, (a + along * t).distance_squared(p))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(near as f64, |(at, _)| at)
    }

    /// The keypoints of the ring, the first one repeated at the end, and the ring begun there, of those that were `passed` as it
    /// was drawn. A stroke that passes enough of the scaffold goes through that alone; elsewhere points of the drawing hold it.
    pub fn select(
        mut self,
        mut passed: Vec<Keypoint>,
        scaffold: &Scaffold,
        angle: f64,
    ) -> (Self, Vec<Keypoint>) {
        passed.retain(|k| k.of_scaffold);
        if keypoints::repeats(&passed) {
            passed.pop();
        }
        if let [first, .., last] = &passed[..]
            && first.point.distance(last.point) < self.reach
        {
            passed.pop();
        }
        let count = self.count();
        // How far a keypoint is from where it was passed: the ring is not quite what was drawn.
        let off = (2.0 * self.reach / self.spacing).ceil() as usize + 2;
        let mut found: Vec<Keypoint> = passed
            .into_iter()
            .map(|k| {
                let share = k.sample.saturating_sub(self.begun) as f64 / self.drawn as f64;
                let near = (share * count as f64).round() as usize;
                let at = self.nearest(k.point, near, off.min(count / 2));
                let drawn = self.local(at).1;
                let line = keypoints::along(k.point, drawn, scaffold, angle);
                Keypoint {
                    tangent: line.unwrap_or(drawn),
                    along_line: line.is_some(),
                    sample: at.round().rem_euclid(count as f64) as usize,
                    ..k
                }
            })
            .collect();
        if found.is_empty() {
            found.push(self.free(0));
        }
        found.sort_by_key(|k| k.sample);
        // It begins at the one nearest to where the hand began.
        let start = (0..found.len()).min_by_key(|&i| {
            let sample = found[i].sample;
            sample.min(count - sample)
        });
        found.rotate_left(start.unwrap_or(0));
        let begin = found[0].sample;
        for k in &mut found {
            k.sample = (k.sample + count - begin) % count;
        }
        self.samples.pop();
        self.samples.rotate_left(begin);
        self.samples.push(self.samples[0]);
        found.push(Keypoint {
            sample: count,
            ..found[0]
        });
        let mut i = 0;
        while i + 1 < found.len() {
            let (from, to) = (found[i].sample, found[i + 1].sample);
            if to - from >= 2 * FEWEST && turn(&found[i], &found[i + 1]) > MOST_TURN {
                found.insert(i + 1, self.free(from.midpoint(to)));
            } else {
                i += 1;
            }
        }
        (self, found)
    }
}

/// By how much a segment turns between two keypoints at least: from the first tangent into the chord and from that into the last.
fn turn(a: &Keypoint, b: &Keypoint) -> f64 {
    match (b.point - a.point).try_normalize() {
        Some(chord) => a.tangent.angle_between(chord) + chord.angle_between(b.tangent),
        None => std::f64::consts::TAU,
    }
}

/// The first and the last sample between where the ends meet: what runs past that is left out.
fn cut(samples: &[DVec3], spacing: f64, reach: f64) -> (usize, usize) {
    let last = samples.len() - 1;
    let most = (OVERLAP * reach / spacing).min(OVERLAP_SHARE * last as f64) as usize;
    let mut best = (0, last, f64::INFINITY);
    for i in 0..=most {
        for j in last - most..=last {
            // Of ends that lie on each other as little as can be is lost.
            let lost = spacing * (i + last - j) as f64;
            let far = samples[i].distance(samples[j]) + 0.05 * lost;
            if far < best.2 {
                best = (i, j, far);
            }
        }
    }
    (best.0, best.1)
}

/// Ends that lie beside each other meet half way, and the way there is spread over the whole ring: a spiral becomes a circle.
/// What is missing along the stroke is not made up for by bending it.
fn meet(points: &mut [DVec3]) {
    let last = points.len() - 1;
    let gap = points[0] - points[last];
    let tip = 2.min(last);
    let along = (points[tip] - points[0]).normalize_or_zero()
        + (points[last] - points[last - tip]).normalize_or_zero();
    let beside = gap
        - along
            .try_normalize()
            .map_or(DVec3::ZERO, |along| along * gap.dot(along));
    for (i, p) in points.iter_mut().enumerate() {
        *p += beside * (i as f64 / last as f64 - 0.5);
    }
}
