//! What hands feel: short when something snaps, longer when something is done, twice as rough when it cannot be.

use bevy::prelude::*;
use bevy_mod_openxr::session::OxrSession;
use midair_studio::hands::{Hands, Haptic};
use midair_studio::settings::Settings;
use openxr::{Duration, HapticVibration};

use crate::frame::Trouble;
use crate::input::Input;
use crate::session::Life;

/// Amplitude, milliseconds and hertz.
fn felt(pulse: Haptic) -> (f32, i64, f32) {
    match pulse {
        Haptic::Tick => (0.4, 12, 220.0),
        Haptic::Done => (0.7, 60, 160.0),
        Haptic::Refused => (1.0, 140, 60.0),
    }
}

/// Hands the pulses of this frame to the controllers.
pub(crate) fn pulse(
    life: Res<Life>,
    input: Option<Res<Input>>,
    session: Option<Res<OxrSession>>,
    settings: Res<Settings>,
    trouble: Res<Trouble>,
    mut hands: ResMut<Hands>,
) {
    if !life.is_worn() || hands.haptics.is_empty() {
        return;
    }
    let pulses = std::mem::take(&mut hands.bypass_change_detection().haptics);
    let (Some(input), Some(session)) = (input, session) else {
        return;
    };
    let strength = settings.comfort.haptics.clamp(0.0, 1.0);
    if strength <= 0.0 {
        return;
    }
    for (side, pulse) in pulses {
        let (amplitude, milliseconds, frequency) = felt(pulse);
        let pulse = HapticVibration::new()
            .amplitude(amplitude * strength)
            .duration(Duration::from_nanos(milliseconds * 1_000_000))
            .frequency(frequency);
        if let Err(code) = input.pulse(&session, settings.hands.main(), side, &pulse) {
            trouble.note("xrApplyHapticFeedback", code);
        }
    }
}
