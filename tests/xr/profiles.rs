//! Every controller's table, and every action of those that the runtime can be.

use serde_json::json;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use bevy::math::Vec2;
use midair_studio::hands::{Action, Side};

use crate::life::{focus, quit};
use crate::perform::Performer;
use crate::stage::{App, Runtime};
use crate::wire::Controller;

/// What the runtime is to accept. The two of extensions are offered by it as well.
const TABLES: [&str; 8] = [
    "htc/vive_controller",
    "valve/index_controller",
    "oculus/touch_controller",
    "microsoft/motion_controller",
    "hp/mixed_reality_controller",
    "bytedance/pico4_controller",
    "bytedance/pico_neo3_controller",
    "khr/simple_controller",
];

type Press = fn(&mut Controller);

/// What is pressed, on which hand, and what arrives.
const INDEX: [(Side, Press, Action); 14] = [
    (Side::Right, |c| c.trigger = 1.0, Action::Act),
    (Side::Left, |c| c.trigger = 1.0, Action::Act),
    (Side::Right, |c| c.squeeze = 1.0, Action::Grab),
    (Side::Left, |c| c.squeeze = 1.0, Action::Grab),
    (Side::Right, |c| c.a = true, Action::Finish),
    (Side::Right, |c| c.b = true, Action::Menu),
    (Side::Left, |c| c.a = true, Action::Undo),
    (Side::Left, |c| c.b = true, Action::Redo),
    (Side::Left, |c| c.stick_click = true, Action::Centre),
    (Side::Right, |c| c.stick_click = true, Action::Centre),
    (Side::Right, |c| c.stick = Vec2::Y, Action::Up),
    (Side::Right, |c| c.stick = Vec2::X, Action::Right),
    (Side::Left, |c| c.stick = Vec2::NEG_Y, Action::Down),
    (Side::Left, |c| c.stick = Vec2::NEG_X, Action::Left),
];

/// Every table is accepted; every action arrives from Index controllers.
pub fn index(folder: &Path) -> Result<()> {
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    let mut app = App::start(folder, &["--vr"])?;
    focus(&mut app)?;
    let log = app.log();
    for table in TABLES {
        if !log.contains(&format!("{table}: ")) {
            println!("     {table}: this runtime does not offer it");
            if !table.starts_with("bytedance/") && !table.starts_with("hp/") {
                bail!("the runtime was not given the table of {table}");
            }
        }
    }
    for line in log.lines().filter(|l| l.contains("bindings accepted")) {
        println!(
            "     {}",
            line.rsplit_once("bindings: ").map_or(line, |l| l.1)
        );
    }
    if log.contains("refused the buttons") {
        bail!("the runtime refused a table:\n{log}");
    }
    every(&mut performer, &mut app, "valve/index_controller")?;
    // The trackpad, as far as it goes with the off hand's save.
    arrives(
        &mut performer,
        &mut app,
        Side::Left,
        |c| c.pad_force = 1.0,
        Action::Save,
    )?;
    let right = &mut performer.rig.hands[1];
    (right.pad_touch, right.pad) = (true, Vec2::new(0.5, -0.25));
    performer.rig.send()?;
    app.until("a swipe arrives", |now| {
        let at = |i: usize| now["hands"][1]["swipe"][i].as_f64().unwrap_or(9.0);
        (at(0) - 0.5).abs() < 0.02 && (at(1) + 0.25).abs() < 0.02
    })?;
    quit(&mut app)
}

/// Every action arrives from Touch controllers, which the runtime makes of the others.
pub fn touch(folder: &Path) -> Result<()> {
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    let mut app = App::start_with(
        folder,
        &["--vr"],
        &[("MIDAIR_XR_ONLY", "oculus/touch_controller")],
    )?;
    focus(&mut app)?;
    every(&mut performer, &mut app, "oculus/touch_controller")?;
    // The stick is the swipe too.
    performer.rig.hands[0].stick = Vec2::new(0.4, 0.0);
    performer.rig.send()?;
    app.until("a swipe arrives", |now| {
        (now["hands"][0]["swipe"][0].as_f64().unwrap_or(9.0) - 0.4).abs() < 0.02
    })?;
    performer.rig.hands[0].stick = Vec2::ZERO;
    performer.rig.hands[0].system = true;
    performer.rig.send()?;
    performer.frames(&mut app, 10)?;
    if app.now["hands"][0]["down"] != json!(["Save"]) {
        println!("     this driver has no menu button: save is not shown under Touch");
    }
    quit(&mut app)
}

/// Windows Mixed Reality, as far as the runtime's simulated driver goes: poses, and the table in force.
pub fn wmr(folder: &Path) -> Result<()> {
    let _runtime = Runtime::simulated("wmr")?;
    let mut app = App::start(folder, &["--vr"])?;
    focus(&mut app)?;
    app.until("both controllers are motion controllers", |now| {
        Side::BOTH.iter().all(|&s| {
            let hand = &now["hands"][s as usize];
            hand["profile"] == "microsoft/motion_controller" && hand["tracked"] == true
        })
    })?;
    quit(&mut app)
}

/// A person's own table takes its lines' place; a mistake in it costs one line and is said.
pub fn own(folder: &Path) -> Result<()> {
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    for home in ["home/config", "home"] {
        let config = folder.join(home);
        fs::create_dir_all(&config)?;
        fs::write(
            config.join("headset.ron"),
            "{\n  \"valve/index_controller\": (\n    finish: [\"main b/click\"],\n    menu: [\"main x/click\"],\n  ),\n}\n",
        )?;
    }
    let mut app = App::start(folder, &["--vr"])?;
    focus(&mut app)?;
    app.until("the mistake is said", |now| {
        let said = now["warnings"].to_string();
        said.contains("headset.ron, line 4") && said.contains("x/click")
    })?;
    // What is pressed together arrives together.
    arrives(
        &mut performer,
        &mut app,
        Side::Right,
        |c| (c.a, c.trigger) = (true, 1.0),
        Action::Act,
    )
    .context("the usual button finishes no more")?;
    performer.rig.send()?;
    arrives_among(
        &mut performer,
        &mut app,
        Side::Right,
        |c| c.b = true,
        Action::Finish,
    )?;
    quit(&mut app)
}

fn every(performer: &mut Performer, app: &mut App, profile: &str) -> Result<()> {
    app.until(&format!("both controllers are {profile}"), |now| {
        Side::BOTH
            .iter()
            .all(|&s| now["hands"][s as usize]["profile"] == profile)
    })?;
    for (side, press, action) in INDEX {
        arrives(performer, app, side, press, action)?;
    }
    println!("     {} actions arrive under {profile}", INDEX.len());
    Ok(())
}

/// One press arrives as one action, and is gone when it is let go.
fn arrives(
    performer: &mut Performer,
    app: &mut App,
    side: Side,
    press: Press,
    action: Action,
) -> Result<()> {
    let rest = performer.rig.hands[side as usize];
    press(&mut performer.rig.hands[side as usize]);
    performer.rig.send()?;
    app.until(&format!("{side:?} {action:?}"), |now| {
        now["hands"][side as usize]["down"] == json!([format!("{action:?}")])
    })?;
    performer.rig.hands[side as usize] = rest;
    performer.rig.send()?;
    app.until(&format!("{side:?} {action:?} is let go"), |now| {
        now["hands"][side as usize]["down"] == json!([])
    })?;
    Ok(())
}

/// The same, whatever else the button does.
fn arrives_among(
    performer: &mut Performer,
    app: &mut App,
    side: Side,
    press: Press,
    action: Action,
) -> Result<()> {
    press(&mut performer.rig.hands[side as usize]);
    performer.rig.send()?;
    app.until(&format!("{side:?} {action:?}"), |now| {
        now["hands"][side as usize]["down"]
            .to_string()
            .contains(&format!("\"{action:?}\""))
    })?;
    Ok(())
}
