//! What hands do in Brush.

use bevy::prelude::*;
use midair_studio::{
    hands::{Action, COUNTED, Cross, Hand, Hands, Haptic, Side},
    hold::{Held, Reserved},
    pick::Touch,
    settings::BrushSkeleton,
};

use crate::{
    paint_on,
    phase::{Draft, Phase},
    stroke::{self, StrokeFault},
    work::{Studio, step_name},
};

/// How much larger one press makes the brush.
const LARGER: f32 = 1.12;
/// How many times larger in a second while the press is held.
const GROWS: f32 = 2.2;
/// Seconds until a held press goes on.
const HOLD: f32 = 0.35;
/// Seconds within which the trigger of the other hand makes of this one's the one that turns around.
const YOUNG: f32 = 0.35;

/// Metres within which a hand that holds its trigger rests.
const RESTS: f32 = 0.02;

/// Seconds each arm of the cross has been held.
#[derive(Resource, Default)]
pub(crate) struct Holding([f32; 2]);

/// The cross: size, and which skeleton; of a selected stroke size and weight.
pub(crate) fn cross(
    mut hands: ResMut<Hands>,
    time: Res<Time>,
    mut draft: ResMut<Draft>,
    mut holding: ResMut<Holding>,
    mut studio: Studio,
) {
    for side in Side::BOTH {
        let hand = hands.get(side);
        let up = f32::from(hand.held(Action::Up)) - f32::from(hand.held(Action::Down));
        let held = &mut holding.0[side as usize];
        *held = if up == 0.0 {
            0.0
        } else {
            *held + time.delta_secs()
        };
        let goes_on = *held > HOLD;
        let pressed = hand.cross();
        if pressed.is_none() && !goes_on {
            continue;
        }
        draft.leading = Some(side);
        if let Some(selected) = studio.easel.selected {
            if let Some(cross) = pressed {
                let done = change_selected(&mut studio, selected, cross);
                hands.pulse(side, Haptic::of(done));
            }
            continue;
        }
        match pressed {
            Some(Cross::Up) => studio.settings.brush.resize(LARGER),
            Some(Cross::Down) => studio.settings.brush.resize(1.0 / LARGER),
            Some(Cross::Right | Cross::Left) if draft.busy().is_some() => {
                hands.pulse(side, Haptic::Refused);
                continue;
            }
            Some(arm) => {
                let brush = &mut studio.settings.brush;
                brush.skeleton = brush.skeleton.step(arm == Cross::Right);
            }
            None => {
                let factor = GROWS.powf(up * time.delta_secs());
                studio.settings.brush.resize(factor);
                continue;
            }
        }
        hands.pulse(side, Haptic::Tick);
    }
}

fn change_selected(studio: &mut Studio, selected: usize, cross: Cross) -> bool {
    let Some((_, _, canvas)) = studio.easel.painting(studio.project.document()) else {
        return false;
    };
    let Some(before) = canvas.strokes.get(selected) else {
        return false;
    };
    let (next, name) = match cross {
        Cross::Up => (stroke::resized(before, LARGER), "Resize stroke"),
        Cross::Down => (stroke::resized(before, 1.0 / LARGER), "Resize stroke"),
        Cross::Right => (weighted(before, 1.15), "Weigh stroke"),
        Cross::Left => (weighted(before, 1.0 / 1.15), "Weigh stroke"),
    };
    let work = studio.changed(selected, Some(next));
    work.is_some_and(|w| studio.commit(w, name))
}

fn weighted(before: &midair_field::Stroke, factor: f32) -> midair_field::Stroke {
    midair_field::Stroke {
        weight: (before.weight * factor).clamp(0.02, 100.0),
        ..before.clone()
    }
}

/// Triggers paint; cancel gives up what was begun.
pub(crate) fn paint(
    mut hands: ResMut<Hands>,
    time: Res<Time>,
    held: Res<Held>,
    mut reserved: ResMut<Reserved>,
    mut draft: ResMut<Draft>,
    mut studio: Studio,
) {
    // While the app itself stands still, a press grows no older.
    draft.bypass_change_detection().age += time.delta_secs().min(COUNTED);
    // The leading hand first: where both triggers go down in one frame it is the one that paints.
    let main = studio.settings.hands.main();
    for side in [main, main.other()] {
        let hand = hands.get(side).clone();
        if hand.pressed(Action::Cancel) {
            cancel(&mut draft, &mut studio);
        }
        if studio.easel.selected.is_some() {
            reserved.claim(side, Action::Delete);
            if hand.pressed(Action::Delete) {
                let done = delete(&mut draft, &mut studio);
                hands.pulse(side, Haptic::of(done));
                continue;
            }
        }
        if held.get(side).is_some() {
            continue;
        }
        let outcome = step(side, &hand, &hands, &mut draft, &mut studio);
        if let Some(done) = outcome {
            hands.pulse(side, done);
        }
    }
}

fn cancel(draft: &mut Draft, studio: &mut Studio) {
    if draft.busy().is_some() {
        draft.drop_all();
    } else if studio.easel.selected.is_some() || studio.easel.picking {
        studio.easel.selected = None;
        studio.easel.picking = false;
    }
}

fn delete(draft: &mut Draft, studio: &mut Studio) -> bool {
    let Some(selected) = studio.easel.selected.take() else {
        return false;
    };
    draft.drop_all();
    let work = studio.changed(selected, None);
    work.is_some_and(|w| studio.commit(w, "Delete stroke"))
}

/// One hand in one frame; gives what it is to feel.
fn step(
    side: Side,
    hand: &Hand,
    hands: &Hands,
    draft: &mut Draft,
    studio: &mut Studio,
) -> Option<Haptic> {
    let other = side.other();
    if *draft.phase(side) == Phase::Alt {
        if !hand.held(Action::Act) {
            draft.set(side, Phase::Idle);
        }
        return None;
    }
    if hand.pressed(Action::Act) {
        draft.leading = Some(side);
        let mut turned = *draft.phase(other) == Phase::Alt;
        if hands.get(other).held(Action::Act) && !turned {
            if hands.get(other).pressed(Action::Act) && draft.busy() != Some(other) {
                // Both in one frame: the other hand's is the one that turns around.
                draft.set(other, Phase::Alt);
                turned = true;
            } else if draft.busy() == Some(other)
                && (draft.age < YOUNG || rests(other, hands, draft, studio))
            {
                draft.drop_all();
                draft.set(other, Phase::Alt);
                turned = true;
            }
        }
        if draft.busy() == Some(other) {
            return Some(Haptic::Refused);
        }
        return press(side, hand, hands, turned, draft, studio);
    }
    if draft.busy() != Some(side) {
        return None;
    }
    let radius = studio.brush().radius / hands.metres_per_world;
    let at = hand.pose.position;
    let down = hand.held(Action::Act);
    let ends = match draft.phase_mut(side) {
        Phase::Leading { way, now } => {
            *now = at.extend(radius);
            let full = way.len() + 2 >= midair_field::MAX_POINTS;
            if down && !full && way.last().is_some_and(|&last| stroke::goes_on(last, *now)) {
                way.push(*now);
            }
            !down || full
        }
        // Drawn at once where it was dragged; otherwise the second press is its other end.
        Phase::Line { from } => hand.released(Action::Act) && from.distance(at) > 0.5 * radius,
        Phase::Polygon { .. } => false,
        Phase::Stamping | Phase::Moving { .. } => !down,
        Phase::Idle | Phase::Alt => false,
    };
    if !ends {
        return None;
    }
    Some(end(side, hand, hands, draft, studio))
}

/// Whether a hand whose trigger is down has gone nowhere since.
pub(crate) fn rests(side: Side, hands: &Hands, draft: &Draft, studio: &Studio) -> bool {
    let near = f32::max(0.5 * studio.brush().radius, RESTS) / hands.metres_per_world;
    let hand = hands.get(side);
    hand.held(Action::Act) && draft.rests(side, hand.pose.position, near)
}

/// A trigger goes down.
fn press(
    side: Side,
    hand: &Hand,
    hands: &Hands,
    turned: bool,
    draft: &mut Draft,
    studio: &mut Studio,
) -> Option<Haptic> {
    let brush = studio.brush();
    let radius = brush.radius / hands.metres_per_world;
    let at = hand.pose.position;
    match draft.phase_mut(side) {
        Phase::Line { from } => {
            if from.distance(at) < 1e-3 * radius {
                studio.notices.warn(StrokeFault::ZeroLine.to_string());
                return Some(Haptic::Refused);
            }
            return Some(end(side, hand, hands, draft, studio));
        }
        Phase::Polygon { corners } => {
            if corners.len() >= 4 && corners[0].distance(at) < radius {
                return Some(end(side, hand, hands, draft, studio));
            }
            if corners.iter().any(|c| c.distance(at) < 0.05 * radius) {
                studio.notices.warn(StrokeFault::SameCorner.to_string());
                return Some(Haptic::Refused);
            }
            corners.push(at);
            return Some(Haptic::Tick);
        }
        _ => {}
    }
    if std::mem::take(&mut studio.easel.picking) {
        return Some(pick(at, studio));
    }
    draft.age = 0.0;
    draft.from = at;
    if let Some(selected) = studio.easel.selected {
        let document = studio.project.document();
        let before = studio
            .easel
            .painting(document)
            .and_then(|(_, _, c)| c.strokes.get(selected).cloned())?;
        draft.set(
            side,
            Phase::Moving {
                stroke: selected,
                before: Box::new(before),
                from: hand.pose,
            },
        );
        return Some(Haptic::Tick);
    }
    draft.erase = brush.erase != turned;
    if draft.erase && studio.untouched().is_none() {
        studio.notices.warn(StrokeFault::NothingToErase.to_string());
        return Some(Haptic::Refused);
    }
    let phase = match brush.skeleton {
        BrushSkeleton::Point => Phase::Leading {
            way: vec![at.extend(radius)],
            now: at.extend(radius),
        },
        BrushSkeleton::Line => Phase::Line { from: at },
        BrushSkeleton::Polygon => Phase::Polygon { corners: vec![at] },
        BrushSkeleton::Volume => {
            let fault = match studio.volume() {
                Ok((name, recipe)) => studio
                    .easel
                    .is_unknown(&recipe)
                    .then_some(StrokeFault::NotReady(name)),
                Err(fault) => Some(fault),
            };
            if let Some(fault) = fault {
                studio.notices.warn(fault.to_string());
                return Some(Haptic::Refused);
            }
            Phase::Stamping
        }
    };
    draft.set(side, phase);
    Some(Haptic::Tick)
}

/// What was begun becomes one step of the document.
pub(crate) fn end(
    side: Side,
    hand: &Hand,
    hands: &Hands,
    draft: &mut Draft,
    studio: &mut Studio,
) -> Haptic {
    let made = studio.work(draft, side, &hand.pose, hands.metres_per_world);
    let name = match draft.phase(side) {
        Phase::Moving { before, from, .. } => {
            if still(from, hand) {
                draft.drop_all();
                return Haptic::Tick;
            }
            format!("Move {}", stroke::name(before).to_lowercase())
        }
        Phase::Polygon { corners } => {
            let off = stroke::out_of_plane(corners);
            if made.is_ok() && off > studio.brush().radius / hands.metres_per_world {
                studio.notices.info(format!(
                    "The corners lie up to {:.0} mm beside one plane: they were brought into it.",
                    off * 1e3
                ));
            }
            step_name(BrushSkeleton::Polygon, draft.erase).to_owned()
        }
        _ => {
            let chosen = studio.settings.brush.skeleton;
            let skeleton = draft.skeleton(side).unwrap_or(chosen);
            step_name(skeleton, draft.erase).to_owned()
        }
    };
    match made {
        Ok(Some(work)) => {
            draft.drop_all();
            Haptic::of(studio.commit(work, &name))
        }
        Ok(None) => {
            draft.drop_all();
            Haptic::Refused
        }
        Err(fault) => {
            // A polygon with too few corners goes on; anything else begins anew.
            if !matches!(fault, StrokeFault::Corners(_)) {
                draft.drop_all();
            }
            studio.notices.warn(fault.to_string());
            Haptic::Refused
        }
    }
}

fn still(from: &midair_studio::hands::Pose, hand: &Hand) -> bool {
    from.position.distance(hand.pose.position) < 1e-4
        && from.rotation.angle_between(hand.pose.rotation) < 1e-3
}

/// Selects the stroke that lies nearest.
fn pick(at: Vec3, studio: &mut Studio) -> Haptic {
    let document = studio.project.document();
    let found = studio
        .easel
        .painting(document)
        .and_then(|(_, object, canvas)| {
            let p = object.placement.affine().inverse().transform_point3(at);
            let nearest = canvas
                .strokes
                .iter()
                .enumerate()
                .map(|(i, s)| (stroke::distance(s, p), i))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            nearest.map(|(_, i)| i)
        });
    studio.easel.selected = found;
    Haptic::of(found.is_some())
}

/// Finish: closes a polygon; on the painting it selects a stroke, on another solid it goes on with
/// that one, on nothing the next stroke begins a new painting.
pub(crate) fn finish(
    mut hands: ResMut<Hands>,
    touch: Res<Touch>,
    held: Res<Held>,
    mut draft: ResMut<Draft>,
    mut studio: Studio,
) {
    let Some(side) = hands.pressed(Action::Finish) else {
        return;
    };
    if !held.is_empty() {
        return;
    }
    let hand = hands.get(side).clone();
    if let Some(busy) = draft.busy() {
        let felt = match draft.phase(busy) {
            Phase::Polygon { .. } => end(busy, &hand, &hands, &mut draft, &mut studio),
            _ => Haptic::Refused,
        };
        hands.pulse(side, felt);
        return;
    }
    if studio.easel.selected.take().is_some() {
        hands.pulse(side, Haptic::Tick);
        return;
    }
    let document = studio.project.document();
    let own = studio.easel.painting(document).map(|(id, ..)| id);
    let felt = match touch.get(side).map(|t| t.object) {
        Some(object) if Some(object) == own => pick(hand.pose.position, &mut studio),
        Some(object) => Haptic::of(paint_on(&mut studio, object)),
        None if own.is_some() => {
            studio.easel.take(None);
            studio.selection.0.clear();
            studio
                .notices
                .info("The next stroke begins a new painting.");
            Haptic::Done
        }
        None => Haptic::Refused,
    };
    hands.pulse(side, felt);
}
