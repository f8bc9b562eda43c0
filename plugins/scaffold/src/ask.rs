//! What the panel and sessions ask of Scaffold, by name.

use std::path::PathBuf;

use bevy::math::{DQuat, DVec3};
use bevy::prelude::*;
use midair_beautify::{Line, LineOptions, StrokeOptions};
use midair_document::{
    ConstructionLine, DrawnStroke, Edit, Kind, LineReading, Object, ObjectId, StrokeReading, affine,
};
use midair_solid::plate;
use midair_studio::command::Command;
use midair_studio::drawing::Drawing;
use midair_studio::notice::Notices;
use midair_studio::project::{Project, Selection};
use midair_studio::settings::{ScaffoldSettings, Settings};
use serde::{Deserialize, Serialize};

use crate::history::{self, Writing};
use crate::phase::{Draft, Phase};
use crate::read::{self, Reading, Scene, carried};
use crate::{SCAFFOLD, draw, make};

/// One thing asked of Scaffold. It is about the lines and strokes that are selected, or where none is about what
/// was drawn last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Ask {
    /// What was drawn last is read in another way: 0 the best, the last one as drawn.
    Reading(usize),
    /// Corrected once more from what was drawn, with thresholds so many times as wide as then; 0 puts back what was
    /// drawn.
    Again(f64),
    /// A line is so long, in metres; it grows from where it begins.
    Length(f64),
    /// A line rises by so many degrees from the level, and leads to where they say, counted from +x towards −z.
    Angles {
        /// From −90 to 90.
        rise: f64,
        /// From −180 to 180.
        heading: f64,
    },
    /// The second of two lines meets the first at so many degrees; it turns about the end that is nearer to it.
    Between(f64),
    /// From now on lines meet others at so many degrees as well, up to a right angle, where they almost do; 0 for none.
    OwnAngle(f64),
    /// A tick mark on a line, at a share of its length.
    Tick {
        /// The line.
        id: ObjectId,
        /// Between 0 and 1.
        at: f64,
    },
    /// Takes the tick marks of lines away.
    Untick,
    /// Strokes are so wide, in metres.
    Width(f64),
    /// A closed stroke, or what meets end to end, is filled: a plate.
    Fill,
    /// All construction lines become one group.
    Group,
    /// The whole history of the drawing goes to a file: into the work folder where none is named.
    History(Option<PathBuf>),
    /// What can be seen of the drawing goes to a sheet of four views, an SVG, likewise.
    Sheet(Option<PathBuf>),
}

impl Ask {
    /// The command that asks for it.
    pub fn command(&self) -> Command {
        Command::Tool {
            tool: SCAFFOLD,
            ask: ron::to_string(self).unwrap_or_default(),
        }
    }
}

/// What an ask is carried out on.
type On<'w> = (
    Res<'w, Settings>,
    Res<'w, Drawing>,
    ResMut<'w, Selection>,
    ResMut<'w, Draft>,
    ResMut<'w, Writing>,
);

pub(crate) fn ask(
    mut commands: MessageReader<Command>,
    (settings, drawing, mut selection, mut draft, mut writing): On,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    for command in commands.read() {
        let ask = match command {
            Command::Tool { tool, ask } if *tool == SCAFFOLD => ask,
            // The document changes under the hand.
            Command::Undo | Command::Redo | Command::New | Command::Open(_) | Command::Restore => {
                draft.phase = Phase::Idle;
                draft.picked = None;
                continue;
            }
            _ => continue,
        };
        let ask: Ask = match ron::from_str(ask) {
            Ok(ask) => ask,
            Err(_) => {
                notices.warn(format!(
                    "Scaffold does not understand \"{ask}\". docs/scaffold.md lists what it does."
                ));
                continue;
            }
        };
        let ids = about(&selection, &draft, &project);
        match ask {
            Ask::Reading(to) => {
                make::choose(to, &mut project, &mut notices, &mut draft);
            }
            Ask::Again(strength) => {
                let set = settings.scaffold.sound();
                let set = (&set, draft.own_angle);
                again(&ids, strength, set, &drawing, &mut project, &mut notices);
            }
            Ask::Tick { id, at } => {
                let fits = at > 0.0 && at < 1.0;
                if !fits || !draw::tick(id, at, &mut project, &mut notices) {
                    notices.warn("A tick mark goes on a construction line, between its ends.");
                }
            }
            Ask::Fill => {
                let thickness = settings.scaffold.sound().plate as f32;
                if let Some(id) = fill(&ids, thickness, &mut project, &mut notices) {
                    selection.set_if_neq(Selection(vec![id]));
                }
            }
            Ask::Group => group(&mut project, &mut notices),
            Ask::History(path) => history::start(path, &project, &mut writing),
            Ask::Sheet(path) => history::start_sheet(path, &project, &mut writing),
            Ask::OwnAngle(degrees) => {
                if (0.0..=90.0).contains(&degrees) {
                    draft.own_angle = degrees;
                } else {
                    notices.warn("An angle of one's own is from 0° (none) to 90°.");
                }
            }
            Ask::Between(degrees) => {
                let between = between(&ids, degrees, &project);
                commit("Set angle", between, &mut project, &mut notices);
            }
            Ask::Length(_) | Ask::Angles { .. } | Ask::Untick | Ask::Width(_) => {
                let changed = ids.iter().filter_map(|&id| {
                    let object = project.document().object(id)?;
                    Some((id, changed(&ask, object)?))
                });
                let changed: Vec<_> = changed.collect();
                commit("Set line", changed, &mut project, &mut notices);
            }
        }
    }
}

/// The lines and strokes that an ask is about.
pub(crate) fn about(selection: &Selection, draft: &Draft, project: &Project) -> Vec<ObjectId> {
    let drawn = |id: &ObjectId| {
        let object = project.document().object(*id);
        object.is_some_and(|o| o.line().is_some() || o.stroke().is_some())
    };
    let ids: Vec<ObjectId> = selection.0.iter().copied().filter(drawn).collect();
    if ids.is_empty() {
        let last = draft.last.as_ref().map(|l| l.id);
        last.into_iter().filter(drawn).collect()
    } else {
        ids
    }
}

fn commit(
    name: &str,
    changed: Vec<(ObjectId, Kind)>,
    project: &mut Project,
    notices: &mut Notices,
) {
    if changed.is_empty() {
        notices.info("Select the line or stroke that is meant first.");
        return;
    }
    let edits = changed
        .into_iter()
        .map(|(id, kind)| Edit::SetKind { id, kind });
    project.commit_live(name, edits, notices);
}

/// Corrects once more from what was drawn.
fn again(
    ids: &[ObjectId],
    strength: f64,
    set: (&ScaffoldSettings, f64),
    drawing: &Drawing,
    project: &mut Project,
    notices: &mut Notices,
) {
    let changed = ids.iter().filter_map(|&id| {
        let object = project.document().object(id)?;
        let (readings, _) = readings_again(id, object, strength, set, drawing)?;
        let reading = if strength > 0.0 {
            readings.first()?
        } else {
            readings.last()?
        };
        let kind = carried(&reading.kind, &affine(&object.placement).inverse());
        let kind = with_what_it_has(kind, object);
        (kind != object.kind).then_some((id, kind))
    });
    let changed: Vec<_> = changed.collect();
    if changed.is_empty() && !ids.is_empty() {
        notices.info("Corrected once more it stays as it is.");
        return;
    }
    commit("Correct again", changed, project, notices);
}

/// Tick marks and width are not the correction's, and what it was told first is what it is measured by.
fn with_what_it_has(kind: Kind, object: &Object) -> Kind {
    match (kind, &object.kind) {
        (Kind::Line(new), Kind::Line(old)) => Kind::Line(ConstructionLine {
            ticks: old.ticks.clone(),
            reading: LineReading {
                auto: new.reading.auto,
                ..old.reading
            },
            ..new
        }),
        (Kind::Stroke(new), Kind::Stroke(old)) => Kind::Stroke(
            DrawnStroke {
                width: old.width,
                reading: StrokeReading {
                    auto: new.reading.auto,
                    ..old.reading
                },
                ..(*new).clone()
            }
            .into(),
        ),
        (kind, _) => kind,
    }
}

fn readings_again(
    id: ObjectId,
    object: &Object,
    strength: f64,
    (set, own_angle): (&ScaffoldSettings, f64),
    drawing: &Drawing,
) -> Option<(Vec<Reading>, bool)> {
    let strength = if strength.is_finite() && strength > 0.0 {
        strength.clamp(0.05, 10.0)
    } else {
        1.0
    };
    let there = affine(&object.placement);
    let scene = Scene::of(drawing, &[id]);
    match &object.kind {
        Kind::Line(line) => {
            let [a, b] = line.raw.map(|p| there.transform_point3(p));
            let options = LineOptions {
                distance: line.reading.distance,
                angle: line.reading.angle,
                length: line.reading.length,
                vertical: set.vertical,
                own_angle: own_angle.to_radians(),
                part_turn: if set.part_turns {
                    line.reading.angle
                } else {
                    0.0
                },
                metres_per_world: 1.0,
            };
            Some(read::line(
                &Line::new(a, b),
                &scene,
                &options.stronger(strength),
            ))
        }
        Kind::Stroke(stroke) => {
            let points: Vec<DVec3> = stroke
                .raw
                .iter()
                .map(|&p| there.transform_point3(p))
                .collect();
            let options = StrokeOptions {
                distance: stroke.reading.distance * strength,
                angle: (stroke.reading.angle * strength).min(1.2),
                spacing: stroke.reading.spacing,
                ..StrokeOptions::default()
            };
            Some(read::stroke(&points, stroke.width, &scene, &options))
        }
        _ => None,
    }
}

/// What an object becomes by a number that is set.
fn changed(ask: &Ask, object: &Object) -> Option<Kind> {
    let there = affine(&object.placement);
    let to_own = |p: DVec3| there.inverse().transform_point3(p);
    match (ask, &object.kind) {
        (Ask::Length(length), Kind::Line(line)) => {
            let [a, b] = line.ends().map(|p| there.transform_point3(p));
            let along = (b - a).try_normalize()?;
            let sound = length.is_finite() && *length >= 1e-3 && *length <= 1e3;
            sound.then(|| set(line, line.a, to_own(a + along * *length)))
        }
        (Ask::Angles { rise, heading }, Kind::Line(line)) => {
            let [a, b] = line.ends().map(|p| there.transform_point3(p));
            let (rise, heading) = (rise.to_radians(), heading.to_radians());
            let along = DVec3::new(
                rise.cos() * heading.cos(),
                rise.sin(),
                -rise.cos() * heading.sin(),
            );
            along
                .is_finite()
                .then(|| set(line, line.a, to_own(a + along * a.distance(b))))
        }
        (Ask::Untick, Kind::Line(line)) => Some(Kind::Line(ConstructionLine {
            ticks: Vec::new(),
            ..line.clone()
        })),
        (Ask::Width(width), Kind::Stroke(stroke)) => {
            let width = if width.is_finite() {
                width.clamp(0.0005, 0.2)
            } else {
                return None;
            };
            Some(Kind::Stroke(
                DrawnStroke {
                    width,
                    ..(**stroke).clone()
                }
                .into(),
            ))
        }
        _ => None,
    }
}

/// A line whose ends were set by numbers: what it was corrected into holds no longer.
fn set(line: &ConstructionLine, a: DVec3, b: DVec3) -> Kind {
    Kind::Line(ConstructionLine {
        a,
        b,
        kept: Vec::new(),
        ..line.clone()
    })
}

fn between(ids: &[ObjectId], degrees: f64, project: &Project) -> Vec<(ObjectId, Kind)> {
    let line = |id: ObjectId| {
        let object = project.document().object(id)?;
        let there = affine(&object.placement);
        let line = object.line()?;
        Some((line, there, line.ends().map(|p| there.transform_point3(p))))
    };
    let mut lines = ids
        .iter()
        .filter_map(|&id| Some((id, line(id)?)))
        .collect::<Vec<_>>();
    if lines.len() < 2 || !degrees.is_finite() {
        return Vec::new();
    }
    let (id, (moved, there, [a, b])) = lines.swap_remove(1);
    let (_, (_, _, [c, d])) = lines.swap_remove(0);
    // It turns about the end that is nearer to the first.
    let far = |p: DVec3| p.distance(c).min(p.distance(d));
    let (hinge, free) = if far(a) <= far(b) { (a, b) } else { (b, a) };
    let (Some(along), Some(of)) = ((free - hinge).try_normalize(), (d - c).try_normalize()) else {
        return Vec::new();
    };
    // Seen from the hinge the first line leads away.
    let of = if hinge.distance(c) <= hinge.distance(d) {
        of
    } else {
        -of
    };
    let axis = of
        .cross(along)
        .try_normalize()
        .unwrap_or_else(|| of.any_orthonormal_vector());
    let turned = DQuat::from_axis_angle(axis, degrees.to_radians()) * of;
    let to = there
        .inverse()
        .transform_point3(hinge + turned * free.distance(hinge));
    let (a, b) = if hinge == a {
        (moved.a, to)
    } else {
        (to, moved.b)
    };
    vec![(id, set(moved, a, b))]
}

/// Fills what is closed; says which object the plate is.
pub(crate) fn fill(
    ids: &[ObjectId],
    thickness: f32,
    project: &mut Project,
    notices: &mut Notices,
) -> Option<ObjectId> {
    let document = project.document();
    let name = ids
        .first()
        .and_then(|&id| document.object(id))
        .map_or("Nothing", |o| o.name.as_str())
        .to_owned();
    match plate(document, ids, thickness) {
        Ok((recipe, placement)) => {
            let id = ObjectId(document.next_id());
            let object = Object::solid(format!("Plate {id}"), recipe).placed(placement);
            let object = object.into();
            let done = project.commit_live("Fill", [Edit::Add { id, object }], notices);
            done.then_some(id)
        }
        Err(fault) => {
            notices.warn(format!("{name} was not filled: {fault}."));
            None
        }
    }
}

fn group(project: &mut Project, notices: &mut Notices) {
    let document = project.document();
    let lines: Vec<ObjectId> = document
        .objects()
        .filter(|(_, o)| o.line().is_some() && o.group.is_none())
        .map(|(id, _)| id)
        .collect();
    if lines.len() < 2 {
        notices.info("There are no two construction lines that could become a group.");
        return;
    }
    let edit = document.group_edit("Scaffold", &lines);
    project.commit_live("Group scaffold", [edit], notices);
}
