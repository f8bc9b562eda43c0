//! What is carried into Assemble is marked there.

use bevy::prelude::*;
use midair_document::{Edit, Object, ObjectId};
use midair_field::Op;
use midair_solid::plate;
use midair_studio::{carry::Carried, notice::Notices, project::Project, settings::Settings};

use crate::ASSEMBLE;

/// Closed solids are marked as they are, to be united, after what is marked already; lines and strokes that
/// close become a plate that is.
pub(crate) fn take(
    carried: On<Carried>,
    settings: Res<Settings>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    if carried.to != ASSEMBLE {
        return;
    }
    let document = project.document();
    let mut pending = document.pending().to_vec();
    let mut open = None;
    let mut drawn = Vec::new();
    for id in carried.taken() {
        let Some(object) = document.object(id) else {
            continue;
        };
        if object.line().is_some() || object.stroke().is_some() {
            drawn.push(id);
        } else if object.recipe().is_none() {
            open = Some(object.name.clone());
        } else if pending.iter().all(|&(o, _)| o != id) {
            pending.push((id, Op::Union));
        }
    }
    if let Some(name) = open {
        notices.warn(format!(
            "{name} is not closed, so it cannot be an operand. Close it first, then carry it here again."
        ));
    }
    let mut edits = Vec::new();
    if let Some(&first) = drawn.first() {
        let thickness = settings.scaffold.sound().plate as f32;
        match plate(document, &drawn, thickness) {
            Ok((recipe, placement)) => {
                let id = ObjectId(document.next_id());
                let object = Object::solid(format!("Plate {id}"), recipe).placed(placement);
                let object = object.into();
                edits.push(Edit::Add { id, object });
                let dim = |id: ObjectId| Edit::SetDimmed { id, dimmed: true };
                edits.extend(drawn.iter().copied().map(dim));
                pending.push((id, Op::Union));
            }
            Err(fault) => {
                let name = document.object(first).map_or("It", |o| o.name.as_str());
                notices.warn(format!("{name} was not filled: {fault}."));
            }
        }
    }
    if pending != document.pending() {
        let name = if edits.is_empty() {
            "Mark operand"
        } else {
            "Fill and mark"
        };
        edits.push(Edit::SetPending { pending });
        project.commit_live(name, edits, &mut notices);
    }
}
