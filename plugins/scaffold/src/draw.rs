//! What hands draw.

use bevy::math::DVec3;
use bevy::prelude::*;
use midair_beautify::Line;
use midair_document::{Edit, Kind, MAX_POINTS, ObjectId};
use midair_studio::command::Command;
use midair_studio::drawing::{Drawing, on_piece};
use midair_studio::hands::{Action, Cross, Hands, Haptic, Side};
use midair_studio::notice::Notices;
use midair_studio::plane::WorkPlane;
use midair_studio::project::Project;
use midair_studio::settings::{Draws, Settings};

use crate::lift::lift;
use crate::make;
use crate::phase::{Draft, Options, PIXELS, Phase, Sample};
use crate::read::{self, Scene};

/// Shorter than this, in physical metres and in pixels, a line is a tick mark or the pick of a point.
const SHORT: (f64, f64) = (0.03, 7.0);
/// Shorter than this it is a press on one spot.
const CLICK: (f64, f64) = (0.006, 3.5);
/// A pick takes a keypoint within this.
const PICK: (f64, f64) = (0.02, 8.0);
/// The tip leaves a sample whenever it went so far.
const SAMPLE: (f64, f64) = (0.001, 1.0);

/// The cross: what the trigger draws, auto-correct, the other readings.
pub(crate) fn turn(
    mut hands: ResMut<Hands>,
    settings: Res<Settings>,
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
    mut commands: MessageWriter<Command>,
) {
    if project.is_changed() {
        make::recognise(&project, &mut draft);
    }
    for side in Side::BOTH {
        let Some(cross) = hands.get(side).cross() else {
            continue;
        };
        let mut done = true;
        match cross {
            Cross::Up if draft.phase == Phase::Idle => {
                let next = match settings.scaffold.draws {
                    Draws::Line => Draws::Stroke,
                    Draws::Stroke => Draws::Line,
                };
                commands.write(Settings::command("scaffold.draws", next));
            }
            Cross::Up => done = false,
            Cross::Down => {
                commands.write(Settings::command("scaffold.auto", !settings.scaffold.auto));
            }
            Cross::Left | Cross::Right => {
                if side != settings.hands.main() {
                    continue;
                }
                let count = draft.last.as_ref().map_or(0, |l| l.readings.len());
                let at = draft.last.as_ref().map_or(0, |l| l.chosen);
                let by = if cross == Cross::Right {
                    1
                } else {
                    count.max(1) - 1
                };
                let to = if count > 0 { (at + by) % count } else { 0 };
                done = make::choose(to, &mut project, &mut notices, &mut draft);
            }
        }
        hands.pulse(side, if done { Haptic::Tick } else { Haptic::Refused });
    }
}

/// What of the world drawing is about.
type World<'w> = (
    Res<'w, Settings>,
    Res<'w, Drawing>,
    Res<'w, WorkPlane>,
    Res<'w, Time>,
);

/// The trigger.
pub(crate) fn draw(
    mut hands: ResMut<Hands>,
    (settings, drawing, plane, time): World,
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    let draft = &mut *draft;
    if let Some(last) = &mut draft.last {
        last.age += time.delta_secs();
    }
    let Some(side) = draft.side() else {
        begin(&hands, &settings, draft);
        return;
    };
    if hands.pressed(Action::Cancel).is_some() {
        draft.phase = Phase::Idle;
        draft.preview = None;
        return;
    }
    let alt = hands.get(side.other()).held(Action::Act) || hands.get(side).held(Action::Free);
    let tip = hands.get(side).pose.position.as_dvec3();
    let step = hands.reach(side, SAMPLE.0, SAMPLE.1);
    let eye = hands.head.map(|h| h.position.as_dvec3());
    match &mut draft.phase {
        Phase::Line {
            from,
            to,
            farthest,
            raw,
            ..
        } => {
            *to = tip;
            *farthest = farthest.max(tip.distance(*from));
            *raw |= alt;
        }
        Phase::Stroke { points, raw, .. } => {
            *raw |= alt;
            let far = points.last().is_none_or(|p| p.at.distance(tip) >= step);
            if far && points.len() < MAX_POINTS {
                points.push(Sample { at: tip, eye });
            }
        }
        Phase::Idle => {}
    }
    if hands.get(side).held(Action::Act) {
        preview(side, &hands, &settings, &drawing, draft);
        return;
    }
    draft.preview = None;
    let done = match std::mem::take(&mut draft.phase) {
        Phase::Line {
            from,
            to,
            farthest,
            raw,
            ..
        } => {
            let gesture = Gesture {
                side,
                from,
                to,
                raw,
            };
            let long = from.distance(to);
            if long < hands.reach(side, SHORT.0, SHORT.1)
                && farthest < hands.reach(side, 2.0 * SHORT.0, 2.0 * SHORT.1)
            {
                short(
                    &gesture,
                    &hands,
                    &settings,
                    &drawing,
                    draft,
                    &mut project,
                    &mut notices,
                )
            } else {
                draft.picked = None;
                line(
                    &gesture,
                    &hands,
                    &settings,
                    &drawing,
                    draft,
                    &mut project,
                    &mut notices,
                )
            }
        }
        Phase::Stroke {
            mut points, raw, ..
        } => {
            if points.last().is_some_and(|p| p.at != tip) && points.len() < MAX_POINTS {
                points.push(Sample { at: tip, eye });
            }
            let lifted = if hands.pixel > 0.0 && !plane.shown {
                let keypoints: Vec<DVec3> = drawing.keypoints().collect();
                lift(&points, &keypoints, PIXELS[1] * f64::from(hands.pixel))
            } else {
                points.iter().map(|p| p.at).collect()
            };
            stroke(
                lifted,
                (side, raw),
                &hands,
                &settings,
                &drawing,
                draft,
                &mut project,
                &mut notices,
            )
        }
        Phase::Idle => false,
    };
    hands.pulse(side, if done { Haptic::Done } else { Haptic::Refused });
}

/// One line that was drawn.
struct Gesture {
    side: Side,
    from: DVec3,
    to: DVec3,
    raw: bool,
}

fn begin(hands: &Hands, settings: &Settings, draft: &mut Draft) {
    for (side, hand) in hands.both() {
        if !hand.pressed(Action::Act) || hand.held(Action::Grab) || !hand.tracked {
            continue;
        }
        let at = hand.pose.position.as_dvec3();
        draft.phase = match settings.scaffold.draws {
            Draws::Line => Phase::Line {
                side,
                from: at,
                to: at,
                farthest: 0.0,
                raw: false,
            },
            Draws::Stroke => Phase::Stroke {
                side,
                points: vec![Sample {
                    at,
                    eye: hands.head.map(|h| h.position.as_dvec3()),
                }],
                raw: false,
            },
        };
        return;
    }
}

/// What the elastic line would become if it were let go now.
fn preview(side: Side, hands: &Hands, settings: &Settings, drawing: &Drawing, draft: &mut Draft) {
    draft.preview = match draft.phase {
        Phase::Line { from, to, raw, .. }
            if !raw
                && settings.scaffold.auto
                && from.distance(to) >= hands.reach(side, SHORT.0, SHORT.1) =>
        {
            let options = Options::of(&settings.scaffold, hands, side);
            let scene = Scene::of(drawing, &[]);
            read::best_line(&Line::new(from, to), &scene, &options.line)
        }
        _ => None,
    };
}

fn line(
    gesture: &Gesture,
    hands: &Hands,
    settings: &Settings,
    drawing: &Drawing,
    draft: &mut Draft,
    project: &mut Project,
    notices: &mut Notices,
) -> bool {
    let options = Options::of(&settings.scaffold, hands, gesture.side);
    let drawn = Line::new(gesture.from, gesture.to);
    let (readings, refused) = read::line(&drawn, &Scene::of(drawing, &[]), &options.line);
    let raw = gesture.raw || !settings.scaffold.auto;
    if refused && !raw {
        notices.info(
            "The line stays as drawn: correcting it would have moved it farther than a hand errs. \
             Zoom in, or choose another reading.",
        );
    }
    let chosen = if raw { readings.len() - 1 } else { 0 };
    make::add(readings, chosen, drawing, project, notices, draft)
}

#[expect(clippy::too_many_arguments, reason = "what a gesture is about, once")]
fn stroke(
    points: Vec<DVec3>,
    (side, raw): (Side, bool),
    hands: &Hands,
    settings: &Settings,
    drawing: &Drawing,
    draft: &mut Draft,
    project: &mut Project,
    notices: &mut Notices,
) -> bool {
    let long: f64 = points.windows(2).map(|p| p[0].distance(p[1])).sum();
    if points.len() < 2 || long < hands.reach(side, SHORT.0, SHORT.1) * 0.3 {
        notices.info("That was a point. Hold the trigger and move the hand to draw a stroke.");
        return false;
    }
    let set = settings.scaffold.sound();
    let options = Options::of(&set, hands, side);
    let (readings, refused) = read::stroke(
        &points,
        set.width,
        &Scene::of(drawing, &[]),
        &options.stroke,
    );
    let raw = raw || !set.auto;
    if refused && !raw {
        notices.info(
            "The stroke stays as drawn: a fair curve through these points would leave it. \
             Draw it slower, or with fewer turns between two points.",
        );
    }
    let chosen = if raw { readings.len() - 1 } else { 0 };
    make::add(readings, chosen, drawing, project, notices, draft)
}

/// A press on one spot, or nearly: a tick mark across a line, or one of two points that a line is to join.
fn short(
    gesture: &Gesture,
    hands: &Hands,
    settings: &Settings,
    drawing: &Drawing,
    draft: &mut Draft,
    project: &mut Project,
    notices: &mut Notices,
) -> bool {
    let side = gesture.side;
    let reach = hands.reach(side, PICK.0, PICK.1);
    let near = |p: &DVec3| p.distance(gesture.to).min(p.distance(gesture.from));
    let key = drawing
        .keypoints()
        .filter(|p| near(p) < reach)
        .min_by(|a, b| near(a).total_cmp(&near(b)));
    let crossed = crossed(gesture, drawing, reach);
    let clicked = gesture.from.distance(gesture.to) < hands.reach(side, CLICK.0, CLICK.1);
    let second = key
        .or(crossed.map(|c| c.2))
        .or(clicked.then_some(gesture.to));
    match (draft.picked.take(), second) {
        (Some(first), Some(second)) if first.distance(second) > 1e-6 => {
            let between = Gesture {
                from: first,
                to: second,
                ..*gesture
            };
            return line(&between, hands, settings, drawing, draft, project, notices);
        }
        (Some(_), Some(_)) => {
            notices.info("The same point twice: nothing is picked now.");
            return false;
        }
        _ => {}
    }
    match (key, crossed) {
        (Some(point), _) => {
            draft.picked = Some(point);
            notices.info("Press on a second point: a line joins the two.");
            true
        }
        (None, Some((id, at, _))) => tick(id, at, project, notices),
        (None, None) => {
            notices.info(
                "Too short for a line. Across a line it is a tick mark, on a keypoint it picks that; \
                 otherwise hold the trigger and pull.",
            );
            false
        }
    }
}

/// The line that a short gesture crosses, how far along it as a share, and where.
fn crossed(gesture: &Gesture, drawing: &Drawing, reach: f64) -> Option<(ObjectId, f64, DVec3)> {
    let middle = gesture.from.midpoint(gesture.to);
    drawing
        .lines()
        .iter()
        .map(|l| {
            // Where the two come nearest: seen from the middle of the gesture, then from there.
            let on = on_piece(middle, l.a, l.b);
            let across = on_piece(on, gesture.from, gesture.to);
            let on = on_piece(across, l.a, l.b);
            let share = on.distance(l.a) / l.a.distance(l.b).max(1e-300);
            ((l.id, share, on), on.distance(across))
        })
        .filter(|((_, share, _), off)| *off < reach && *share > 1e-6 && *share < 1.0 - 1e-6)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(found, _)| found)
}

/// A tick mark on a line.
pub(crate) fn tick(id: ObjectId, at: f64, project: &mut Project, notices: &mut Notices) -> bool {
    let Some(line) = project.document().object(id).and_then(|o| o.line()) else {
        return false;
    };
    let mut line = line.clone();
    let place = line.ticks.partition_point(|&t| t < at);
    line.ticks.insert(place, at);
    let kind = Kind::Line(line);
    project.commit_live("Tick mark", [Edit::SetKind { id, kind }], notices)
}
