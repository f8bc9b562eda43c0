use std::path::Path;

use anyhow::{Result, bail};
use bevy::app::AppExit;
use midair_document::{Document, MeshStore, Object};
use midair_playback::{RecorderPlugin, Session, Step};
use midair_studio::command::Command;
use midair_studio::project::{Begin, Places};

use super::{Window, open};
use crate::{Stage, app, device, shot};

pub(super) fn run(args: Window) -> Result<()> {
    if args.vr {
        bail!(
            "this Midair has no headset support built in, so no headset can be used. \
             Start it without --vr for the flat screen"
        );
    }
    let places = Places::of_user()?;
    let opened = match &args.file {
        Some(file) => Some(begin(file, &places)?),
        None => None,
    };
    if !has_display() {
        bail!(
            "no display was found (neither DISPLAY nor WAYLAND_DISPLAY is set). Start Midair on a \
             desktop, or run a session without one: midair play assets/sessions/cup.ron --export cup.stl"
        );
    }
    say_when_nothing_draws();
    let mut app = app(
        Stage::Window,
        places,
        Begin {
            opened,
            journal: true,
        },
    );
    device::watch(&mut app);
    if let Some(frames) = args.lose_card {
        device::lose_after(&mut app, frames);
    }
    if let Some(record) = args.record {
        app.add_plugins(RecorderPlugin::create(&record, "Recorded live")?);
    }
    if let Some(file) = args.shot {
        let asks = match &args.play {
            Some(session) => asks(&Session::load(session)?)?,
            None => Vec::new(),
        };
        shot::window(&mut app, file, args.size, asks);
    }
    match app.run() {
        AppExit::Success => Ok(()),
        AppExit::Error(code) => bail!("the window ended with status {code}"),
    }
}

/// The engine panics, on a thread of its own, where nothing can draw: one line instead.
fn say_when_nothing_draws() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let said = panic.payload_as_str().unwrap_or_default();
        if said.starts_with("Unable to find a GPU")
            || said.starts_with("Failed to create wgpu surface")
        {
            eprintln!(
                "midair: no graphics card was found that can draw a window. Install its Vulkan driver \
                 (mesa-vulkan-drivers has one that needs no card), or run a session without a window: \
                 midair play assets/sessions/cup.ron --export cup.stl"
            );
            std::process::exit(1);
        }
        usual(panic);
    }));
}

/// What a session asks for. In a window the hands are those of whoever sits there.
fn asks(session: &Session) -> Result<Vec<Command>> {
    let ask = |(i, step): (usize, &Step)| match step {
        Step::Ask(command) => Ok(command.clone()),
        _ => bail!(
            "{}: before a picture of the window only Ask steps are played",
            session.place(i)
        ),
    };
    session.steps().iter().enumerate().map(ask).collect()
}

#[cfg(target_os = "linux")]
fn has_display() -> bool {
    ["DISPLAY", "WAYLAND_DISPLAY"]
        .iter()
        .any(|v| std::env::var_os(v).is_some_and(|d| !d.is_empty()))
}

#[cfg(not(target_os = "linux"))]
fn has_display() -> bool {
    true
}

/// A document, or a mesh in an otherwise empty one.
fn begin(file: &Path, places: &Places) -> Result<(Document, MeshStore, std::path::PathBuf)> {
    if file.extension().is_some_and(|e| e == "midair") {
        let (document, meshes) = open(file)?;
        return Ok((document, meshes, file.to_owned()));
    }
    let component = midair_library::import(
        &places.library,
        file,
        None,
        &midair_field::bake::Progress::new(),
    )?;
    let mut history = midair_document::History::new(Document::new(), MeshStore::new());
    history.add(Object::solid(component.name.clone(), component.placed()))?;
    let shelf = midair_library::MeshShelf::new(places.library.meshes());
    for hash in history.document().meshes() {
        if let Some(mesh) = shelf.mesh(&hash) {
            history.meshes().insert(mesh);
        }
    }
    let document = history.document().clone();
    let store = history.meshes().clone();
    Ok((document, store, file.with_extension("midair")))
}
