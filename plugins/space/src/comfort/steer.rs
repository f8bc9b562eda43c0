//! A grip on nothing and a push of the stick: left and right turn the world in steps, and where one hand moves it, up
//! and down scale it.

use bevy::prelude::*;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Hands, HandsInput, Haptic, Pose, Side};
use midair_studio::pick::Touch;
use midair_studio::settings::Settings;
use midair_studio::show::Drafts;
use midair_studio::world::{RANGE, WorldAsk, WorldView};

use crate::room::Stance;

/// How far a stick is pushed to turn, and let back to turn again.
const PUSHED: [f32; 2] = [0.75, 0.4];
/// How much larger in a second, as a power of two.
const GROWS: f32 = 1.2;

/// Which hands hold nothing fast.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct Grips {
    empty: [bool; 2],
    pushed: [bool; 2],
}

pub(crate) fn steer(
    (settings, stance, time): (Res<Settings>, Res<Stance>, Res<Time>),
    (touch, drafts, view): (Res<Touch>, Res<Drafts>, Res<WorldView>),
    mut input: ResMut<HandsInput>,
    mut hands: ResMut<Hands>,
    mut grips: ResMut<Grips>,
    mut commands: MessageWriter<Command>,
) {
    let held = Side::BOTH.map(|s| input.frames[s as usize].down.has(Action::Grab));
    let world_from_room = view.world_from_room();
    let about = |pose: Pose| world_from_room.point(pose.position);
    for side in Side::BOTH {
        let i = side as usize;
        if !held[i] {
            grips.empty[i] = false;
            grips.pushed[i] = false;
            continue;
        }
        if !hands.get(side).held(Action::Grab) {
            grips.empty[i] = touch.get(side).is_none() && drafts.is_empty();
        }
        // With both hands the hands themselves turn and scale it.
        if !grips.empty[i] || !drafts.is_empty() || held[side.other() as usize] {
            continue;
        }
        let frame = input.side(side);
        let Some(swipe) = frame.swipe else {
            grips.pushed[i] = false;
            continue;
        };
        // The tool sees no stick, and no cross, while a grip on nothing is held.
        frame.swipe = None;
        for arm in [Action::Up, Action::Right, Action::Down, Action::Left] {
            frame.down.set(arm, false);
        }
        let step = settings.comfort.snap_turn.clamp(0.0, 180.0);
        let least = PUSHED[usize::from(grips.pushed[i])];
        let pushes = swipe.x.abs() > least && swipe.x.abs() > swipe.y.abs();
        if pushes && !grips.pushed[i] && step > 0.0 {
            commands.write(Command::World(WorldAsk::Turn {
                // To look to the right, the world goes to the left.
                degrees: step * swipe.x.signum(),
                about: about(stance.head),
            }));
            hands.pulse(side, Haptic::Tick);
        }
        grips.pushed[i] = pushes;
        if settings.world.one_handed && swipe.y.abs() > PUSHED[1] && !pushes {
            let factor = view.scale() * (GROWS * swipe.y * time.delta_secs()).exp2();
            if RANGE.contains(&factor) {
                commands.write(Command::World(WorldAsk::Scale {
                    factor,
                    about: about(stance.hand(side)),
                }));
            }
        }
    }
}
