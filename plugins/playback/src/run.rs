use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use bevy::{app::PluginsState, prelude::*};
use midair_studio::notice::Notices;

use crate::parts::{Parts, PartsPlugin, cpu_seconds};
use crate::{
    FrameTimes, HandsOnlyFault, Next, Place, Player, Report, Session, check_hands_only, prepare,
};

/// How a session is played.
#[derive(Clone, Copy, Debug)]
pub struct PlayOptions {
    /// Whether what hands cannot do is refused.
    pub hands_only: bool,
    /// How long background work may keep one frame waiting.
    pub patience: Duration,
    /// Whether frames come as in life: at the session's own pace, and none waits for background work.
    /// What came of it then depends on the machine.
    pub paced: bool,
    /// Whether the report tells where a frame's time went.
    pub parts: bool,
    /// Whether the report tells at the end what there is, which takes a surface of each solid; checks on the way look
    /// anyway.
    pub counted: bool,
    /// Tells what there is: objects, lines, strokes, edits, undo, redo, updates. The rest of the
    /// report is filled in here.
    pub probe: fn(&mut World) -> Report,
}

impl Default for PlayOptions {
    fn default() -> Self {
        Self {
            hands_only: false,
            patience: Duration::from_secs(120),
            paced: false,
            parts: false,
            counted: true,
            probe: |_| Report::default(),
        }
    }
}

/// Why a session was not played to its end.
#[derive(Debug, thiserror::Error)]
pub enum PlayError {
    /// Refused by `--hands-only`.
    #[error(transparent)]
    HandsOnly(#[from] HandsOnlyFault),
    /// An [`crate::Step::Expect`] that does not hold.
    #[error("{at}: {what}")]
    Expected {
        /// The step.
        at: Place,
        /// What is instead.
        what: String,
    },
    /// A recording that no longer happens as it was recorded.
    #[error(
        "{at}: in frame {frame} the recording took in a result that nobody asked for now: Midair \
         or the document has changed since; without `recorded: true` it plays without its timing"
    )]
    Diverged {
        /// The step.
        at: Place,
        /// The frame, counted from 0.
        frame: u64,
    },
    /// Background work that does not come to an end.
    #[error(
        "{at}: {jobs} pieces of background work are still not done at frame {frame} after waiting \
         {patience:?}"
    )]
    Stuck {
        /// The step.
        at: Place,
        /// The frame, counted from 0.
        frame: u64,
        /// How many.
        jobs: usize,
        /// How long was waited.
        patience: Duration,
    },
    /// The app asked to exit.
    #[error("{at}: the app ended before the session did")]
    Exited {
        /// The step.
        at: Place,
    },
}

/// Plays the whole of `session` in `app`, which has the [`crate::PlayerPlugin`] and no other way
/// in, as fast as the machine can; time is the session's. The app is as the session left it
/// afterwards, for export or a picture, also where an error came first.
///
/// Ends always: a session has at most [`crate::MAX_FRAMES`] frames and each waits for background
/// work at most `options.patience`.
pub fn play(app: &mut App, session: Session, options: PlayOptions) -> Result<Report, PlayError> {
    let session = Arc::new(session);
    if options.hands_only {
        check_hands_only(&session)?;
    }
    if options.parts {
        app.add_plugins(PartsPlugin);
    }
    ready(app);
    app.insert_resource(Player::new(session.clone(), &options));
    let mut frame_ms = Vec::new();
    let before = cpu_seconds();
    let outcome = drive(app, &session, options.paced, &mut frame_ms);
    let cpu = cpu_seconds().zip(before).map(|(now, then)| now - then);
    let player = app.world_mut().remove_resource::<Player>();
    outcome?;
    let mut report = if options.counted {
        (options.probe)(app.world_mut())
    } else {
        Report::default()
    };
    report.title = session.title().to_owned();
    report.frames = player.as_ref().map_or(0, Player::frames);
    report.seconds = player.map_or(0.0, |p| p.time().as_secs_f64());
    report.steps = session.steps().len();
    report.frame_ms = FrameTimes::of(frame_ms);
    report.cpu_seconds = cpu;
    if let Some(parts) = app.world_mut().remove_resource::<Parts>() {
        (report.main_ms, report.parts_ms) = parts.figures();
        report.systems = parts.systems();
    }
    report.warnings = app
        .world()
        .get_resource::<Notices>()
        .map_or_else(Vec::new, |n| n.warnings().to_vec());
    if session.is_truncated() {
        report.warnings.push(format!(
            "{}: the recording ends in the middle; it was played up to there",
            session.file()
        ));
    }
    Ok(report)
}

fn drive(
    app: &mut App,
    session: &Session,
    paced: bool,
    frame_ms: &mut Vec<f32>,
) -> Result<(), PlayError> {
    let mut step = 0;
    while prepare(app.world_mut())? == Next::Frame {
        let played = app
            .world()
            .get_resource::<Player>()
            .and_then(Player::current);
        let counts = played.is_some();
        let lasts = played.map_or_else(|| session.dt(), |b| b.dt);
        step = played.map_or(step, |b| b.step);
        if let Some(mut parts) = app.world_mut().get_resource_mut::<Parts>() {
            parts.count(counts);
        }
        let since = Instant::now();
        app.update();
        if counts {
            frame_ms.push(since.elapsed().as_secs_f32() * 1e3);
        }
        if paced {
            std::thread::sleep(lasts.saturating_sub(since.elapsed()));
        }
        if app.should_exit().is_some() {
            return Err(PlayError::Exited {
                at: session.place(step),
            });
        }
    }
    Ok(())
}

/// What a runner does before the first frame.
fn ready(app: &mut App) {
    while app.plugins_state() == PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    if app.plugins_state() == PluginsState::Ready {
        app.finish();
        app.cleanup();
    }
}
