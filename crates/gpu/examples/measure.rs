//! Measures every workload of the GPU, without the app: to be carried to a machine with a graphics card.
//!
//! `measure [NAME...] [--software] [--quantised] [--runs N] [--json FILE]`: a NAME stands for all that begin with it.

use std::process::ExitCode;
use std::sync::Arc;

use midair_gpu::measure::{all, growth};
use midair_gpu::{Gpu, GpuOptions, SolidOptions};

fn main() -> ExitCode {
    match measure() {
        Ok(()) => ExitCode::SUCCESS,
        Err(line) => {
            eprintln!("{line}");
            ExitCode::FAILURE
        }
    }
}

fn measure() -> Result<(), String> {
    let (mut names, mut json, mut runs) = (Vec::new(), None, 7);
    let (mut software, mut options) = (false, SolidOptions::default());
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--software" => software = true,
            "--quantised" => options.quantised = true,
            "--json" => json = Some(words.next().ok_or("--json needs a file")?),
            "--runs" => {
                let n = words.next().and_then(|n| n.parse().ok());
                runs = n
                    .filter(|n| *n > 0)
                    .ok_or("--runs needs a number above 0")?;
            }
            name if name.starts_with('-') => return Err(format!("there is no option {name}")),
            name => names.push(name.to_owned()),
        }
    }
    let gpu = Arc::new(
        Gpu::open(&GpuOptions {
            software,
            budget: 4 << 30,
        })
        .map_err(|e| format!("{e} (--software measures on software)"))?,
    );
    let adapter = gpu.adapter();
    let clock = if gpu.is_timed() {
        "with a clock"
    } else {
        "without a clock"
    };
    println!("{} ({}), {clock}", adapter.name, adapter.api);
    println!(
        "{:24} {:>9} {:>8} {:>8} {:>8} {:>8} {:>10} {:>9} {:>7} {:>8} {:>8}",
        "workload",
        "total ms",
        "cull",
        "fuse",
        "extract",
        "read",
        "processor",
        "triangles",
        "bricks",
        "used MB",
        "all MB"
    );
    let wanted = |n: &str| names.is_empty() || names.iter().any(|w| n.starts_with(w.as_str()));
    let mut figures = Vec::new();
    for work in all().into_iter().filter(|w| wanted(&w.name)) {
        match work.run(&gpu, options, runs) {
            Ok(f) => {
                let device = f.device_ms.unwrap_or([f64::NAN; 3]);
                println!(
                    "{:24} {:9.3} {:8.3} {:8.3} {:8.3} {:8.3} {:10.3} {:9} {:7} {:8.2} {:8.2}",
                    f.name,
                    f.total_ms,
                    device[0],
                    device[1],
                    device[2],
                    f.read_ms,
                    f.processor_ms,
                    f.triangles,
                    f.bricks,
                    f.bytes[0] as f64 / 1e6,
                    f.bytes[1] as f64 / 1e6
                );
                figures.push(f);
            }
            Err(line) => println!("{:24} {line}", work.name),
        }
    }
    if let Some(exponent) = growth(&figures) {
        println!("bytes in use grow with the nodes along a side to the power of {exponent:.2}");
    }
    let time = |name: &str| figures.iter().find(|f| f.name == name).map(|f| f.total_ms);
    if let (Some(dab), Some(full)) = (time("gpu/dab-32-in-256"), time("gpu/full-256")) {
        println!("a dab of 32³ in 256³ takes {:.4} of the whole", dab / full);
    }
    if let Some(file) = json {
        let rows: Vec<_> = figures
            .iter()
            .map(|f| {
                serde_json::json!({
                    "name": f.name, "total_ms": f.total_ms, "device_ms": f.device_ms, "read_ms": f.read_ms,
                    "processor_ms": f.processor_ms, "triangles": f.triangles, "bricks": f.bricks, "bytes": f.bytes,
                })
            })
            .collect();
        let text =
            serde_json::json!({ "adapter": adapter.name, "api": adapter.api, "figures": rows });
        std::fs::write(&file, text.to_string()).map_err(|e| format!("{file}: {e}"))?;
    }
    Ok(())
}
