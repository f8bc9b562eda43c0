//! `midair bench`: the papers' workloads on this machine.

use std::{fs, io};

use anyhow::{Context, Result};
use midair_bench::{Budget, report, report_on_card, select, select_on_card};
use midair_gpu::{Gpu, GpuOptions};

use super::{Backend, Bench};

/// Measures the workloads asked for, prints each as a row, and writes them all as JSON.
///
/// # Errors
///
/// A name that is none, a backend that this machine has not, a mesh that cannot be read, or a file
/// that cannot be written.
pub fn run(bench: Bench) -> Result<()> {
    let out = &mut io::stdout().lock();
    let figures = match bench.backend {
        Backend::Cpu => report(&select(&bench.names)?, &Budget::default(), out)?,
        Backend::Gpu => {
            let chosen = select_on_card(&bench.names)?;
            let gpu = Gpu::open(&GpuOptions {
                software: true,
                budget: 4 << 30,
            })?;
            if gpu.adapter().software {
                let name = &gpu.adapter().name;
                eprintln!(
                    "midair: {name} is no graphics card but software: the figures say little"
                );
            }
            report_on_card(&gpu.into(), &chosen, &Budget::default(), out)?
        }
    };
    if let Some(file) = bench.json {
        let text = serde_json::to_string_pretty(&figures)? + "\n";
        fs::write(&file, text).with_context(|| format!("{} was not written", file.display()))?;
    }
    Ok(())
}
