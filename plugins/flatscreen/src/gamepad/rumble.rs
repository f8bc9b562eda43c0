//! What hands feel, the gamepad shakes: short on a snap, longer when something is done.

use std::time::Duration;

use bevy::input::gamepad::{GamepadRumbleIntensity, GamepadRumbleRequest};
use bevy::prelude::*;
use midair_studio::hands::{Hands, Haptic};

use crate::bindings::Controls;

use super::Pad;

pub(crate) fn rumble(
    pad: Res<Pad>,
    controls: Res<Controls>,
    mut hands: ResMut<Hands>,
    mut requests: MessageWriter<GamepadRumbleRequest>,
) {
    if hands.haptics.is_empty() {
        return;
    }
    let pulses = std::mem::take(&mut hands.bypass_change_detection().haptics);
    let Some(gamepad) = controls.pad().filter(|_| pad.leads()) else {
        return;
    };
    for (_, pulse) in pulses {
        let (weak, strong, milliseconds) = match pulse {
            Haptic::Tick => (0.35, 0.0, 30),
            Haptic::Done => (0.5, 0.3, 120),
            Haptic::Refused => (0.0, 0.8, 220),
        };
        requests.write(GamepadRumbleRequest::Add {
            duration: Duration::from_millis(milliseconds),
            intensity: GamepadRumbleIntensity {
                weak_motor: weak,
                strong_motor: strong,
            },
            gamepad,
        });
    }
}
