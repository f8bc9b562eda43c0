//! What is carried into Scaffold: a solid gives the box around it as construction lines.

use bevy::math::DVec3;
use bevy::prelude::*;
use midair_document::{ConstructionLine, Edit, Kind, Object, ObjectId, affine};
use midair_studio::carry::Carried;
use midair_studio::notice::Notices;
use midair_studio::project::Project;

use crate::SCAFFOLD;

/// The corners of a box by the bits of their numbers, and its edges.
const EDGES: [(usize, usize); 12] = [
    (0, 1),
    (1, 3),
    (3, 2),
    (2, 0),
    (0, 4),
    (1, 5),
    (3, 7),
    (2, 6),
    (4, 5),
    (5, 7),
    (7, 6),
    (6, 4),
];

pub(crate) fn carried(
    carried: On<Carried>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    if carried.to != SCAFFOLD {
        return;
    }
    let document = project.document();
    let boxes = carried.objects.iter().filter_map(|&id| {
        let object = document.object(id)?;
        let drawn = object.line().is_some() || object.stroke().is_some();
        let bounds = object.bounds();
        (!drawn && !bounds.is_empty()).then(|| {
            let there = affine(&object.placement);
            let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
            let corner = |i: usize| {
                let pick = |axis: usize| {
                    if i >> axis & 1 == 0 {
                        low[axis]
                    } else {
                        high[axis]
                    }
                };
                there.transform_point3(DVec3::new(pick(0), pick(1), pick(2)))
            };
            (id, EDGES.map(|(a, b)| (corner(a), corner(b))))
        })
    });
    let boxes: Vec<_> = boxes.collect();
    if boxes.is_empty() {
        notices.warn("Lines and strokes are Scaffold's already: draw over them.");
        return;
    }
    let mut next = document.next_id();
    let mut edits = Vec::new();
    for (id, edges) in boxes {
        for (a, b) in edges {
            let kind = Kind::Line(ConstructionLine::raw(a, b));
            let line = ObjectId(next);
            let object = Object::new(format!("Line {line}"), kind).into();
            edits.push(Edit::Add { id: line, object });
            next += 1;
        }
        edits.push(Edit::SetDimmed { id, dimmed: true });
    }
    project.commit_live("Box as scaffold", edits, &mut notices);
}
