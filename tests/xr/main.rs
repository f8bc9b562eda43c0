//! Scenarios in a headset: the built app, a real OpenXR runtime, controllers that do what a session says.
//!
//! Started by `tests/xr/run.sh` in a root file system of its own; without one it says so and ends. Arguments name
//! scenarios; all are run where there are none. `scenarios/NAME.ron` says what is performed.

mod brush;
mod calls;
mod faults;
mod frames;
mod life;
mod looks;
mod materials;
mod perform;
mod profiles;
mod restored;
mod room;
mod scenario;
mod stage;
mod taught;
mod wire;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;

/// One scenario by its name.
struct Scenario {
    name: String,
    run: Box<dyn Fn(&Path) -> Result<()>>,
}

/// Those that are no session.
fn own() -> impl Iterator<Item = Scenario> {
    let all: [(&str, fn(&Path) -> Result<()>); 19] = [
        ("absent", life::absent),
        ("from-flat", life::from_flat),
        ("tracking", life::tracking),
        ("alone", life::alone),
        ("attention", life::attention),
        ("killed", life::killed),
        ("room", room::room),
        ("taught", taught::taught),
        ("restored", restored::restored),
        ("looks", looks::looks),
        ("materials", materials::materials),
        ("brush", brush::brush),
        ("desk", looks::desk),
        ("index", profiles::index),
        ("touch", profiles::touch),
        ("wmr", profiles::wmr),
        ("own-table", profiles::own),
        ("each-call", faults::each_call),
        ("chair", frames::chair),
    ];
    all.into_iter().map(|(name, run)| Scenario {
        name: name.to_owned(),
        run: Box::new(run),
    })
}

fn main() -> ExitCode {
    if !Path::new("/job/tests/xr").exists() || !Path::new("/usr/bin/monado-service").exists() {
        println!("skipped: tests/xr/run.sh runs these in their own root file system");
        return ExitCode::SUCCESS;
    }
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let all = match scenario::files() {
        Ok(files) => files,
        Err(error) => {
            println!("FAIL {error:#}");
            return ExitCode::FAILURE;
        }
    };
    let mut all = all;
    all.extend(own());
    let (mut passed, mut again, mut failed) = (0, Vec::new(), 0);
    for scenario in all {
        if !wanted.is_empty() && !wanted.contains(&scenario.name) {
            continue;
        }
        if once(&scenario) {
            passed += 1;
            continue;
        }
        // The runtime and the software renderer are not ours: one more try tells a fault from a mishap, and is said.
        println!("     {}: once more", scenario.name);
        if once(&scenario) {
            again.push(scenario.name);
        } else {
            failed += 1;
        }
    }
    println!("{} passed, {failed} failed", passed + again.len());
    if !again.is_empty() {
        println!("only at the second try: {}", again.join(", "));
    }
    if failed == 0 && passed + again.len() > 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Runs a scenario and says what came of it.
fn once(scenario: &Scenario) -> bool {
    let folder = Path::new(stage::OUT).join(&scenario.name);
    let _ = std::fs::remove_dir_all(&folder);
    let begun = Instant::now();
    let done = std::fs::create_dir_all(&folder)
        .map_err(Into::into)
        .and_then(|()| (scenario.run)(&folder));
    let seconds = begun.elapsed().as_secs_f64();
    let Err(error) = done else {
        println!("ok   {} ({seconds:.1} s)", scenario.name);
        return true;
    };
    println!("FAIL {} ({seconds:.1} s): {error:#}", scenario.name);
    for log in ["midair.log", "../monado.log"] {
        let text = std::fs::read_to_string(folder.join(log)).unwrap_or_default();
        let lines: Vec<_> = text.lines().collect();
        println!("--- {log}, its end:");
        for line in &lines[lines.len().saturating_sub(25)..] {
            println!("{line}");
        }
    }
    false
}
