//! What each button does now, beside it, when a controller comes near the face (ScaffoldSketch §3.2).

use std::collections::BTreeMap;

use bevy::prelude::*;
use midair_studio::hands::{Action, Side};
use midair_studio::settings::Settings;
use midair_studio::tools::{Hint, HintKey, Hints};
use midair_studio::world::WorldView;

use super::{Label, LabelKey, Labels};
use crate::hands::Part;
use crate::room::Stance;

/// Metres from the eyes at which names appear, and at which they go.
const NEAR: [f32; 2] = [0.35, 0.42];

/// Where a controller has what a hint is about.
fn part(key: HintKey) -> Option<Part> {
    Some(match key {
        HintKey::Action(action) => match action {
            Action::Act => Part::Trigger,
            Action::Grab => Part::Grip,
            Action::Up => Part::Up,
            Action::Right | Action::Redo => Part::Right,
            Action::Down => Part::Down,
            Action::Left | Action::Undo => Part::Left,
            Action::Finish | Action::Delete | Action::Centre => Part::Pad,
            Action::Library | Action::Modes | Action::Menu | Action::Save => Part::Menu,
            Action::Cancel | Action::Free => return None,
        },
        HintKey::Swipe => Part::Pad,
        HintKey::Move => return None,
    })
}

/// How one presses it, where a press alone is not what is meant.
fn how(key: HintKey) -> &'static str {
    match key {
        HintKey::Action(Action::Finish) => "hold: ",
        HintKey::Action(Action::Delete) => "twice: ",
        HintKey::Swipe => "touch: ",
        _ => "",
    }
}

/// What each part of one controller does.
fn names(hints: &Hints, side: Side, main: Side) -> BTreeMap<Part, String> {
    let mut names: BTreeMap<Part, Vec<String>> = BTreeMap::new();
    let mut say = |hint: &Hint| {
        if let Some(part) = part(hint.action) {
            let text = format!("{}{}", how(hint.action), hint.does);
            let known = names.entry(part).or_default();
            if !known.contains(&text) {
                known.push(text);
            }
        }
    };
    for hint in hints
        .buttons
        .iter()
        .filter(|h| h.side.is_none_or(|s| s == side))
    {
        // These belong to one hand each.
        let own = match hint.action {
            HintKey::Action(Action::Library | Action::Modes) => side == main,
            HintKey::Action(Action::Save | Action::Undo | Action::Redo) => side != main,
            _ => true,
        };
        if own {
            say(hint);
        }
    }
    let always: &[(Action, &str)] = if side == main {
        &[(Action::Library, "library"), (Action::Modes, "hold: modes")]
    } else {
        &[
            (Action::Undo, "undo"),
            (Action::Redo, "redo"),
            (Action::Save, "save what it touches"),
        ]
    };
    let taken: Vec<Part> = names.keys().copied().collect();
    for &(action, does) in always {
        let key = HintKey::Action(action);
        if let Some(part) = part(key).filter(|p| !taken.contains(p)) {
            names.entry(part).or_default().push(does.to_owned());
        }
    }
    names
        .into_iter()
        .map(|(part, all)| (part, all.join("\n")))
        .collect()
}

pub(crate) fn buttons(
    (hints, settings): (Res<Hints>, Res<Settings>),
    (stance, view): (Res<Stance>, Res<WorldView>),
    mut labels: ResMut<Labels>,
    mut near: Local<[bool; 2]>,
    mut gizmos: Gizmos,
) {
    if !settings.comfort.labels || !stance.head_known {
        return;
    }
    let world = view.world_from_room();
    for side in Side::BOTH {
        let hand = stance.hand(side);
        let i = side as usize;
        let middle = hand.position + hand.rotation * Part::Pad.place();
        let reach = NEAR[usize::from(near[i])];
        near[i] = stance.tracked[i] && middle.distance(stance.head.position) < reach;
        if !near[i] {
            continue;
        }
        for (part, text) in names(&hints, side, settings.hands.main()) {
            let from = hand.position + hand.rotation * part.place();
            let at = hand.position + hand.rotation * part.label();
            gizmos.line(
                world.point(from),
                // It ends where the name begins, not across its letters.
                world.point(from.lerp(at, 0.6)),
                Color::srgba(0.75, 0.75, 0.80, 0.8),
            );
            labels.say(Label {
                key: LabelKey::button(side, part),
                at,
                text,
                wrap: 180.0,
                ..Label::default()
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hints_name_the_buttons_of_their_hand_and_say_how_they_are_pressed() {
        let mut hints = Hints::default();
        hints
            .begin("")
            .say(Action::Act, "select")
            .say(Action::Finish, "fuse 3");
        hints.buttons.push(Hint {
            side: Some(Side::Left),
            action: HintKey::Action(Action::Right),
            does: "intersect".to_owned(),
        });
        let right = names(&hints, Side::Right, Side::Right);
        assert_eq!(right[&Part::Trigger], "select");
        assert_eq!(right[&Part::Pad], "hold: fuse 3");
        assert_eq!(right[&Part::Menu], "library\nhold: modes");
        assert!(!right.contains_key(&Part::Right));
        let left = names(&hints, Side::Left, Side::Right);
        assert_eq!(left[&Part::Right], "intersect");
        assert_eq!(left[&Part::Left], "undo");
    }
}
