use std::path::Path;

use anyhow::{Context, Result, bail};
use bevy::app::AppExit;
use bevy::prelude::{PostStartup, ResMut};
use midair_document::{Document, MeshStore, Object};
use midair_openxr::{Headset, Life};
use midair_playback::{RecorderPlugin, Session, Step};
use midair_studio::command::Command;
use midair_studio::evaluate::{self, Choice, Evaluations};
use midair_studio::notice::Notices;
use midair_studio::project::{Begin, Places};

use super::{Window, open};
use crate::{
    Again, RehearsalPlugin, ResumePlugin, Stage, SwitchPlugin, app, device, headset_app, shot,
    start_again,
};

pub(super) fn run(args: Window) -> Result<()> {
    let places = Places::of_user()?;
    let opened = match &args.file {
        Some(file) => Some(begin(file, &places)?),
        None => None,
    };
    let headset = args.vr.then(Headset::open);
    if !has_display() && !matches!(headset, Some(Ok(_))) {
        if let Some(Err(fault)) = &headset {
            bail!("no headset: {fault}. There is no display for the flat screen either");
        }
        bail!(
            "no display was found (neither DISPLAY nor WAYLAND_DISPLAY is set). Start Midair on a \
             desktop, or run a session without one: midair play assets/sessions/cup.ron --export cup.stl"
        );
    }
    say_when_nothing_draws();
    let start = Begin {
        opened,
        journal: true,
    };
    let mut app = match headset {
        Some(Ok(headset)) => headset_app(headset, has_display(), places, start),
        // Without a headset the work goes on flat, and the reason is said where it is seen.
        Some(Err(fault)) => {
            let mut app = app(Stage::Window, places, start);
            let line = format!("No headset: {fault}.");
            eprintln!("midair: {line}");
            app.world_mut().resource_mut::<Notices>().warn(line);
            app
        }
        None => app(Stage::Window, places, start),
    };
    let asked = args.backend;
    let backend = move || match asked {
        Some(backend) => backend.forced(),
        None => evaluate::Backend::following(Choice::Auto),
    };
    app.world_mut().resource_mut::<Evaluations>().backend = backend();
    if app.world().contains_resource::<Life>() {
        // A headset's runtime works on the drawing device's queue, which nobody else may use meanwhile: the card that
        // makes has a device of its own there, and what it made comes by main memory.
        app.add_systems(PostStartup, move |mut evaluations: ResMut<Evaluations>| {
            evaluations.backend = backend();
        });
    }
    let kept = match &args.rehearse {
        Some(folder) => vec!["--rehearse".into(), folder.into()],
        None => Vec::new(),
    };
    let again = Again::keeping(kept.clone());
    if !app.world().contains_resource::<Life>() {
        app.add_plugins(SwitchPlugin(again.clone()));
    }
    if args.resume {
        app.add_plugins(ResumePlugin);
    }
    if let Some(folder) = args.rehearse {
        app.add_plugins(RehearsalPlugin(folder));
    }
    let mut after_a_loss = kept;
    if args.vr {
        after_a_loss.push("--vr".into());
    }
    device::watch(&mut app, after_a_loss, args.card_lost);
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
    let ended = app.run();
    drop(app);
    if let Some(arguments) = again.take() {
        return start_again(&arguments)
            .context("Midair was not started again for the headset; start it with --vr");
    }
    match ended {
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
        if device::is_loss(said) {
            device::lost();
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
