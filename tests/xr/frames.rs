//! Where a frame's time goes in the headset, with the chair open and hands that move: without panels, and with some open and a wand
//! on one. Shown, not judged: a machine that draws with its processor has less of it for the rest.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use bevy::math::{Quat, Vec3};
use midair_studio::command::Command;
use midair_studio::hands::{Pose, Side};
use serde_json::Value;

use crate::life::{focus, quit};
use crate::perform::Performer;
use crate::stage::{App, Runtime, midair};

/// Frames that are looked at.
const FRAMES: u16 = 120;

/// The chair, both hands around it, tables of the schedule's own time.
pub fn chair(folder: &Path) -> Result<()> {
    let chair = folder.join("chair.midair").display().to_string();
    midair(&["play", "/job/assets/sessions/chair.ron", "--save", &chair])?;
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    let mut app = App::start(folder, &["--vr", &chair])?;
    focus(&mut app)?;
    println!(
        "     from the command to the first frame in focus: {:.2} s",
        app.focused
    );
    panel(&mut app, "tutorial", false)?;
    app.until("the chair is drawn", |now| now["busy"] == 0)?;
    let around = |t: f32, x: f32| Pose {
        position: Vec3::new(x + 0.15 * t.sin(), 0.5 + 0.2 * t.cos(), 0.1),
        rotation: Quat::from_rotation_y(0.3 * t.sin()),
    };
    table(folder, "no panel", &mut performer, &mut app, |t| {
        [around(t, -0.2), around(t, 0.2)]
    })?;
    for id in ["library", "outline", "settings"] {
        panel(&mut app, id, true)?;
    }
    // Pictures of shapes are made once.
    performer.frames(&mut app, 60)?;
    // The left hand shows its wrist, the right one's wand wanders over what is before the eyes.
    table(folder, "four panels", &mut performer, &mut app, |t| {
        let wand = Pose {
            position: Vec3::new(0.1, 1.3, 0.3),
            rotation: Quat::from_rotation_y(0.4 * (0.7 * t).sin())
                * Quat::from_rotation_x(0.35 + 0.2 * t.cos()),
        };
        [Pose::at(Vec3::new(-0.22, 1.15, 0.2)), wand]
    })?;
    quit(&mut app)
}

fn panel(app: &mut App, id: &str, open: bool) -> Result<()> {
    app.ask(&Command::Panel {
        id: id.to_owned(),
        open,
    })
}

/// Moves the hands for a while, and shows where the time of those frames went.
fn table(
    folder: &Path,
    what: &str,
    performer: &mut Performer,
    app: &mut App,
    hands: impl Fn(f32) -> [Pose; 2],
) -> Result<()> {
    let path = folder.join("parts.json");
    let shown = path.display();
    performer.frames(app, 10)?;
    app.say(&format!("parts {shown}"))?;
    let laid = |now: &Value| {
        let number = |i: usize| now["laid_out"][i].as_f64().unwrap_or(0.0);
        (number(0), number(1))
    };
    let (begin, before) = (Instant::now(), laid(&app.now));
    for frame in 0..FRAMES {
        let both = hands(0.05 * f32::from(frame));
        for side in Side::BOTH {
            performer.rig.hands[side as usize].pose = both[side as usize];
        }
        performer.rig.send()?;
        performer.frames(app, 1)?;
    }
    let took = begin.elapsed().as_secs_f64();
    app.say(&format!("parts {shown}"))?;
    // The whole frame, then its parts by name.
    let ((main, parts), systems): ((Value, BTreeMap<String, Value>), Vec<Value>) =
        serde_json::from_str(&fs::read_to_string(&path).context("parts.json")?)?;
    let figure = |part: &Value, name: &str| part[name].as_f64().unwrap_or(f64::NAN);
    let whole: f64 = parts.values().map(|p| figure(p, "median")).sum();
    if parts.is_empty() || whole == 0.0 {
        bail!("no frame in the headset was counted: {main}");
    }
    println!(
        "     {what}, ms of a frame  median   share     99 %   ({:.0} frames a second)",
        f64::from(FRAMES) / took
    );
    for (name, part) in &parts {
        let median = figure(part, "median");
        println!(
            "     {name:<20} {median:>7.3}  {:>5.1} %  {:>7.3}",
            100.0 * median / whole,
            figure(part, "p99")
        );
    }
    println!(
        "     the schedule itself  {:>7.3}           {:>7.3}",
        figure(&main, "median"),
        figure(&main, "p99")
    );
    for system in systems.iter().take(40) {
        println!(
            "     {:>8.1} us a frame, {:>5.2} runs, {} {}",
            1e3 * figure(system, "total_ms") / figure(&main, "count"),
            figure(system, "runs") / figure(&main, "count"),
            system["schedule"].as_str().unwrap_or_default(),
            system["name"].as_str().unwrap_or_default(),
        );
    }
    if !systems.is_empty() {
        let all: f64 = systems.iter().map(|s| figure(s, "total_ms")).sum();
        println!(
            "     {:.2} ms a frame in {} systems",
            all / figure(&main, "count"),
            systems.len()
        );
    }
    let after = laid(&app.now);
    let (times, ms) = (after.0 - before.0, after.1 - before.1);
    println!(
        "     panels laid out {:.2} times a frame, {:.2} ms each",
        times / f64::from(FRAMES),
        ms / times.max(1.0)
    );
    Ok(())
}
