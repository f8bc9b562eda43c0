//! What hands do in Assemble.

use bevy::prelude::*;
use midair_document::{Edit, ObjectId};
use midair_field::{Op, Placement};
use midair_studio::{
    command::Command,
    evaluate::Evaluations,
    hands::{Action, Cross, Hands, Haptic, Side},
    notice::Notices,
    objects::{carried, companions, picked},
    pick::Touch,
    project::{Project, Selection},
    settings::Settings,
    show::Drafts,
    snap::Snapper,
};

use crate::{
    ASSEMBLE,
    fuse::{self, Pending},
    hold::{Axis, Hold, Stretch},
    phase::{Draft, Options, Phase},
};

/// What the tool's panel and the flat screen's shortcuts ask for.
pub(crate) fn ask(
    mut commands: MessageReader<Command>,
    touch: Res<Touch>,
    selection: Res<Selection>,
    mut options: ResMut<Options>,
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
                hands.pulse(Side::Right, haptic(done));
            }
            ("save-as", ending) => options.save_as = ending.to_owned(),
            _ => notices.warn(format!("Assemble does not understand \"{ask}\".")),
        }
    }
}

fn haptic(done: bool) -> Haptic {
    if done { Haptic::Done } else { Haptic::Refused }
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
    project.commit(name, [Edit::SetPending { pending }], notices)
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
    touch: Res<Touch>,
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    for side in Side::BOTH {
        if hands.get(side).pressed(Action::Cancel) && draft.phase(side) == Phase::Operating {
            draft.set(side, Phase::Idle);
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
                    hands.pulse(side, haptic(done));
                }
                // Nothing to cancel: SceneOperate itself is put away.
                (None, Mark::Cancel) => draft.set(side, Phase::Idle),
                (None, Mark::As(_)) => hands.pulse(side, Haptic::Refused),
            },
            Phase::Holding { .. } => {}
        }
    }
}

/// Deletes what the hand touches, or on an empty hand what is selected.
pub(crate) fn delete(
    mut hands: ResMut<Hands>,
    touch: Res<Touch>,
    mut selection: ResMut<Selection>,
    mut draft: ResMut<Draft>,
    mut drafts: ResMut<Drafts>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    for side in Side::BOTH {
        if !hands.get(side).pressed(Action::Delete) {
            continue;
        }
        let objects = match draft.held(side).or(touch.get(side).map(|t| t.object)) {
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
            for s in Side::BOTH {
                if draft.held(s) == Some(object) {
                    draft.set(s, Phase::Idle);
                }
            }
        }
        draft.stretch = None;
        let done = project.commit("Delete", edits, &mut notices);
        selection.0.retain(|o| !objects.contains(o));
        hands.pulse(side, haptic(done));
    }
}

/// One press carries the whole sequence out.
pub(crate) fn finish(
    mut hands: ResMut<Hands>,
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    mut evaluations: ResMut<Evaluations>,
    mut notices: ResMut<Notices>,
) {
    let Some(side) = hands.pressed(Action::Finish) else {
        return;
    };
    if Side::BOTH.iter().any(|&s| draft.held(s).is_some()) {
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
    hands.pulse(side, haptic(done));
}

/// The hand that does not lead saves what it touches as a mesh file.
pub(crate) fn save(
    mut hands: ResMut<Hands>,
    touch: Res<Touch>,
    (options, settings): (Res<Options>, Res<Settings>),
    project: Res<Project>,
    mut commands: MessageWriter<Command>,
    mut notices: ResMut<Notices>,
) {
    let side = settings.hands.off();
    if !hands.get(side).pressed(Action::Save) {
        return;
    }
    match touch.get(side) {
        Some(touched) => {
            let path = project.export_path(touched.object, &options.save_as);
            commands.write(Command::ExportObject {
                object: touched.object,
                path,
            });
            hands.pulse(side, Haptic::Done);
        }
        None => {
            let hand = if side == Side::Left { "left" } else { "right" };
            notices.info(format!(
                "Touch what to save with the {hand} hand, then press save."
            ));
            hands.pulse(side, Haptic::Refused);
        }
    }
}

/// Takes things in hand and moves what is held.
pub(crate) fn grab(
    mut hands: ResMut<Hands>,
    touch: Res<Touch>,
    project: Res<Project>,
    selection: Res<Selection>,
    mut draft: ResMut<Draft>,
    mut drafts: ResMut<Drafts>,
    mut snapper: Snapper,
) {
    let document = project.document();
    for side in Side::BOTH {
        let hand = hands.get(side);
        if !hand.pressed(Action::Grab) || draft.held(side).is_some() {
            continue;
        }
        let Some(touched) = touch.get(side).filter(|t| !document.is_locked(t.object)) else {
            continue;
        };
        let Some(object) = document.object(touched.object) else {
            continue;
        };
        let standing = *drafts.get(touched.object).unwrap_or(&object.placement);
        let hold = Hold::new(&hand.pose, &standing);
        draft.set(
            side,
            Phase::Holding {
                object: touched.object,
                hold,
            },
        );
        if draft.held(side.other()) == Some(touched.object) {
            let [left, right] = Side::BOTH.map(|s| hands.get(s).pose.position);
            draft.stretch = Some((touched.object, Stretch::new(left, right, &standing)));
        }
        drafts.set(touched.object, standing);
        hands.pulse(side, Haptic::Tick);
    }
    let [left, right] = Side::BOTH.map(|s| hands.get(s).pose.position);
    if let Some((object, stretch)) = &mut draft.stretch {
        // The right pad says along which axis (EasyVRModeling Fig. 4b).
        if let Some(axis) = hands.get(Side::Right).swipe.and_then(Axis::of_quadrant) {
            stretch.choose(axis, left, right);
        }
        drafts.set(*object, stretch.placement(left, right));
        return;
    }
    for side in Side::BOTH {
        if let Phase::Holding { object, hold } = draft.phase(side) {
            let wanted = hold.placement(&hands.get(side).pose);
            let along = companions(document, &selection.0, object);
            drafts.set(object, snapper.place(object, &along, wanted, &hands, side));
        }
    }
    // A group, and what is selected together, moves as one.
    for (side, other) in Side::BOTH.map(|s| (s, s.other())) {
        let Some((object, now)) = draft.held(side).and_then(|o| Some((o, *drafts.get(o)?))) else {
            continue;
        };
        let Some(before) = document.object(object).map(|o| o.placement) else {
            continue;
        };
        for companion in companions(document, &selection.0, object) {
            if draft.held(other) != Some(companion)
                && let Some(standing) = document.object(companion)
            {
                let there = carried(&before, &now, &standing.placement);
                drafts.set(companion, there);
            }
        }
    }
}

/// A hand that lets go: the last one commits the gesture as one edit.
pub(crate) fn release(
    mut hands: ResMut<Hands>,
    mut draft: ResMut<Draft>,
    mut drafts: ResMut<Drafts>,
    selection: Res<Selection>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    for side in Side::BOTH {
        let Some(object) = draft.held(side) else {
            continue;
        };
        if hands.get(side).pressed(Action::Cancel) {
            // Both hands give it up; it goes back to where it was.
            for s in Side::BOTH {
                if draft.held(s) == Some(object) {
                    draft.set(s, Phase::Idle);
                }
            }
            draft.stretch = None;
            drafts.take(object);
            for companion in companions(project.document(), &selection.0, object) {
                if !draft.holds(companion) {
                    drafts.take(companion);
                }
            }
            continue;
        }
        if hands.get(side).held(Action::Grab) {
            continue;
        }
        draft.set(side, Phase::Idle);
        let stretched = draft.stretch.take_if(|(o, _)| *o == object).is_some();
        if draft.holds(object) {
            // The other hand goes on holding it, as it stands now.
            if stretched && let Some(standing) = drafts.get(object) {
                let other = side.other();
                let hold = Hold::new(&hands.get(other).pose, standing);
                draft.set(other, Phase::Holding { object, hold });
            }
            continue;
        }
        if let Some(placement) = drafts.take(object) {
            let with: Vec<_> = companions(project.document(), &selection.0, object)
                .into_iter()
                .filter(|&c| !draft.holds(c))
                .filter_map(|c| Some((c, drafts.take(c)?)))
                .collect();
            commit_placement(
                &mut project,
                &mut notices,
                object,
                placement,
                with,
                stretched,
            );
            hands.pulse(side, Haptic::Tick);
        }
    }
}

fn commit_placement(
    project: &mut Project,
    notices: &mut Notices,
    id: ObjectId,
    placement: Placement,
    with: Vec<(ObjectId, Placement)>,
    stretched: bool,
) {
    let Some(object) = project.document().object(id) else {
        return;
    };
    let scaled = stretched || object.placement.scale != placement.scale;
    let before = object.placement;
    let still = placement.translation.distance(before.translation) < 1e-5
        && placement.rotation.angle_between(before.rotation) < 1e-3
        && placement.scale == before.scale;
    if still {
        // A click, or the rounding of one: no step to undo.
        return;
    }
    let name = format!("{} {}", if scaled { "Scale" } else { "Move" }, object.name);
    let fresh = object.fresh;
    let mut edits = vec![Edit::SetPlacement { id, placement }];
    if fresh && object.placement != placement {
        edits.push(Edit::SetFresh { id, fresh: false });
    }
    edits.extend(
        with.into_iter()
            .map(|(id, placement)| Edit::SetPlacement { id, placement }),
    );
    project.commit(name, edits, notices);
}

/// Whether the marks make a copy or a fusion.
pub(crate) fn pending(project: &Project) -> Pending {
    Pending::of(project.document())
}
