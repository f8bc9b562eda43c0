//! What each button does now, and how flat ways in place the hand.

use bevy::prelude::*;
use midair_studio::{
    hands::{Action, Hands},
    hold::Held,
    pick::Touch,
    settings::BrushSkeleton,
    tools::{Aim, Hints},
};

use crate::{
    phase::{Draft, Phase},
    stroke,
    work::Studio,
};

pub(crate) fn aim(studio: Studio, draft: Res<Draft>, mut aim: ResMut<Aim>) {
    let mut next = Aim {
        draws: true,
        alt_acts: true,
        // What is painted goes where surfaces are.
        drawn: false,
        level: studio.settings.brush.skeleton == BrushSkeleton::Volume,
        ..default()
    };
    if let Some(side) = draft.busy() {
        match draft.phase(side) {
            // The first corner closes the polygon.
            Phase::Polygon { corners } if corners.len() >= 4 => next.points.push(corners[0]),
            // A stroke that is moved would be stopped by the painting it is part of.
            Phase::Moving { .. } => next.surfaces = false,
            _ => {}
        }
    }
    aim.set_if_neq(next);
}

pub(crate) fn hints(
    studio: Studio,
    draft: Res<Draft>,
    held: Res<Held>,
    hands: Res<Hands>,
    touch: Res<Touch>,
    mut hints: ResMut<Hints>,
) {
    let mut next = Hints::default();
    let brush = studio.brush();
    let document = studio.project.document();
    let painting = studio.easel.painting(document);
    let erase = if draft.busy().is_some() {
        draft.erase
    } else {
        brush.erase
    };
    let does = if erase { "erase" } else { "paint" };
    let length = |l: f32| midair_studio::units::length(l, studio.settings.units.length);
    let size = match brush.skeleton {
        BrushSkeleton::Volume => length(brush.size / hands.metres_per_world),
        _ => length(brush.radius / hands.metres_per_world),
    };
    if !held.is_empty() {
        next.begin("Moving: let go to place it")
            .say(Action::Cancel, "put it back");
    } else if let Some(side) = draft.busy() {
        match draft.phase(side) {
            Phase::Leading { way, .. } => {
                next.begin(format!("{} points: let go to end the stroke", way.len()))
                    .say(Action::Up, "larger")
                    .say(Action::Down, "smaller");
            }
            Phase::Line { .. } => {
                next.begin("A line: set its other end")
                    .say(Action::Act, "the other end");
            }
            Phase::Polygon { corners } => {
                let n = corners.len();
                let corners = if n == 1 { "corner" } else { "corners" };
                let more = match 4_usize.saturating_sub(n) {
                    0 => String::new(),
                    left => format!(": {left} more at least"),
                };
                next.begin(format!("A polygon with {n} {corners}{more}"))
                    .say(Action::Act, "another corner");
                if n >= 4 {
                    next.say(Action::Finish, "close it");
                }
            }
            Phase::Stamping => {
                next.begin(format!("Let go to {does} it there"))
                    .say(Action::Up, "larger")
                    .say(Action::Down, "smaller");
            }
            Phase::Moving { before, .. } => {
                next.begin(format!("Moving {}", stroke::name(before).to_lowercase()));
            }
            Phase::Idle | Phase::Alt => {}
        }
        next.say(Action::Cancel, "give it up");
    } else if studio.easel.picking {
        next.begin("Press on the stroke to select")
            .say(Action::Act, "select the stroke")
            .say(Action::Cancel, "back to painting");
    } else if let Some(selected) = studio.easel.selected {
        let name = painting
            .and_then(|(_, _, c)| c.strokes.get(selected))
            .map_or("Stroke", stroke::name);
        next.begin(format!("{name} {} is selected", selected + 1))
            .say(Action::Act, "drag it")
            .say(Action::Up, "larger")
            .say(Action::Down, "smaller")
            .say(Action::Right, "stronger")
            .say(Action::Left, "weaker")
            .say(Action::Delete, "delete the stroke")
            .say(Action::Cancel, "back to painting");
    } else {
        let what = match brush.skeleton {
            BrushSkeleton::Volume => studio.volume().map_or("Volume".into(), |(name, _)| name),
            other => other.name().to_owned(),
        };
        let on = painting.map_or("a new painting", |(_, o, _)| &o.name);
        next.begin(format!("{what} {size} on {on}"))
            .say(
                Action::Act,
                match brush.skeleton {
                    BrushSkeleton::Line => format!("{does}: one end, then the other"),
                    BrushSkeleton::Polygon => format!("{does}: corner by corner"),
                    _ => does.to_owned(),
                },
            )
            .say(Action::Up, "larger")
            .say(Action::Down, "smaller")
            .say(
                Action::Right,
                brush.skeleton.step(true).name().to_lowercase(),
            )
            .say(
                Action::Left,
                brush.skeleton.step(false).name().to_lowercase(),
            );
        let side = draft.leading.unwrap_or(studio.settings.hands.main());
        let own = painting.map(|(id, ..)| id);
        match touch.get(side).map(|t| t.object) {
            Some(object) if Some(object) == own => {
                next.say(Action::Finish, "select this stroke");
            }
            Some(object) => {
                let name = document.object(object).map_or("it", |o| &o.name);
                next.say(Action::Finish, format!("paint on {name}"));
            }
            None if own.is_some() => {
                next.say(Action::Finish, "new painting");
            }
            None => {}
        }
    }
    next.pair([Action::Up, Action::Down], "size").pair(
        [Action::Left, Action::Right],
        if studio.easel.selected.is_some() {
            "weight"
        } else {
            "brush"
        },
    );
    hints.set_if_neq(next);
}
