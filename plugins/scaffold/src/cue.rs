//! What Scaffold says of its phase: what each button does now.

use bevy::prelude::*;
use midair_studio::hands::{Action, Side};
use midair_studio::pick::Touch;
use midair_studio::settings::{Draws, Settings};
use midair_studio::tools::Hints;

use crate::phase::{Draft, Phase};

pub(crate) fn hints(
    settings: Res<Settings>,
    touch: Res<Touch>,
    draft: Res<Draft>,
    mut hints: ResMut<Hints>,
) {
    let mut next = Hints::default();
    let auto = settings.scaffold.auto;
    let corrected = if auto { "corrected" } else { "as drawn" };
    match &draft.phase {
        Phase::Line { raw, .. } => {
            let becomes = match &draft.preview {
                _ if *raw || !auto => "as drawn".to_owned(),
                Some(reading) => reading.words.clone(),
                None => "a tick mark, or a point to join".to_owned(),
            };
            next.begin(format!("A line: {becomes}"))
                .say(Action::Act, "let go to end it")
                .say(Action::Free, "keep it as drawn")
                .say(Action::Cancel, "give it up");
        }
        Phase::Stroke { raw, .. } => {
            let becomes = if *raw { "as drawn" } else { corrected };
            next.begin(format!("A stroke, {becomes}"))
                .say(Action::Act, "let go to end it")
                .say(Action::Free, "keep it as drawn")
                .say(Action::Cancel, "give it up");
        }
        Phase::Idle => {
            let (what, other) = match settings.scaffold.draws {
                Draws::Line => ("line", "draw strokes"),
                Draws::Stroke => ("stroke", "draw lines"),
            };
            let over = draft
                .over
                .and_then(|i| draft.last.as_ref()?.readings.get(i));
            let act = match over {
                Some(reading) => format!("read it as {}", reading.words),
                None => format!("draw a {what}"),
            };
            let status = if draft.picked.is_some() {
                "Scaffold: press on the second point".to_owned()
            } else {
                format!("Scaffold: {what}s, {corrected}")
            };
            next.begin(status)
                .say(Action::Act, act)
                .say(Action::Up, other)
                .say(
                    Action::Down,
                    if auto {
                        "auto-correct off"
                    } else {
                        "auto-correct on"
                    },
                );
            if let Some(last) = &draft.last {
                let of = last.readings.len();
                if of > 1 {
                    let at = last.chosen + 1;
                    next.say(Action::Right, format!("other reading ({at} of {of})"));
                }
            }
            if Side::BOTH.iter().any(|&s| touch.get(s).is_some()) {
                next.say(Action::Grab, "move").say(Action::Delete, "delete");
            }
        }
    }
    if *hints != next {
        *hints = next;
    }
}
