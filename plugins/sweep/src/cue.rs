//! What Sweep shows of its phase: the curve between the ends, and what each button does now.

use bevy::prelude::*;
use midair_curve::Even;
use midair_studio::{
    hands::{Action, Hands},
    hold::Ghosted,
    project::{Project, Selection},
    settings::{Settings, SweepHands, SweepShape},
    show::Readouts,
    tools::{Aim, Hint, HintKey, Hints},
};
use midair_swept::Rib;

use crate::act::{hangs, target};
use crate::edit;
use crate::phase::{Draft, Phase};
use crate::solo::Solo;

/// The curve that is held.
const CURVE: Color = Color::srgb(0.95, 0.96, 1.0);
/// What belongs to it.
const FAINT: Color = Color::srgba(0.72, 0.76, 0.86, 0.7);

pub(crate) fn curve(
    mut gizmos: Gizmos,
    draft: Res<Draft>,
    settings: Res<Settings>,
    project: Res<Project>,
    hands: Res<Hands>,
    mut readouts: ResMut<Readouts>,
) {
    let unit = 1.0 / hands.metres_per_world;
    let count = settings.sweep.count.clamp(8, 96) as usize;
    if let Phase::Editing { object, at, grip } = &draft.phase {
        if let Some((sweep, placement)) = edit::curves(&project, *object) {
            let ribs = grip.as_ref().map_or(&sweep.ribs, |g| &g.bent);
            if let Some(rib) = ribs.get(*at) {
                let to_world = placement.affine();
                let mut points = Vec::new();
                rib.points_into(count, &mut points);
                let there: Vec<Vec3> = points
                    .iter()
                    .map(|&p| to_world.transform_point3(p))
                    .collect();
                for end in [there.first(), there.last()].into_iter().flatten() {
                    gizmos.sphere(*end, 0.008 * unit, CURVE);
                }
                readouts.say(
                    there[there.len() / 2],
                    format!("{} of {}", at + 1, ribs.len()),
                );
                gizmos.linestrip(there, CURVE);
            }
        }
        return;
    }
    for (i, end) in draft.ends.iter().enumerate() {
        let Some(end) = end else { continue };
        let at = end.position.as_vec3();
        let length = draft.lengths.0[i].min(0.6) as f32;
        gizmos.line(at, at + end.along().as_vec3() * (length / 3.0), FAINT);
        let size = if draft.pinned[i].is_some() {
            0.012
        } else {
            0.006
        };
        gizmos.sphere(at, size * unit, FAINT);
        if draft.pinned[i].is_some() {
            readouts.say(at, "pinned");
        }
    }
    for rail in draft.rails.iter().flatten() {
        gizmos.linestrip(rail.line.points().iter().map(|p| p.as_vec3()), FAINT);
    }
    if let Solo::LeftDrawn { ends, way } = &draft.solo {
        let from = ends[0].position.as_vec3();
        gizmos.linestrip(way.iter().map(|w| from + w.1), FAINT);
    }
    let Some(rib) = draft.live else { return };
    let mut points = Vec::new();
    rib.points_into(count, &mut points);
    if settings.sweep.shape == SweepShape::Tube {
        let mut ring = Vec::new();
        rib.ring_into(count, &mut ring);
        ring.extend(points.first());
        gizmos.linestrip(ring[count - 1..].iter().copied(), FAINT);
    } else {
        frames(&mut gizmos, &rib, unit);
    }
    gizmos.linestrip(points, CURVE);
    for (i, w) in draft.slopes.iter().enumerate() {
        if *w != 1.0 {
            readouts.say(rib.points[i], format!("w {w:.2}"));
        }
    }
    let turns = rib.twist / std::f32::consts::TAU;
    if turns.abs() >= 0.5 {
        let middle = rib.curve().at(0.5).as_vec3();
        readouts.say(middle, format!("{turns:.1} turns"));
    }
}

/// The frame's normals along the curve, where its points gather.
fn frames(gizmos: &mut Gizmos, rib: &Rib, unit: f32) {
    const TICKS: usize = 24;
    let (curve, pace, frames) = (rib.curve(), rib.pace(), rib.frames());
    let even = Even::new(&curve);
    for i in 0..=TICKS {
        let v = even.at(pace.at(i as f64 / TICKS as f64));
        let at = curve.at(v).as_vec3();
        let normal = frames.at(v).y_axis.as_vec3();
        gizmos.line(at, at + normal * (0.015 * unit), FAINT);
    }
}

/// What is bent, or would be closed, is a shell: what it becomes is shown in its place. And how a
/// pointer is to find a depth for the ends.
pub(crate) fn ghosts(
    draft: Res<Draft>,
    settings: Res<Settings>,
    mut ghosted: ResMut<Ghosted>,
    mut aim: ResMut<Aim>,
) {
    let bent = match &draft.phase {
        Phase::Editing {
            object,
            grip: Some(_),
            ..
        } => vec![*object],
        _ => Vec::new(),
    };
    ghosted.set_if_neq(Ghosted(bent));
    let mut next = Aim {
        draws: draft.alone,
        both: settings.sweep.hands != SweepHands::One,
        // What is swept goes where it is led, whatever stands there.
        surfaces: !draft.is_sweeping() && !matches!(draft.solo, Solo::LeftWay { .. }),
        ..Aim::default()
    };
    if draft.alone
        && !draft.is_sweeping()
        && let (Some(rib), Solo::Ready { .. }) = (&draft.live, &draft.solo)
    {
        let mut points = Vec::new();
        rib.points_into(25, &mut points);
        next.points = rib.points.to_vec();
        next.lines = points.windows(2).map(|p| (p[0], p[1])).collect();
    }
    aim.set_if_neq(next);
}

pub(crate) fn hints(
    draft: Res<Draft>,
    settings: Res<Settings>,
    project: Res<Project>,
    selection: Res<Selection>,
    hands: Res<Hands>,
    mut hints: ResMut<Hints>,
) {
    let mut next = Hints::default();
    let shape = match settings.sweep.shape {
        SweepShape::Clones => "row of clones",
        other => other.name(),
    };
    match &draft.phase {
        Phase::Sweeping { .. } => {
            next.begin(format!("Sweeping a {shape}: {} curves", draft.ribs.len()))
                .say(Action::Act, "let go to keep it")
                .say(Action::Down, "smooth")
                .say(Action::Cancel, "give it up");
        }
        Phase::Editing { grip: Some(_), .. } => {
            next.begin("Bending a curve: let go to keep it")
                .say(Action::Cancel, "put it back");
        }
        Phase::Editing { .. } => {
            next.begin("A sweep's own curves")
                .say(Action::Act, "hold to bend the one at hand")
                .say(Action::Down, "smooth")
                .say(Action::Left, "cut here")
                .say(Action::Right, "sweep on from its end")
                .say(Action::Finish, "done");
        }
        Phase::Idle => {
            let status = match (&draft.offer, &draft.extends) {
                (Some(offer), _) => {
                    let mm = offer.thickness * 1e3;
                    format!("It is open: finish makes it {mm:.0} mm thick")
                }
                (None, Some(_)) => "Sweep on: hold near its end".to_owned(),
                (None, None) => format!("Sweep a {shape}"),
            };
            next.begin(status);
            if draft.alone {
                let does = match draft.solo {
                    Solo::Left | Solo::LeftTangent { .. } => "place the left end, pull its tangent",
                    Solo::Right { .. } | Solo::RightTangent { .. } => {
                        "place the right end, pull its tangent"
                    }
                    Solo::Ready { .. } | Solo::LeftWay { .. } => {
                        "hold, draw the way of the left end"
                    }
                    _ => "hold, draw the way of the right end: the left one plays back",
                };
                next.say(Action::Act, does);
                if matches!(draft.solo, Solo::Ready { .. }) {
                    // A pointer that draws takes nothing in hand: only the curve itself.
                    let does = if hands.pixel > 0.0 {
                        "the curve's middle: carry both ends"
                    } else {
                        "carry both ends; or drag the curve by its middle"
                    };
                    next.say(Action::Grab, does);
                }
                if draft.solo != Solo::Left {
                    next.say(Action::Cancel, "one step back");
                }
            } else {
                next.say(Action::Act, "hold to sweep");
                next.buttons.push(Hint {
                    side: None,
                    action: HintKey::Swipe,
                    does: "outward: thin out at that end".to_owned(),
                });
            }
            next.say(Action::Up, settings.sweep.shape.next().name());
            if draft.offer.is_some() {
                next.say(Action::Finish, "make it thick");
            } else if target(&project, &selection).is_some() {
                next.say(Action::Down, "smooth")
                    .say(Action::Finish, "take up its curves");
            } else if hangs(&draft, &settings) {
                next.say(Action::Finish, "keep the row as it hangs");
            }
        }
    }
    if *hints != next {
        *hints = next;
    }
}
