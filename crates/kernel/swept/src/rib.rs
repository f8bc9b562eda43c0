use glam::{DQuat, DVec3, Quat, Vec3};
use midair_curve::{End, Even, Frames, Hermite, Lengths, Pace};
use serde::{Deserialize, Serialize};

/// The curve at one moment of a sweep, as the two hands held it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rib {
    /// p₀ and p₁, metres.
    pub points: [Vec3; 2],
    /// m₀ and m₁, metres.
    pub tangents: [Vec3; 2],
    /// w₀ and w₁ (Eq. 11).
    #[serde(default = "even", skip_serializing_if = "is_even")]
    pub slopes: [f32; 2],
    /// How the left hand was turned: the frame's start.
    #[serde(default, skip_serializing_if = "is_level")]
    pub start: Quat,
    /// Radians by which the frame is turned at the other end: α + 2πk (§3.1.7).
    #[serde(default, skip_serializing_if = "is_none")]
    pub twist: f32,
}

fn even() -> [f32; 2] {
    [1.0; 2]
}

fn is_even(slopes: &[f32; 2]) -> bool {
    *slopes == [1.0; 2]
}

fn is_level(q: &Quat) -> bool {
    *q == Quat::IDENTITY
}

fn is_none(x: &f32) -> bool {
    *x == 0.0
}

/// Points at even steps of u, each where the curve has run the share v(u) of its length.
fn spread(
    curve: Hermite,
    pace: Pace,
    count: usize,
) -> impl DoubleEndedIterator<Item = DVec3> + ExactSizeIterator {
    let even = Even::new(&curve);
    let last = count.max(2) - 1;
    (0..last + 1).map(move |i| curve.at(even.at(pace.at(i as f64 / last as f64))))
}

/// Points between which a rib's frame is made.
const FRAME_POINTS: usize = 64;

impl Rib {
    /// What the hands hold at this moment. `before` is the twist of the moment before, so that
    /// turns beyond 360° are counted.
    pub fn held(left: &End, right: &End, lengths: Lengths, slopes: [f32; 2], before: f64) -> Self {
        let curve = Hermite::between(left, right, lengths.0);
        let frames = Frames::new(&curve, left.rotation, FRAME_POINTS);
        let twist = midair_curve::unwound(frames.angle_to(right.rotation), before);
        Self {
            points: curve.points.map(|p| p.as_vec3()),
            tangents: curve.tangents.map(|m| m.as_vec3()),
            slopes: Pace::new(slopes.map(f64::from)).slopes.map(|w| w as f32),
            start: left.rotation.as_quat().normalize(),
            twist: twist as f32,
        }
    }

    /// The curve.
    pub fn curve(&self) -> Hermite {
        Hermite {
            points: self.points.map(|p| p.as_dvec3()),
            tangents: self.tangents.map(|m| m.as_dvec3()),
        }
    }

    /// How its points are spread.
    pub fn pace(&self) -> Pace {
        Pace::new(self.slopes.map(f64::from))
    }

    /// The frame along it.
    pub fn frames(&self) -> Frames {
        let start: DQuat = self.start.as_dquat();
        Frames::new(&self.curve(), start, FRAME_POINTS).twisted(f64::from(self.twist))
    }

    /// The right end as it was held: its position and how it was turned.
    pub fn right(&self) -> End {
        let frame = self.frames().at(1.0);
        End {
            position: self.points[1].as_dvec3(),
            rotation: DQuat::from_mat3(&frame).normalize(),
        }
    }

    /// The left end as it was held. Its x axis is along the curve.
    pub fn left(&self) -> End {
        let frame = self.frames().at(0.0);
        End {
            position: self.points[0].as_dvec3(),
            rotation: DQuat::from_mat3(&frame).normalize(),
        }
    }

    /// `count` points at even steps of u, at least two, both ends among them: each where the curve has
    /// run the share v(u) of its length.
    pub fn points_into(&self, count: usize, out: &mut Vec<Vec3>) {
        out.extend(spread(self.curve(), self.pace(), count).map(|p| p.as_vec3()));
    }

    /// The closed profile of a tube: 2·count − 2 points, the curve from left to right and its
    /// closing one back (§3.2.2). The first `count` are those of [`Rib::points_into`].
    pub fn ring_into(&self, count: usize, out: &mut Vec<Vec3>) {
        self.points_into(count, out);
        let back = spread(self.curve().closing(), self.pace(), count);
        let inner = back.rev().skip(1).take(count.max(2) - 2);
        out.extend(inner.map(|p| p.as_vec3()));
    }

    /// The largest distance between corresponding points of two ribs (§3.2.1's measure against ε).
    pub fn apart(&self, other: &Self, count: usize) -> f32 {
        let own = spread(self.curve(), self.pace(), count);
        own.zip(spread(other.curve(), other.pace(), count))
            .map(|(a, b)| a.distance_squared(b))
            .fold(0.0, f64::max)
            .sqrt() as f32
    }

    /// Whether every number is finite and the start is a rotation.
    pub fn is_sound(&self) -> bool {
        let vectors = self.points.iter().chain(&self.tangents);
        vectors
            .into_iter()
            .all(|v| v.is_finite() && v.abs().max_element() <= 1.0e4)
            && self.slopes.iter().all(|w| (0.0..=3.0).contains(w))
            && self.start.is_finite()
            && (self.start.length_squared() - 1.0).abs() < 1e-3
            && self.twist.is_finite()
    }

    /// Whether both ends are at one point, and the curve no more than the shortest tangents that hands
    /// there have (a millimetre).
    pub fn is_point(&self) -> bool {
        self.points[0].distance(self.points[1]) < 1.0e-4
            && self.tangents.iter().all(|m| m.length() < 1.1e-3)
    }

    /// Moved by `by`.
    #[must_use]
    pub fn shifted(self, by: Vec3) -> Self {
        Self {
            points: self.points.map(|p| p + by),
            ..self
        }
    }

    /// Between two ribs, in proportion.
    #[must_use]
    pub fn lerp(&self, to: &Self, t: f32) -> Self {
        let mix = |a: Vec3, b: Vec3| a + (b - a) * t;
        let pair = |a: [Vec3; 2], b: [Vec3; 2]| [mix(a[0], b[0]), mix(a[1], b[1])];
        let number = |a: f32, b: f32| a + (b - a) * t;
        Self {
            points: pair(self.points, to.points),
            tangents: pair(self.tangents, to.tangents),
            slopes: [
                number(self.slopes[0], to.slopes[0]).clamp(0.0, 3.0),
                number(self.slopes[1], to.slopes[1]).clamp(0.0, 3.0),
            ],
            start: self.start.slerp(to.start, t).normalize(),
            twist: number(self.twist, to.twist),
        }
    }
}
