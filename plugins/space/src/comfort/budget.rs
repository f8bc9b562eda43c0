//! How long a frame's work takes, against the ninety that a headset wants in a second.

use std::time::{Duration, Instant};

use bevy::prelude::*;
use midair_studio::hands::Side;
use midair_studio::settings::Settings;

use crate::boards::WRIST;
use crate::labels::{Label, LabelKey, Labels, Weight};
use crate::room::Stance;

/// Milliseconds of a frame at 90 Hz.
const BUDGET: f32 = 1e3 / 90.0;
/// Seconds between two figures: what changes faster cannot be read.
const READ: f32 = 0.5;

/// The time of frames: of the schedule's own work, and from one to the next.
#[derive(Resource, Debug, Default)]
pub(crate) struct Pace {
    began: Option<Instant>,
    work: Duration,
    worst: Duration,
    frames: u32,
    since: f32,
    /// Mean and worst milliseconds of work, and frames a second.
    shown: [f32; 3],
}

pub(crate) fn begin(mut pace: ResMut<Pace>) {
    pace.began = Some(Instant::now());
}

pub(crate) fn end(time: Res<Time<Real>>, mut pace: ResMut<Pace>) {
    let Some(began) = pace.began.take() else {
        return;
    };
    let took = began.elapsed();
    pace.work += took;
    pace.worst = pace.worst.max(took);
    pace.frames += 1;
    pace.since += time.delta_secs();
    if pace.since >= READ {
        let frames = pace.frames as f32;
        pace.shown = [
            pace.work.as_secs_f32() * 1e3 / frames,
            pace.worst.as_secs_f32() * 1e3,
            frames / pace.since,
        ];
        (pace.work, pace.worst) = (Duration::ZERO, Duration::ZERO);
        (pace.frames, pace.since) = (0, 0.0);
    }
}

pub(crate) fn tell(
    (pace, settings, stance): (Res<Pace>, Res<Settings>, Res<Stance>),
    mut labels: ResMut<Labels>,
) {
    if !settings.comfort.budget {
        return;
    }
    let [mean, worst, rate] = pace.shown;
    let off = settings.hands.off();
    let outwards = match off {
        Side::Left => -1.0,
        Side::Right => 1.0,
    };
    let late = if worst > BUDGET {
        Weight::Warning
    } else {
        Weight::Plain
    };
    labels.say(Label {
        key: LabelKey::Budget,
        // Over the panel on the wrist, which it would cover before it.
        at: stance.hand(off).position + Vec3::new(WRIST.x * outwards, WRIST.y + 0.235, WRIST.z),
        text: format!("{mean:.1} ms of {BUDGET:.1} (most {worst:.1})   {rate:.0} Hz"),
        weight: late,
        ..Label::default()
    });
}
