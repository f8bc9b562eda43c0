//! Minimum variation of curvature over the tangent magnitudes (Eq. 9), by Levenberg–Marquardt.

use glam::DVec3;
use midair_curve::Spline;
use nalgebra::DVector;

use super::measure::{Along, Measure};

/// What a curve goes through.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its points, at least two.
    pub points: Vec<DVec3>,
    /// Its unit direction in each.
    pub tangents: Vec<DVec3>,
    /// Whether the last point is the first one again, and the curvature goes round.
    pub closed: bool,
}

impl Curve {
    /// How many segments it has.
    pub fn segments(&self) -> usize {
        self.points.len().saturating_sub(1)
    }
}

/// A fair curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// The curve.
    pub spline: Spline,
    /// The magnitudes xᵢ,₁ and xᵢ,₂ of its tangents, in metres, two to a segment.
    pub magnitudes: Vec<f64>,
    /// What is left of Eq. 9, 1/m².
    pub variation: f64,
    /// How many steps were taken.
    pub steps: usize,
}

/// Samples of the curvature per segment (§4.2.2 asks for one at least).
const SAMPLES: usize = 10;
/// The same in a ring: wider apart a kink hides between two, and where they begin shows.
const RING_SAMPLES: usize = 24;
/// A magnitude is between these, as shares of the chord of its segment: a tangent runs the stroke's own way and
/// never outgrows its segment.
const ROOM: (f64, f64) = (0.002, 4.0);
/// In a ring no shorter than this: a cusp that hides between two samples of the curvature is a kink to the eye.
const RING_ROOM: f64 = 0.15;
/// Tangent magnitudes to begin with, as shares of the chords; the first is the paper's.
const STARTS: [f64; 4] = [1.0 / 3.0, 0.55, 0.2, 0.9];
/// Steps from each start, after which only the best …
const FIRST_STEPS: usize = 5;
/// … so many go on, for so many steps at most.
const LAST: usize = 2;
const MOST_STEPS: usize = 40;
/// What is tried of one magnitude alone when the best has come to rest, as shares of the chord …
const JUMPS: [f64; 7] = [0.002, 0.08, 0.2, 0.35, 0.55, 0.85, 1.3];
/// The same where corners are in the way, as multiples of it …
const NUDGES: [f64; 6] = [0.75, 0.9, 0.97, 1.03, 1.1, 1.3];
/// … and how often.
const ROUNDS: usize = 3;

/// The curve through `curve`'s points of least Σ (cᵢ − cᵢ₊₁)² (Eq. 9). Begun at a third of each chord as the paper
/// does, and elsewhere; it is not worse than what any of the starts leads to. Magnitudes stay above zero: the paper
/// begins where no cusps exist, and below zero a tangent runs against the stroke's own sense. A curve without segments is
/// empty.
pub fn fit(curve: &Curve) -> Fitted {
    let each = if curve.closed { RING_SAMPLES } else { SAMPLES };
    let count = (each * curve.segments() + each).max(12);
    fit_with(curve, count, Along::Curve)
}

/// The same with `count` samples of the curvature over the whole curve, and a choice of what they lie on.
pub fn fit_with(curve: &Curve, count: usize, along: Along) -> Fitted {
    if !curve.closed || curve.segments() < 2 {
        return searched(curve, count, along);
    }
    // Any keypoint of a ring may be the first: the search always begins at the same one.
    let n = curve.segments();
    let least = |a: &usize, b: &usize| {
        let [a, b] = [a, b].map(|&i| curve.points[i].to_array());
        let differ = a.iter().zip(&b).map(|(a, b)| a.total_cmp(b));
        differ.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    };
    let first = (0..n).min_by(least).unwrap_or(0);
    let turned = |of: &[DVec3]| (0..=n).map(|i| of[(first + i) % n]).collect();
    let begun = Curve {
        points: turned(&curve.points),
        tangents: turned(&curve.tangents),
        closed: true,
    };
    let mut fitted = searched(&begun, count, along);
    fitted.magnitudes.rotate_right(2 * first);
    fitted.spline = super::spline(curve, &fitted.magnitudes);
    fitted
}

fn searched(curve: &Curve, count: usize, along: Along) -> Fitted {
    let chords: Vec<f64> = curve
        .points
        .windows(2)
        .map(|q| q[0].distance(q[1]).max(1e-9))
        .collect();
    if curve.segments() == 0 {
        return Fitted {
            spline: Spline::default(),
            magnitudes: Vec::new(),
            variation: 0.0,
            steps: 0,
        };
    }
    let mut measure = Measure::new(curve, count.max(6), Along::Curve);
    let free: Vec<bool> = (0..curve.segments())
        .map(|i| !is_straight(curve, i))
        .collect();
    let room = Room {
        least: if curve.closed { RING_ROOM } else { ROOM.0 },
        chords: &chords,
        free: &free,
    };
    // Begun as the paper does and in other ways: the valleys are many, and the nearest is not the deepest.
    let mut tries: Vec<Descent> = STARTS
        .iter()
        .map(|&share| {
            let share = |i: usize| if free[i] { share } else { 1.0 / 3.0 };
            let x = chords
                .iter()
                .enumerate()
                .flat_map(|(i, c)| [c * share(i); 2]);
            x.collect()
        })
        .chain([even(curve)])
        .map(|x: Vec<f64>| Descent::new(x, &mut measure))
        .collect();
    for descent in &mut tries {
        descent.run(FIRST_STEPS, &room, &mut measure);
    }
    tries.sort_by(|a, b| a.value.total_cmp(&b.value));
    tries.truncate(LAST);
    for descent in &mut tries {
        descent.run(MOST_STEPS, &room, &mut measure);
    }
    tries.sort_by(|a, b| a.value.total_cmp(&b.value));
    let mut best = tries.swap_remove(0);
    for _ in 0..ROUNDS {
        if !best.jump(&room, &mut measure) {
            break;
        }
    }
    if along == Along::Chords {
        // Their corners are thresholds for a descent: it goes on from where the smooth curve came to rest.
        measure = Measure::new(curve, count.max(6), along);
        best = Descent {
            steps: best.steps,
            ..Descent::new(best.x, &mut measure)
        };
        best.run(MOST_STEPS, &room, &mut measure);
        for _ in 0..ROUNDS {
            if !best.nudge(&room, &mut measure) {
                break;
            }
        }
    }
    let Descent {
        mut x,
        value,
        steps,
        ..
    } = best;
    for (i, x) in x.chunks_mut(2).enumerate() {
        if let Some(arc) = arc(curve, i).filter(|a| x.iter().all(|m| (m / a - 1.0).abs() < 0.02)) {
            x.fill(arc);
        }
    }
    Fitted {
        spline: super::spline(curve, &x),
        magnitudes: x,
        variation: value,
        steps,
    }
}

/// A curve not far from the fair one, in a fraction of the time: enough to see where it strays.
pub(super) fn rough(curve: &Curve) -> Spline {
    if curve.segments() == 0 {
        return Spline::default();
    }
    super::spline(curve, &even(curve))
}

/// Whether a segment is straight whatever its magnitudes: they would run it past its ends and back.
fn is_straight(curve: &Curve, segment: usize) -> bool {
    let (q, d) = (&curve.points[segment..], &curve.tangents[segment..]);
    let along = (q[1] - q[0]).normalize_or_zero();
    along.dot(d[0]) > 1.0 - 1e-9 && along.dot(d[1]) > 1.0 - 1e-9
}

/// What magnitudes may become.
struct Room<'a> {
    /// As a share of the chord.
    least: f64,
    chords: &'a [f64],
    /// Segments whose magnitudes mean something.
    free: &'a [bool],
}

impl Room<'_> {
    fn clamp(&self, i: usize, x: f64) -> f64 {
        let chord = self.chords[i / 2];
        x.clamp(self.least * chord, ROOM.1 * chord)
    }

    /// Whether a magnitude would leave its room downhill.
    fn holds(&self, i: usize, x: f64, gradient: f64) -> bool {
        let share = x / self.chords[i / 2];
        !self.free[i / 2]
            || share <= self.least * (1.0 + 1e-9) && gradient > 0.0
            || share >= ROOM.1 * (1.0 - 1e-9) && gradient < 0.0
    }
}

/// Levenberg–Marquardt from one start, to be gone on with.
struct Descent {
    x: Vec<f64>,
    value: f64,
    damping: f64,
    steps: usize,
    done: bool,
}

impl Descent {
    fn new(x: Vec<f64>, measure: &mut Measure) -> Self {
        Self {
            value: measure.value(&x),
            x,
            damping: 1e-3,
            steps: 0,
            done: false,
        }
    }

    fn run(&mut self, most: usize, room: &Room, measure: &mut Measure) {
        let mut trial = self.x.clone();
        let most = self.steps + most;
        while self.steps < most && !self.done {
            self.steps += 1;
            let (residuals, mut jacobian) = measure.linearised(&self.x);
            let gradient = jacobian.tr_mul(&residuals);
            // What stands at the end of its room and would leave it holds still, so that the others step as if it did.
            for i in 0..trial.len() {
                if room.holds(i, self.x[i], gradient[i]) {
                    jacobian.column_mut(i).fill(0.0);
                }
            }
            let gradient = jacobian.tr_mul(&residuals);
            let matrix = jacobian.tr_mul(&jacobian);
            // A magnitude that says nothing is not moved far.
            let least = 1e-6 * matrix.diagonal().max() + 1e-12;
            let mut gained = None;
            for _ in 0..8 {
                let mut damped = matrix.clone();
                for i in 0..trial.len() {
                    damped[(i, i)] += self.damping * (matrix[(i, i)] + least);
                }
                let step: Option<DVector<f64>> = damped.cholesky().map(|c| c.solve(&gradient));
                let Some(step) = step else {
                    self.damping *= 10.0;
                    continue;
                };
                for i in 0..trial.len() {
                    trial[i] = if room.free[i / 2] {
                        room.clamp(i, self.x[i] - step[i])
                    } else {
                        self.x[i]
                    };
                }
                let next = measure.value(&trial);
                if next < self.value {
                    gained = Some((self.value - next) / self.value.max(1e-300));
                    self.value = next;
                    self.x.copy_from_slice(&trial);
                    self.damping = (self.damping * 0.2).max(1e-12);
                    break;
                }
                self.damping *= 6.0;
            }
            self.done = gained.is_none_or(|g| g < 1e-4);
        }
    }

    /// Tries each magnitude by itself elsewhere on its chord.
    fn jump(&mut self, room: &Room, measure: &mut Measure) -> bool {
        self.search(|_, chord| JUMPS.map(|by| by * chord), room, measure)
    }

    /// Tries each a little shorter and longer.
    fn nudge(&mut self, room: &Room, measure: &mut Measure) -> bool {
        self.search(|x, _| NUDGES.map(|by| by * x), room, measure)
    }

    /// Tries each magnitude by itself elsewhere, and goes on from where that is better. Says whether it was.
    fn search<const N: usize>(
        &mut self,
        there: impl Fn(f64, f64) -> [f64; N],
        room: &Room,
        measure: &mut Measure,
    ) -> bool {
        let before = self.value;
        for i in 0..self.x.len() {
            if !room.free[i / 2] {
                continue;
            }
            let mut best = (self.x[i], self.value);
            for there in there(self.x[i], room.chords[i / 2]) {
                let there = room.clamp(i, there);
                let was = std::mem::replace(&mut self.x[i], there);
                let value = measure.value(&self.x);
                if value < best.1 {
                    best = (there, value);
                }
                self.x[i] = was;
            }
            (self.x[i], self.value) = best;
        }
        if self.value < before {
            self.done = false;
            self.damping = 1e-3;
            self.run(MOST_STEPS, room, measure);
        }
        self.value < 0.999 * before
    }
}

/// Magnitudes with which each segment by itself bends most evenly (Hobby's velocities, taken about its chord).
fn even(curve: &Curve) -> Vec<f64> {
    let ends = curve.points.windows(2).zip(curve.tangents.windows(2));
    ends.flat_map(|(q, d)| {
        let chord = q[1] - q[0];
        let long = chord.length().max(1e-9);
        let (a, b) = (d[0].dot(chord) / long, d[1].dot(chord) / long);
        // 2 / (3 (1 + cos)) of the chord is a circular arc where both angles are equal.
        let velocity = |cos: f64| (2.0 / (3.0 * (1.0 + cos).max(0.2))).min(1.5) * long;
        [velocity(a), velocity(b)]
    })
    .collect()
}

/// The magnitude with which a segment is rounder than that of least variation, where its ends and
/// tangents are those of a circular arc: 0.03 % off a quarter of a circle instead of 0.08 %.
fn arc(curve: &Curve, segment: usize) -> Option<f64> {
    let (q, d) = (
        &curve.points[segment..=segment + 1],
        &curve.tangents[segment..=segment + 1],
    );
    let chord = (q[1] - q[0]).try_normalize()?;
    let mirrored = chord * (2.0 * d[0].dot(chord)) - d[0];
    let half = d[0].angle_between(chord);
    (mirrored.distance(d[1]) < 1e-6 && half > 1e-6 && half < 1.1).then(|| {
        let radius = q[0].distance(q[1]) / (2.0 * half.sin());
        4.0 / 3.0 * (0.5 * half).tan() * radius
    })
}
