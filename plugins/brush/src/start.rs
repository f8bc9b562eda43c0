//! Painting on what is there: any solid becomes a convolution surface first (3DBrushVR §3).

use bevy::prelude::*;
use midair_document::{Edit, Kind, ObjectId};
use midair_field::{Canvas, Node, Placement, Recipe, Skeleton, Stroke};
use midair_studio::command::Command;

use crate::{
    BRUSH,
    ask::Ask,
    easel::canvas,
    phase::{Draft, Phase},
    stroke,
    work::Studio,
};

/// Takes up an object: a painting as it is, another solid as the first stroke of one. Returns whether
/// it can be painted on now.
pub(crate) fn paint_on(studio: &mut Studio, id: ObjectId) -> bool {
    let document = studio.project.document();
    let Some(object) = document.object(id) else {
        return false;
    };
    if document.is_locked(id) {
        studio.notices.warn(format!(
            "{} is locked: unlock it, then paint on it.",
            object.name
        ));
        return false;
    }
    if canvas(object).is_none() {
        let Some(recipe) = object.operand() else {
            studio.notices.warn(format!(
                "{} is not closed and cannot be painted on: close it first.",
                object.name
            ));
            return false;
        };
        let brush = studio.brush();
        let frame = stroke::Frame::of(&Placement::IDENTITY);
        let made = stroke::volume(
            (object.name.as_str(), &recipe),
            &Placement::IDENTITY,
            &frame,
        );
        let first = match made {
            Ok(first) => first,
            Err(fault) => {
                studio.notices.warn(fault.to_string());
                return false;
            }
        };
        let painted = Canvas {
            strokes: vec![first],
            blend: brush.blend,
            reach: brush.reach,
        };
        let kind = Kind::Solid(Recipe::new(Node::Canvas(painted)));
        let mut edits = vec![Edit::SetKind { id, kind }];
        if object.fresh {
            edits.push(Edit::SetFresh { id, fresh: false });
        }
        let name = format!("Paint on {}", object.name);
        if !studio.project.commit(name, edits, &mut studio.notices) {
            return false;
        }
    }
    studio.easel.take(Some(id));
    studio
        .selection
        .set_if_neq(midair_studio::project::Selection(vec![id]));
    let name = studio
        .project
        .document()
        .object(id)
        .map_or_else(String::new, |o| o.name.clone());
    studio.notices.info(format!("Painting on {name}."));
    true
}

/// What the panel, sessions and shortcuts ask for.
pub(crate) fn ask(
    mut commands: MessageReader<Command>,
    mut draft: ResMut<Draft>,
    hands: Res<midair_studio::hands::Hands>,
    mut studio: Studio,
) {
    for command in commands.read() {
        let text = match command {
            Command::Tool { tool, ask } if *tool == BRUSH => ask,
            // The document changes under the hands: what they are in the middle of is given up.
            Command::Undo | Command::Redo | Command::New | Command::Open(_) | Command::Restore => {
                draft.drop_all();
                studio.easel.mix = None;
                continue;
            }
            _ => continue,
        };
        match ron::from_str::<Ask>(text) {
            Ok(ask) => carry_out(ask, &mut draft, &hands, &mut studio),
            Err(e) => studio.notices.warn(format!(
                "Brush does not understand \"{text}\": {}. docs/brush.md lists what there is.",
                e.code.to_string().replace('\n', " ")
            )),
        }
    }
}

fn carry_out(
    ask: Ask,
    draft: &mut Draft,
    hands: &midair_studio::hands::Hands,
    studio: &mut Studio,
) {
    match ask {
        Ask::New => {
            draft.drop_all();
            studio.easel.take(None);
            studio.selection.0.clear();
        }
        Ask::PaintOn(id) => {
            if !paint_on(studio, ObjectId(id))
                && studio.project.document().object(ObjectId(id)).is_none()
            {
                studio
                    .notices
                    .warn(format!("There is no object {id} to paint on."));
            }
        }
        Ask::Volume(id) => {
            if studio.shelf.library.get(&id).is_none() {
                let fault = stroke::StrokeFault::NoBrush(id);
                studio.notices.warn(fault.to_string());
                return;
            }
            studio.settings.brush.volume = id;
            studio.settings.brush.skeleton = midair_studio::settings::BrushSkeleton::Volume;
        }
        Ask::Carried => {
            if studio.easel.carried.is_some() {
                studio.settings.brush.volume.clear();
                studio.settings.brush.skeleton = midair_studio::settings::BrushSkeleton::Volume;
            }
        }
        Ask::Pick => {
            draft.drop_all();
            studio.easel.selected = None;
            studio.easel.picking = !studio.easel.picking;
        }
        Ask::Select(stroke) => {
            draft.drop_all();
            let count = studio.untouched().map_or(0, |w| w.canvas.strokes.len());
            studio.easel.selected = stroke.filter(|&s| s < count);
            studio.easel.picking = false;
        }
        Ask::Mix { blend, reach, done } => mix(studio, blend, reach, done),
        Ask::Free => {
            let Some((id, ..)) = studio.easel.painting(studio.project.document()) else {
                studio
                    .notices
                    .info("Take up a painting first, then free it.");
                return;
            };
            let links = Vec::new();
            let edit = Edit::SetLinks { id, links };
            studio
                .project
                .commit("Follow nothing", [edit], &mut studio.notices);
        }
        Ask::Close => {
            if let Some(side) = draft.busy()
                && matches!(draft.phase(side), Phase::Polygon { .. })
            {
                let hand = hands.get(side).clone();
                crate::act::end(side, &hand, hands, draft, studio);
            }
        }
        Ask::Resize(at, factor) => {
            let sound = factor > 1e-3 && factor < 1e3;
            change(studio, at, "Resize stroke", sound, |s| {
                Some(stroke::resized(s, factor))
            });
        }
        Ask::Weight(at, weight) => {
            let sound = weight.is_finite() && weight > 0.0;
            change(studio, at, "Weigh stroke", sound, |s| {
                Some(Stroke {
                    weight,
                    ..s.clone()
                })
            });
        }
        Ask::Erase(at, erase) => change(studio, at, "Turn stroke around", true, |s| {
            Some(Stroke { erase, ..s.clone() })
        }),
        Ask::Move(at, (x, y, z)) => {
            let by = Vec3::new(x, y, z);
            change(studio, at, "Move stroke", by.is_finite(), |s| {
                let mut next = s.clone();
                next.placement.translation += by;
                Some(next)
            });
        }
        Ask::Delete(at) => {
            change(studio, at, "Delete stroke", true, |_| None);
            if studio.easel.selected == Some(at) {
                studio.easel.selected = None;
            }
        }
    }
}

fn change(
    studio: &mut Studio,
    at: usize,
    name: &str,
    sound: bool,
    to: impl FnOnce(&Stroke) -> Option<Stroke>,
) {
    let document = studio.project.document();
    let before = studio
        .easel
        .painting(document)
        .and_then(|(_, _, c)| c.strokes.get(at));
    let Some(before) = before else {
        studio.notices.warn(format!(
            "The painting has no stroke {}: choose another one.",
            at + 1
        ));
        return;
    };
    if !sound {
        studio
            .notices
            .warn("That is no number for a stroke: nothing was changed.");
        return;
    }
    let next = to(before);
    if let Some(work) = studio.changed(at, next) {
        studio.commit(work, name);
    }
}

/// How strokes blend: shown while a slider is dragged, one step when it is let go.
fn mix(studio: &mut Studio, blend: f32, reach: f32, done: bool) {
    let (blend, reach) = (blend.clamp(1.0, 16.0), reach.clamp(1.05, 4.0));
    if !blend.is_finite() || !reach.is_finite() {
        return;
    }
    studio.settings.brush.blend = blend;
    studio.settings.brush.reach = reach;
    studio.easel.mix = (!done).then_some((blend, reach));
    if !done {
        return;
    }
    let Some((id, _, canvas)) = studio.easel.painting(studio.project.document()) else {
        return;
    };
    if (canvas.blend, canvas.reach) == (blend, reach) {
        return;
    }
    let next = Canvas {
        blend,
        reach,
        strokes: refitted(canvas, reach),
    };
    let kind = Kind::Solid(Recipe::new(Node::Canvas(next)));
    studio
        .project
        .commit("Blend", [Edit::SetKind { id, kind }], &mut studio.notices);
}

/// Short lines and areas keep their surface at their radius when the reach changes.
pub(crate) fn refitted(canvas: &Canvas, reach: f32) -> Vec<Stroke> {
    let one = |s: &Stroke| match s.skeleton {
        Skeleton::Line(..) | Skeleton::Polygon(_) if reach != canvas.reach => Stroke {
            weight: s.weight * s.fitted_weight(reach) / s.fitted_weight(canvas.reach),
            ..s.clone()
        },
        _ => s.clone(),
    };
    canvas.strokes.iter().map(one).collect()
}
