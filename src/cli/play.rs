use std::fs::File;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use anyhow::{Context, Result};
use bevy::render::renderer::RenderDevice;
use midair_document::{may_save, save};
use midair_playback::{PlayOptions, PlayerPlugin, RecorderPlugin, Session, play};
use midair_solid::{ExportOptions, export, may_export};
use midair_studio::evaluate::Evaluations;
use midair_studio::materials::MaterialShelf;
use midair_studio::project::{Begin, Places, Project};

use super::{Play, open};
use crate::{Stage, app, drawn, probe, shot, wear};

pub(super) fn run(args: Play) -> Result<()> {
    let session = Session::load(&args.session)?;
    // What cannot be written is said before a long session is played for it.
    if let Some(file) = &args.save {
        may_save(file)?;
    }
    for file in &args.export {
        may_export(file)?;
    }
    for file in args.report.iter().chain(&args.shot) {
        may_write(file)?;
    }
    let opened = match &args.open {
        Some(file) => {
            let (document, meshes) = open(file)?;
            Some((document, meshes, file.clone()))
        }
        None => None,
    };
    let stage = if args.shot.is_some() || args.drawn {
        Stage::Picture
    } else {
        Stage::Bare
    };
    let begin = Begin {
        opened,
        journal: false,
    };
    let mut app = app(stage, Places::of_user()?, begin);
    app.world_mut().resource_mut::<Evaluations>().backend = args.backend.forced();
    app.add_plugins(PlayerPlugin);
    if args.in_headset {
        wear(&mut app);
    }
    if let Some(record) = &args.record {
        app.add_plugins(RecorderPlugin::create(record, session.title())?);
    }
    let options = PlayOptions {
        hands_only: args.hands_only,
        paced: args.paced,
        parts: args.report.is_some(),
        counted: args.report.is_some(),
        probe,
        ..PlayOptions::default()
    };
    let costs = args.drawn.then(|| drawn::draw_every_frame(&mut app));
    let mut report = play(&mut app, session, options)?;
    report.drawn = costs.map(|c| c.report());
    if args.drawn && app.world().get_resource::<RenderDevice>().is_none() {
        eprintln!(
            "midair: nothing was drawn: no graphics driver was found. Install Mesa's software one \
             (mesa-vulkan-drivers), or play without --drawn"
        );
    }
    for warning in &report.warnings {
        eprintln!("midair: {warning}");
    }
    let world = app.world();
    let project = world.resource::<Project>();
    if let Some(file) = &args.save {
        for warning in save(file, project.document(), project.meshes())? {
            eprintln!("midair: {warning}");
        }
    }
    let volumes = world.resource::<Evaluations>().volumes.clone();
    for file in &args.export {
        let options = ExportOptions {
            step: args.step,
            up: args.up,
            materials: world.resource::<MaterialShelf>().all().clone(),
            ..ExportOptions::default()
        };
        export(
            file,
            project.document(),
            project.meshes(),
            &*volumes,
            &options,
            &AtomicBool::new(false),
        )?;
    }
    if let Some(file) = &args.report {
        let text = serde_json::to_string_pretty(&report)?;
        std::fs::write(file, text + "\n")
            .with_context(|| format!("{} was not written", file.display()))?;
    }
    if let Some(file) = &args.shot {
        let seen_by = if args.in_headset {
            shot::SeenBy::Headset
        } else {
            let (width, height) = args.size.unwrap_or((1280, 720));
            shot::SeenBy::Camera(width, height)
        };
        shot::picture(&mut app, file, seen_by)?;
    }
    Ok(())
}

/// Whether a file could be written there; leaves nothing behind.
fn may_write(file: &Path) -> Result<()> {
    let there = file.exists();
    let opened = File::options()
        .write(true)
        .create(true)
        .truncate(false)
        .open(file);
    opened.with_context(|| format!("{} was not written", file.display()))?;
    if !there {
        // What was made only to see whether it can be.
        let _ = std::fs::remove_file(file);
    }
    Ok(())
}
