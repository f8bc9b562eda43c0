//! Hands that let go.

use bevy::prelude::*;
use midair_document::{Edit, ObjectId};
use midair_field::Placement;

use super::{Held, Hold};
use crate::hands::{Action, Hands, Haptic, Side};
use crate::notice::Notices;
use crate::objects::companions;
use crate::project::{Project, Selection};
use crate::show::Drafts;

/// A hand that lets go: the last one commits the gesture as one edit.
pub(super) fn release(
    mut hands: ResMut<Hands>,
    mut held: ResMut<Held>,
    mut drafts: ResMut<Drafts>,
    selection: Res<Selection>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    for side in Side::BOTH {
        let Some(object) = held.get(side) else {
            continue;
        };
        if hands.get(side).pressed(Action::Cancel) {
            // Both hands give it up; it goes back to where it was.
            held.drop(object);
            drafts.take(object);
            for companion in companions(project.document(), &selection.0, object) {
                if !held.holds(companion) {
                    drafts.take(companion);
                }
            }
            continue;
        }
        if hands.get(side).held(Action::Grab) {
            continue;
        }
        held.empty(side);
        let stretched = held.stretch.take_if(|(o, _)| *o == object).is_some();
        if held.holds(object) {
            // The other hand goes on holding it, as it stands now.
            if stretched && let Some(standing) = drafts.get(object) {
                let other = side.other();
                let hold = Hold::new(&hands.get(other).pose, standing);
                held.take(other, object, hold);
            }
            continue;
        }
        if let Some(placement) = drafts.take(object) {
            let with: Vec<_> = companions(project.document(), &selection.0, object)
                .into_iter()
                .filter(|&c| !held.holds(c))
                .filter_map(|c| Some((c, drafts.take(c)?)))
                .collect();
            put_down(
                &mut project,
                &mut notices,
                object,
                placement,
                with,
                stretched,
            );
            hands.pulse(side, Haptic::Tick);
        }
    }
}

fn put_down(
    project: &mut Project,
    notices: &mut Notices,
    id: ObjectId,
    placement: Placement,
    with: Vec<(ObjectId, Placement)>,
    stretched: bool,
) {
    let Some(object) = project.document().object(id) else {
        return;
    };
    let scaled = stretched || object.placement.scale != placement.scale;
    let before = object.placement;
    let still = placement.translation.distance(before.translation) < 1e-5
        && placement.rotation.angle_between(before.rotation) < 1e-3
        && placement.scale == before.scale;
    if still {
        // A click, or the rounding of one: no step to undo.
        return;
    }
    let name = format!("{} {}", if scaled { "Scale" } else { "Move" }, object.name);
    let fresh = object.fresh;
    let mut edits = vec![Edit::SetPlacement { id, placement }];
    if fresh && object.placement != placement {
        edits.push(Edit::SetFresh { id, fresh: false });
    }
    edits.extend(
        with.into_iter()
            .map(|(id, placement)| Edit::SetPlacement { id, placement }),
    );
    project.commit_live(name, edits, notices);
}
