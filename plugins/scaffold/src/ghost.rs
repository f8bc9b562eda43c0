//! The other readings of what was drawn last: faint, each with a place at which it is picked.

use bevy::math::DVec3;
use midair_curve::Polyline;
use midair_document::{DrawnStroke, Kind};
use midair_studio::drawing::on_piece;

use crate::phase::{Draft, Last, Phase};
use crate::read::Reading;

/// Ghosts and marks of what was drawn last are seen for so many seconds.
pub(crate) const SEEN: f32 = 6.0;
/// More ghosts than this confuse.
const GHOSTS: usize = 3;
/// A press within this of its place picks a ghost: physical metres, pixels.
pub(crate) const PICK: (f64, f64) = (0.015, 8.0);
/// How far along a line its place is, towards the end that differs most: away from the keypoint there.
const ALONG: f64 = 0.8;

/// A reading that what was drawn last is not.
pub(crate) struct Ghost<'a> {
    /// Which of the readings.
    pub reading: usize,
    /// What it would become.
    pub of: &'a Reading,
    /// Where it is picked, in world metres.
    pub place: DVec3,
}

/// Those that can be picked now.
pub(crate) fn ghosts(draft: &Draft) -> impl Iterator<Item = Ghost<'_>> {
    let last = draft.last.as_ref();
    let last = last.filter(|l| l.age < SEEN && draft.phase == Phase::Idle);
    last.into_iter().flat_map(|l| {
        let all = l.readings.iter().zip(&l.places).enumerate();
        all.filter(|(i, _)| *i != l.chosen)
            .map(|(reading, (of, &place))| Ghost { reading, of, place })
            .take(GHOSTS)
    })
}

/// The ghost whose place is nearest to a point, within reach.
pub(crate) fn at(draft: &Draft, point: DVec3, reach: f64) -> Option<usize> {
    ghosts(draft)
        .map(|g| (g.reading, g.place.distance(point)))
        .filter(|(_, far)| *far < reach)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(reading, _)| reading)
}

impl Last {
    /// Where each reading is picked: there it differs from the chosen one.
    pub(crate) fn lay_out(&mut self) {
        let Some(chosen) = self.readings.get(self.chosen) else {
            return;
        };
        let place = |r: &Reading| place(&r.kind, &chosen.kind);
        self.places = self.readings.iter().map(place).collect();
    }
}

fn place(kind: &Kind, chosen: &Kind) -> DVec3 {
    match (kind, chosen) {
        (Kind::Line(line), Kind::Line(chosen)) => {
            let far = line.a.distance(chosen.a) > line.b.distance(chosen.b);
            let along = if far { 1.0 - ALONG } else { ALONG };
            line.a.lerp(line.b, along)
        }
        (Kind::Stroke(stroke), Kind::Stroke(chosen)) => farthest(stroke, chosen),
        _ => DVec3::ZERO,
    }
}

/// The point of a stroke that is farthest from another.
fn farthest(stroke: &DrawnStroke, other: &DrawnStroke) -> DVec3 {
    let resampled = |s: &DrawnStroke, count| Polyline::new(s.points()).resampled(count);
    let other = resampled(other, 64);
    let off = |p: DVec3| {
        let pieces = other.windows(2);
        let far = pieces.map(|w| on_piece(p, w[0], w[1]).distance_squared(p));
        far.fold(f64::INFINITY, f64::min)
    };
    let points = resampled(stroke, 24);
    let farthest = points.iter().copied();
    farthest
        .max_by(|a, b| off(*a).total_cmp(&off(*b)))
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use midair_document::{ConstructionLine, ObjectId};

    use super::*;

    #[test]
    fn a_ghost_is_picked_where_it_differs_and_only_while_it_is_seen() {
        let line = |b: DVec3| Reading {
            kind: Kind::Line(ConstructionLine::raw(DVec3::ZERO, b)),
            words: String::new(),
        };
        let mut last = Last {
            id: ObjectId(1),
            readings: vec![line(DVec3::X), line(DVec3::new(1.0, 0.1, 0.0))],
            places: Vec::new(),
            chosen: 0,
            age: 0.0,
            gone: false,
        };
        last.lay_out();
        let mut draft = Draft {
            last: Some(last),
            ..Draft::default()
        };
        let there = DVec3::new(0.8, 0.08, 0.001);
        assert_eq!(at(&draft, there, 0.01), Some(1));
        assert_eq!(at(&draft, DVec3::X * 0.8, 0.01), None);
        if let Some(last) = &mut draft.last {
            last.age = SEEN + 1.0;
        }
        assert_eq!(at(&draft, there, 0.01), None);
    }
}
