//! What is said in the room: read-outs, signs of operands, notices.

use bevy::color::ColorToPacked;
use bevy::prelude::*;
use midair_studio::evaluate::Evaluations;
use midair_studio::notice::{Notices, Weight as Loudness};
use midair_studio::panel::{STAYS, egui::Color32};
use midair_studio::project::{Project, Shelf};
use midair_studio::show::{Cues, ObjectMap, Readouts};
use midair_studio::world::WorldView;

use super::{Label, LabelKey, Labels, Weight};
use crate::room::Stance;

/// Metres from the eyes to what is said to somebody, and below where they look.
const BEFORE: f32 = 0.75;
const BELOW: f32 = 0.20;

pub(crate) fn readouts(
    (readouts, view): (Res<Readouts>, Res<WorldView>),
    mut labels: ResMut<Labels>,
) {
    let room = view.room_from_world;
    for (i, readout) in readouts.0.iter().enumerate() {
        // One above the other where they are about the same place.
        let same = readouts.0[..i]
            .iter()
            .filter(|r| r.at.distance(readout.at) < 0.02)
            .count();
        labels.say(Label {
            key: LabelKey::Readout(i),
            at: room.point(readout.at),
            lift: 24.0 + 32.0 * same as f32,
            text: readout.text.clone(),
            ..Label::default()
        });
    }
}

/// Each operand carries its place and its sign, since colour alone is no cue for everyone.
pub(crate) fn operands(
    (cues, map, view): (Res<Cues>, Res<ObjectMap>, Res<WorldView>),
    places: Query<&Transform>,
    mut labels: ResMut<Labels>,
) {
    for (&id, cue) in &cues.0 {
        let Some(text) = &cue.label else { continue };
        let Some(at) = map.get(id).and_then(|e| places.get(e).ok()) else {
            continue;
        };
        let [r, g, b, _] = cue.tint.colour().to_srgba().to_u8_array();
        labels.say(Label {
            key: LabelKey::Operand(id),
            at: view.room_from_world.point(at.translation),
            text: text.clone(),
            edge: Some(Color32::from_rgb(r, g, b)),
            ..Label::default()
        });
    }
}

/// What the studio has to say: before the eyes, low enough to look past; it stays where it was said.
pub(crate) fn notices(
    (notices, evaluations): (Res<Notices>, Res<Evaluations>),
    stance: Res<Stance>,
    mut labels: ResMut<Labels>,
    mut said: Local<Option<(String, Vec3)>>,
) {
    let recent: Vec<_> = notices.recent(STAYS).collect();
    let mut lines: Vec<_> = recent
        .iter()
        .rev()
        .take(3)
        .rev()
        .map(|n| n.text.clone())
        .collect();
    let warns = recent
        .iter()
        .rev()
        .take(3)
        .any(|n| n.weight == Loudness::Warning);
    let busy = evaluations.outstanding();
    if busy > 0 {
        lines.push(format!(
            "Making {busy} solid{}",
            if busy == 1 { "" } else { "s" }
        ));
    }
    let text = lines.join("\n");
    if text.is_empty() {
        *said = None;
        return;
    }
    let before = stance.head.position + stance.ahead() * BEFORE - Vec3::Y * BELOW;
    let at = match said.as_ref() {
        // Who turned away is followed.
        Some((_, at)) if at.distance(before) < 0.5 => at.lerp(before, 0.05),
        _ => before,
    };
    *said = Some((text.clone(), at));
    labels.say(Label {
        key: LabelKey::Notice,
        at,
        text,
        weight: if warns {
            Weight::Warning
        } else {
            Weight::Plain
        },
        ..Label::default()
    });
}

/// An empty room says how one begins.
pub(crate) fn empty(
    (project, shelf, stance): (Res<Project>, Res<Shelf>, Res<Stance>),
    mut labels: ResMut<Labels>,
) {
    if project.document().objects().next().is_some() {
        return;
    }
    let text = if shelf.open {
        "Point at a shape and press the trigger: it appears in your hand"
    } else {
        "Press the menu button for the library, or look at your other wrist"
    };
    labels.say(Label {
        key: LabelKey::Empty,
        at: stance.head.position + 1.2 * stance.ahead() - 0.05 * Vec3::Y,
        text: text.to_owned(),
        ..Label::default()
    });
}
