//! What Assemble says of its phase: what each button does now.

use bevy::prelude::*;
use midair_studio::{
    hands::{Action, Hands, Side},
    hold::Held,
    pick::Touch,
    project::Project,
    tools::Hints,
};

use crate::{
    act,
    fuse::Pending,
    phase::{Draft, Phase},
};

pub(crate) fn hints(
    project: Res<Project>,
    hands: Res<Hands>,
    (touch, held): (Res<Touch>, Res<Held>),
    draft: Res<Draft>,
    mut hints: ResMut<Hints>,
) {
    let mut next = Hints::default();
    let touching = Side::BOTH.iter().any(|&s| touch.get(s).is_some());
    let holding = Side::BOTH.iter().any(|&s| held.get(s).is_some());
    let operating = Side::BOTH
        .iter()
        .any(|&s| draft.phase(s) == Phase::Operating);
    if let Some((object, stretch)) = held.stretch() {
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
