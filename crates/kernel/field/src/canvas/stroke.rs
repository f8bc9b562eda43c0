use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};
use midair_mesh::Aabb;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::kernel::{Edge, Family, T};
use crate::recipe::transformed;
use crate::{Node, Placement, Recipe};

/// What a stroke is convolved from. Lengths in metres, in the stroke's own frame. `R` is how a solid
/// is held, by value everywhere but inside files.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Skeleton<R = Recipe> {
    /// A point, or the way it was led: its potential is the greatest along the way, so that a hand
    /// that rests does not swell the stroke. x, y, z, and the factor on the stroke's radius there.
    Points(Arc<[Vec4]>),
    /// A line between two points.
    Line(Vec3, Vec3),
    /// A flat area with these corners in order; corners beside the plane that fits them best are
    /// brought into it.
    Polygon(Arc<[Vec3]>),
    /// A solid. A painting keeps its own potential; anything else has that of the half-space along
    /// its surface, which falls off within the stroke's radius.
    Volume(R),
}

/// One stroke of a canvas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stroke<R = Recipe> {
    /// What it is convolved from.
    pub skeleton: Skeleton<R>,
    /// How far its surface lies from its skeleton, metres; for a volume, how far it melts.
    pub radius: f32,
    /// The factor on its potential, λ in 3DBrushVR Eq. 3.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub weight: f32,
    /// It takes away from the strokes before it. Those after it are not touched.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub erase: bool,
    /// Strokes that follow each other with one number here, not 0, are one: where several are felt, the
    /// most that one of them is felt counts, so that a led point and its mirror image do not swell
    /// where they meet.
    #[serde(default, skip_serializing_if = "is_none")]
    pub twin: u32,
    /// Where it stands on the canvas; its scale scales the radius as well.
    #[serde(default)]
    pub placement: Placement,
}

/// A painting: its strokes in the order they were painted (3DBrushVR §4.1 Eq. 3).
///
/// Potentials F are joined from the first stroke to the last: a painted one by (Fᵖ + Fᵢᵖ)^(1/p), an
/// erasing one by taking it away from what stands, held below 2T first and above 0 after, so that
/// the erased hole has the eraser's own radius and later strokes are whole. The surface is F = T.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Canvas {
    /// In the order they were painted.
    pub strokes: Vec<Stroke>,
    /// p: 1 superposes (two halves of a line are the line), from [`HARD`] on strokes are united
    /// as they are.
    #[serde(default = "one")]
    pub blend: f32,
    /// How far strokes feel each other: their support over their radius, above 1.
    #[serde(default = "reach")]
    pub reach: f32,
}

/// The exponent from which strokes no longer melt.
pub const HARD: f32 = 16.0;
/// The most strokes of one canvas.
pub const MAX_STROKES: usize = 65_536;
/// The most points of one stroke.
pub const MAX_POINTS: usize = 65_536;

fn one() -> f32 {
    1.0
}

fn is_one(x: &f32) -> bool {
    *x == 1.0
}

fn is_none(x: &u32) -> bool {
    *x == 0
}

/// Where the potential of a point falls off most evenly at its surface: F″ = 0 at u = 1/√3.
fn reach() -> f32 {
    1.75
}

/// Why a canvas is not sound.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CanvasError {
    /// A skeleton with points that are not finite, or too few or too many of them.
    #[error(
        "stroke {0} has no skeleton that can be painted: its points are not finite, too few or too many"
    )]
    Skeleton(usize),
    /// A radius or weight that means nothing.
    #[error("stroke {0} has a radius or weight that is not a positive number")]
    Radius(usize),
    /// A stroke that stands nowhere.
    #[error("stroke {0} stands nowhere: its placement is not finite, or scaled by zero")]
    Placement(usize),
    /// A blend or reach out of range.
    #[error("a canvas blends with an exponent of at least 1 and a reach between 1.05 and 4")]
    Blend,
    /// Too many strokes.
    #[error("a canvas of {0} strokes; at most {MAX_STROKES} are possible")]
    TooMany(usize),
}

impl Default for Canvas {
    fn default() -> Self {
        Self {
            strokes: Vec::new(),
            blend: one(),
            reach: reach(),
        }
    }
}

impl<R> Stroke<R> {
    /// The same stroke with its solid held in another way.
    ///
    /// # Errors
    /// What `f` gives.
    pub fn map<S, E>(&self, f: &mut impl FnMut(&R) -> Result<S, E>) -> Result<Stroke<S>, E> {
        Ok(Stroke {
            skeleton: match &self.skeleton {
                Skeleton::Points(points) => Skeleton::Points(points.clone()),
                Skeleton::Line(a, b) => Skeleton::Line(*a, *b),
                Skeleton::Polygon(corners) => Skeleton::Polygon(corners.clone()),
                Skeleton::Volume(solid) => Skeleton::Volume(f(solid)?),
            },
            radius: self.radius,
            weight: self.weight,
            erase: self.erase,
            twin: self.twin,
            placement: self.placement,
        })
    }
}

impl Stroke {
    /// A stroke of weight 1 that stands where its skeleton does.
    pub fn new(skeleton: Skeleton, radius: f32) -> Self {
        Self {
            skeleton,
            radius,
            weight: 1.0,
            erase: false,
            twin: 0,
            placement: Placement::IDENTITY,
        }
    }

    /// A ball.
    pub fn point(at: Vec3, radius: f32) -> Self {
        Self::new(Skeleton::Points(Arc::new([at.extend(1.0)])), radius)
    }

    /// Whether it is one with the stroke before it.
    pub(super) fn is_twin(&self, before: &Self) -> bool {
        self.twin != 0 && self.twin == before.twin && self.erase == before.erase
    }

    /// The weight with which a line or polygon too short to fill the kernel still has its surface
    /// at the radius, over its middle: 1 for all others.
    pub fn fitted_weight(&self, reach: f32) -> f32 {
        let family = Family::new(reach);
        let support = reach * self.radius;
        let there = match &self.skeleton {
            Skeleton::Line(a, b) => {
                let half = 0.5 * a.distance(*b) / support;
                family.at_line(family.inverse, -half, half)
            }
            Skeleton::Polygon(corners) => match Flat::new(corners) {
                Some(flat) => {
                    let corners: Vec<Vec2> = flat.corners.iter().map(|c| c / support).collect();
                    let mean = corners.iter().sum::<Vec2>() / corners.len() as f32;
                    family.at_polygon(&Edge::all(&corners), mean, 1.0 / reach)
                }
                None => T,
            },
            _ => T,
        };
        (T / there.max(0.02 * T)).max(1.0)
    }

    /// The box of the skeleton in the stroke's own frame, grown by `radii` of its radius; for a
    /// volume the box of its solid.
    fn own_box(&self, radii: f32) -> Aabb {
        let spread = |points: &mut dyn Iterator<Item = (Vec3, f32)>| {
            points.fold(Aabb::EMPTY, |all, (p, size)| {
                all.union(&Aabb::around(p, Vec3::splat(size * self.radius * radii)))
            })
        };
        match &self.skeleton {
            Skeleton::Points(points) => spread(&mut points.iter().map(|p| (p.truncate(), p.w))),
            Skeleton::Line(a, b) => spread(&mut [*a, *b].into_iter().map(|p| (p, 1.0))),
            Skeleton::Polygon(corners) => spread(&mut corners.iter().map(|p| (*p, 1.0))),
            Skeleton::Volume(recipe) if recipe.bounds().is_empty() => Aabb::EMPTY,
            Skeleton::Volume(recipe) if radii > 1.0 => recipe.bounds().grown(self.melt()),
            Skeleton::Volume(recipe) => recipe.bounds(),
        }
    }

    /// How far beyond its surface a volume is felt, in its own metres.
    fn melt(&self) -> f32 {
        let Skeleton::Volume(recipe) = &self.skeleton else {
            return 0.0;
        };
        match unnamed(recipe).node() {
            Node::Canvas(canvas) => canvas.melt(),
            _ => self.radius,
        }
    }

    fn is_finite(&self) -> bool {
        match &self.skeleton {
            Skeleton::Points(points) => {
                let sound = |p: &Vec4| p.is_finite() && p.w > 0.0;
                (1..=MAX_POINTS).contains(&points.len()) && points.iter().all(sound)
            }
            Skeleton::Line(a, b) => a.is_finite() && b.is_finite() && a != b,
            Skeleton::Polygon(corners) => {
                (3..=MAX_POINTS).contains(&corners.len())
                    && corners.iter().all(|c| c.is_finite())
                    && Flat::new(corners).is_some()
            }
            Skeleton::Volume(_) => true,
        }
    }
}

impl Canvas {
    /// A number that no stroke is named a twin by.
    pub fn next_twin(&self) -> u32 {
        let most = self.strokes.iter().map(|s| s.twin).max();
        most.unwrap_or(0).wrapping_add(1).max(1)
    }

    /// Whether every number in it makes sense; the solids it holds aside.
    ///
    /// # Errors
    /// The first thing that is not so.
    pub fn validate(&self) -> Result<(), CanvasError> {
        if self.strokes.len() > MAX_STROKES {
            return Err(CanvasError::TooMany(self.strokes.len()));
        }
        if !(self.blend >= 1.0 && (1.05..=4.0).contains(&self.reach)) {
            return Err(CanvasError::Blend);
        }
        for (i, stroke) in self.strokes.iter().enumerate() {
            if !stroke.is_finite() {
                return Err(CanvasError::Skeleton(i + 1));
            }
            let positive = |x: f32| x > 0.0 && x.is_finite();
            if !positive(stroke.radius) || !positive(stroke.weight) {
                return Err(CanvasError::Radius(i + 1));
            }
            if !stroke.placement.is_sound() {
                return Err(CanvasError::Placement(i + 1));
            }
        }
        Ok(())
    }

    /// The solids its strokes hold.
    pub fn recipes(&self) -> impl Iterator<Item = &Recipe> {
        self.strokes.iter().filter_map(|s| match &s.skeleton {
            Skeleton::Volume(recipe) => Some(recipe),
            _ => None,
        })
    }

    /// A box around the surface: each stroke alone has it within its radius, and where n of them
    /// feel each other one of them has at least T·n^(−1/p) there.
    pub(crate) fn bounds(&self) -> Aabb {
        let painted: Vec<&Stroke> = self.strokes.iter().filter(|s| !s.erase).collect();
        let placed = |s: &Stroke, radii: f32| transformed(&s.own_box(radii), &s.placement.affine());
        let many = painted.len() > 64;
        let felt: Vec<Aabb> = if many {
            Vec::new()
        } else {
            painted.iter().map(|s| placed(s, self.reach)).collect()
        };
        let mut all = Aabb::EMPTY;
        for (i, stroke) in painted.iter().enumerate() {
            let near = if many {
                usize::MAX
            } else {
                let own = &felt[i];
                felt.iter()
                    .filter(|b| !b.intersection(own).is_empty())
                    .count()
            };
            all = all.union(&placed(stroke, self.radii(near, stroke.weight)));
        }
        all
    }

    /// How far beyond its surface it is felt at most.
    fn melt(&self) -> f32 {
        let each = self.strokes.iter().filter(|s| !s.erase).map(|s| {
            let own = match &s.skeleton {
                Skeleton::Points(points) => {
                    let widest = points.iter().map(|p| p.w).fold(0.0, f32::max);
                    (self.reach - 1.0) * s.radius * widest
                }
                Skeleton::Volume(_) => s.melt(),
                _ => (self.reach - 1.0) * s.radius,
            };
            own * s.placement.scale.abs().max_element()
        });
        each.fold(0.0, f32::max)
    }

    /// How far, in radii, the surface can lie from one of `near` strokes.
    fn radii(&self, near: usize, weight: f32) -> f32 {
        if near == usize::MAX {
            return self.reach;
        }
        if near <= 1 && weight <= 1.0 {
            return 1.0;
        }
        let share = T * (near as f32).powf(-1.0 / self.blend.min(HARD)) / weight;
        let family = Family::new(self.reach);
        // The steepest of the three profiles reaches furthest: u² = 1 − (F/F(0))^½.
        let u2 = 1.0 - (share / family.point).min(1.0).sqrt();
        (u2.sqrt() * self.reach).max(1.0)
    }
}

/// A polygon in the plane that fits it best.
#[derive(Clone, Debug)]
pub(super) struct Flat {
    pub origin: Vec3,
    pub x: Vec3,
    pub y: Vec3,
    pub normal: Vec3,
    /// Counter-clockwise seen along the normal.
    pub corners: Vec<Vec2>,
}

impl Flat {
    /// `None` for corners that enclose nothing.
    pub fn new(corners: &[Vec3]) -> Option<Self> {
        let n = corners.len();
        let origin = corners.iter().sum::<Vec3>() / n as f32;
        // Newell's normal: twice the area it encloses.
        let mut area = Vec3::ZERO;
        for (i, a) in corners.iter().enumerate() {
            area += (a - origin).cross(corners[(i + 1) % n] - origin);
        }
        let reach = corners
            .iter()
            .map(|c| c.distance_squared(origin))
            .fold(0.0, f32::max);
        if !(area.length() > 1.0e-6 * reach && reach > 0.0) {
            return None;
        }
        let normal = area.normalize();
        let (x, y) = normal.any_orthonormal_pair();
        let (x, y) = if x.cross(y).dot(normal) < 0.0 {
            (y, x)
        } else {
            (x, y)
        };
        let corners = corners
            .iter()
            .map(|c| Vec2::new((c - origin).dot(x), (c - origin).dot(y)))
            .collect();
        Some(Self {
            origin,
            x,
            y,
            normal,
            corners,
        })
    }
}

/// What a solid is under the names it was given.
pub(super) fn unnamed(recipe: &Recipe) -> &Recipe {
    match recipe.node() {
        Node::Component { recipe, .. } => unnamed(recipe),
        _ => recipe,
    }
}
