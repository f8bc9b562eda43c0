//! What hands do in Assemble.

use bevy::prelude::*;
use midair_document::{Edit, ObjectId};
use midair_field::Op;
use midair_studio::{
    command::Command,
    evaluate::Evaluations,
    hands::{Action, Cross, Hands, Haptic, Side},
    hold::{Held, Reserved},
    notice::Notices,
    objects::picked,
    pick::Touch,
    project::{Project, Selection},
};

use crate::{
    ASSEMBLE,
    fuse::{self, Pending},
    phase::{Draft, Phase},
};

/// What the tool's panel and the flat screen's shortcuts ask for.
pub(crate) fn ask(
    mut commands: MessageReader<Command>,
    touch: Res<Touch>,
    selection: Res<Selection>,
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    mut evaluations: ResMut<Evaluations>,
    mut hands: ResMut<Hands>,
    mut notices: ResMut<Notices>,
) {
    for command in commands.read() {
        let (tool, ask) = match command {
            Command::Tool { tool, ask } => (tool, ask),
            // The document changes under the hands: what they are in the middle of is given up.
            Command::Undo | Command::Redo | Command::New | Command::Open(_) | Command::Restore => {
                *draft = Draft::default();
                continue;
            }
            _ => continue,
        };
        if *tool != ASSEMBLE {
            continue;
        }
        let (verb, rest) = ask.split_once(' ').unwrap_or((ask, ""));
        match (verb, rest) {
            ("mark", name) => {
                let side = Side::BOTH.into_iter().find(|&s| touch.get(s).is_some());
                let Some(mark) = Mark::named(name) else {
                    notices.warn(format!(
                        "Assemble knows no mark \"{name}\". Use union, intersect, subtract or cancel."
                    ));
                    continue;
                };
                let touched = side.and_then(|s| touch.get(s)).map(|t| t.object);
                match touched.map_or_else(|| selection.0.clone(), |t| vec![t]) {
                    objects if objects.is_empty() => {
                        notices.info("Touch or select what to mark first.");
                    }
                    objects => {
                        for object in objects {
                            apply_mark(&mut project, &mut notices, object, mark);
                        }
                    }
                }
            }
            ("update", _) => {
                let done = fuse::finish(&mut project, &mut evaluations, &mut notices);
                hands.pulse(Side::Right, Haptic::of(done));
            }
            _ => notices.warn(format!("Assemble does not understand \"{ask}\".")),
        }
    }
}

/// What the cross does to an operand while SceneOperate is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mark {
    As(Op),
    Cancel,
}

impl Mark {
    pub fn of(cross: Cross) -> Self {
        match cross {
            Cross::Up => Self::As(Op::Union),
            Cross::Right => Self::As(Op::Intersect),
            Cross::Down => Self::As(Op::Subtract),
            Cross::Left => Self::Cancel,
        }
    }

    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "union" => Self::As(Op::Union),
            "intersect" => Self::As(Op::Intersect),
            "subtract" => Self::As(Op::Subtract),
            "cancel" => Self::Cancel,
            _ => return None,
        })
    }
}

fn apply_mark(project: &mut Project, notices: &mut Notices, object: ObjectId, mark: Mark) -> bool {
    let document = project.document();
    if document.object(object).is_none_or(|o| o.recipe().is_none()) {
        notices.warn("Only closed solids can be operands.");
        return false;
    }
    let mut pending = document.pending().to_vec();
    let at = pending.iter().position(|&(o, _)| o == object);
    let name = match mark {
        Mark::As(op) => {
            match at {
                Some(at) => pending[at].1 = op,
                None => pending.push((object, op)),
            }
            "Mark operand"
        }
        Mark::Cancel => {
            let Some(at) = at else { return false };
            pending.remove(at);
            "Unmark operand"
        }
    };
    project.commit_live(name, [Edit::SetPending { pending }], notices)
}

/// A model that a hand touches and acts on is selected.
pub(crate) fn select(
    hands: Res<Hands>,
    touch: Res<Touch>,
    project: Res<Project>,
    mut selection: ResMut<Selection>,
) {
    for (side, hand) in hands.both() {
        if hand.pressed(Action::Act) {
            // A group is selected as one; what is selected with others stays so, to be moved together.
            let touched = touch.get(side).map(|t| t.object);
            if touched.is_some_and(|t| selection.0.contains(&t)) {
                continue;
            }
            let picked = touched.map_or_else(Vec::new, |t| picked(project.document(), t));
            selection.set_if_neq(Selection(picked));
        }
    }
}

/// The cross opens SceneOperate on that hand; then its arms mark what the hand touches.
pub(crate) fn operate(
    mut hands: ResMut<Hands>,
    (touch, held): (Res<Touch>, Res<Held>),
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    for side in Side::BOTH {
        if hands.get(side).pressed(Action::Cancel) && draft.phase(side) == Phase::Operating {
            draft.set(side, Phase::Idle);
        }
        // A hand that takes something closes it.
        if held.get(side).is_some() {
            draft.set(side, Phase::Idle);
            continue;
        }
        let Some(cross) = hands.get(side).cross() else {
            continue;
        };
        match draft.phase(side) {
            Phase::Idle => {
                draft.set(side, Phase::Operating);
                hands.pulse(side, Haptic::Tick);
            }
            Phase::Operating => match (touch.get(side), Mark::of(cross)) {
                (Some(touched), mark) => {
                    let done = apply_mark(&mut project, &mut notices, touched.object, mark);
                    hands.pulse(side, Haptic::of(done));
                }
                // Nothing to cancel: SceneOperate itself is put away.
                (None, Mark::Cancel) => draft.set(side, Phase::Idle),
                (None, Mark::As(_)) => hands.pulse(side, Haptic::Refused),
            },
        }
    }
}

/// One press carries the whole sequence out.
pub(crate) fn finish(
    mut hands: ResMut<Hands>,
    (held, reserved): (Res<Held>, Res<Reserved>),
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    mut evaluations: ResMut<Evaluations>,
    mut notices: ResMut<Notices>,
) {
    let Some(side) = hands.pressed(Action::Finish) else {
        return;
    };
    // It answers a question that was asked just now.
    if reserved.has(side, Action::Finish) {
        return;
    }
    if !held.is_empty() {
        notices.info("Let go of the operand first, then update.");
        hands.pulse(side, Haptic::Refused);
        return;
    }
    let done = fuse::finish(&mut project, &mut evaluations, &mut notices);
    if done {
        for s in Side::BOTH {
            draft.set(s, Phase::Idle);
        }
    }
    hands.pulse(side, Haptic::of(done));
}

/// Whether the marks make a copy or a fusion.
pub(crate) fn pending(project: &Project) -> Pending {
    Pending::of(project.document())
}
