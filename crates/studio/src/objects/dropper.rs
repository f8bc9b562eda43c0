//! The eyedropper: the next object that is acted on gives its look to what is selected.

use bevy::prelude::*;

use super::Ask;
use crate::StudioSet;
use crate::command::Command;
use crate::hands::{Action, FilterHands, HandsInput, Side};
use crate::pick::Touch;

/// The eyedropper.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct Dropper {
    held: Held,
    /// Which hands acted in the frame before.
    acted: [bool; 2],
    /// The hand that took with it in this frame.
    taken: Option<Side>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Held {
    /// Put away.
    #[default]
    No,
    /// In hand: the next act is its own.
    Yes,
    /// It has done its work; the button that did it is nobody else's until it is up.
    Spent,
}

impl Dropper {
    /// Whether it is in hand.
    pub fn is_on(&self) -> bool {
        self.held == Held::Yes
    }

    pub(super) fn turn(&mut self, on: bool) {
        self.held = if on { Held::Yes } else { Held::No };
        // A button that is down already was meant for something else.
        self.acted = [true; 2];
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Dropper>().add_systems(
        Update,
        (
            // What the ways in wrote is taken out again before anyone sees it, and recordings keep the ask.
            take.in_set(FilterHands),
            // What the hand touches where it acted is known by now.
            like.in_set(StudioSet::Act),
        ),
    );
}

/// Its click is not the tool's: the hands do not act while it is in one of them.
fn take(mut dropper: ResMut<Dropper>, mut input: ResMut<HandsInput>) {
    if dropper.held == Held::No {
        return;
    }
    let downs = Side::BOTH.map(|side| input.side(side).down);
    let acts = downs.map(|down| down.has(Action::Act));
    let mut next = *dropper;
    match next.held {
        Held::Yes if downs.iter().any(|down| down.has(Action::Cancel)) => next.held = Held::No,
        Held::Yes => {
            let began = |side: &Side| acts[*side as usize] && !next.acted[*side as usize];
            if let Some(side) = Side::BOTH.into_iter().find(began) {
                next.taken = Some(side);
                next.held = Held::Spent;
            }
        }
        Held::Spent if !acts.contains(&true) => next.held = Held::No,
        Held::Spent | Held::No => {}
    }
    next.acted = acts;
    dropper.set_if_neq(next);
    for side in Side::BOTH {
        let down = &mut input.side(side).down;
        down.set(Action::Act, false);
        down.set(Action::Grab, false);
    }
}

/// On nothing it is put away.
fn like(mut dropper: ResMut<Dropper>, touch: Res<Touch>, mut commands: MessageWriter<Command>) {
    if dropper.taken.is_none() {
        return;
    }
    let touched = dropper.taken.take().and_then(|side| touch.get(side));
    if let Some(touched) = touched {
        commands.write(Command::Objects(Ask::Like {
            ids: Vec::new(),
            of: touched.object,
        }));
    }
}
