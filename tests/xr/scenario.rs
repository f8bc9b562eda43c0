//! Scenarios from files: a session that is performed, and what has to come of it.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use midair_studio::command::Command;
use serde::Deserialize;
use serde_json::Value;

use crate::Scenario;
use crate::life::focus;
use crate::perform::{Performer, load};
use crate::stage::{App, Runtime, midair};

/// `scenarios/NAME.ron`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Performance {
    /// The session that is performed, from the repository's root.
    session: String,
    /// By how much the volume may differ from that of the session played without a headset.
    #[serde(default = "two_percent")]
    volume: f64,
    /// Whether it makes lines and strokes and nothing that has a volume.
    #[serde(default)]
    drawing: bool,
}

fn two_percent() -> f64 {
    0.02
}

/// Every scenario that has a file.
pub fn files() -> Result<Vec<Scenario>> {
    let mut all = Vec::new();
    for entry in fs::read_dir("/job/tests/xr/scenarios")? {
        let path = entry?.path();
        let text = fs::read_to_string(&path)?;
        let performance: Performance =
            ron::from_str(&text).with_context(|| path.display().to_string())?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        all.push(Scenario {
            name: name.into_owned(),
            run: Box::new(move |folder| perform(&performance, folder)),
        });
    }
    all.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(all)
}

/// Performs it, saves, plays the recording without a headset: the same bytes, no fault, the volume of the session.
fn perform(what: &Performance, folder: &Path) -> Result<()> {
    let session = load(&format!("/job/{}", what.session))?;
    let file = |name: &str| folder.join(name).display().to_string();
    let (record, saved) = (file("recorded.ron"), file("made.midair"));
    let mut runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    let mut app = App::start(folder, &["--vr", "--record", &record])?;
    focus(&mut app)?;
    println!("     in focus after {:.1} s", app.focused);
    // Who knows the way needs no card in it.
    app.ask(&Command::Panel {
        id: "tutorial".to_owned(),
        open: false,
    })?;
    performer.session(&mut app, &session)?;
    app.until("the work is done", |now| now["busy"] == 0)?;
    app.ask(&Command::SaveAs(saved.clone().into()))?;
    app.until("the document is saved", |now| {
        now["busy"] == 0 && fs::metadata(&saved).is_ok()
    })?;
    // An end that is asked for would be in the recording as well.
    app.kill(&record)?;
    if !runtime.is_alive() {
        bail!("the runtime died");
    }
    let session = format!("/job/{}", what.session);
    if what.drawing {
        return drawn(&record, &saved, &session, &file);
    }
    midair(&["export", &saved, "--to", &file("saved.stl")])?;
    midair(&["play", &record, "--export", &file("played.stl")])?;
    same(&file("saved.stl"), &file("played.stl"))?;
    midair(&["check", &file("played.stl"), &saved])?;
    midair(&["play", &session, "--export", &file("session.stl")])?;
    let (is, should) = (volume(&file("played.stl"))?, volume(&file("session.stl"))?);
    let off = (is / should - 1.0).abs();
    println!(
        "     the recording exports the same bytes; no fault; volume {is:.6} m3, {:.2} % off the session's",
        off * 100.0
    );
    if off > what.volume {
        bail!("its volume is {is} m3, the session's {should} m3");
    }
    Ok(())
}

fn same(saved: &str, played: &str) -> Result<()> {
    if fs::read(saved)? != fs::read(played)? {
        bail!("the recording, played without a headset, exports something else");
    }
    Ok(())
}

/// What is drawn has no volume: its lines and strokes are as many as those of the session.
fn drawn(record: &str, saved: &str, session: &str, file: &dyn Fn(&str) -> String) -> Result<()> {
    midair(&["export", saved, "--to", &file("saved.obj")])?;
    let (played, reported) = (file("played.obj"), file("played.json"));
    midair(&["play", record, "--export", &played, "--report", &reported])?;
    same(&file("saved.obj"), &played)?;
    midair(&["check", saved])?;
    midair(&["play", session, "--report", &file("session.json")])?;
    let count = |report: &str| -> Result<[usize; 2]> {
        let report: Value = serde_json::from_str(&fs::read_to_string(report)?)?;
        Ok(["lines", "strokes"].map(|what| report[what].as_array().map_or(0, Vec::len)))
    };
    let (is, should) = (count(&reported)?, count(&file("session.json"))?);
    println!(
        "     the recording exports the same bytes; {} lines and {} strokes",
        is[0], is[1]
    );
    if is != should || is[0] + is[1] == 0 {
        bail!("there are {is:?} lines and strokes, in the session {should:?}");
    }
    Ok(())
}

fn volume(mesh: &str) -> Result<f64> {
    let report: Value = serde_json::from_str(&midair(&["check", "--json", mesh])?)?;
    report[0]["volume"]
        .as_f64()
        .with_context(|| format!("{mesh}: no volume in {report}"))
}
