//! Minimum variation of curvature over the tangent magnitudes (Eq. 9), by Levenberg–Marquardt.

use glam::DVec3;
use midair_curve::Spline;
use nalgebra::DVector;

use super::measure::Measure;

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
const MOST_STEPS: usize = 60;
/// No tangent is longer than so many chords of its segment.
const MOST_CHORDS: f64 = 4.0;
/// Tangent magnitudes to begin with, as shares of the chords; the first is the paper's.
const STARTS: [f64; 4] = [1.0 / 3.0, 0.55, 0.2, 0.9];
/// Steps from each start, after which only the best …
const FIRST_STEPS: usize = 6;
/// … so many go on.
const LAST: usize = 2;

/// The curve through `curve`'s points of least Σ (cᵢ − cᵢ₊₁)² (Eq. 9), begun at a third of each
/// chord as the paper does. A curve without segments is empty.
pub fn fit(curve: &Curve) -> Fitted {
    let count = (SAMPLES * curve.segments() + SAMPLES).max(12);
    fit_with(curve, count)
}

/// The same with `count` samples of the curvature over the whole curve.
pub fn fit_with(curve: &Curve, count: usize) -> Fitted {
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
    let mut measure = Measure::new(curve, count.max(6));
    let free: Vec<bool> = (0..curve.segments())
        .map(|i| !is_straight(curve, i))
        .collect();
    let room = Room {
        chords: &chords,
        free: &free,
    };
    // Begun as the paper does and in other ways: the valleys are many, and the nearest is not the deepest.
    let mut tries: Vec<Descent> = STARTS
        .iter()
        .map(|share| {
            let share = |i: usize| if free[i] { *share } else { 1.0 / 3.0 };
            let x = chords
                .iter()
                .enumerate()
                .flat_map(|(i, c)| [c * share(i); 2]);
            let x = x.collect();
            let mut descent = Descent::new(x, &mut measure);
            descent.run(FIRST_STEPS, &room, &mut measure);
            descent
        })
        .collect();
    tries.sort_by(|a, b| a.value.total_cmp(&b.value));
    tries.truncate(LAST);
    for descent in &mut tries {
        descent.run(MOST_STEPS, &room, &mut measure);
    }
    tries.sort_by(|a, b| a.value.total_cmp(&b.value));
    let Descent {
        mut x,
        value,
        steps,
        ..
    } = tries.swap_remove(0);
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

/// Whether a segment is straight whatever its magnitudes: they would run it past its ends and back.
fn is_straight(curve: &Curve, segment: usize) -> bool {
    let (q, d) = (&curve.points[segment..], &curve.tangents[segment..]);
    let along = (q[1] - q[0]).normalize_or_zero();
    along.dot(d[0]) > 1.0 - 1e-9 && along.dot(d[1]) > 1.0 - 1e-9
}

/// What magnitudes may become.
struct Room<'a> {
    chords: &'a [f64],
    /// Segments whose magnitudes mean something.
    free: &'a [bool],
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
        while self.steps < most && !self.done {
            self.steps += 1;
            let (residuals, jacobian) = measure.linearised(&self.x);
            let matrix = jacobian.tr_mul(&jacobian);
            let gradient = jacobian.tr_mul(&residuals);
            // A magnitude that says nothing is not moved far.
            let least = 1e-6 * matrix.diagonal().max() + 1e-12;
            let mut gained = None;
            for _ in 0..12 {
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
                    // A tangent never turns round and never outgrows its segment.
                    let chord = room.chords[i / 2];
                    trial[i] = if room.free[i / 2] {
                        (self.x[i] - step[i]).clamp(0.01 * chord, MOST_CHORDS * chord)
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
            self.done = gained.is_none_or(|g| g < 1e-6);
        }
    }
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
