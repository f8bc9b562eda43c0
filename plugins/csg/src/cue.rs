//! What Assemble shows of its phase: operand colours and signs, and what each button does now.

use bevy::prelude::*;
use midair_field::Op;
use midair_studio::{
    hands::{Action, Hands, Side},
    pick::Touch,
    project::{Project, Selection},
    show::{Cues, Tint},
    tools::Hints,
};

use crate::{
    act,
    fuse::Pending,
    phase::{Draft, Phase},
    preview::Preview,
};

pub(crate) fn colours(
    project: Res<Project>,
    touch: Res<Touch>,
    selection: Res<Selection>,
    draft: Res<Draft>,
    preview: Res<Preview>,
    mut cues: ResMut<Cues>,
) {
    let document = project.document();
    let mut next = Cues::default();
    for (id, object) in document.objects() {
        if object.fresh {
            next.entry(id).tint = Tint::Fresh;
        }
    }
    for (i, &(id, op)) in document.pending().iter().enumerate() {
        // The first operand's operator is ignored: it is what the others join.
        let tint = match if i == 0 { Op::Union } else { op } {
            Op::Union => Tint::Union,
            Op::Intersect => Tint::Intersect,
            Op::Subtract => Tint::Subtract,
        };
        let cue = next.entry(id);
        cue.tint = tint;
        cue.ghost = preview.is_shown();
        cue.label = tint.sign().map(|s| format!("{} {s}", i + 1));
    }
    for side in Side::BOTH {
        let held = draft.held(side);
        if let Some(object) = held.or(touch.get(side).map(|t| t.object)) {
            next.entry(object).touched = true;
        }
    }
    for &object in &selection.0 {
        next.entry(object).selected = true;
    }
    if *cues != next {
        *cues = next;
    }
}

pub(crate) fn hints(
    project: Res<Project>,
    hands: Res<Hands>,
    touch: Res<Touch>,
    draft: Res<Draft>,
    mut hints: ResMut<Hints>,
) {
    let mut next = Hints::default();
    let touching = Side::BOTH.iter().any(|&s| touch.get(s).is_some());
    let holding = Side::BOTH.iter().any(|&s| draft.held(s).is_some());
    let operating = Side::BOTH
        .iter()
        .any(|&s| draft.phase(s) == Phase::Operating);
    if let Some((object, stretch)) = &draft.stretch {
        let [left, right] = Side::BOTH.map(|s| hands.get(s).pose.position);
        let factor = stretch.factor(left, right);
        let name = project.document().object(*object).map_or("", |o| &o.name);
        next.begin(format!(
            "Scaling {name} along {}: × {:.2} / {:.2} / {:.2}",
            stretch.axis().letter(),
            factor.x,
            factor.y,
            factor.z
        ))
        .say(Action::Up, "X")
        .say(Action::Right, "Y")
        .say(Action::Down, "Z")
        .say(Action::Left, "all three")
        .say(Action::Cancel, "put it back");
    } else if holding {
        next.begin("Moving: let go to place it")
            .say(Action::Grab, "with the other hand too: scale")
            .say(Action::Delete, "delete")
            .say(Action::Cancel, "put it back");
    } else if operating {
        next.begin("Marking operands, left to right")
            .say(Action::Up, "∪ unite")
            .say(Action::Right, "∩ intersect")
            .say(Action::Down, "− subtract")
            .say(Action::Left, if touching { "unmark" } else { "close" });
    } else {
        next.begin("Assemble");
        if touching {
            next.say(Action::Grab, "move and turn")
                .say(Action::Act, "select")
                .say(Action::Delete, "delete")
                .say(Action::Save, "save as a mesh");
        }
        next.say(Action::Up, "mark operands")
            .say(Action::Library, "library");
    }
    match act::pending(&project) {
        Pending::Nothing => {}
        Pending::Copy(id) => {
            let name = project.document().object(id).map_or("", |o| &o.name);
            next.say(Action::Finish, format!("copy {name}"));
        }
        Pending::Fuse(count) => {
            next.say(Action::Finish, format!("fuse {count}"));
        }
    }
    if *hints != next {
        *hints = next;
    }
}
