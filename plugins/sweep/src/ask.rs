//! What Sweep's panel asks for, by name.

use bevy::prelude::*;
use midair_curve::Polyline;
use midair_document::{Object, ObjectId};
use midair_field::Sweep;
use midair_studio::{
    command::Command,
    hands::Side,
    notice::Notices,
    project::{Project, Selection},
};
use midair_swept::MAX_COUNT;
use serde::{Deserialize, Serialize};

use crate::act::target;
use crate::phase::{Draft, Phase};
use crate::{SWEEP, edit, free};

/// One thing that only Sweep understands, written as RON in [`Command::Tool`]. What is about a sweep
/// is about the selected one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SweepAsk {
    /// Eq. 12, so many times over.
    Smooth(u32),
    /// Points along each curve.
    Count(u32),
    /// Metres; 0 opens it.
    Thickness(f32),
    /// Whether a tube is closed at its ends and full.
    Caps(bool),
    /// Cuts it at a curve, from 0.
    Cut(usize),
    /// The next sweep goes on with it.
    Extend,
    /// Takes up its curves, or puts them down.
    Edit,
    /// An end follows a stroke, or is free again.
    Rail {
        /// Which end.
        side: Side,
        /// The stroke's number.
        stroke: Option<u64>,
    },
    /// An end stays where it is, or follows the hand again.
    Pin {
        /// Which end.
        side: Side,
        /// Whether it stays.
        on: bool,
    },
    /// The sweep or the row of clones follows no stroke any more.
    Free,
    /// The row of clones becomes so many objects, each on its own.
    Apart,
    /// So many clones in the selected row, along each of its curves.
    Clones(u32),
    /// w₀ and w₁.
    Slopes(f32, f32),
}

impl SweepAsk {
    /// As a panel asks for it.
    pub fn command(self) -> Command {
        Command::Tool {
            tool: SWEEP,
            ask: ron::to_string(&self).unwrap_or_default(),
        }
    }
}

/// The points of a stroke or a line in the world, where an object is one.
pub(crate) fn stroke(object: &Object) -> Option<Polyline> {
    let there = midair_document::affine(&object.placement);
    let points = match object.line() {
        Some(line) => line.ends().to_vec(),
        None => object.stroke()?.points(),
    };
    Some(Polyline::new(
        points.into_iter().map(|p| there.transform_point3(p)),
    ))
}

pub(crate) fn ask(
    mut commands: MessageReader<Command>,
    mut selection: ResMut<Selection>,
    mut project: ResMut<Project>,
    mut draft: ResMut<Draft>,
    mut notices: ResMut<Notices>,
) {
    for command in commands.read() {
        let ask = match command {
            Command::Tool { tool, ask } if *tool == SWEEP => ask,
            // The document changes under the hands: what they are in the middle of is given up.
            Command::Undo | Command::Redo | Command::New | Command::Open(_) | Command::Restore => {
                draft.drop_sweep();
                draft.kept = None;
                if let Phase::Editing { grip, .. } = &mut draft.phase {
                    *grip = None;
                }
                continue;
            }
            _ => continue,
        };
        match ron::from_str::<SweepAsk>(ask) {
            Ok(SweepAsk::Apart) => free::apart(&mut project, &mut selection, &mut notices),
            Ok(SweepAsk::Clones(count)) => {
                edit::recount(&mut project, &selection, &mut notices, count);
            }
            Ok(ask) => carry_out(ask, &selection, &mut project, &mut draft, &mut notices),
            Err(_) => notices.warn(format!("Sweep does not understand \"{ask}\".")),
        }
    }
}

fn carry_out(
    ask: SweepAsk,
    selection: &Selection,
    project: &mut Project,
    draft: &mut Draft,
    notices: &mut Notices,
) {
    match ask {
        SweepAsk::Rail { side, stroke: None } => {
            draft.rails[side as usize] = None;
            return;
        }
        SweepAsk::Rail {
            side,
            stroke: Some(id),
        } => {
            let object = ObjectId(id);
            match project.document().object(object).and_then(stroke) {
                Some(line) => draft.rails[side as usize] = Some(crate::ends::Rail { object, line }),
                None => notices.warn(format!(
                    "Object {id} is neither stroke nor line. Draw one in Scaffold, then let an end follow it."
                )),
            }
            return;
        }
        SweepAsk::Pin { side, on } => {
            let i = side as usize;
            draft.pinned[i] = if on { draft.ends[i] } else { None };
            return;
        }
        SweepAsk::Slopes(w0, w1) => {
            let fit = |w: f32| {
                if w.is_finite() {
                    w.clamp(0.0, 3.0)
                } else {
                    1.0
                }
            };
            draft.slopes = [fit(w0), fit(w1)];
            return;
        }
        SweepAsk::Free => {
            free::free(project, selection, notices);
            return;
        }
        _ => {}
    }
    let Some(id) = target(project, selection) else {
        notices.info("Select a sweep first.");
        return;
    };
    let Some((sweep, _)) = edit::curves(project, id) else {
        return;
    };
    let (step, next) = match ask {
        SweepAsk::Smooth(times) => {
            edit::smooth(project, notices, id, times.min(1000) as usize);
            return;
        }
        SweepAsk::Cut(at) => {
            edit::cut_at(project, notices, id, at);
            return;
        }
        SweepAsk::Extend => {
            draft.phase = Phase::Idle;
            draft.extends = Some(id);
            return;
        }
        SweepAsk::Edit => {
            draft.phase = match draft.phase {
                Phase::Editing { .. } => Phase::Idle,
                _ => Phase::Editing {
                    object: id,
                    at: 0,
                    grip: None,
                },
            };
            return;
        }
        SweepAsk::Count(count) => (
            "Points of",
            Sweep {
                count: count.clamp(2, MAX_COUNT),
                ..sweep
            },
        ),
        SweepAsk::Thickness(thickness) => ("Thickness of", Sweep { thickness, ..sweep }),
        SweepAsk::Caps(caps) => ("Caps of", Sweep { caps, ..sweep }),
        SweepAsk::Rail { .. }
        | SweepAsk::Pin { .. }
        | SweepAsk::Slopes(..)
        | SweepAsk::Free
        | SweepAsk::Clones(_)
        | SweepAsk::Apart => return,
    };
    edit::replace(project, notices, id, step, next);
}
