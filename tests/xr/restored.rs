//! Work that a crash left behind, taken back by the wand.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use bevy::math::{Quat, Vec3};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};

use crate::life::{cube, focus};
use crate::perform::Performer;
use crate::room::{WRIST, Wand};
use crate::stage::{App, Runtime, midair};

/// The app is killed with work that is not in a file. Started again in the headset it says so, a click on the wrist brings
/// the work back with its undo list, and more is done with it. Both recordings make the same bytes, one after the other.
pub fn restored(folder: &Path) -> Result<()> {
    let file = |name: &str| folder.join(name).display().to_string();
    let (first, second, saved) = (file("before.ron"), file("after.ron"), file("made.midair"));
    let _runtime = Runtime::remote()?;
    let mut performer = looking()?;
    let mut app = App::start(folder, &["--vr", "--record", &first])?;
    focus(&mut app)?;
    let at = Vec3::new(0.1, 1.0, -0.3);
    cube(&mut performer, &mut app, at)?;
    carry(&mut performer, &mut app, at, at + 0.15 * Vec3::X)?;
    let edits = app.now["edits"].clone();
    if app.now["undo"] != 2 {
        bail!("a cube was placed and moved: {}", app.now);
    }
    app.kill(&first)?;

    // Hands and head are where they were: devices know nothing of programs.
    let mut app = App::start(folder, &["--vr", "--record", &second])?;
    focus(&mut app)?;
    app.until("it says that work was left behind", |now| {
        now["info"].to_string().contains("Restore it")
    })?;
    if app.now["objects"] != 0 {
        bail!("it does not begin empty: {}", app.now);
    }
    app.say("boards")?;
    performer.go(&mut app, Side::Left, Pose::at(Vec3::new(-0.22, 1.15, 0.1)))?;
    let mut wand = Wand { performer, app };
    wand.opened(WRIST)?;
    wand.click(WRIST, "Restore it")?;
    wand.app
        .until("the work is back, its undo list included", |now| {
            now["objects"] == 1 && now["undo"] == 2 && now["busy"] == 0
        })?;
    println!("     back with {edits} edits and their undo list");
    wand.click(WRIST, "Undo")?;
    wand.app.until("undo works", |now| now["redo"] == 1)?;
    wand.click(WRIST, "Redo")?;
    wand.app.until("redo works", |now| now["redo"] == 0)?;
    let Wand {
        mut performer,
        mut app,
    } = wand;
    let at = at + 0.15 * Vec3::X;
    carry(&mut performer, &mut app, at, at + 0.1 * Vec3::Y)?;
    cube(&mut performer, &mut app, at + 0.6 * Vec3::NEG_X)?;
    app.ask(&Command::SaveAs(saved.clone().into()))?;
    app.until("it is saved", |now| {
        now["busy"] == 0 && fs::metadata(&saved).is_ok()
    })?;
    app.kill(&second)?;

    // What a run took back is opened where its recording is played.
    let left = file("left.midair");
    midair(&["play", &first, "--save", &left])?;
    midair(&["export", &saved, "--to", &file("saved.stl")])?;
    midair(&[
        "play",
        &second,
        "--open",
        &left,
        "--export",
        &file("played.stl"),
    ])?;
    if fs::read(file("saved.stl"))? != fs::read(file("played.stl"))? {
        bail!("the recordings make another mesh");
    }
    midair(&["check", &saved])?;
    println!("     both recordings, one after the other, export the same bytes");
    Ok(())
}

/// Somebody who stands before the work and looks at it.
fn looking() -> Result<Performer> {
    let mut performer = Performer::new()?;
    performer.rig.head = Pose {
        position: Vec3::new(0.0, 1.6, 0.5),
        rotation: Quat::from_rotation_x(-0.35),
    };
    performer.rig.send()?;
    Ok(performer)
}

/// The right hand takes what is at `from` to `to`.
fn carry(performer: &mut Performer, app: &mut App, from: Vec3, to: Vec3) -> Result<()> {
    let edits = app.now["edits"].as_u64().context("edits")?;
    performer.go(app, Side::Right, Pose::at(from))?;
    performer.frames(app, 2)?;
    performer.press(app, Side::Right, Action::Grab, true)?;
    performer.go(app, Side::Right, Pose::at(to))?;
    performer.press(app, Side::Right, Action::Grab, false)?;
    app.until("it was carried", |now| {
        now["edits"] == edits + 1 && now["dragging"] == false && now["busy"] == 0
    })?;
    Ok(())
}
