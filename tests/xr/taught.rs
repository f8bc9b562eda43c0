//! The tutorial, followed in the headset by what its panel says: with the wand, and with the buttons that it names.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use bevy::math::{Quat, Vec3};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use serde_json::Value;

use crate::life::focus;
use crate::perform::Performer;
use crate::room::{LIBRARY, TUTORIAL, Wand};
use crate::stage::{App, Runtime, midair};

/// Where the cube is put, and the sphere at a corner of it; and a point of each that is not in the other.
const CUBE: Vec3 = Vec3::new(0.30, 0.75, -0.45);
const SPHERE: Vec3 = Vec3::new(0.47, 0.92, -0.33);
const OF_CUBE: Vec3 = Vec3::new(0.20, 0.65, -0.53);
const OF_SPHERE: Vec3 = Vec3::new(0.57, 1.00, -0.26);
/// Nothing is there.
const AIR: Vec3 = Vec3::new(0.15, 1.35, 0.15);

/// The first task whole: a cube and a sphere, united, intersected, subtracted. Then the rest is put off, the work is saved
/// from the wrist, and its recording exports the same bytes.
pub fn taught(folder: &Path) -> Result<()> {
    let file = |name: &str| folder.join(name).display().to_string();
    let (record, saved) = (file("recorded.ron"), file("made.midair"));
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    performer.rig.head = Pose {
        position: Vec3::new(0.0, 1.6, 0.5),
        rotation: Quat::from_rotation_x(-0.35),
    };
    performer.rig.send()?;
    let mut app = App::start(folder, &["--vr", "--record", &record])?;
    focus(&mut app)?;
    app.say("boards")?;
    performer.go(&mut app, Side::Left, Pose::at(Vec3::new(-0.22, 1.15, 0.1)))?;
    performer.go(&mut app, Side::Right, Pose::at(AIR))?;
    let mut wand = Wand { performer, app };
    wand.opened(TUTORIAL)?;
    wand.click(TUTORIAL, "Show me")?;

    let mut done = Vec::new();
    loop {
        let (app, before) = (&mut wand.app, done.last().cloned());
        app.until("the next step is shown", |now| {
            now["lesson"] != "" && before.as_deref() != now["lesson"].as_str()
        })?;
        let step = app.now["lesson"].as_str().context("lesson")?.to_owned();
        // The chair is the next task.
        if step == "clear" {
            break;
        }
        let says = text(&mut wand)?;
        println!("     {step}: {says}");
        for key in ["no key", "mouse", "Click", "pad's"] {
            if says.contains(key) {
                bail!("{step}: \"{says}\" is not for these controllers");
            }
        }
        obey(&mut wand, &step).with_context(|| step.clone())?;
        done.push(step);
    }
    // Nothing was skipped but what only a mouse needs.
    if done.len() != 13 {
        bail!("these steps were done: {done:?}");
    }
    wand.click(TUTORIAL, "Later")?;
    wand.app.until("the tutorial waits", |now| {
        !now["panels"].to_string().contains("\"tutorial\"")
    })?;
    let Wand { mut app, .. } = wand;
    app.until("the work is done", |now| now["busy"] == 0)?;
    app.ask(&Command::SaveAs(saved.clone().into()))?;
    app.until("it is saved", |now| {
        now["busy"] == 0 && fs::metadata(&saved).is_ok()
    })?;
    app.kill(&record)?;
    midair(&["export", &saved, "--to", &file("saved.stl")])?;
    midair(&["play", &record, "--export", &file("played.stl")])?;
    if fs::read(file("saved.stl"))? != fs::read(file("played.stl"))? {
        bail!("the recording, played without a headset, makes another mesh");
    }
    midair(&["check", &file("played.stl"), &saved])?;
    println!("     the recording exports the same bytes; no fault");
    Ok(())
}

/// What the tutorial's panel says to do.
fn text(wand: &mut Wand) -> Result<String> {
    wand.performer.frames(&mut wand.app, 3)?;
    let all = wand.app.now["boards"]
        .as_array()
        .and_then(|all| all.iter().find(|b| b["id"] == TUTORIAL))
        .context("the tutorial's panel")?;
    let texts = all["texts"].as_array().into_iter().flatten();
    let texts = texts.filter_map(|t| t[0].as_str());
    let longest = texts
        .filter(|t| !t.contains(" of 3:"))
        .max_by_key(|t| t.len());
    Ok(longest.unwrap_or_default().to_owned())
}

/// What a step says, by hands.
fn obey(wand: &mut Wand, step: &str) -> Result<()> {
    match step {
        "library" => {
            tap(wand, Side::Right, Action::Menu)?;
            wand.opened(LIBRARY)
        }
        "cube" => place(wand, "Cube", 1, CUBE),
        "sphere" => place(wand, "Sphere", 2, Vec3::new(-0.35, 0.80, -0.45)),
        "meet" => drag(wand, Vec3::new(-0.35, 0.80, -0.45), SPHERE),
        "unite-cube" => {
            go(wand, AIR)?;
            tap(wand, Side::Right, Action::Up)?;
            mark(wand, OF_CUBE, Action::Up)
        }
        "unite-sphere" => mark(wand, OF_SPHERE, Action::Up),
        "intersect-sphere" | "subtract-sphere" => {
            go(wand, AIR)?;
            tap(wand, Side::Right, Action::Up)?;
            let arm = if step == "subtract-sphere" {
                Action::Down
            } else {
                Action::Right
            };
            mark(wand, OF_SPHERE, arm)
        }
        "unite" | "intersect" | "subtract" => {
            tap(wand, Side::Right, Action::Finish)?;
            busy(wand)
        }
        "undo" | "undo-again" => {
            tap(wand, Side::Left, Action::Undo)?;
            busy(wand)
        }
        other => bail!("nobody here knows the step {other}"),
    }
}

fn busy(wand: &mut Wand) -> Result<()> {
    wand.app
        .until("nothing is under way", |now: &Value| now["busy"] == 0)?;
    Ok(())
}

fn go(wand: &mut Wand, at: Vec3) -> Result<()> {
    let Wand { performer, app } = wand;
    performer.go(app, Side::Right, Pose::at(at))?;
    // What lies at the hand is found in the frame after it is there.
    performer.frames(app, 2)
}

fn tap(wand: &mut Wand, side: Side, action: Action) -> Result<()> {
    let Wand { performer, app } = wand;
    performer.press(app, side, action, true)?;
    performer.press(app, side, action, false)?;
    performer.frames(app, 3)
}

fn mark(wand: &mut Wand, at: Vec3, arm: Action) -> Result<()> {
    go(wand, at)?;
    tap(wand, Side::Right, arm)
}

/// A shape is clicked on its shelf, is in the hand then, and is put where it is to be.
fn place(wand: &mut Wand, name: &str, count: u64, to: Vec3) -> Result<()> {
    wand.click(LIBRARY, name)?;
    wand.app.until("it is there", |now| {
        now["objects"] == count && now["busy"] == 0 && now["hands"][1]["on"] == ""
    })?;
    take(wand, to)
}

fn drag(wand: &mut Wand, from: Vec3, to: Vec3) -> Result<()> {
    go(wand, from)?;
    take(wand, to)
}

/// What is at the right hand is taken and put somewhere else.
fn take(wand: &mut Wand, to: Vec3) -> Result<()> {
    let Wand { performer, app } = wand;
    performer.press(app, Side::Right, Action::Grab, true)?;
    app.until("it is held", |now| now["dragging"] == true)?;
    performer.go(app, Side::Right, Pose::at(to))?;
    performer.frames(app, 2)?;
    performer.press(app, Side::Right, Action::Grab, false)?;
    app.until("it is let go", |now| {
        now["dragging"] == false && now["busy"] == 0
    })?;
    Ok(())
}
