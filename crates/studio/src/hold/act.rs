//! Hands that take, delete and save what they touch.

use bevy::prelude::*;
use midair_document::Edit;

use super::{Axis, Held, Hold, Reserved, Stretch};
use crate::command::Command;
use crate::hands::{Action, Hands, Haptic, Side};
use crate::notice::Notices;
use crate::objects::{carried, companions, picked};
use crate::pick::Touch;
use crate::project::{Project, Selection};
use crate::settings::Settings;
use crate::show::Drafts;
use crate::snap::Snapper;

/// Deletes what the hand touches, or on an empty hand what is selected.
pub(super) fn delete(
    mut hands: ResMut<Hands>,
    (touch, reserved): (Res<Touch>, Res<Reserved>),
    mut selection: ResMut<Selection>,
    mut held: ResMut<Held>,
    mut drafts: ResMut<Drafts>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    for side in Side::BOTH {
        if !hands.get(side).pressed(Action::Delete) || reserved.has(side, Action::Delete) {
            continue;
        }
        let objects = match held.get(side).or(touch.get(side).map(|t| t.object)) {
            Some(object) => picked(project.document(), object),
            None => selection.0.clone(),
        };
        let edits: Vec<_> = objects
            .iter()
            .filter(|&&o| project.document().object(o).is_some())
            .map(|&id| Edit::Remove { id })
            .collect();
        if edits.is_empty() {
            hands.pulse(side, Haptic::Refused);
            continue;
        }
        for &object in &objects {
            drafts.take(object);
            held.drop(object);
        }
        let done = project.commit_live("Delete", edits, &mut notices);
        selection.0.retain(|o| !objects.contains(o));
        hands.pulse(side, Haptic::of(done));
    }
}

/// The hand that does not lead saves what it touches as a mesh file.
pub(super) fn save(
    mut hands: ResMut<Hands>,
    (touch, reserved): (Res<Touch>, Res<Reserved>),
    settings: Res<Settings>,
    project: Res<Project>,
    mut commands: MessageWriter<Command>,
    mut notices: ResMut<Notices>,
) {
    let side = settings.hands.off();
    if !hands.get(side).pressed(Action::Save) || reserved.has(side, Action::Save) {
        return;
    }
    match touch.get(side) {
        Some(touched) => {
            let path = project.export_path(touched.object, &settings.files.save_mesh_as);
            commands.write(Command::ExportObject {
                object: touched.object,
                path,
            });
            hands.pulse(side, Haptic::Done);
        }
        None => {
            notices.info("Nothing is saved yet: point at what to save, then press the same again.");
            hands.pulse(side, Haptic::Refused);
        }
    }
}

/// Takes things in hand and moves what is held.
pub(super) fn grab(
    mut hands: ResMut<Hands>,
    (touch, reserved): (Res<Touch>, Res<Reserved>),
    project: Res<Project>,
    selection: Res<Selection>,
    mut held: ResMut<Held>,
    mut drafts: ResMut<Drafts>,
    mut snapper: Snapper,
) {
    let document = project.document();
    for side in Side::BOTH {
        let hand = hands.get(side);
        let free = held.get(side).is_none() && !reserved.has(side, Action::Grab);
        if !hand.pressed(Action::Grab) || !free {
            continue;
        }
        let Some(touched) = touch.get(side).filter(|t| !document.is_locked(t.object)) else {
            continue;
        };
        let Some(object) = document.object(touched.object) else {
            continue;
        };
        let standing = *drafts.get(touched.object).unwrap_or(&object.placement);
        held.take(side, touched.object, Hold::new(&hand.pose, &standing));
        if held.get(side.other()) == Some(touched.object) {
            let [left, right] = Side::BOTH.map(|s| hands.get(s).pose.position);
            held.stretch = Some((touched.object, Stretch::new(left, right, &standing)));
        }
        drafts.set(touched.object, standing);
        hands.pulse(side, Haptic::Tick);
    }
    if held.is_empty() {
        return;
    }
    let [left, right] = Side::BOTH.map(|s| hands.get(s).pose.position);
    if let Some((object, stretch)) = &mut held.stretch {
        // The right pad says along which axis (EasyVRModeling Fig. 4b), or a click of either cross.
        let touched = hands.get(Side::Right).swipe.and_then(Axis::of_quadrant);
        let clicked = || Side::BOTH.iter().find_map(|&s| hands.get(s).cross());
        if let Some(axis) = touched.or_else(|| clicked().map(Axis::from)) {
            stretch.choose(axis, left, right);
        }
        drafts.set(*object, stretch.placement(left, right));
        return;
    }
    for side in Side::BOTH {
        if let Some((object, hold)) = held.hold(side) {
            let wanted = hold.placement(&hands.get(side).pose);
            let along = companions(document, &selection.0, object);
            drafts.set(object, snapper.place(object, &along, wanted, &hands, side));
        }
    }
    // A group, and what is selected together, moves as one.
    for (side, other) in Side::BOTH.map(|s| (s, s.other())) {
        let Some((object, now)) = held.get(side).and_then(|o| Some((o, *drafts.get(o)?))) else {
            continue;
        };
        let Some(before) = document.object(object).map(|o| o.placement) else {
            continue;
        };
        for companion in companions(document, &selection.0, object) {
            if held.get(other) != Some(companion)
                && let Some(standing) = document.object(companion)
            {
                let there = carried(&before, &now, &standing.placement);
                drafts.set(companion, there);
            }
        }
    }
}
