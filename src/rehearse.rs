//! What a test is told, and what it may ask for: a conversation by two files in a folder.
//!
//! A test that drives real devices cannot count frames: it waits until what it did has arrived. `said.jsonl` gets a line of
//! JSON for each frame; `asks.ron` is read as it grows, a command a line, and asked for as a panel
//! would.

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::PathBuf;

use bevy::prelude::*;
use midair_openxr::Life;
use midair_openxr::input::Controllers;
use midair_playback::{Arrivals, Parts, PartsPlugin};
use midair_studio::StudioSet;
use midair_studio::command::Command;
use midair_studio::hands::{Hands, HandsInput, Side, WriteHands};
use midair_studio::notice::Notices;
use midair_studio::panel::Panels;
use midair_studio::project::{Project, Selection};
use midair_studio::show::Drafts;
use midair_studio::tools::Tools;
use serde::Serialize;

/// Talks to a test by files in a folder.
pub struct RehearsalPlugin(pub PathBuf);

impl Plugin for RehearsalPlugin {
    fn build(&self, app: &mut App) {
        let said = OpenOptions::new()
            .create(true)
            .append(true)
            .open(self.0.join("said.jsonl"));
        let Ok(said) = said else {
            eprintln!(
                "midair: {}: cannot be written to, so the test is told nothing",
                self.0.display()
            );
            return;
        };
        let asks = self.0.join("asks.ron");
        let heard = std::fs::metadata(&asks).map_or(0, |m| m.len());
        app.insert_resource(Talk {
            said,
            asks,
            // What was asked of the app before it started itself again is done.
            heard,
            rest: String::new(),
            asked: 0,
            frames: 0,
        })
        .init_resource::<Arrivals>()
        .add_plugins(PartsPlugin)
        .add_systems(Update, hear.in_set(StudioSet::Gather).before(WriteHands))
        .add_systems(First, count)
        .add_systems(Last, (tell, figures.run_if(on_message::<AppExit>)).chain());
    }
}

#[derive(Resource)]
struct Talk {
    said: File,
    asks: PathBuf,
    /// Bytes read so far.
    heard: u64,
    rest: String,
    /// Commands asked for so far.
    asked: usize,
    frames: u64,
}

/// What stands, as a test sees it.
#[derive(Serialize)]
struct Standing<'a> {
    life: String,
    mode: &'a str,
    objects: usize,
    edits: u64,
    undo: usize,
    redo: usize,
    selected: usize,
    /// Objects that a hand moves at the moment.
    dragging: bool,
    busy: usize,
    asked: usize,
    panels: Vec<&'a str>,
    warnings: &'a [String],
    info: Vec<&'a str>,
    hands: [HandSaid; 2],
}

/// One hand, as tools are given it.
#[derive(Serialize)]
struct HandSaid {
    profile: &'static str,
    tracked: bool,
    /// Position and quaternion.
    pose: [f32; 7],
    down: Vec<String>,
    swipe: Option<[f32; 2]>,
}

/// Only frames in the headset count.
fn count(life: Option<Res<Life>>, mut parts: ResMut<Parts>) {
    parts.count(life.is_some_and(|l| *l == Life::Focused));
}

/// Where the frames' time went.
fn figures(talk: Res<Talk>, parts: Res<Parts>) {
    if let Ok(text) = serde_json::to_string_pretty(&parts.figures()) {
        let _ = std::fs::write(talk.asks.with_file_name("parts.json"), text);
    }
}

fn hear(
    mut talk: ResMut<Talk>,
    mut commands: MessageWriter<Command>,
    mut notices: ResMut<Notices>,
) {
    let Ok(mut file) = File::open(&talk.asks) else {
        return;
    };
    let mut new = String::new();
    let from = talk.heard;
    if file.seek(SeekFrom::Start(from)).is_err() || file.read_to_string(&mut new).is_err() {
        return;
    }
    talk.heard += new.len() as u64;
    talk.rest.push_str(&new);
    while let Some(end) = talk.rest.find('\n') {
        let line: String = talk.rest.drain(..=end).collect();
        match ron::from_str::<Command>(line.trim()) {
            Ok(command) => {
                commands.write(command);
            }
            Err(fault) => notices.warn(format!("asks.ron: {}: {fault}", line.trim())),
        }
        talk.asked += 1;
    }
}

fn tell(world: &mut World) {
    let busy = world.resource_scope(|world, work: Mut<Arrivals>| {
        work.0.unfinished(world) + work.0.waiting(world)
    });
    let project = world.resource::<Project>();
    let tools = world.resource::<Tools>();
    let panels = world.resource::<Panels>();
    let notices = world.resource::<Notices>();
    let input = world.resource::<HandsInput>();
    let hands = world.resource::<Hands>();
    let controllers = world.get_resource::<Controllers>();
    let history = project.history();
    let hand = |side: Side| {
        let frame = &input.frames[side as usize];
        let pose = hands.get(side).pose;
        let [x, y, z] = pose.position.to_array();
        let [a, b, c, d] = pose.rotation.to_array();
        HandSaid {
            profile: controllers.map_or("", |c| c.side(side).profile),
            tracked: hands.get(side).tracked,
            pose: [x, y, z, a, b, c, d],
            down: frame.down.iter().map(|a| format!("{a:?}")).collect(),
            swipe: frame.swipe.map(|s| s.to_array()),
        }
    };
    let standing = Standing {
        life: world
            .get_resource::<Life>()
            .map_or("None".to_owned(), |life| format!("{life:?}")),
        mode: tools.active().map_or("", |t| t.id.as_str()),
        objects: project.document().objects().count(),
        edits: history.committed(),
        undo: history.undo_len(),
        redo: history.redo_len(),
        selected: world.resource::<Selection>().0.len(),
        dragging: !world.resource::<Drafts>().is_empty(),
        busy,
        asked: world.resource::<Talk>().asked,
        panels: panels
            .all()
            .iter()
            .filter(|p| panels.is_open(p.id))
            .map(|p| p.id)
            .collect(),
        warnings: notices.warnings(),
        info: notices.recent(1e9).map(|n| n.text.as_str()).collect(),
        hands: [hand(Side::Left), hand(Side::Right)],
    };
    let Ok(line) = serde_json::to_string(&standing) else {
        return;
    };
    let mut talk = world.resource_mut::<Talk>();
    talk.frames += 1;
    let frames = talk.frames;
    // A test that is gone needs to be told nothing.
    let _ = writeln!(talk.said, "{{\"frame\":{frames},{}", &line[1..]);
}
