//! Auto-correcting shape strokes (ScaffoldSketch §4.2).

mod curvature;
mod fit;
mod keypoints;
mod measure;
mod ring;
#[cfg(test)]
mod ring_tests;
mod straight;
#[cfg(test)]
mod tests;

use glam::DVec3;
use midair_curve::{CubicBezier, Polyline, Spline};

pub use fit::{Curve, Fitted, fit, fit_with};
pub use keypoints::Keypoint;
pub use measure::Along;

use crate::line::Scaffold;

/// How a stroke is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeOptions {
    /// Physical metres between its samples (§4.2.1: 1 cm).
    pub spacing: f64,
    /// Physical metres within which it goes through a keypoint (§4.2.1: 3 cm).
    pub distance: f64,
    /// Radians within which it follows a line there (§4.2.1: 25°).
    pub angle: f64,
    /// It is straight when it leaves the best line by less than this share of its length (8 %) …
    pub straight_distance: f64,
    /// … and is not longer by more than this (10 %).
    pub straight_length: f64,
    /// Physical metres per metre of world.
    pub metres_per_world: f64,
}

impl Default for StrokeOptions {
    fn default() -> Self {
        Self {
            spacing: 0.01,
            distance: 0.03,
            angle: 25.0_f64.to_radians(),
            straight_distance: 0.08,
            straight_length: 0.10,
            metres_per_world: 1.0,
        }
    }
}

/// What became of a stroke.
#[derive(Clone, Debug, PartialEq)]
pub enum Fair {
    /// A curve of minimum variation of curvature through keypoints.
    Curve {
        /// The curve.
        spline: Spline,
        /// What it goes through, and how.
        keypoints: Vec<Keypoint>,
        /// Whether it ends where it begins, smoothly.
        closed: bool,
    },
    /// A straight line.
    Straight(Segment),
    /// Too little was drawn to say: less than two points, or no length.
    Nothing,
}

/// A straight line between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where it begins.
    pub a: DVec3,
    /// Where it ends.
    pub b: DVec3,
}

/// Samples of one stroke are at most this many.
const MOST_SAMPLES: usize = 4_000;

/// Turns a stroke into a fair curve through the keypoints of `scaffold` that it passes
/// (ScaffoldSketch §4.2). Where it begins or ends near none, it begins or ends where it was drawn.
///
/// Points that are not finite are left out.
pub fn fair_stroke(points: &[DVec3], scaffold: &Scaffold, options: &StrokeOptions) -> Fair {
    let drawn = Polyline::new(points.iter().copied());
    let scale = options.metres_per_world;
    if drawn.points().len() < 2 || drawn.length() < 1e-9 || !scale.is_finite() || scale <= 0.0 {
        return Fair::Nothing;
    }
    let spacing = (options.spacing / scale).max(drawn.length() / MOST_SAMPLES as f64);
    let samples = drawn.spaced(spacing);
    let reach = options.distance / scale;
    let (keypoints, closed) = keypoints::select(&samples, scaffold, reach, options.angle);
    if let (Some(first), Some(last)) = (keypoints.first(), keypoints.last())
        && keypoints.len() <= 2
        && !closed
        && straight::is_straight(&samples, options)
    {
        return Fair::Straight(Segment {
            a: first.point,
            b: last.point,
        });
    }
    let curve = if closed {
        let ring = ring::Ring::new(&samples, spacing, reach);
        let (ring, keypoints) = ring.select(keypoints, scaffold, options.angle);
        let free = |sample: usize| ring.free(sample);
        through(ring.samples(), keypoints, free, closed, reach)
    } else {
        let free = |sample: usize| keypoints::free(&samples, sample);
        through(&samples, keypoints, free, closed, reach)
    };
    Fair::Curve {
        spline: curve.0,
        keypoints: curve.1,
        closed,
    }
}

/// Fits, and where the curve strays from what was drawn takes a point of the drawing in between:
/// detail strokes away from any scaffold keep their shape.
fn through(
    samples: &[DVec3],
    mut keypoints: Vec<Keypoint>,
    free: impl Fn(usize) -> Keypoint,
    closed: bool,
    reach: f64,
) -> (Spline, Vec<Keypoint>) {
    /// Points of the drawing that are taken in at most.
    const MOST: usize = 12;
    let mut rough = true;
    for round in 0.. {
        let curve = curve_of(&keypoints, closed);
        let spline = if rough {
            fit::rough(&curve)
        } else {
            fit(&curve).spline
        };
        let shown = spline.flattened(16);
        let worst = samples
            .iter()
            .enumerate()
            .map(|(i, p)| (i, straight::to_polyline(*p, shown.points())))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((at, off)) = worst else {
            return (spline, keypoints);
        };
        let allowed = reach.max(0.04 * shown.length());
        let place = keypoints.partition_point(|k| k.sample < at);
        if off <= allowed || round >= MOST || keypoints.iter().any(|k| k.sample == at) {
            if rough {
                rough = false;
                continue;
            }
            return (spline, keypoints);
        }
        keypoints.insert(place, free(at));
    }
    (Spline::default(), keypoints)
}

fn curve_of(keypoints: &[Keypoint], closed: bool) -> Curve {
    Curve {
        points: keypoints.iter().map(|k| k.point).collect(),
        tangents: keypoints.iter().map(|k| k.tangent).collect(),
        closed,
    }
}

/// The segments of a curve with these tangent magnitudes.
fn spline(curve: &Curve, magnitudes: &[f64]) -> Spline {
    let segments = curve.points.windows(2).zip(curve.tangents.windows(2));
    Spline {
        segments: segments
            .zip(magnitudes.chunks(2))
            .map(|((q, d), x)| CubicBezier([q[0], q[0] + d[0] * x[0], q[1] - d[1] * x[1], q[1]]))
            .collect(),
    }
}
