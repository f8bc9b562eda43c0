//! What is seen while one draws: the elastic line, how far it reaches, other readings as ghosts, and the marks of
//! what was kept.

use bevy::math::DVec3;
use bevy::prelude::*;
use midair_document::{ConstructionLine, Kind, Object, affine};
use midair_mesh::Unit;
use midair_studio::drawing::Drawing;
use midair_studio::hands::{Hands, Side};
use midair_studio::pick::Touch;
use midair_studio::project::{Project, Selection};
use midair_studio::settings::{Draws, RoomKind, Settings};
use midair_studio::show::Readouts;
use midair_studio::units;

use crate::ghost::{self, SEEN, ghosts};
use crate::phase::{Draft, PIXELS, Phase};

/// The colours of what is only there for the moment.
struct Pencils {
    ink: Color,
    faint: Color,
    accent: Color,
}

impl Pencils {
    fn of(room: RoomKind) -> Self {
        let (ink, faint) = match room {
            RoomKind::Dusk => ([0xf2, 0xf0, 0xec], [0xb4, 0xb6, 0xbd]),
            RoomKind::Day | RoomKind::Paper => ([0x16, 0x17, 0x1a], [0x6c, 0x6f, 0x78]),
        };
        let of = |[r, g, b]: [u8; 3]| Color::srgb_u8(r, g, b);
        Self {
            ink: of(ink),
            faint: of(faint),
            accent: Color::srgb_u8(0x8f, 0x7a, 0xe6),
        }
    }
}

/// What is drawn over the room.
pub(crate) fn lines(
    mut gizmos: Gizmos,
    hands: Res<Hands>,
    settings: Res<Settings>,
    drawing: Res<Drawing>,
    draft: Res<Draft>,
) {
    let pencils = Pencils::of(settings.look.room);
    let side = draft.side().unwrap_or(settings.hands.main());
    let tip = hands.get(side).pose.position;
    let set = settings.scaffold.sound();
    let reach = match set.draws {
        Draws::Line => hands.reach(side, set.distance, PIXELS[0]),
        Draws::Stroke => hands.reach(side, set.stroke_distance, PIXELS[1]),
    } * set.strength;
    match &draft.phase {
        Phase::Idle => {
            // The keypoint that a line would begin at.
            let at = tip.as_dvec3();
            let near = drawing
                .keypoints()
                .filter(|k| k.distance(at) < reach)
                .min_by(|a, b| a.distance(at).total_cmp(&b.distance(at)));
            if let Some(near) = near.filter(|_| hands.get(side).tracked) {
                gizmos.sphere(near.as_vec3(), 0.35 * reach as f32, pencils.accent);
            }
        }
        Phase::Line { from, to, raw, .. } => {
            gizmos.line(from.as_vec3(), to.as_vec3(), pencils.ink);
            if settings.scaffold.auto && !raw {
                gizmos.sphere(tip, reach as f32, pencils.faint.with_alpha(0.5));
            }
            if let Some(Kind::Line(line)) = draft.preview.as_ref().map(|p| &p.kind) {
                gizmos.line(line.a.as_vec3(), line.b.as_vec3(), pencils.accent);
            }
        }
        Phase::Stroke { points, raw, .. } => {
            gizmos.linestrip(points.iter().map(|p| p.at.as_vec3()), pencils.ink);
            if settings.scaffold.auto && !raw {
                gizmos.sphere(tip, reach as f32, pencils.faint.with_alpha(0.5));
            }
        }
    }
    if let Some(picked) = draft.picked {
        gizmos.sphere(picked.as_vec3(), 0.4 * reach as f32, pencils.accent);
        gizmos.line(picked.as_vec3(), tip, pencils.faint);
    }
    let place = hands.reach(side, ghost::PICK.0, ghost::PICK.1) as f32;
    for ghost in ghosts(&draft) {
        // The one that a press would pick stands out.
        let over = draft.over == Some(ghost.reading);
        let colour = pencils.accent.with_alpha(if over { 1.0 } else { 0.45 });
        match &ghost.of.kind {
            Kind::Line(line) => gizmos.line(line.a.as_vec3(), line.b.as_vec3(), colour),
            Kind::Stroke(stroke) => {
                gizmos.linestrip(stroke.points().iter().map(|p| p.as_vec3()), colour);
            }
            _ => {}
        }
        gizmos.sphere(ghost.place.as_vec3(), 0.5 * place, colour);
    }
}

/// Lengths, angles and the marks of what was kept.
pub(crate) fn words(
    hands: Res<Hands>,
    touch: Res<Touch>,
    selection: Res<Selection>,
    settings: Res<Settings>,
    project: Res<Project>,
    draft: Res<Draft>,
    mut readouts: ResMut<Readouts>,
) {
    let unit = settings.units.length;
    let document = project.document();
    match &draft.phase {
        Phase::Line { from, to, .. } => {
            let shown = match draft.preview.as_ref().map(|p| &p.kind) {
                Some(Kind::Line(line)) => {
                    marks(line, line.ends(), &mut readouts);
                    line.ends()
                }
                _ => [*from, *to],
            };
            let text = measure(shown, unit);
            readouts.say(to.as_vec3(), text);
        }
        Phase::Stroke { points, .. } => {
            let long: f64 = points.windows(2).map(|p| p[0].at.distance(p[1].at)).sum();
            if let Some(last) = points.last() {
                readouts.say(last.at.as_vec3(), units::length(long as f32, unit));
            }
        }
        Phase::Idle => {
            let mut ids: Vec<_> = selection.0.clone();
            let last = draft.last.as_ref().filter(|l| l.age < SEEN);
            ids.extend(last.map(|l| l.id));
            ids.extend(
                Side::BOTH
                    .iter()
                    .filter_map(|&s| touch.get(s))
                    .map(|t| t.object),
            );
            ids.sort_unstable();
            ids.dedup();
            // What is selected by the dozen is not read one by one.
            ids.truncate(12);
            for object in ids.iter().filter_map(|&id| document.object(id)) {
                say(object, unit, &mut readouts);
            }
            for ghost in ghosts(&draft) {
                let number = ghost.reading + 1;
                let text = if draft.over == Some(ghost.reading) {
                    format!("{number} {}", ghost.of.words)
                } else {
                    format!("{number}")
                };
                readouts.say(ghost.place.as_vec3(), text);
            }
            if let Some(picked) = draft.picked {
                let tip = hands.get(settings.hands.main()).pose.position.as_dvec3();
                readouts.say(picked.as_vec3(), measure([picked, tip], unit));
            }
        }
    }
}

fn say(object: &Object, unit: Unit, readouts: &mut Readouts) {
    let there = affine(&object.placement);
    if let Some(line) = object.line() {
        let ends = line.ends().map(|p| there.transform_point3(p));
        marks(line, ends, readouts);
        let at = ends[0].lerp(ends[1], 0.62).as_vec3();
        readouts.say(at, measure(ends, unit));
    }
}

/// The marks of a line: those of an end beside it, the others at a third of its length.
fn marks(line: &ConstructionLine, ends: [DVec3; 2], readouts: &mut Readouts) {
    let at_end = |end: Option<bool>| {
        let mut marks: Vec<&str> = Vec::new();
        for kept in line.kept.iter().filter(|k| k.end == end) {
            let mark = kept.relation.mark();
            if !marks.contains(&mark) {
                marks.push(mark);
            }
        }
        marks.join(" ")
    };
    for (end, at) in [
        (Some(false), ends[0]),
        (Some(true), ends[1]),
        (None, ends[0].lerp(ends[1], 0.35)),
    ] {
        let text = at_end(end);
        if !text.is_empty() {
            readouts.say(at.as_vec3(), text);
        }
    }
}

/// How long a line is and how far it rises from the level.
fn measure(ends: [DVec3; 2], unit: Unit) -> String {
    let along = ends[1] - ends[0];
    let length = units::length(along.length() as f32, unit);
    let rise = along.y.atan2(along.x.hypot(along.z)).to_degrees().abs();
    format!("{length} · {rise:.0}°")
}
