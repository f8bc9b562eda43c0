//! The ring of modes at a hand: open while its button is held; where the hand goes or the stick points is chosen, and
//! letting go takes it.

use bevy::prelude::*;
use midair_studio::carry::in_hands;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Hands, Haptic, Side};
use midair_studio::hold::Held;
use midair_studio::panel;
use midair_studio::tools::Tools;

use crate::room::{Stance, facing};

/// Metres a hand goes to the rim.
const RADIUS: f32 = 0.09;

/// The ring, if it is open.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Ring {
    open: Option<Open>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Open {
    side: Side,
    /// Where the hand was, in metres of the room.
    at: Vec3,
    chosen: Option<usize>,
}

impl Ring {
    /// Whether it is to be seen.
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Where it opened, in metres of the room.
    pub fn at(&self) -> Vec3 {
        self.open.map_or(Vec3::ZERO, |o| o.at)
    }

    /// Which mode would be taken.
    pub fn chosen(&self) -> Option<usize> {
        self.open.and_then(|o| o.chosen)
    }
}

pub(crate) fn turn(
    (mut hands, tools): (ResMut<Hands>, Res<Tools>),
    (stance, held): (Res<Stance>, Res<Held>),
    mut ring: ResMut<Ring>,
    mut commands: MessageWriter<Command>,
) {
    let count = tools.all().len();
    let Some(mut open) = ring.open else {
        let side = Side::BOTH
            .into_iter()
            .find(|&s| hands.get(s).held(Action::Modes));
        if let Some(side) = side {
            ring.open = Some(Open {
                side,
                at: stance.hand(side).position,
                chosen: None,
            });
            hands.pulse(side, Haptic::Tick);
        }
        return;
    };
    let hand = hands.get(open.side);
    if hand.held(Action::Modes) {
        let turn = facing(open.at, stance.head.position);
        let gone = turn.inverse() * (stance.hand(open.side).position - open.at);
        let pushed = hand.swipe.and_then(|s| panel::sector(s, count));
        let chosen = pushed
            .or(panel::sector(gone.truncate() / RADIUS, count))
            .or(open.chosen);
        if chosen != open.chosen {
            open.chosen = chosen;
            ring.open = Some(open);
            hands.pulse(open.side, Haptic::Tick);
        }
        return;
    }
    ring.open = None;
    // A press of cancel takes the choice back.
    let meant = open.chosen.filter(|_| !hand.held(Action::Cancel));
    if let Some(tool) = meant.and_then(|i| tools.all().get(i)) {
        // What a hand holds goes along.
        commands.write(if held.is_empty() {
            Command::Mode(tool.id.clone())
        } else {
            Command::Carry {
                objects: in_hands(&held),
                to: tool.id.clone(),
            }
        });
        hands.pulse(open.side, Haptic::Done);
    }
}
