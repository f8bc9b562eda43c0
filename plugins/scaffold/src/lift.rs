//! Depth for what is drawn with a pointer: a stroke takes its depth from the keypoints it crosses, and lies
//! between them where those say.

use bevy::math::DVec3;

use crate::phase::Sample;

/// Three keypoints and more span a plane when all lie this near to it, as a share of their extent.
const FLAT: f64 = 2e-3;

/// A keypoint that a stroke crosses as it is seen, and at which sample.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Crossing {
    sample: usize,
    point: DVec3,
    /// Radians between the two.
    off: f64,
}

/// The points of a stroke with depths from the `keypoints` that are seen within `radians` of it. Where it crosses
/// three that span a plane, all of it lies in that plane; otherwise depths go evenly from one to the next. Samples
/// without an eye stay where they are.
pub fn lift(samples: &[Sample], keypoints: &[DVec3], radians: f64) -> Vec<DVec3> {
    let crossings = crossings(samples, keypoints, radians);
    let as_drawn = || samples.iter().map(|s| s.at).collect();
    if crossings.is_empty() {
        return as_drawn();
    }
    if let Some((middle, normal)) = plane(&crossings) {
        let on = samples.iter().map(|s| on_plane(s, middle, normal));
        if let Some(points) = on.collect::<Option<Vec<_>>>() {
            return points;
        }
    }
    let depth = |c: &Crossing| {
        samples[c.sample]
            .eye
            .map_or(0.0, |eye| c.point.distance(eye))
    };
    samples
        .iter()
        .enumerate()
        .map(|(i, sample)| {
            let Some(eye) = sample.eye else {
                return sample.at;
            };
            let after = crossings.partition_point(|c| c.sample < i);
            let far = match (
                after.checked_sub(1).map(|b| &crossings[b]),
                crossings.get(after),
            ) {
                (Some(a), Some(b)) => {
                    let span = (b.sample - a.sample).max(1) as f64;
                    let t = (i - a.sample) as f64 / span;
                    depth(a) + (depth(b) - depth(a)) * t
                }
                (Some(one), None) | (None, Some(one)) => depth(one),
                (None, None) => return sample.at,
            };
            eye + (sample.at - eye).normalize_or_zero() * far
        })
        .collect()
}

fn crossings(samples: &[Sample], keypoints: &[DVec3], radians: f64) -> Vec<Crossing> {
    let mut found: Vec<Crossing> = Vec::new();
    for (i, sample) in samples.iter().enumerate() {
        let Some(eye) = sample.eye else { continue };
        let ray = (sample.at - eye).normalize_or_zero();
        // Of what is seen at one place the nearest to where one draws.
        let nearest = keypoints
            .iter()
            .map(|&point| (point, (point - eye).angle_between(ray)))
            .filter(|(_, off)| *off < radians)
            .min_by(|a, b| {
                let deep = |p: DVec3| p.distance(sample.at);
                (a.1 + 1e-3 * deep(a.0)).total_cmp(&(b.1 + 1e-3 * deep(b.0)))
            });
        let Some((point, off)) = nearest else {
            continue;
        };
        match found.last_mut().filter(|c| c.point == point) {
            Some(last) if off < last.off => (last.sample, last.off) = (i, off),
            Some(_) => {}
            None => found.push(Crossing {
                sample: i,
                point,
                off,
            }),
        }
    }
    found
}

/// A point and the unit normal of the plane that the keypoints span, if they span one.
fn plane(crossings: &[Crossing]) -> Option<(DVec3, DVec3)> {
    let mut points: Vec<DVec3> = Vec::new();
    for c in crossings {
        if !points.contains(&c.point) {
            points.push(c.point);
        }
    }
    if points.len() < 3 {
        return None;
    }
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let size = points
        .iter()
        .map(|p| p.distance(middle))
        .fold(0.0, f64::max);
    let (mut best, mut normal) = (0.0, DVec3::ZERO);
    for i in 0..points.len() {
        for j in 0..i {
            let n = (points[i] - middle).cross(points[j] - middle);
            if n.length() > best {
                (best, normal) = (n.length(), n.normalize());
            }
        }
    }
    let flat = points
        .iter()
        .all(|p| (*p - middle).dot(normal).abs() < FLAT * size);
    (flat && best > 0.05 * size * size).then_some((middle, normal))
}

fn on_plane(sample: &Sample, middle: DVec3, normal: DVec3) -> Option<DVec3> {
    let eye = sample.eye?;
    let ray = (sample.at - eye).try_normalize()?;
    let towards = ray.dot(normal);
    // Seen from its edge it gives no depth.
    if towards.abs() < 0.08 {
        return None;
    }
    let far = (middle - eye).dot(normal) / towards;
    (far > 0.0).then(|| eye + ray * far)
}

#[cfg(test)]
mod tests {
    use super::*;

    const EYE: DVec3 = DVec3::new(0.0, 0.0, 3.0);

    fn seen(at: DVec3) -> Sample {
        // Drawn in the plane z = 0, wherever it is meant to be.
        let ray = at - EYE;
        Sample {
            at: EYE + ray * (3.0 / -ray.z),
            eye: Some(EYE),
        }
    }

    #[test]
    fn a_stroke_across_three_corners_lies_in_their_plane() {
        let corners = [
            DVec3::new(-0.3, -0.2, 0.2),
            DVec3::new(0.3, -0.2, -0.4),
            DVec3::new(0.0, 0.4, -0.1),
        ];
        let meant: Vec<DVec3> = (0..3)
            .flat_map(|k| (0..20).map(move |i| (k, f64::from(i) / 20.0)))
            .map(|(k, t)| corners[k].lerp(corners[(k + 1) % 3], t))
            .collect();
        let samples: Vec<Sample> = meant.iter().map(|&p| seen(p)).collect();
        for (p, q) in lift(&samples, &corners, 0.01).iter().zip(&meant) {
            assert!(p.distance(*q) < 1e-9, "{p} {q}");
        }
    }

    #[test]
    fn between_two_keypoints_the_depth_goes_evenly() {
        let ends = [DVec3::new(-0.3, 0.0, 0.5), DVec3::new(0.3, 0.0, -0.5)];
        let samples: Vec<Sample> = (0..=40)
            .map(|i| seen(ends[0].lerp(ends[1], f64::from(i) / 40.0)))
            .collect();
        let out = lift(&samples, &ends, 0.005);
        assert!(out[0].distance(ends[0]) < 1e-9 && out[40].distance(ends[1]) < 1e-9);
        assert!(out.windows(2).all(|p| p[1].z < p[0].z));
    }

    #[test]
    fn near_no_keypoint_it_stays_where_it_was_drawn() {
        let samples = [seen(DVec3::ZERO), seen(DVec3::X * 0.1)];
        let out = lift(&samples, &[DVec3::Y], 0.01);
        assert_eq!(out, [samples[0].at, samples[1].at]);
    }
}
