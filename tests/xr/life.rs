//! What a runtime, a headset and controllers can do to somebody at work.

use serde_json::json;
use std::fs;
use std::path::Path;
use std::process::{Command as Process, Stdio};

use anyhow::{Context, Result, bail};
use bevy::math::{Quat, Vec3};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::project::{Answer, Then};
use serde_json::Value;

use crate::perform::Performer;
use crate::room::{LIBRARY, WRIST, Wand};
use crate::stage::{App, Guard, Runtime, midair, until};

/// Waits until the controllers are the app's.
pub fn focus(app: &mut App) -> Result<f64> {
    let seconds = app.until("the headset shows Midair", |now| now["life"] == "Focused")?;
    let age = app.age();
    // Where the processor draws, the first frame waits for its shaders.
    app.until("frames are drawn", |now| {
        now["life"] == "Focused" && (0..2).any(|i| now["hands"][i]["profile"] != "")
    })?;
    app.focused = age;
    Ok(seconds)
}

/// A cube at the right hand, which then stands in its middle.
pub fn cube(performer: &mut Performer, app: &mut App, at: Vec3) -> Result<()> {
    performer.go(app, Side::Right, Pose::at(at))?;
    if !app.now["panels"].to_string().contains("\"library\"") {
        app.ask(&Command::ToggleLibrary)?;
    }
    let before = app.now["objects"].as_u64().unwrap_or(0);
    app.ask(&Command::Place {
        component: "solid/cube".to_owned(),
        side: Side::Right,
    })?;
    app.until("a cube is there", |now| {
        now["objects"] == before + 1 && now["busy"] == 0
    })?;
    Ok(())
}

/// Ends the app, whatever is not saved.
pub fn quit(app: &mut App) -> Result<()> {
    app.ask(&Command::Leave(Then::Quit))?;
    let asks = |now: &Value| now["panels"].to_string().contains("\"leave\"");
    if !app.ends_or(asks)? {
        app.ask(&Command::Answer(Answer::Discard))?;
        app.ends_or(|_| false)?;
    }
    Ok(())
}

fn says(now: &Value, part: &str) -> bool {
    now["warnings"].to_string().contains(part) || now["info"].to_string().contains(part)
}

/// The runtime is killed while a hand drags: the drag is kept or given up whole, undo works, the app goes on flat, and comes
/// back into the headset when the runtime does. Its recording plays.
pub fn killed(folder: &Path) -> Result<()> {
    let file = |name: &str| folder.join(name).display().to_string();
    let (record, saved) = (file("recorded.ron"), file("made.midair"));
    let runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    let mut app = App::start(folder, &["--vr", "--record", &record])?;
    focus(&mut app)?;
    let at = Vec3::new(0.1, 1.0, -0.3);
    cube(&mut performer, &mut app, at)?;
    performer.press(&mut app, Side::Right, Action::Grab, true)?;
    performer.go(&mut app, Side::Right, Pose::at(at + 0.1 * Vec3::X))?;
    app.until("the cube is dragged", |now| now["dragging"] == true)?;
    let before = app.now["edits"].as_u64().context("edits")?;
    runtime.kill()?;
    let gone = app.until("the app has noticed", |now| {
        now["life"] == "Lost" && now["dragging"] == false
    })?;
    let after = app.now["edits"].as_u64().context("edits")?;
    println!(
        "     noticed after {gone:.1} s; the drag was {}",
        if after > before { "kept" } else { "given up" }
    );
    if !says(&app.now, "Your work is kept") {
        bail!("it does not say what happened: {}", app.now);
    }
    // Flat, it goes on.
    app.ask(&Command::Undo)?;
    app.until("undo works", |now| now["redo"] == 1)?;
    app.ask(&Command::Redo)?;
    app.until("redo works", |now| now["redo"] == 0)?;
    let mut runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    let back = app.until("it is in the headset again", |now| now["life"] == "Focused")?;
    println!("     in the headset again {back:.1} s after the runtime was started again");
    let edits = app.now["edits"].as_u64().context("edits")?;
    cube(&mut performer, &mut app, at + 0.6 * Vec3::X)?;
    performer.press(&mut app, Side::Right, Action::Grab, true)?;
    performer.go(&mut app, Side::Right, Pose::at(at + 0.7 * Vec3::X))?;
    performer.press(&mut app, Side::Right, Action::Grab, false)?;
    app.until("the hands work again", |now| now["edits"] == edits + 2)?;
    app.ask(&Command::SaveAs(saved.clone().into()))?;
    app.until("it is saved", |now| {
        now["busy"] == 0 && fs::metadata(&saved).is_ok()
    })?;
    // An end that is asked for would be in the recording as well.
    app.kill(&record)?;
    if !runtime.is_alive() {
        bail!("the runtime died");
    }
    midair(&["export", &saved, "--to", &file("saved.stl")])?;
    midair(&["play", &record, "--export", &file("played.stl")])?;
    if fs::read(file("saved.stl"))? != fs::read(file("played.stl"))? {
        bail!("the recording makes another mesh");
    }
    midair(&["check", &file("played.stl"), &saved])?;
    Ok(())
}

/// Tracking is lost and found; a pose is none; a hand is frozen where it was, never at the origin.
pub fn tracking(folder: &Path) -> Result<()> {
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    let mut app = App::start(folder, &["--vr"])?;
    focus(&mut app)?;
    let there = Pose {
        position: Vec3::new(0.3, 1.2, -0.2),
        rotation: Quat::from_rotation_y(0.4),
    };
    performer.go(&mut app, Side::Right, there)?;
    performer.press(&mut app, Side::Right, Action::Grab, true)?;
    let pose = app.now["hands"][1]["pose"].clone();
    for lost in ["is off", "is nowhere"] {
        let hand = &mut performer.rig.hands[1];
        if lost == "is off" {
            hand.active = false;
        } else {
            hand.pose.position = Vec3::NAN;
        }
        performer.rig.send()?;
        app.until(&format!("a hand that {lost} is not tracked"), |now| {
            now["hands"][1]["tracked"] == false
        })?;
        if lost == "is nowhere" {
            app.until("it says that the place is none", |now| {
                says(now, "a place for the right controller that is none")
            })?;
        }
        if app.now["hands"][1]["pose"] != pose {
            bail!(
                "a hand that {lost} has moved to {}",
                app.now["hands"][1]["pose"]
            );
        }
        if app.now["hands"][0]["tracked"] != true {
            bail!("the other hand is lost as well");
        }
        performer.go(&mut app, Side::Right, there)?;
    }
    performer.press(&mut app, Side::Right, Action::Grab, false)?;
    quit(&mut app)
}

/// One controller alone does what the other one would; a hand that never was there is no trouble.
pub fn alone(folder: &Path) -> Result<()> {
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    performer.off(Side::Left)?;
    let mut app = App::start(folder, &["--vr"])?;
    focus(&mut app)?;
    app.until("it says that one controller is alone", |now| {
        says(now, "Only the right controller is on")
    })?;
    let right = &mut performer.rig.hands[1];
    right.b = true;
    performer.rig.send()?;
    performer.frames(&mut app, 3)?;
    performer.rig.hands[1].stick.x = -1.0;
    performer.rig.send()?;
    app.until("menu and left is undo", |now| {
        now["hands"][1]["down"] == json!(["Undo"])
    })?;
    performer.rig.hands[1].stick.x = 0.0;
    performer.rig.hands[1].trigger = 1.0;
    performer.rig.send()?;
    app.until("menu and trigger is the other hand's", |now| {
        now["hands"][0]["down"] == json!(["Act"]) && now["hands"][1]["down"] == json!([])
    })?;
    let right = &mut performer.rig.hands[1];
    (right.trigger, right.b) = (0.0, false);
    performer.rig.send()?;
    app.until("it was no press of the menu", |now| {
        now["hands"][0]["down"] == json!([]) && now["hands"][1]["down"] == json!([])
    })?;
    if app.now["panels"].to_string().contains("\"library\"") {
        bail!("the library was opened");
    }
    // What hangs on a wrist stands before the body of who has none to look at, and the only wand clicks it.
    app.say("boards")?;
    let mut wand = Wand { performer, app };
    wand.opened(WRIST)?;
    wand.click(WRIST, "Library")?;
    wand.opened(LIBRARY)?;
    let Wand {
        mut performer,
        mut app,
    } = wand;
    // The other one is switched on.
    performer.rig.hands[0].active = true;
    performer.rig.send()?;
    app.until("the other hand is there", |now| {
        now["hands"][0]["tracked"] == true
    })?;
    quit(&mut app)
}

/// Another window takes the controllers and gives them back; the person leaves the headset and goes back.
pub fn attention(folder: &Path) -> Result<()> {
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    let mut app = App::start(folder, &["--vr"])?;
    focus(&mut app)?;
    cube(&mut performer, &mut app, Vec3::new(0.1, 1.0, -0.3))?;
    performer.press(&mut app, Side::Right, Action::Grab, true)?;
    let other = Process::new("hello_xr")
        .args(["-g", "Vulkan2"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .context("hello_xr")?;
    let other = Guard(other);
    until("the other window is there", || {
        Ok(client("HelloXR")?.is_some())
    })?;
    take_focus("HelloXR")?;
    app.until("the controllers are another window's", |now| {
        now["life"] == "Shown" || now["life"] == "Asleep"
    })?;
    app.until("nothing is held", |now| {
        now["hands"][1]["down"] == json!([]) && now["dragging"] == false
    })?;
    drop(other);
    take_focus("Midair")?;
    performer.press(&mut app, Side::Right, Action::Grab, false)?;
    focus(&mut app)?;
    let undo = app.now["undo"].clone();
    for round in 0..2 {
        app.ask(&Command::Headset(false))?;
        app.until("the headset is left", |now| now["life"] == "Flat")?;
        if app.now["undo"] != undo {
            bail!("leaving changed the work: {}", app.now);
        }
        app.ask(&Command::Headset(true))?;
        let seconds = focus(&mut app)?;
        println!(
            "     back in the headset after {seconds:.1} s, round {}",
            round + 1
        );
        performer.settle(&mut app)?;
    }
    quit(&mut app)
}

/// The number that the runtime gives a program.
fn client(name: &str) -> Result<Option<String>> {
    let output = Process::new("monado-ctl").output().context("monado-ctl")?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned()
        + &String::from_utf8_lossy(&output.stderr);
    let line = text.lines().find(|l| l.contains(name));
    Ok(line.and_then(|l| {
        l.split_whitespace()
            .find(|w| w.chars().all(|c| c.is_ascii_digit()))
            .map(str::to_owned)
    }))
}

fn take_focus(name: &str) -> Result<()> {
    let id = client(name)?.with_context(|| format!("{name} is no client of the runtime"))?;
    for how in ["-f", "-p"] {
        Process::new("monado-ctl")
            .args([how, &id])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()
            .context("monado-ctl")?;
    }
    Ok(())
}

/// What is missing is one line with the way out, and status 1 where there is no flat screen either.
pub fn absent(folder: &Path) -> Result<()> {
    let run = |environment: &[(&str, &str)]| -> Result<String> {
        let output = Process::new(crate::stage::MIDAIR)
            .arg("--vr")
            .env("MIDAIR_HOME", folder.join("home"))
            .envs(environment.iter().copied())
            .stdin(Stdio::null())
            .output()?;
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let lines: Vec<_> = said.lines().filter(|l| l.starts_with("midair: ")).collect();
        if output.status.code() != Some(1) || lines.len() != 1 {
            bail!("status {} and {} lines: {said}", output.status, lines.len());
        }
        Ok(lines[0].to_owned())
    };
    // Nobody answers behind the runtime's manifest.
    let line = run(&[])?;
    if !line.contains("no OpenXR runtime answers") || !line.contains("openxr_monado.json") {
        bail!("no service: {line}");
    }
    println!("     {line}");
    let line = run(&[("XR_RUNTIME_JSON", "/nowhere.json")])?;
    if !line.contains("no OpenXR runtime answers") || !line.contains("/nowhere.json") {
        bail!("no manifest: {line}");
    }
    // A loader that is none, in place of the real one.
    let loader = "/usr/lib/x86_64-linux-gnu/libopenxr_loader.so.1";
    let at = fs::canonicalize(loader)?.display().to_string();
    let done = Process::new("mount")
        .args(["--bind", "/dev/null", &at])
        .status()?;
    if !done.success() {
        bail!("the loader could not be hidden");
    }
    let line = run(&[]);
    let _ = Process::new("umount").arg(&at).status();
    let line = line?;
    if !line.contains("loader was not found") || !line.contains("libopenxr-loader1") {
        bail!("no loader: {line}");
    }
    println!("     {line}");
    Ok(())
}

/// From a window: no runtime is one line and the flat screen; with one the app starts itself again in the headset, with the
/// work and its undo list.
pub fn from_flat(folder: &Path) -> Result<()> {
    let _display = crate::stage::display()?;
    let window = [("DISPLAY", ":7")];
    let mut app = App::start_with(folder, &["--vr"], &window)?;
    app.until("the flat screen, with a line", |now| {
        now["life"] == "None" && says(now, "No headset: no OpenXR runtime answers")
    })?;
    app.ask(&Command::ToggleLibrary)?;
    app.ask(&Command::Place {
        component: "solid/cube".to_owned(),
        side: Side::Right,
    })?;
    app.until("a cube is there", |now| {
        now["objects"] == 1 && now["undo"] == 1 && now["busy"] == 0
    })?;
    let before = app.now["warnings"].as_array().map_or(0, Vec::len);
    app.ask(&Command::Headset(true))?;
    app.until("it says that there is none", |now| {
        now["warnings"].as_array().map_or(0, Vec::len) == before + 1
    })?;
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    app.ask(&Command::Headset(true))?;
    app.counts_again();
    let seconds = focus(&mut app)?;
    println!("     in the headset {seconds:.1} s after it was asked for");
    app.until("the work is there, with its undo list", |now| {
        now["objects"] == 1 && now["undo"] == 1
    })?;
    performer.settle(&mut app)?;
    app.ask(&Command::Undo)?;
    app.until("undo works", |now| now["objects"] == 0)?;
    quit(&mut app)
}
