use std::{path::Path, sync::Mutex};

use bevy::{ecs::message::MessageCursor, prelude::*};
use midair_studio::{
    StudioSet,
    command::Command,
    hands::{AdvanceHands, HandsInput},
    notice::Notices,
    settings::Settings,
};

use crate::{Arrivals, Frame, Player, RecordError, Recording};

/// The recording of the app that the [`RecorderPlugin`] was added to.
#[derive(Resource)]
pub struct Recorder {
    /// The file it goes to.
    pub recording: Recording,
    /// The frame that is being recorded, and what was asked for in it.
    now: Option<(Frame, Vec<Command>)>,
    seen: MessageCursor<Command>,
    /// What makes the usual settings into those at the start.
    settings: Vec<Command>,
    said: bool,
}

/// Records every frame of the app it is added to.
///
/// What panels, shortcuts and ways in ask for is recorded; what tools ask for between
/// [`StudioSet::Ask`] and [`StudioSet::Cue`] is not, for it follows from the hands.
pub struct RecorderPlugin(Mutex<Option<Recording>>);

impl RecorderPlugin {
    /// Begins a recording in `path`, which is overwritten.
    pub fn create(path: &Path, title: &str) -> Result<Self, RecordError> {
        let recording = Recording::create(path, title)?;
        Ok(Self(Mutex::new(Some(recording))))
    }
}

impl Plugin for RecorderPlugin {
    fn build(&self, app: &mut App) {
        let recording = match self.0.lock() {
            Ok(mut slot) => slot.take(),
            Err(poisoned) => poisoned.into_inner().take(),
        };
        let Some(recording) = recording else { return };
        app.insert_resource(Recorder {
            recording,
            now: None,
            seen: MessageCursor::default(),
            settings: Vec::new(),
            said: false,
        })
        .init_resource::<Arrivals>()
        .add_systems(
            PostStartup,
            // An app without settings has none to write down.
            |settings: Option<Res<Settings>>, mut recorder: ResMut<Recorder>| {
                recorder.settings = settings.map_or_else(Vec::new, |s| s.shaping());
            },
        )
        .add_message::<Command>()
        .add_systems(
            Update,
            (
                gather
                    .in_set(StudioSet::Gather)
                    // All ways in have written by then.
                    .after(AdvanceHands),
                // What was written since follows from the hands.
                skip.after(StudioSet::Cue),
            ),
        )
        // Last: what the frame took in is known.
        .add_systems(Last, keep);
    }
}

fn gather(
    mut recorder: ResMut<Recorder>,
    input: Res<HandsInput>,
    time: Res<Time>,
    asked: Res<Messages<Command>>,
) {
    let recorder = &mut *recorder;
    let asked = recorder.seen.read(&asked).cloned();
    // A session begins with the usual settings: what a person has set otherwise comes first.
    let first = std::mem::take(&mut recorder.settings);
    let commands = first.into_iter().chain(asked).collect();
    let frame = Frame {
        dt: time.delta(),
        input: *input,
    };
    recorder.now = Some((frame, commands));
}

fn skip(mut recorder: ResMut<Recorder>, asked: Res<Messages<Command>>) {
    recorder.seen.clear(&asked);
}

fn keep(world: &mut World) {
    let ready = world.resource_scope(|world, work: Mut<Arrivals>| work.0.delivered(world));
    // Frames in which a player only waits are not part of its session.
    let plays = world
        .get_resource::<Player>()
        .is_none_or(|p| p.current().is_some());
    let exits = world
        .get_resource::<Messages<AppExit>>()
        .is_some_and(|m| !m.is_empty());
    let mut recorder = world.resource_mut::<Recorder>();
    if let Some((frame, asked)) = recorder.now.take()
        && plays
    {
        recorder.recording.push(&frame, &asked, &ready);
    }
    if !exits && recorder.recording.is_open() || recorder.said {
        return;
    }
    recorder.said = true;
    if let Err(e) = recorder.recording.finish() {
        let line = e.to_string();
        match world.get_resource_mut::<Notices>() {
            Some(mut notices) => notices.warn(line),
            None => warn!("{line}"),
        }
    }
}
