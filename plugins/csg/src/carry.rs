//! What is carried into Assemble is marked there.

use bevy::prelude::*;
use midair_document::Edit;
use midair_field::Op;
use midair_studio::{carry::Carried, notice::Notices, project::Project};

use crate::ASSEMBLE;

/// Closed solids are marked as they are, to be united, after what is marked already.
pub(crate) fn take(
    carried: On<Carried>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    if carried.to != ASSEMBLE {
        return;
    }
    let document = project.document();
    let mut pending = document.pending().to_vec();
    let mut open = None;
    for &id in &carried.objects {
        let Some(object) = document.object(id) else {
            continue;
        };
        if object.recipe().is_none() {
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
    if pending != document.pending() {
        project.commit_live("Mark operand", [Edit::SetPending { pending }], &mut notices);
    }
}
