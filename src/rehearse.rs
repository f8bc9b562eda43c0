//! What a test is told, and what it may ask for: a conversation by two files in a folder.
//!
//! A test that drives real devices cannot count frames: it waits until what it did has arrived. `said.jsonl` gets a line of
//! JSON for each frame; `asks.ron` is read as it grows, a command a line, and asked for as a panel
//! would. Four lines are for the test alone: `boards` has the panels of the room told from then on, with the place of each word;
//! `eyes FILE.png` takes a picture of what both eyes see in the headset, and `window FILE.png` of the window on the desktop;
//! `parts FILE.json` writes where the time of the frames went since the line before.

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use midair_openxr::Life;
use midair_openxr::input::Controllers;
use midair_playback::{Arrivals, Counted, Parts, PartsPlugin};
use midair_space::boards::Board;
use midair_space::{Boards, Wands};
use midair_studio::StudioSet;
use midair_studio::command::Command;
use midair_studio::hands::{ActionSet, Hands, HandsInput, Side, WriteHands};
use midair_studio::help::Tutorial;
use midair_studio::notice::Notices;
use midair_studio::panel::Panels;
use midair_studio::project::{Project, Selection};
use midair_studio::settings::{Lesson, Settings};
use midair_studio::show::Drafts;
use midair_studio::tools::Tools;
use midair_studio::world::WorldView;
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
            boards: false,
        })
        .init_resource::<Arrivals>()
        .init_resource::<EyesSeen>()
        .add_plugins(PartsPlugin)
        .add_systems(Update, hear.in_set(StudioSet::Gather).before(WriteHands))
        .add_systems(First, count)
        .add_systems(Last, tell.after(Counted));
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
    /// Whether boards are told.
    boards: bool,
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
    /// The step of the tutorial that is shown; empty where none is.
    lesson: &'a str,
    warnings: &'a [String],
    info: Vec<&'a str>,
    hands: [HandSaid; 2],
    /// Only where they were asked for.
    boards: Vec<BoardSaid>,
    /// Pictures of both eyes that are written.
    eyes: usize,
    /// How often panels were laid out, and the milliseconds of it.
    laid_out: (u64, f64),
}

/// One panel of the room, in metres of world.
#[derive(Serialize)]
struct BoardSaid {
    id: String,
    shown: bool,
    /// Its middle, and which way it faces.
    at: [f32; 3],
    front: [f32; 3],
    /// What is written on it, and where.
    texts: Vec<(String, [f32; 3])>,
}

/// One hand, as tools are given it.
#[derive(Serialize)]
struct HandSaid {
    profile: &'static str,
    tracked: bool,
    /// Position and quaternion.
    pose: [f32; 7],
    down: Vec<String>,
    /// What a panel has of what is pressed.
    captured: Vec<String>,
    swipe: Option<[f32; 2]>,
    /// The panel that the wand is on.
    on: String,
}

/// Only frames in the headset count.
fn count(life: Option<Res<Life>>, mut parts: ResMut<Parts>) {
    parts.count(life.is_some_and(|l| *l == Life::Focused));
}

/// Where the frames' time went.
fn figures(parts: &Parts, file: &Path) {
    if let Ok(text) = serde_json::to_string_pretty(&(parts.figures(), parts.systems())) {
        let _ = std::fs::write(file, text);
    }
}

fn hear(
    mut talk: ResMut<Talk>,
    mut asks: MessageWriter<Command>,
    mut notices: ResMut<Notices>,
    (mut seen, mut parts): (ResMut<EyesSeen>, ResMut<Parts>),
    mut commands: Commands,
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
        let line = line.trim();
        if line == "boards" {
            talk.boards = true;
        } else if let Some(file) = line.strip_prefix("eyes ") {
            seen.look(file.into(), &mut commands);
        } else if let Some(file) = line.strip_prefix("window ") {
            seen.look_at_window(file.into(), &mut commands);
        } else if let Some(file) = line.strip_prefix("parts ") {
            figures(&parts, Path::new(file));
            parts.restart();
        } else {
            match ron::from_str::<Command>(line) {
                Ok(command) => {
                    asks.write(command);
                }
                Err(fault) => notices.warn(format!("asks.ron: {line}: {fault}")),
            }
        }
        talk.asked += 1;
    }
}

/// The panels of the room, as a wand would find them.
fn boards(world: &World) -> Vec<BoardSaid> {
    let (Some(boards), Some(view)) = (
        world.get_resource::<Boards>(),
        world.get_resource::<WorldView>(),
    ) else {
        return Vec::new();
    };
    let out = view.world_from_room();
    let said = |board: &Board| BoardSaid {
        id: format!("{:?}", board.id),
        shown: board.shown,
        at: out.point(board.pose.position).to_array(),
        front: (out.rotation * board.pose.rotation * Vec3::Z).to_array(),
        texts: board
            .texts()
            .into_iter()
            .map(|(text, at)| (text, out.point(board.at(at)).to_array()))
            .collect(),
    };
    boards.all().map(said).collect()
}

/// Pictures of what the eyes see.
#[derive(Resource, Default)]
struct EyesSeen {
    written: usize,
    halves: [Option<Image>; 2],
}

impl EyesSeen {
    /// Both eyes of one frame, as they are handed to the runtime, side by side.
    fn look(&mut self, file: PathBuf, commands: &mut Commands) {
        self.halves = default();
        for eye in 0..2 {
            let file = file.clone();
            commands
                .spawn(Screenshot::texture_view(midair_openxr::eye(eye)))
                .observe(
                    move |shot: On<ScreenshotCaptured>, mut seen: ResMut<EyesSeen>| {
                        seen.halves[eye as usize] = Some(shot.image.clone());
                        let [Some(left), Some(right)] = &seen.halves else {
                            return;
                        };
                        match side_by_side(left, right, &file) {
                            Ok(()) => seen.written += 1,
                            Err(fault) => eprintln!("midair: {}: {fault}", file.display()),
                        }
                    },
                );
        }
    }
}

impl EyesSeen {
    /// What the window on the desktop shows.
    fn look_at_window(&mut self, file: PathBuf, commands: &mut Commands) {
        commands.spawn(Screenshot::primary_window()).observe(
            move |shot: On<ScreenshotCaptured>, mut seen: ResMut<EyesSeen>| {
                let written = shot.image.clone().try_into_dynamic();
                let written = written
                    .map_err(anyhow::Error::from)
                    .and_then(|image| Ok(image.to_rgb8().save(&file)?));
                match written {
                    Ok(()) => seen.written += 1,
                    Err(fault) => eprintln!("midair: {}: {fault}", file.display()),
                }
            },
        );
    }
}

fn side_by_side(left: &Image, right: &Image, file: &Path) -> anyhow::Result<()> {
    let [left, right] = [left, right].map(|i| i.clone().try_into_dynamic());
    let (left, right) = (left?.to_rgb8(), right?.to_rgb8());
    let mut both = image::RgbImage::new(left.width() + right.width(), left.height());
    image::imageops::replace(&mut both, &left, 0, 0);
    image::imageops::replace(&mut both, &right, i64::from(left.width()), 0);
    Ok(both.save(file)?)
}

/// Where the tutorial is.
fn lesson(world: &World) -> &str {
    let progress = world.resource::<Settings>().help.tutorial;
    let tutorial = world.get_resource::<Tutorial>();
    tutorial
        .filter(|_| progress.state == Lesson::Going)
        .and_then(|t| t.name(progress.step))
        .unwrap_or_default()
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
    let wands = world.get_resource::<Wands>();
    let named = |down: ActionSet| down.iter().map(|a| format!("{a:?}")).collect();
    let hand = |side: Side| {
        let frame = &input.frames[side as usize];
        let pose = hands.get(side).pose;
        let [x, y, z] = pose.position.to_array();
        let [a, b, c, d] = pose.rotation.to_array();
        HandSaid {
            profile: controllers.map_or("", |c| c.side(side).profile),
            tracked: hands.get(side).tracked,
            pose: [x, y, z, a, b, c, d],
            down: named(frame.down),
            captured: wands.map_or_else(Vec::new, |w| named(w.get(side).captured())),
            swipe: frame.swipe.map(|s| s.to_array()),
            on: wands
                .and_then(|w| w.get(side).met)
                .map_or_else(String::new, |met| format!("{:?}", met.board)),
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
        lesson: lesson(world),
        warnings: notices.warnings(),
        info: notices.recent(1e9).map(|n| n.text.as_str()).collect(),
        hands: [hand(Side::Left), hand(Side::Right)],
        boards: if world.resource::<Talk>().boards {
            boards(world)
        } else {
            Vec::new()
        },
        eyes: world.resource::<EyesSeen>().written,
        laid_out: world.get_resource::<Boards>().map_or((0, 0.0), |b| {
            let (times, took) = b.laid_out();
            (times, took.as_secs_f64() * 1e3)
        }),
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
