//! The frame's hands: freshly located, in metres of world.

use bevy::prelude::*;
use bevy_mod_openxr::resources::OxrFrameState;
use bevy_mod_openxr::session::OxrSession;
use midair_studio::hands::{ActionSet, HandFrame, HandsInput, Side};
use midair_studio::notice::Notices;
use midair_studio::settings::Settings;
use midair_studio::world::WorldView;

use super::bindings::Bindings;
use super::controllers::Controllers;
use super::one_hand::OneHand;
use super::read::{Input, tip};
use crate::frame::{Trouble, Turn};
use crate::session::Life;

/// Metres from where a controller aims from to the tip of its wand.
pub const WAND: f32 = 0.08;
/// Frames in which the hands of a headset that was laid aside let go, before the mouse has them.
const LETS_GO: u8 = 2;
/// Seconds for which a second controller may take its time.
const ALONE: f32 = 4.0;

/// What is remembered from frame to frame.
#[derive(Default)]
pub(super) struct Before {
    /// Frames to let go in.
    lets_go: u8,
    alone: OneHand,
    /// Seconds for which one controller has been on and the other has not.
    alone_for: f32,
    /// It was said.
    said: bool,
    /// A hand whose controller was on once.
    seen: [bool; 2],
    /// That its place made no sense was said of this hand.
    nowhere: [bool; 2],
}

/// What there is to read from, where a session runs.
type Session<'w> = (
    Option<ResMut<'w, Input>>,
    Option<Res<'w, OxrSession>>,
    Option<Res<'w, OxrFrameState>>,
    Res<'w, Turn>,
    Res<'w, Life>,
    Res<'w, Trouble>,
);

pub(super) fn gather(
    (input, session, state, turn, life, trouble): Session,
    (bindings, settings, view, time): (Res<Bindings>, Res<Settings>, Res<WorldView>, Res<Time>),
    mut hands: ResMut<HandsInput>,
    mut controllers: ResMut<Controllers>,
    mut notices: ResMut<Notices>,
    mut before: Local<Before>,
) {
    let before = &mut *before;
    let world = view.world_from_room();
    if !life.is_worn() {
        if before.lets_go > 0 {
            // Nothing that was held goes on with the mouse: first every button is up.
            before.lets_go -= 1;
            hands.frames = [HandFrame::default(); 2];
            controllers.lose();
        }
        return;
    }
    before.lets_go = LETS_GO;
    hands.metres_per_world = view.scale();
    // Hands are free: no screen says how near is near.
    hands.pixel = 0.0;
    let (Some(mut input), Some(session), Some(state)) = (input, session, state) else {
        hands.frames = [HandFrame::default(); 2];
        return;
    };
    let at = state.predicted_display_time;
    if turn.waited {
        hands.head = input.head(at, &trouble).map(|head| world.pose(&head));
    }
    if *life != Life::Focused {
        // Another window has the controllers.
        controllers.lose();
        hands.frames = [HandFrame::default(); 2];
        return;
    }
    let main = settings.hands.main();
    input.sync(&session, &bindings, main, &trouble);
    let mut down = [ActionSet::NONE; 2];
    for side in Side::BOTH {
        let i = side as usize;
        let read = input.hand(
            &session,
            side,
            main,
            at,
            &trouble,
            &mut controllers.hands[i],
        );
        if read.senseless && !std::mem::replace(&mut before.nowhere[i], true) {
            notices.warn(format!(
                "The runtime gives a place for the {} controller that is none. It stays where it was, and can be used again once its place \
                 is known. If that goes on, start the runtime anew.",
                which(side)
            ));
        }
        let aims = read.aim.filter(|_| read.tracked && read.active);
        before.seen[i] |= read.active;
        down[i] = read.down;
        *hands.side(side) = HandFrame {
            pose: aims.map(|aim| {
                let mut at = world.pose(&tip(&aim, settings.comfort.pointer_angle, WAND));
                at.rotation = at.rotation.normalize();
                at
            }),
            down: read.down,
            swipe: read.swipe,
        };
    }
    alone(before, &mut hands, down, time.delta_secs(), &mut notices);
}

fn which(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

/// A controller that stays the only one does what the other hand would, with its menu button held.
fn alone(
    before: &mut Before,
    hands: &mut HandsInput,
    down: [ActionSet; 2],
    dt: f32,
    notices: &mut Notices,
) {
    let only = match before.seen {
        [true, false] => Side::Left,
        [false, true] => Side::Right,
        _ => {
            before.alone_for = 0.0;
            return;
        }
    };
    before.alone_for += dt;
    if before.alone_for < ALONE {
        return;
    }
    if !std::mem::replace(&mut before.said, true) {
        let which = which(only);
        notices.info(format!(
            "Only the {which} controller is on. Hold its menu button and it does what the other hand would: trigger alt, \
             left undo, right redo, up save, down delete. Switch the other one on at any time."
        ));
    }
    let (mine, other) = before.alone.advance(down[only as usize], dt);
    hands.side(only).down = mine;
    hands.side(only.other()).down = other;
}
