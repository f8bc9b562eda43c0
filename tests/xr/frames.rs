//! Where a frame's time goes in the headset, with the chair open and hands that move. Shown, not judged: a machine that
//! draws with its processor has less of it for the rest.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use bevy::math::{Quat, Vec3};
use midair_studio::hands::{Pose, Side};
use serde_json::Value;

use crate::life::{focus, quit};
use crate::perform::Performer;
use crate::stage::{App, Runtime, midair};

/// The chair, both hands around it, a table of the schedule's own time.
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
    app.until("the chair is drawn", |now| now["busy"] == 0)?;
    let begin = Instant::now();
    while begin.elapsed() < Duration::from_secs(6) {
        let t = begin.elapsed().as_secs_f32();
        for (side, x) in [(Side::Left, -0.2), (Side::Right, 0.2)] {
            let around = Vec3::new(x + 0.15 * t.sin(), 0.5 + 0.2 * t.cos(), 0.1);
            performer.rig.hands[side as usize].pose = Pose {
                position: around,
                rotation: Quat::from_rotation_y(0.3 * t.sin()),
            };
        }
        performer.rig.send()?;
        std::thread::sleep(Duration::from_millis(11));
    }
    quit(&mut app)?;
    let path = folder.join("talk/parts.json");
    // The whole frame, then its parts by name.
    let (main, parts): (Value, BTreeMap<String, Value>) =
        serde_json::from_str(&fs::read_to_string(&path).context("parts.json")?)?;
    let figure = |part: &Value, name: &str| part[name].as_f64().unwrap_or(f64::NAN);
    let whole: f64 = parts.values().map(|p| figure(p, "median")).sum();
    if parts.is_empty() || whole == 0.0 {
        bail!("no frame in the headset was counted: {main}");
    }
    println!("     ms of a frame         median   share     99 %");
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
    Ok(())
}
