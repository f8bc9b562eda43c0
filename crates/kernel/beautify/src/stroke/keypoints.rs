//! What a stroke goes through, and along what.

use glam::DVec3;

use crate::line::Scaffold;

/// A point that the curve goes through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keypoint {
    /// Where.
    pub point: DVec3,
    /// The unit direction of the curve there.
    pub tangent: DVec3,
    /// Whether it is a keypoint of the scaffold, and not a point that was drawn.
    pub of_scaffold: bool,
    /// Whether the direction is a scaffold line's.
    pub along_line: bool,
    /// The sample nearest to it.
    pub sample: usize,
}

/// A keypoint on a line is one that lies nearer to it than this, metres.
const ON: f64 = 1e-6;

/// The keypoints within `reach` of the samples, in order, consecutive repeats dropped, and whether
/// the stroke closes. Ends near none are keypoints of their own; of a stroke that closes they are none ([`super::ring`]).
pub(super) fn select(
    samples: &[DVec3],
    scaffold: &Scaffold,
    reach: f64,
    angle: f64,
) -> (Vec<Keypoint>, bool) {
    let mut points: Vec<DVec3> = Vec::new();
    for p in scaffold.keypoints().filter(|p| p.is_finite()) {
        if !points.iter().any(|q| q.distance_squared(p) < ON * ON) {
            points.push(p);
        }
    }
    // (point, sample, distance) of each run of samples that are nearest to one keypoint.
    let mut runs: Vec<(DVec3, usize, f64)> = Vec::new();
    for (i, &p) in samples.iter().enumerate() {
        let nearest = points
            .iter()
            .map(|&q| (q, q.distance_squared(p)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((q, d)) = nearest.filter(|(_, d)| *d < reach * reach) else {
            continue;
        };
        match runs.last_mut().filter(|run| run.0 == q) {
            Some(run) if d < run.2 => (run.1, run.2) = (i, d),
            Some(_) => {}
            None => runs.push((q, i, d)),
        }
    }
    let mut found: Vec<Keypoint> = runs
        .into_iter()
        .map(|(point, sample, _)| {
            let drawn = tangent(samples, sample);
            let line = along(point, drawn, scaffold, angle);
            Keypoint {
                point,
                tangent: line.unwrap_or(drawn),
                of_scaffold: true,
                along_line: line.is_some(),
                sample,
            }
        })
        .collect();
    let last = samples.len() - 1;
    let near = |k: Option<&Keypoint>, end: usize| {
        k.is_some_and(|k| k.point.distance(samples[end]) < reach)
    };
    if !near(found.first(), 0) {
        found.insert(0, free(samples, 0));
    }
    if !near(found.last(), last) {
        found.push(free(samples, last));
    }
    // A single keypoint under both ends, and a drawing that comes back: the curve closes there.
    if found.len() == 1 {
        found.push(Keypoint {
            sample: last,
            ..found[0]
        });
        found[0].sample = 0;
    }
    let end = found.len() - 1;
    // Ends on two keypoints go from one to the other, near as they may be; unless it came by both before.
    let two = found[0].of_scaffold && found[end].of_scaffold && !repeats(&found);
    let meets = !two && samples[0].distance(samples[last]) < reach;
    let closed = (meets || found[0].point.distance(found[end].point) < reach) && samples.len() > 8;
    (found, closed)
}

/// Whether the last two are the first two again: it ran past where it began.
pub(super) fn repeats(found: &[Keypoint]) -> bool {
    matches!(found, [a, b, .., c, d] if a.point == c.point && b.point == d.point)
}

/// A point of the drawing itself.
pub(super) fn free(samples: &[DVec3], sample: usize) -> Keypoint {
    Keypoint {
        point: samples[sample],
        tangent: tangent(samples, sample),
        of_scaffold: false,
        along_line: false,
        sample,
    }
}

/// The local average direction: over two samples to each side.
fn tangent(samples: &[DVec3], at: usize) -> DVec3 {
    let (from, to) = (at.saturating_sub(2), (at + 2).min(samples.len() - 1));
    (samples[to] - samples[from])
        .try_normalize()
        .or_else(|| (samples[samples.len() - 1] - samples[0]).try_normalize())
        .unwrap_or(DVec3::X)
}

/// The direction of the scaffold line through `point` that `drawn` follows, in the stroke's sense.
pub(super) fn along(point: DVec3, drawn: DVec3, scaffold: &Scaffold, angle: f64) -> Option<DVec3> {
    scaffold
        .lines
        .iter()
        .filter(|l| super::straight::to_polyline(point, &[l.a, l.b]) < ON)
        .filter_map(crate::Line::direction)
        .map(|d| if d.dot(drawn) < 0.0 { -d } else { d })
        .max_by(|a, b| a.dot(drawn).total_cmp(&b.dot(drawn)))
        .filter(|d| d.dot(drawn) > angle.cos())
}
