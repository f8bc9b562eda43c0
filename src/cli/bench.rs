//! `midair bench`: the papers' workloads on this machine.

use std::{fs, io};

use anyhow::{Context, Result, bail};
use midair_bench::{Budget, report, select};

use super::{Backend, Bench};

/// Measures the workloads asked for, prints each as a row, and writes them all as JSON.
///
/// # Errors
///
/// A name that is none, a backend that this build has not, a mesh that cannot be read, or a file
/// that cannot be written.
pub fn run(bench: Bench) -> Result<()> {
    if bench.backend == Backend::Gpu {
        bail!("this build has no GPU backend: leave --backend out, or give --backend cpu");
    }
    let workloads = select(&bench.names)?;
    let figures = report(&workloads, &Budget::default(), &mut io::stdout().lock())?;
    if let Some(file) = bench.json {
        let text = serde_json::to_string_pretty(&figures)? + "\n";
        fs::write(&file, text).with_context(|| format!("{} was not written", file.display()))?;
    }
    Ok(())
}
