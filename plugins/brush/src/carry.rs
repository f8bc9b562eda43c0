//! What comes in from other modes.

use bevy::prelude::*;
use midair_studio::{carry::Carried, settings::BrushSkeleton};

use crate::{BRUSH, easel::canvas, paint_on, stroke, work::Studio};

/// A solid becomes a volume brush; a painting is gone on with.
pub(crate) fn take(carried: On<Carried>, mut studio: Studio) {
    if carried.to != BRUSH {
        return;
    }
    let document = studio.project.document();
    let objects: Vec<_> = carried
        .objects
        .iter()
        .filter_map(|&id| Some((id, document.object(id)?.clone())))
        .collect();
    if let [(id, object)] = objects.as_slice()
        && canvas(object).is_some()
    {
        let id = *id;
        paint_on(&mut studio, id);
        return;
    }
    for (_, object) in objects {
        let Some(recipe) = object.operand() else {
            studio.notices.warn(format!(
                "{} is not closed, so it is no volume to paint with. Close it first.",
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
            "{} is the volume brush now: the trigger paints it.",
            object.name
        ));
        studio.easel.carried = Some((object.name, recipe));
        studio.easel.selected = None;
        studio.settings.brush.volume.clear();
        studio.settings.brush.skeleton = BrushSkeleton::Volume;
        studio.settings.brush.size = size.max_element();
        studio.settings.brush = studio.settings.brush.sound();
        return;
    }
}
