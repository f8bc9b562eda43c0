//! What is done with a sweep afterwards: bent, cut, smoothed, closed.

use std::sync::Arc;

use bevy::math::Affine3A;
use bevy::prelude::*;
use midair_curve::{End, Lengths};
use midair_document::{Edit, Kind, Object, ObjectId};
use midair_field::{Node, Placement, Recipe, Row, Sweep};
use midair_studio::{
    hands::{Action, Hands, Haptic, Side},
    notice::Notices,
    project::{Project, Selection},
};
use midair_swept::{Rib, bent, cut, smoothed};

use crate::act::ALPHA;
use crate::ends::pose;
use crate::free;
use crate::phase::{Draft, Grip, Held, Phase};
use crate::write::{kind_of, said};

/// A sweep's curves and where it stands.
pub(crate) fn curves(project: &Project, object: ObjectId) -> Option<(Sweep, Placement)> {
    let found = project.document().object(object)?;
    Some((found.sweep()?.clone(), found.placement))
}

/// Puts another sweep in the place of one; whether that was possible.
pub(crate) fn replace(
    project: &mut Project,
    notices: &mut Notices,
    id: ObjectId,
    step: &str,
    sweep: Sweep,
) -> bool {
    let name = project.document().object(id).map_or("", |o| &o.name);
    let step = format!("{step} {name}");
    match kind_of(&sweep) {
        Ok(kind) => project.commit(step, [Edit::SetKind { id, kind }], notices),
        Err(reason) => {
            notices.warn(reason);
            false
        }
    }
}

/// Eq. 12 some times over.
pub(crate) fn smooth(
    project: &mut Project,
    notices: &mut Notices,
    id: ObjectId,
    times: usize,
) -> bool {
    let Some((sweep, _)) = curves(project, id) else {
        return false;
    };
    let ribs = smoothed(&sweep.ribs, ALPHA, times);
    replace(project, notices, id, "Smooth", Sweep { ribs, ..sweep })
}

/// The selected row of clones has more or fewer of them, along the same curves.
pub(crate) fn recount(
    project: &mut Project,
    selection: &Selection,
    notices: &mut Notices,
    count: u32,
) {
    let found = free::selected_row(project.document(), selection);
    let Some((id, object, row, recipe)) = found else {
        notices.info("Select a row of clones first.");
        return;
    };
    let row = Row {
        count: count.max(1),
        ..row.clone()
    };
    if let Err(fault) = row.validate() {
        notices.warn(said(&fault));
        return;
    }
    let recipe = recipe.clone();
    let step = format!("Clones of {}", object.name);
    let kind = Kind::Solid(Recipe::new(Node::Clones { row, recipe }));
    project.commit(step, [Edit::SetKind { id, kind }], notices);
}

/// One sweep becomes two that meet at a curve.
pub(crate) fn cut_at(
    project: &mut Project,
    notices: &mut Notices,
    id: ObjectId,
    at: usize,
) -> bool {
    let document = project.document();
    let Some((sweep, object)) = document
        .object(id)
        .and_then(|o| Some((o.sweep()?.clone(), o.clone())))
    else {
        return false;
    };
    let Some((a, b)) = cut(&sweep.ribs, at) else {
        notices.info("It is cut between its ends: point at a curve inside of it.");
        return false;
    };
    let kind = |ribs: Arc<[Rib]>| -> Kind {
        let part = Recipe::new(Node::Sweep(Sweep {
            ribs,
            ..sweep.clone()
        }));
        match &object.kind {
            Kind::Sheet(_) => Kind::Sheet(part),
            _ => Kind::Solid(part),
        }
    };
    let new = ObjectId(document.next_id());
    let other = Object {
        name: format!("{} (2)", object.name),
        kind: kind(b),
        ..object.clone()
    };
    let step = format!("Cut {}", object.name);
    let edits = [
        Edit::SetKind { id, kind: kind(a) },
        Edit::Add {
            id: new,
            object: other.into(),
        },
    ];
    project.commit(step, edits, notices)
}

/// The curve of a sweep nearest to a point of its own frame, and how far along it, from 0 to 1.
pub(crate) fn nearest(ribs: &[Rib], to: Vec3) -> (usize, f32) {
    const POINTS: usize = 9;
    let mut best = (f32::INFINITY, 0, 0.5);
    for (i, rib) in ribs.iter().enumerate() {
        // Not counted along its length: every curve is asked in every frame.
        let curve = rib.curve();
        for k in 0..POINTS {
            let along = k as f32 / (POINTS - 1) as f32;
            let far = curve.at(along.into()).as_vec3().distance_squared(to);
            if far < best.0 {
                best = (far, i, along);
            }
        }
    }
    (best.1, best.2)
}

/// How many curves on either side follow one that is bent.
pub(crate) fn reach(ribs: usize) -> usize {
    (ribs / 6).max(2)
}

fn rigid(p: &Placement) -> Affine3A {
    Affine3A::from_rotation_translation(p.rotation, p.translation)
}

fn moved(by: &Affine3A, e: &End) -> End {
    let held = by * pose(e).affine();
    let (_, rotation, position) = held.to_scale_rotation_translation();
    End {
        position: position.as_dvec3(),
        rotation: rotation.as_dquat().normalize(),
    }
}

/// A curve of the sweep, held at one end or both, follows the hands; its neighbours follow it.
pub(crate) fn bend(
    mut hands: ResMut<Hands>,
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    let Phase::Editing { object, at, grip } = &mut draft.phase else {
        return;
    };
    let id = *object;
    let Some((sweep, placement)) = curves(&project, id) else {
        // It was deleted, or undone.
        draft.phase = Phase::Idle;
        return;
    };
    let to_own = placement.affine().inverse();
    if grip.is_none() {
        let lead = Side::BOTH
            .into_iter()
            .rev()
            .find(|&s| hands.get(s).pressed(Action::Act));
        let pointer = hands.get(lead.unwrap_or(Side::Right)).pose.position;
        *at = nearest(&sweep.ribs, to_own.transform_point3(pointer)).0;
    }
    *at = (*at).min(sweep.ribs.len().saturating_sub(1));
    let Some(from) = grip
        .as_ref()
        .map(|g| g.from)
        .or(sweep.ribs.get(*at).copied())
    else {
        return;
    };
    for side in Side::BOTH {
        let hand = hands.get(side);
        if hand.pressed(Action::Act) {
            let own = to_own.transform_point3(hand.pose.position);
            let (_, along) = nearest(&[from], own);
            let into = hand.pose.affine().inverse() * rigid(&placement);
            let offsets =
                [from.left(), from.right()].map(|e| moved(&into, &scaled(&e, &placement)));
            let grip = grip.get_or_insert_with(|| {
                Box::new(Grip {
                    from,
                    ends: [None; 2],
                    bent: sweep.ribs.clone(),
                })
            });
            // Taken by an end it is bent there, taken by its middle it moves.
            let takes = [along < 0.7, along > 0.3];
            for k in 0..2 {
                if takes[k] && grip.ends[k].is_none() {
                    grip.ends[k] = Some(Held {
                        by: side,
                        offset: offsets[k],
                    });
                }
            }
            hands.pulse(side, Haptic::Tick);
        }
    }
    let Some(held) = grip else {
        return;
    };
    let into_own = rigid(&placement).inverse();
    let own_ends = [from.left(), from.right()];
    let ends: [End; 2] = std::array::from_fn(|k| match &held.ends[k] {
        Some(h) => {
            let there = hands.get(h.by).pose.affine();
            let own = moved(&(into_own * there), &h.offset);
            unscaled(&own, &placement)
        }
        None => own_ends[k],
    });
    let sound = ends.iter().all(End::is_sound);
    if sound {
        let before = from.tangents.map(|m| f64::from(m.length()));
        let chord = |e: &[End; 2]| e[0].position.distance(e[1].position).max(1e-6);
        // The curve keeps its shape while its ends keep their distance.
        let grown = chord(&ends) / chord(&own_ends);
        let lengths = Lengths(before.map(|l| l * grown));
        let to = Rib::held(
            &ends[0],
            &ends[1],
            lengths,
            from.slopes,
            f64::from(from.twist),
        );
        held.bent = bent(&sweep.ribs, *at, &to, reach(sweep.ribs.len()));
    }
    let let_go = held
        .ends
        .iter()
        .flatten()
        .all(|h| !hands.get(h.by).held(Action::Act));
    if let_go {
        let ribs = held.bent.clone();
        *grip = None;
        let done = replace(
            &mut project,
            &mut notices,
            id,
            "Bend",
            Sweep { ribs, ..sweep },
        );
        let felt = if done { Haptic::Done } else { Haptic::Refused };
        hands.pulse(Side::Right, felt);
    }
}

/// An end of the object's frame, its scale taken in.
fn scaled(e: &End, placement: &Placement) -> End {
    End {
        position: e.position * placement.scale.as_dvec3(),
        ..*e
    }
}

fn unscaled(e: &End, placement: &Placement) -> End {
    End {
        position: e.position / placement.scale.as_dvec3(),
        ..*e
    }
}
