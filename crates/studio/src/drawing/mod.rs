//! What is drawn, where hands can find it: construction lines, strokes and keypoints of the document in
//! world metres, and double precision.
//!
//! It follows the document and looks only at what changed.

use std::sync::Arc;

use bevy::math::DVec3;
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use midair_document::{Document, Object, ObjectId, affine};

use crate::StudioSet;
use crate::project::Project;
use crate::settings::{LinesShown, Settings};

/// A construction line as it stands in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneLine {
    /// Which object it is.
    pub id: ObjectId,
    /// Where it begins.
    pub a: DVec3,
    /// Where it ends.
    pub b: DVec3,
    /// Its tick marks besides ends and middle.
    pub ticks: Vec<DVec3>,
}

impl SceneLine {
    /// Ends, middle, tick marks.
    pub fn keypoints(&self) -> impl Iterator<Item = DVec3> + '_ {
        [self.a, self.b, self.a.midpoint(self.b)]
            .into_iter()
            .chain(self.ticks.iter().copied())
    }
}

/// A stroke as it stands in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneStroke {
    /// Which object it is.
    pub id: ObjectId,
    /// Points joined by straight lines.
    pub points: Arc<[DVec3]>,
    /// Whether it ends where it begins.
    pub closed: bool,
    /// Metres from its middle to its side.
    pub radius: f64,
    /// The box around it.
    low: DVec3,
    high: DVec3,
}

/// What is drawn and can be seen and touched: not what is hidden or locked away.
#[derive(Resource, Default)]
pub struct Drawing {
    lines: Vec<SceneLine>,
    strokes: Vec<SceneStroke>,
    /// What a stroke was made from, so that it is made anew only when that changes.
    known: HashMap<ObjectId, (Arc<Object>, SceneStroke)>,
}

/// A place on something that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnDrawing {
    /// Which object.
    pub id: ObjectId,
    /// The nearest point of its middle line.
    pub point: DVec3,
    /// Metres from there, less its radius; for a ray, metres along it.
    pub distance: f64,
}

impl Drawing {
    /// The construction lines, oldest first.
    pub fn lines(&self) -> &[SceneLine] {
        &self.lines
    }

    /// The strokes, oldest first.
    pub fn strokes(&self) -> &[SceneStroke] {
        &self.strokes
    }

    /// The keypoints of all lines: ends, middles, tick marks.
    pub fn keypoints(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.lines.iter().flat_map(SceneLine::keypoints)
    }

    /// What lies nearest to a point, within `reach` metres of its side.
    pub fn nearest(&self, to: DVec3, reach: f64) -> Option<OnDrawing> {
        let lines = self
            .lines
            .iter()
            .map(|l| (l.id, on_piece(to, l.a, l.b), 0.0));
        let near = |s: &&SceneStroke| {
            let out = (s.low - to).max(to - s.high).max(DVec3::ZERO);
            out.length() <= reach + s.radius
        };
        let strokes = self.strokes.iter().filter(near).filter_map(|s| {
            let on = |p: &[DVec3]| on_piece(to, p[0], p[1]);
            let nearest = s.points.windows(2).map(on);
            let nearest =
                nearest.min_by(|a, b| a.distance_squared(to).total_cmp(&b.distance_squared(to)));
            Some((s.id, nearest?, s.radius))
        });
        lines
            .chain(strokes)
            .map(|(id, point, radius)| OnDrawing {
                id,
                point,
                distance: (point.distance(to) - radius).max(0.0),
            })
            .filter(|on| on.distance <= reach)
            .min_by(|a, b| a.distance.total_cmp(&b.distance))
    }

    /// What is seen within `radians` of a ray from `origin` along the unit `towards`, for an eye at `eye`: the nearest to the
    /// ray, and how far along it that is.
    pub fn met(
        &self,
        (origin, towards): (DVec3, DVec3),
        eye: DVec3,
        radians: f64,
    ) -> Option<OnDrawing> {
        let lines = self.lines.iter().map(|l| (l.id, [l.a, l.b], 0.0));
        let near = |s: &&SceneStroke| {
            let middle = s.low.midpoint(s.high);
            let off = (middle - origin).reject_from_normalized(towards).length();
            let around = 0.5 * s.low.distance(s.high) + s.radius;
            off <= around + radians * (middle.distance(eye) + around)
        };
        let strokes = self.strokes.iter().filter(near);
        let strokes = strokes.flat_map(|s| {
            let pieces = s.points.windows(2);
            pieces.map(|p| (s.id, [p[0], p[1]], s.radius))
        });
        lines
            .chain(strokes)
            .filter_map(|(id, [a, b], radius)| {
                let point = nearest_to_ray((origin, towards), a, b);
                let far = (point - origin).dot(towards);
                let off = (point - origin).reject_from_normalized(towards).length() - radius;
                let seen = off.max(0.0) / point.distance(eye).max(1e-9);
                (far > 0.0 && seen <= radians).then_some((seen, id, point, far))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.3.total_cmp(&b.3)))
            .map(|(_, id, point, distance)| OnDrawing {
                id,
                point,
                distance,
            })
    }

    /// Follows the document. Construction lines that are hidden are not there.
    pub fn follow(&mut self, document: &Document, lines: LinesShown) {
        self.lines.clear();
        self.strokes.clear();
        let mut known = std::mem::take(&mut self.known);
        for (id, object) in document.objects() {
            if object.line().is_none() && object.stroke().is_none()
                || !document.is_visible(id)
                || document.is_locked(id)
            {
                continue;
            }
            if let Some(line) = object.line().filter(|_| lines != LinesShown::Hidden) {
                let there = affine(&object.placement);
                let at = |p: DVec3| there.transform_point3(p);
                self.lines.push(SceneLine {
                    id,
                    a: at(line.a),
                    b: at(line.b),
                    ticks: line.keypoints().skip(3).map(at).collect(),
                });
            }
            let Some(shared) = document.object_shared(id).filter(|o| o.stroke().is_some()) else {
                continue;
            };
            let made = known
                .remove(&id)
                .filter(|(from, _)| Arc::ptr_eq(from, shared))
                .or_else(|| Some((shared.clone(), stroke(id, object)?)));
            if let Some(made) = made {
                self.strokes.push(made.1.clone());
                self.known.insert(id, made);
            }
        }
    }
}

fn stroke(id: ObjectId, object: &Object) -> Option<SceneStroke> {
    let drawn = object.stroke()?;
    let there = affine(&object.placement);
    let points: Arc<[DVec3]> = drawn
        .points()
        .iter()
        .map(|&p| there.transform_point3(p))
        .collect();
    let fold = |f: fn(DVec3, DVec3) -> DVec3| points.iter().copied().reduce(f).unwrap_or_default();
    Some(SceneStroke {
        id,
        closed: drawn.closed,
        radius: 0.5 * drawn.width * f64::from(object.placement.scale.abs().max_element()),
        low: fold(DVec3::min),
        high: fold(DVec3::max),
        points,
    })
}

/// The nearest point of a straight piece.
pub fn on_piece(to: DVec3, a: DVec3, b: DVec3) -> DVec3 {
    let along = b - a;
    let t = (to - a).dot(along) / along.length_squared().max(1e-300);
    a + along * t.clamp(0.0, 1.0)
}

/// The point of a straight piece that is nearest to a ray.
fn nearest_to_ray((origin, towards): (DVec3, DVec3), a: DVec3, b: DVec3) -> DVec3 {
    // Seen along the ray, both are flat.
    let flat = |p: DVec3| (p - origin).reject_from_normalized(towards);
    let (from, to) = (flat(a), flat(b));
    let along = to - from;
    let t = -from.dot(along) / along.length_squared().max(1e-300);
    a + (b - a) * t.clamp(0.0, 1.0)
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Drawing>().add_systems(
        Update,
        // Hands find what is drawn as the frame before left it; what is asked for in this one is in already.
        follow.in_set(StudioSet::Ask).in_set(FollowDrawing),
    );
}

/// The step in which [`Drawing`] follows the document.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct FollowDrawing;

fn follow(project: Res<Project>, settings: Res<Settings>, mut drawing: ResMut<Drawing>) {
    if project.is_changed() || settings.is_changed() {
        drawing.follow(project.document(), settings.scaffold.lines);
    }
}

#[cfg(test)]
mod tests {
    use midair_document::{ConstructionLine, DrawnStroke, Edit, Kind};

    use super::*;

    fn drawn() -> Document {
        let mut document = Document::new();
        let line = ConstructionLine {
            ticks: vec![0.25],
            ..ConstructionLine::raw(DVec3::ZERO, DVec3::X)
        };
        let stroke = DrawnStroke::raw(vec![DVec3::Z, DVec3::Z + DVec3::Y], 0.02);
        for kind in [Kind::Line(line), Kind::Stroke(stroke.into())] {
            let id = ObjectId(document.next_id());
            let object = Object::new("", kind).into();
            document.apply(&Edit::Add { id, object }).unwrap();
        }
        document
    }

    #[test]
    fn what_is_drawn_is_found_from_a_point() {
        let mut drawing = Drawing::default();
        drawing.follow(&drawn(), LinesShown::Shown);
        assert_eq!(drawing.keypoints().count(), 4);
        let found = drawing.nearest(DVec3::new(0.4, 0.01, 0.0), 0.02).unwrap();
        assert_eq!((found.id, found.point), (ObjectId(1), DVec3::X * 0.4));
        assert!(drawing.nearest(DVec3::new(0.4, 0.5, 0.0), 0.02).is_none());
        drawing.follow(&drawn(), LinesShown::Hidden);
        assert!(drawing.lines().is_empty() && drawing.strokes().len() == 1);
    }
}
