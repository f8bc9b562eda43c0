//! What is drawn and not closed: construction lines and shape strokes (ScaffoldSketch §3.2).
//!
//! Both keep what the hand drew beside what became of it, and what the correction was told, so that
//! it can be done once more with more or less strength. Metres and radians, double precision, in the
//! frame of their object.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use midair_curve::{CubicBezier, Spline};
use midair_field::Placement;
use midair_mesh::Aabb;
use serde::{Deserialize, Serialize};

use crate::ObjectId;

/// A stroke may have this many points and segments: an hour of drawing in one go has fewer.
pub const MAX_POINTS: usize = 20_000;

/// A straight construction line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConstructionLine {
    /// Where it begins.
    pub a: DVec3,
    /// Where it ends.
    pub b: DVec3,
    /// Where the hand began and ended it.
    pub raw: [DVec3; 2],
    /// Tick marks between its ends, as shares of its length in (0, 1). Ends and middle are keypoints
    /// without them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ticks: Vec<f64>,
    /// The relations it was brought into.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub kept: Vec<Kept>,
    /// What the correction was told.
    #[serde(default)]
    pub reading: LineReading,
}

/// A relation that a correction brought about: a record, not a link. It names the other object where
/// there is one, which may be gone by now.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Kept {
    /// Which relation.
    pub relation: Relation,
    /// The end that it is about: `false` where the line begins, `true` where it ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<bool>,
    /// The line it relates to; `None` for the vertical.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub with: Option<ObjectId>,
}

/// What can hold between two lines (ScaffoldSketch §4.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Relation {
    /// An end lies on a keypoint.
    Meets,
    /// An end lies on the line.
    Touches,
    /// Square.
    Square,
    /// Parallel.
    Parallel,
    /// As long.
    Equal,
    /// At an angle that is a whole part of a turn.
    Angle,
}

impl Relation {
    /// The mark beside the line.
    pub fn mark(self) -> &'static str {
        match self {
            Self::Meets => "●",
            Self::Touches => "○",
            Self::Square => "⟂",
            Self::Parallel => "‖",
            Self::Equal => "=",
            Self::Angle => "∠",
        }
    }

    /// Its name in reports and words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Meets => "meets",
            Self::Touches => "touches",
            Self::Square => "square",
            Self::Parallel => "parallel",
            Self::Equal => "equal",
            Self::Angle => "angle",
        }
    }
}

/// What a line's correction was told.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LineReading {
    /// Whether it was corrected at all.
    pub auto: bool,
    /// Metres of world between an end and a keypoint or line.
    pub distance: f64,
    /// Radians off parallel or square.
    pub angle: f64,
    /// Off equal length, as a share.
    pub length: f64,
}

impl Default for LineReading {
    fn default() -> Self {
        Self {
            auto: false,
            distance: 0.05,
            angle: 10.0_f64.to_radians(),
            length: 0.25,
        }
    }
}

/// A shape stroke: what was drawn, and the curve that became of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DrawnStroke {
    /// The points of the hand, in order.
    pub raw: Vec<DVec3>,
    /// The control points of its cubic segments, each beginning where the one before ends. None: the
    /// stroke is what was drawn.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub segments: Vec<[DVec3; 4]>,
    /// Whether it ends where it begins, smoothly.
    #[serde(default)]
    pub closed: bool,
    /// Metres from side to side of the tube it is drawn as.
    pub width: f64,
    /// The keypoints that the curve goes through.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub through: Vec<Through>,
    /// What the correction was told.
    #[serde(default)]
    pub reading: StrokeReading,
}

/// A keypoint of a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Through {
    /// Where.
    pub point: DVec3,
    /// Whether it is one of the scaffold, and not a point that was drawn.
    pub of_scaffold: bool,
    /// Whether the curve follows a line there.
    pub along_line: bool,
}

/// What a stroke's correction was told.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct StrokeReading {
    /// Whether it was corrected at all.
    pub auto: bool,
    /// Metres of world within which it goes through a keypoint.
    pub distance: f64,
    /// Radians within which it follows a line there.
    pub angle: f64,
    /// Metres of world between its samples.
    pub spacing: f64,
}

impl Default for StrokeReading {
    fn default() -> Self {
        Self {
            auto: false,
            distance: 0.03,
            angle: 25.0_f64.to_radians(),
            spacing: 0.01,
        }
    }
}

/// Why a line or a stroke cannot be part of a document.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DrawingFault {
    /// A number that is none.
    #[error("one of its points is not a place")]
    NotFinite,
    /// Less than two points, or more than any stroke has.
    #[error("a stroke has 2 to {MAX_POINTS} points")]
    Points,
    /// A width that is none.
    #[error("its width is not between 0 and 1 m")]
    Width,
    /// A tick mark that is not between the ends.
    #[error("a tick mark is not between its ends")]
    Tick,
    /// A segment that does not begin where the one before ends.
    #[error("its segments do not meet")]
    Apart,
}

impl ConstructionLine {
    /// As drawn, with nothing kept.
    pub fn raw(a: DVec3, b: DVec3) -> Self {
        Self {
            a,
            b,
            raw: [a, b],
            ticks: Vec::new(),
            kept: Vec::new(),
            reading: LineReading::default(),
        }
    }

    /// Both ends.
    pub fn ends(&self) -> [DVec3; 2] {
        [self.a, self.b]
    }

    /// Ends, middle, tick marks (§3.2).
    pub fn keypoints(&self) -> impl Iterator<Item = DVec3> + '_ {
        let ticks = self.ticks.iter().map(|&t| self.a.lerp(self.b, t));
        [self.a, self.b, self.a.midpoint(self.b)]
            .into_iter()
            .chain(ticks)
    }

    pub(crate) fn check(&self) -> Result<(), DrawingFault> {
        let points = [self.a, self.b, self.raw[0], self.raw[1]];
        let reading = [
            self.reading.distance,
            self.reading.angle,
            self.reading.length,
        ];
        if !points.iter().all(|p| p.is_finite()) || !reading.iter().all(|n| n.is_finite()) {
            return Err(DrawingFault::NotFinite);
        }
        if !self.ticks.iter().all(|t| *t > 0.0 && *t < 1.0) {
            return Err(DrawingFault::Tick);
        }
        Ok(())
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.ticks[..]) + size_of_val(&self.kept[..])
    }
}

impl DrawnStroke {
    /// As drawn.
    pub fn raw(points: Vec<DVec3>, width: f64) -> Self {
        Self {
            raw: points,
            segments: Vec::new(),
            closed: false,
            width,
            through: Vec::new(),
            reading: StrokeReading::default(),
        }
    }

    /// Its curve; empty where the stroke is what was drawn.
    pub fn spline(&self) -> Spline {
        Spline {
            segments: self.segments.iter().map(|&p| CubicBezier(p)).collect(),
        }
    }

    /// The stroke as points joined by straight lines: the curve in sixteen pieces a segment, or what
    /// was drawn. The last point is the first one where it is closed.
    pub fn points(&self) -> Vec<DVec3> {
        if self.segments.is_empty() {
            self.raw.clone()
        } else {
            self.spline().flattened(16).points().to_vec()
        }
    }

    pub(crate) fn check(&self) -> Result<(), DrawingFault> {
        let mut control = self.segments.iter().flatten();
        let numbers = [
            self.reading.distance,
            self.reading.angle,
            self.reading.spacing,
        ];
        let finite = self.raw.iter().all(|p| p.is_finite())
            && control.all(|p| p.is_finite())
            && self.through.iter().all(|k| k.point.is_finite())
            && numbers.iter().all(|n| n.is_finite());
        if !finite {
            return Err(DrawingFault::NotFinite);
        }
        let lists = [self.raw.len(), self.segments.len(), self.through.len()];
        if self.raw.len() < 2 || lists.iter().any(|&n| n > MAX_POINTS) {
            return Err(DrawingFault::Points);
        }
        if !(self.width > 0.0 && self.width <= 1.0) {
            return Err(DrawingFault::Width);
        }
        let apart = |pair: &[[DVec3; 4]]| pair[0][3].distance(pair[1][0]) > 1e-9;
        if self.segments.windows(2).any(apart) {
            return Err(DrawingFault::Apart);
        }
        Ok(())
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of::<Self>()
            + size_of_val(&self.raw[..])
            + size_of_val(&self.segments[..])
            + size_of_val(&self.through[..])
    }
}

/// The motion that a placement is, in double precision: points of an object to points of the world.
/// Whole placements take nothing from what holds between lines.
pub fn affine(placement: &Placement) -> DAffine3 {
    let q = placement.rotation;
    let turn = DQuat::from_xyzw(q.x.into(), q.y.into(), q.z.into(), q.w.into());
    // A single-precision rotation is of unit length to 1e-7 only.
    let turn = DMat3::from_quat(turn.normalize());
    DAffine3::from_mat3_translation(
        turn * DMat3::from_diagonal(placement.scale.as_dvec3()),
        placement.translation.as_dvec3(),
    )
}

/// The box around points and what is drawn `margin` metres around them.
pub(crate) fn around(points: impl IntoIterator<Item = DVec3>, margin: f64) -> Aabb {
    let (low, high) = points
        .into_iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        });
    if !low.cmple(high).all() {
        return Aabb::EMPTY;
    }
    Aabb {
        min: (low - margin).as_vec3(),
        max: (high + margin).as_vec3(),
    }
}
