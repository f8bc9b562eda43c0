//! Points of the surface, and where its sides meet, found with the field.

use glam::{Mat3, Vec3};

use super::near::Near;

/// The cosine of the angle between two sides from which what lies between them is sharp: 15°.
const SHARP: f32 = 0.966;
/// In steps: for differences of the field.
const DELTA: f32 = 0.03;
/// In steps: from how far beside the edge its sides are looked at, each time nearer.
const BESIDE: [f32; 2] = [0.3, 0.1];
/// The cosine of the angle by which a flat side turns, at most.
const FLAT: f32 = 0.9999;
/// In steps: how far off the surface a point of an edge may lie.
const OFF: f32 = 0.02;
/// In steps: how near to a vertex an edge is too near to be worth a split.
const NEAR: f32 = 0.01;
/// How far from straight the field may run through a vertex, as a share of its slope, before the vertex
/// itself counts as lying on an edge.
const BENT: f32 = 0.04;
/// In steps: how far beside an edge a vertex is set down that would come to lie on it.
const ASIDE: f32 = 0.12;
/// In steps: how far a vertex may be moved to lie on the surface.
const MOST: f32 = 0.4;
/// In steps: how far from the middle of what bridges it an edge or a corner may lie.
const REACH: f32 = 1.5;

/// A point of the surface, and the normal there.
#[derive(Clone, Copy)]
pub(super) struct Foot {
    pub at: Vec3,
    pub normal: Vec3,
    /// Whether it lies on an edge, so that it belongs to no side.
    pub edge: bool,
}

/// The field at a point.
struct Sample {
    here: f32,
    gradient: Vec3,
    /// Whether it turns a corner there.
    edge: bool,
}

/// A point where two sides meet.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    pub at: Vec3,
    /// Of the side that the first end lies on, and of the other.
    pub normals: [Vec3; 2],
}

/// Looks at the field, which is told at eight points together.
pub(super) struct Sampler<'f> {
    field: &'f Near<'f>,
    step: f32,
}

impl<'f> Sampler<'f> {
    pub fn new(field: &'f Near<'f>) -> Self {
        Self {
            step: field.step(),
            field,
        }
    }

    /// Square metres below which a piece counts as without area, doubled.
    pub fn least(&self) -> f32 {
        1e-5 * self.step * self.step
    }

    /// The field around a point; `None` where it is no distance, or the point between two sides.
    fn sample(&self, p: Vec3) -> Option<Sample> {
        let d = DELTA * self.step;
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| d * axis);
        let around = [p, p, p + x, p - x, p + y, p - y, p + z, p - z];
        let [here, _, east, west, up, down, south, north] = self.field.at_all(&around);
        let pairs = [(east, west), (up, down), (south, north)];
        let gradient = Vec3::from_array(pairs.map(|(a, b)| (a - b) / (2.0 * d)));
        let bend = Vec3::from_array(pairs.map(|(a, b)| (a + b - 2.0 * here) / (2.0 * d)));
        let slope = gradient.length();
        (0.5..2.0).contains(&slope).then_some(Sample {
            here,
            gradient,
            edge: bend.length() > BENT * slope,
        })
    }

    /// The nearest point of the surface, by Newton's method.
    fn foot(&self, from: Vec3) -> Option<Foot> {
        let mut at = from;
        let mut sample = self.sample(at)?;
        for _ in 0..2 {
            if sample.here.abs() < 0.001 * self.step {
                break;
            }
            at -= sample.here * sample.gradient / sample.gradient.length_squared();
            sample = self.sample(at)?;
        }
        let on = sample.here.abs() < OFF * self.step && at.distance(from) < MOST * self.step;
        on.then_some(Foot {
            at,
            normal: sample.gradient.try_normalize()?,
            edge: sample.edge,
        })
    }

    /// As [`Self::foot`]; what would come to lie on an edge is set down beside it, so that it has a side.
    pub fn footing(&self, from: Vec3) -> Option<Foot> {
        let foot = self.foot(from)?;
        if !foot.edge {
            return Some(foot);
        }
        let (u, v) = foot.normal.any_orthonormal_pair();
        let aside = [u, -u, v, -v].map(|way| self.foot(foot.at + ASIDE * self.step * way));
        let clear = aside.into_iter().flatten().filter(|f| !f.edge);
        let distance = |f: &Foot| f.at.distance_squared(from);
        Some(
            clear
                .min_by(|a, b| distance(a).total_cmp(&distance(b)))
                .unwrap_or(foot),
        )
    }

    /// Where the sides of two points of the surface meet, if what lies between them is sharp.
    pub fn edge(&self, a: Foot, b: Foot) -> Option<Edge> {
        if a.edge || b.edge {
            return None;
        }
        let middle = 0.5 * (a.at + b.at);
        let mut sides = [a, b];
        let mut at = straight(meet(middle, sides)?, sides)?;
        for beside in BESIDE {
            let mut flat = true;
            for (side, end) in sides.iter_mut().zip([a, b]) {
                let here = self.foot(self.beside(at, end.at, beside)?)?;
                let turned = here.normal.dot(end.normal);
                if turned < 0.7 {
                    return None;
                }
                flat &= turned > FLAT;
                if !here.edge {
                    *side = here;
                }
            }
            at = meet(at, sides)?;
            // From nearer it would look the same.
            if flat {
                break;
            }
        }
        let sharp = self.field.at(at).abs() < OFF * self.step
            && at.distance(middle) < REACH * self.step
            && at.distance(a.at).min(at.distance(b.at)) > NEAR * self.step;
        sharp.then_some(Edge {
            at,
            normals: sides.map(|s| s.normal),
        })
    }

    /// A point a little way from an edge into the side on which `end` lies.
    fn beside(&self, edge: Vec3, end: Vec3, steps: f32) -> Option<Vec3> {
        let length = edge.distance(end);
        let way = (steps * self.step).min(0.7 * length);
        (length > 0.0).then(|| edge + (way / length) * (end - edge))
    }

    /// Where three sides meet, near the triangle between them.
    pub fn corner(&self, ends: [Foot; 3]) -> Option<Vec3> {
        let middle = (ends[0].at + ends[1].at + ends[2].at) / 3.0;
        let mut sides = ends;
        let mut at = meet_three(sides)?;
        for beside in BESIDE {
            for (side, end) in sides.iter_mut().zip(ends) {
                // Close to an edge of its own it tells nothing new.
                if let Some(here) = self.foot(self.beside(at, end.at, beside)?)
                    && !here.edge
                    && here.normal.dot(end.normal) > 0.7
                {
                    *side = here;
                }
            }
            at = meet_three(sides)?;
        }
        let there = self.field.at(at).abs() < OFF * self.step;
        (there && at.distance(middle) < REACH * self.step).then_some(at)
    }
}

/// The point nearest to `from` in both tangent planes; `None` where they are one side.
fn meet(from: Vec3, [a, b]: [Foot; 2]) -> Option<Vec3> {
    let c = a.normal.dot(b.normal);
    if c > SHARP {
        return None;
    }
    let (ra, rb) = (a.normal.dot(a.at - from), b.normal.dot(b.at - from));
    let det = 1.0 - c * c;
    // Two sides of a sheet have no line in common.
    (det > 0.05).then(|| from + ((ra - c * rb) / det) * a.normal + ((rb - c * ra) / det) * b.normal)
}

/// Where the way from one end to the other crosses the edge through `at`, were the two sides laid flat: so
/// that what is cut keeps the order that it has along the edge.
fn straight(at: Vec3, [a, b]: [Foot; 2]) -> Option<Vec3> {
    let along = a.normal.cross(b.normal).try_normalize()?;
    let place = |end: Foot| {
        let s = (end.at - at).dot(along);
        (s, (end.at - at - s * along).length())
    };
    let ((sa, da), (sb, db)) = (place(a), place(b));
    (da + db > 0.0).then(|| at + (sa * db + sb * da) / (da + db) * along)
}

/// The point in all three tangent planes.
fn meet_three(sides: [Foot; 3]) -> Option<Vec3> {
    let planes = Mat3::from_cols(sides[0].normal, sides[1].normal, sides[2].normal).transpose();
    let offsets = Vec3::from_array(sides.map(|s| s.normal.dot(s.at)));
    (planes.determinant().abs() > 0.1).then(|| planes.inverse() * offsets)
}
