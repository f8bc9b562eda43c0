//! What the command line offers; each command's work is in a file of its own.

mod bench;
mod check;
mod export;
mod import;
mod library;
mod play;
mod window;

use std::io::{self, Write};
use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::{Args, Parser, Subcommand, ValueEnum};
use midair_document::{Document, MeshStore};
use midair_studio::evaluate::Choice;

/// A studio for making 3D models with your hands in the air.
#[derive(Parser, Debug)]
#[command(version, about, args_conflicts_with_subcommands = true)]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    window: Window,
}

/// Without a command: the window, or the headset.
#[derive(Args, Debug)]
pub struct Window {
    /// A document (*.midair) or a mesh to open
    file: Option<PathBuf>,
    /// Use the headset (OpenXR, SteamVR)
    #[arg(long)]
    vr: bool,
    /// Where solids are made [default: as the settings say: the graphics card where there is a real one]
    #[arg(long)]
    backend: Option<Backend>,
    /// Record the hands to a session file
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Save a picture of the window after it has drawn the first solids, and quit
    #[arg(long, value_name = "FILE.png", hide = true)]
    shot: Option<PathBuf>,
    /// Take up unsaved work at once
    #[arg(long, hide = true)]
    resume: bool,
    /// Tell a test what stands, and do what it asks for, by files in a folder
    #[arg(long, value_name = "FOLDER", hide = true)]
    rehearse: Option<PathBuf>,
    /// How large that window is
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size, requires = "shot", hide = true)]
    size: Option<(u32, u32)>,
    /// A session of what is asked for before that picture: only its `Ask` steps
    #[arg(long, value_name = "SESSION", requires = "shot", hide = true)]
    play: Option<PathBuf>,
    /// Lose the graphics card after so many frames, to see that the window goes on
    #[arg(long, value_name = "FRAMES", hide = true)]
    lose_card: Option<u32>,
    /// When the graphics card was lost, in seconds since 1970, where that is why the app was started again
    #[arg(long, value_name = "SECONDS", hide = true)]
    card_lost: Option<u64>,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Run a session without a window
    Play(Play),
    /// Write a document's solids as a mesh file
    Export(Export),
    /// Bake meshes into your library
    Import(Import),
    /// List the components of the library
    Library {
        /// As JSON
        #[arg(long)]
        json: bool,
    },
    /// Time the papers' workloads on this machine
    Bench(Bench),
    /// Is this mesh watertight, manifold, consistently wound; is this document sound
    Check {
        /// Meshes (GLB, glTF, OBJ, STL, PLY) or documents (*.midair)
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// As JSON
        #[arg(long)]
        json: bool,
    },
}

/// `midair play`
#[derive(Args, Debug)]
pub struct Play {
    /// The session (RON)
    session: PathBuf,
    /// Refuse everything that hands could not do: document-level edits, any hand faster than 2 m/s
    #[arg(long)]
    hands_only: bool,
    /// Play at the pace of life: 90 frames a second, none waits for background work, live previews are made. What
    /// comes of it then depends on the machine
    #[arg(long)]
    paced: bool,
    /// Draw every frame, small, and report what that costs: extraction, and the render world's processor time
    #[arg(long, requires = "report")]
    drawn: bool,
    /// Where solids are made; the processor gives the same bytes every time
    #[arg(long, default_value = "cpu")]
    backend: Backend,
    /// Start from this document instead of an empty one
    #[arg(long, value_name = "FILE")]
    open: Option<PathBuf>,
    /// Save the document at the end
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// Write the visible solids at the end; may be given more than once
    #[arg(long, value_name = "FILE")]
    export: Vec<PathBuf>,
    /// Save a picture at the end
    #[arg(long, value_name = "FILE.png")]
    shot: Option<PathBuf>,
    /// That picture as two eyes of a headset see it, with hands and panels, side by side
    #[arg(long, requires = "shot", hide = true)]
    in_headset: bool,
    /// Pixels of that picture
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size, requires = "shot", conflicts_with = "in_headset", hide = true)]
    size: Option<(u32, u32)>,
    /// Write what happened as JSON
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
    /// Record the session as it is played, frame by frame
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// The grid step of the exports in metres [default: the document's own]
    #[arg(long, value_name = "METRES", value_parser = step)]
    step: Option<f32>,
    /// The axis that points up in the exports: y or z [default: z in STL and 3MF, y in the rest]
    #[arg(long, value_name = "AXIS")]
    up: Option<midair_mesh::Up>,
}

/// `midair export`
#[derive(Args, Debug)]
pub struct Export {
    /// The document
    file: PathBuf,
    /// Where to; the ending says the format: glb, gltf, obj, stl, ply, 3mf
    #[arg(long, value_name = "OUT")]
    to: PathBuf,
    /// The grid step in metres [default: the document's own]
    #[arg(long, value_name = "METRES", value_parser = step)]
    step: Option<f32>,
    /// The unit of the numbers in the file [default: mm for STL and 3MF, m for the rest]
    #[arg(long, value_name = "UNIT")]
    unit: Option<midair_mesh::Unit>,
    /// The axis that points up in the file: y or z [default: z in STL and 3MF, y in the rest]
    #[arg(long, value_name = "AXIS")]
    up: Option<midair_mesh::Up>,
}

/// `midair import`
#[derive(Args, Debug)]
pub struct Import {
    /// Meshes: GLB, glTF, OBJ, STL, PLY
    #[arg(required = true, value_name = "MESH")]
    meshes: Vec<PathBuf>,
    /// What the library calls it [default: the file's name]
    #[arg(long)]
    name: Option<String>,
}

/// `midair bench`
#[derive(Args, Debug)]
pub struct Bench {
    /// Which workloads: a name stands for all that begin with it [default: all]
    names: Vec<String>,
    /// Where the field is evaluated
    #[arg(long, default_value = "cpu")]
    backend: Backend,
    /// Write the figures as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Where the field is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// On the processor's cores
    Cpu,
    /// On the graphics card
    Gpu,
}

impl Backend {
    /// The same, not to be changed by a setting.
    fn forced(self) -> midair_studio::evaluate::Backend {
        midair_studio::evaluate::Backend::forced(match self {
            Self::Cpu => Choice::Processor,
            Self::Gpu => Choice::Card,
        })
    }
}

/// Steps from a tenth of a millimetre to a metre: smaller ones fill the memory, larger ones show nothing.
fn step(text: &str) -> Result<f32, String> {
    let step: f32 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (1e-4..=1.0).contains(&step) {
        Ok(step)
    } else {
        Err("a step lies between 0.0001 and 1 metre".to_owned())
    }
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let pair = text.split_once('x').and_then(|(w, h)| {
        let (w, h) = (w.parse::<u32>().ok()?, h.parse::<u32>().ok()?);
        (1..=8192).contains(&w.min(h)).then_some((w, h))
    });
    pair.filter(|p| p.0.max(p.1) <= 8192)
        .ok_or_else(|| "give width and height in pixels, as in 1280x720".to_owned())
}

/// Carries one command out.
///
/// # Errors
///
/// What the user asked cannot be done: one line that names the file, the reason and the way out.
pub fn run(cli: Cli) -> Result<()> {
    match cli.command {
        None => window::run(cli.window),
        Some(Command::Play(play)) => play::run(play),
        Some(Command::Export(export)) => export::run(export),
        Some(Command::Import(import)) => import::run(import),
        Some(Command::Library { json }) => library::run(json),
        Some(Command::Bench(bench)) => bench::run(bench),
        Some(Command::Check { files, json }) => check::run(&files, json),
    }
}

/// A line on standard output. A reader who has seen enough is no failure; a full disk is.
fn say(line: impl std::fmt::Display) -> Result<()> {
    match writeln!(io::stdout().lock(), "{line}") {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        outcome => outcome.context("standard output cannot be written"),
    }
}

/// Reads a document, or a mesh as a document of one object. Warnings go to standard error.
fn open(path: &std::path::Path) -> Result<(Document, MeshStore)> {
    let opened = midair_document::open(path)?;
    for warning in opened.warnings {
        eprintln!("midair: {warning}");
    }
    Ok((opened.document, opened.meshes))
}
