//! What comes in from other modes.

use bevy::prelude::*;
use midair_document::{Edit, Object, ObjectId};
use midair_studio::{carry::Carried, settings::BrushSkeleton};

use crate::{BRUSH, easel::canvas, paint_on, stroke, work::Studio};

/// The points that a drawn line or stroke goes through, in the world.
pub(crate) fn way(object: &Object) -> Option<Vec<Vec3>> {
    let points = match (object.line(), object.stroke()) {
        (Some(line), _) => vec![line.a, line.b],
        (None, Some(stroke)) => stroke.points(),
        (None, None) => return None,
    };
    let placed = midair_document::affine(&object.placement);
    let world = points
        .into_iter()
        .map(|p| placed.transform_point3(p).as_vec3());
    Some(world.collect())
}

/// Drawn lines and strokes become line skeletons of the painting, as one step.
fn draw(studio: &mut Studio, objects: &[(ObjectId, Object)]) {
    let radius = studio.brush().radius;
    let mut work = None;
    let mut dimmed = Vec::new();
    for (id, object) in objects {
        let Some(points) = way(object) else { continue };
        let Some(&first) = points.first() else {
            continue;
        };
        let work = work.get_or_insert_with(|| studio.base(first));
        let frame = stroke::Frame::of(&work.placement);
        let made = match points.as_slice() {
            [a, b] => stroke::line(*a, *b, radius, work.canvas.reach, &frame),
            _ => {
                let way: Vec<Vec4> = points.iter().map(|p| p.extend(radius)).collect();
                Ok(stroke::led(&way, &frame))
            }
        };
        match made {
            Ok(stroke) => {
                work.strokes.push(stroke);
                work.sources.push(Some(*id));
                dimmed.push(Edit::SetDimmed {
                    id: *id,
                    dimmed: true,
                });
            }
            Err(fault) => studio.notices.warn(fault.to_string()),
        }
    }
    if let Some(work) = work.filter(|w| !w.strokes.is_empty()) {
        studio.commit_with(work, dimmed, "Carry strokes into a painting");
    }
}

/// A solid becomes a volume brush, a drawn line or stroke a line skeleton; a painting is gone on with.
pub(crate) fn take(carried: On<Carried>, mut studio: Studio) {
    if carried.to != BRUSH {
        return;
    }
    let document = studio.project.document();
    let objects: Vec<_> = carried
        .taken()
        .filter_map(|id| Some((id, document.object(id)?.clone())))
        .collect();
    if let [(id, object)] = objects.as_slice()
        && canvas(object).is_some()
    {
        let id = *id;
        paint_on(&mut studio, id);
        return;
    }
    if objects.iter().any(|(_, o)| way(o).is_some()) {
        draw(&mut studio, &objects);
        return;
    }
    for (id, object) in objects {
        let Some(recipe) = object.operand() else {
            studio.notices.warn(format!(
                "{} is not closed, so it cannot be a brush: close it first, then carry it here again.",
                object.name
            ));
            continue;
        };
        let frame = stroke::Frame::of(&midair_field::Placement::IDENTITY);
        let fits = stroke::volume(
            (object.name.as_str(), &recipe),
            &midair_field::Placement::IDENTITY,
            &frame,
        );
        if let Err(fault) = fits {
            studio.notices.warn(fault.to_string());
            continue;
        }
        let size = recipe.bounds().size() * object.placement.scale.abs();
        studio.notices.info(format!(
            "{} is the volume brush now: paint with it.",
            object.name
        ));
        studio.easel.carried = Some((object.name, recipe));
        studio.easel.source = Some(id);
        studio.easel.selected = None;
        studio.settings.brush.volume.clear();
        studio.settings.brush.skeleton = BrushSkeleton::Volume;
        studio.settings.brush.size = size.max_element();
        studio.settings.brush = studio.settings.brush.sound();
        return;
    }
}
