//! A runtime that refuses each call in turn: the app says so in one line and goes on.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Side};
use serde_json::Value;

use crate::calls::{FRAME, START};
use crate::life::{focus, quit};
use crate::perform::Performer;
use crate::stage::{App, Runtime};

/// Where the layer reads what fails.
const FAIL: &str = "/out/fail";

fn fail(lines: &str) -> Result<()> {
    fs::write(FAIL, lines).context(FAIL)
}

fn warnings(now: &Value) -> usize {
    now["warnings"].as_array().map_or(0, Vec::len)
}

/// Each call is refused in turn.
pub fn each_call(folder: &Path) -> Result<()> {
    let layers = folder.join("layers");
    fs::create_dir_all(&layers)?;
    fs::write(
        layers.join("fail.json"),
        r#"{"file_format_version": "1.0.0", "api_layer": {"name": "XR_APILAYER_MIDAIR_fail",
            "library_path": "/target/debug/examples/libxr_layer.so", "api_version": "1.0", "implementation_version": "1",
            "description": "lets calls fail"}}"#,
    )?;
    fail("")?;
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    let path = layers.display().to_string();
    let mut app = App::start_with(
        folder,
        &["--vr"],
        &[
            ("XR_API_LAYER_PATH", &path),
            ("XR_ENABLE_API_LAYERS", "XR_APILAYER_MIDAIR_fail"),
        ],
    )?;
    focus(&mut app)?;
    performer.settle(&mut app)?;
    for call in FRAME {
        let before = warnings(&app.now);
        fail(&format!("{call} -1\n"))?;
        // A refused view has nothing to say: the eyes stay where they are.
        if call != "xrLocateViews" {
            app.until(&format!("{call} is spoken of"), |now| {
                warnings(now) > before && now["warnings"].to_string().contains(call)
            })?;
        }
        fail("")?;
        app.until(&format!("it goes on after {call}"), |now| {
            now["life"] == "Focused"
                && Side::BOTH
                    .iter()
                    .all(|&s| now["hands"][s as usize]["tracked"] == true)
        })?;
        if warnings(&app.now) > before + 1 {
            bail!("{call} took more than a line: {}", app.now["warnings"]);
        }
    }
    println!(
        "     {} calls of a frame, refused in turn: a line each",
        FRAME.len()
    );
    // A pulse is felt when the ring opens, and is asked of the runtime.
    fail("xrApplyHapticFeedback -1\n")?;
    performer.press(&mut app, Side::Right, Action::Menu, true)?;
    app.until("a refused pulse is spoken of", |now| {
        now["warnings"]
            .to_string()
            .contains("xrApplyHapticFeedback")
    })?;
    fail("")?;
    performer.press(&mut app, Side::Right, Action::Menu, false)?;
    // The one that ends everything.
    fail("xrPollEvent -13\n")?;
    app.until("the runtime is lost", |now| now["life"] == "Lost")?;
    for call in START {
        let code = if call == "xrGetSystem" { -35 } else { -1 };
        let before = warnings(&app.now);
        fail(&format!("{call} {code}\n"))?;
        let word = match call {
            "xrCreateInstance" | "xrGetInstanceProperties" => "refused",
            "xrGetSystem" => "no headset is connected",
            _ => call,
        };
        app.until(&format!("{call} is spoken of"), |now| {
            now["warnings"]
                .as_array()
                .into_iter()
                .flatten()
                .skip(before)
                .any(|w| w.as_str().unwrap_or_default().contains(word))
        })?;
        if app.now["life"] != "Lost" {
            bail!("{call} was refused and it is {}", app.now["life"]);
        }
    }
    fail("")?;
    focus(&mut app)?;
    performer.settle(&mut app)?;
    println!(
        "     {} calls of a start, refused in turn: a line each, then it is in the headset",
        START.len()
    );
    // Nothing of it touched the work.
    app.ask(&Command::Undo)?;
    quit(&mut app)
}
