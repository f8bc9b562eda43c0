//! Rails are live: a sweep whose end ran along a stroke follows when the stroke is drawn otherwise.

use bevy::math::{DAffine3, Vec3};
use midair_curve::Polyline;
use midair_document::{Document, Edit, Kind, Object, ObjectId, affine};
use midair_field::{Node, Recipe, Row, Sweep};
use midair_swept::Rib;

use crate::ask::stroke;
use crate::write::kind_of;

/// A rail as it was and as it is, both in the frame of what follows it, and which end does.
struct Moved {
    end: usize,
    was: Polyline,
    is: Polyline,
}

/// The edits that bring sweeps and rows of clones after their rails. One that cannot follow, since
/// nothing would be left of it, stays as it was.
pub(crate) fn follow(was: &Document, is: &Document) -> Vec<Edit> {
    let linked = is.objects().filter(|(_, o)| !o.links.is_empty());
    linked
        .filter_map(|(id, object)| {
            let rails = rails(was, is, id, object);
            let kind = (!rails.is_empty()).then(|| followed(object, &rails))??;
            Some(Edit::SetKind { id, kind })
        })
        .collect()
}

/// The rails of an object that changed. What moved together with its rail stands to it as before.
fn rails(was: &Document, is: &Document, id: ObjectId, object: &Object) -> Vec<Moved> {
    let Some(before) = was.object(id) else {
        return Vec::new();
    };
    let own = |line: &Polyline, to_world: DAffine3| {
        let back = to_world.inverse();
        Polyline::new(line.points().iter().map(|&p| back.transform_point3(p)))
    };
    let links = object.links.iter();
    links
        .filter_map(|link| {
            let (old, new) = (was.object(link.source)?, is.object(link.source)?);
            if old.kind == new.kind && old.placement == new.placement {
                return None;
            }
            let moved = Moved {
                end: link.part as usize,
                was: own(&stroke(old)?, affine(&before.placement)),
                is: own(&stroke(new)?, affine(&object.placement)),
            };
            (moved.end < 2 && moved.was != moved.is).then_some(moved)
        })
        .collect()
}

fn followed(object: &Object, rails: &[Moved]) -> Option<Kind> {
    let after = |ribs: &[Rib]| ribs.iter().map(|r| brought(r, rails)).collect();
    match object.shown()?.node() {
        Node::Sweep(sweep) => kind_of(&Sweep {
            ribs: after(&sweep.ribs),
            ..sweep.clone()
        })
        .ok(),
        Node::Clones { row, recipe } => {
            let row = Row {
                ribs: after(&row.ribs),
                ..row.clone()
            };
            row.validate().ok()?;
            let recipe = recipe.clone();
            Some(Kind::Solid(Recipe::new(Node::Clones { row, recipe })))
        }
        _ => None,
    }
}

/// Each end goes as far as its place on the rail did, counted by the rail's length; the tangents grow
/// with the chord.
fn brought(rib: &Rib, rails: &[Moved]) -> Rib {
    let mut points = rib.points;
    for rail in rails {
        let at = rib.points[rail.end].as_dvec3();
        let share = rail.was.nearest(at) / rail.was.length().max(1e-12);
        let places = (
            rail.was.at(share * rail.was.length()),
            rail.is.at(share * rail.is.length()),
        );
        if let (Some(from), Some(to)) = places {
            points[rail.end] = (at + (to - from)).as_vec3();
        }
    }
    let chord = |p: [Vec3; 2]| p[0].distance(p[1]);
    let grown = if chord(rib.points) > 1e-6 {
        (chord(points) / chord(rib.points)).clamp(0.1, 10.0)
    } else {
        1.0
    };
    Rib {
        points,
        tangents: rib.tangents.map(|m| m * grown),
        ..*rib
    }
}
