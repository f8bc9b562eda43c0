//! Workloads on the graphics card.

use std::io::Write;
use std::sync::Arc;

use midair_gpu::measure::{self, Figures, Work};
use midair_gpu::{Gpu, SolidOptions};
use serde_json::json;

use crate::catalogue::{BenchError, UnknownName, workloads};
use crate::figure::{Details, Figure, Table};
use crate::measure::Budget;
use crate::report::ReportError;

/// What the card is to do: `gpu/…`, and `csg/…` under the processor's names.
///
/// # Errors
/// A name that no workload of the card begins with.
pub fn select_on_card(names: &[String]) -> Result<Vec<Work>, UnknownName> {
    let all = measure::all();
    let begins = |work: &Work, name: &str| work.name.starts_with(&name.replacen("csg/", "gpu/", 1));
    for name in names {
        if !all.iter().any(|w| begins(w, name)) {
            let known = all.iter().map(|w| w.name.clone()).collect();
            let name = name.clone();
            return Err(UnknownName { name, known });
        }
    }
    let wanted = |w: &Work| names.is_empty() || names.iter().any(|n| begins(w, n));
    Ok(all.into_iter().filter(wanted).collect())
}

/// Measures workloads on the card one after the other and writes each as a row of a table.
///
/// # Errors
/// The first workload that fails, or `out`.
pub fn report_on_card(
    gpu: &Arc<Gpu>,
    chosen: &[Work],
    budget: &Budget,
    out: &mut impl Write,
) -> Result<Vec<Figure>, ReportError> {
    let table = Table::for_names(chosen.iter().map(|w| w.name.as_str()));
    writeln!(out, "{}", table.header())?;
    let mut figures = Vec::new();
    for work in chosen {
        let measured = work.run(gpu, SolidOptions::default(), budget.runs);
        let measured = measured.map_err(|line| {
            ReportError::Workload(work.name.clone(), Box::new(BenchError::Card(line)))
        })?;
        let figure = figure(&measured, gpu, budget.runs);
        writeln!(out, "{}", table.row(&figure))?;
        out.flush()?;
        figures.push(figure);
    }
    Ok(figures)
}

fn figure(f: &Figures, gpu: &Gpu, runs: usize) -> Figure {
    let mut details = Details::new();
    if let Some([cull, fuse, extract]) = f.device_ms {
        details.insert("cull_ms".into(), json!(cull));
        details.insert("fuse_ms".into(), json!(fuse));
        details.insert("extract_ms".into(), json!(extract));
    }
    details.insert("read_ms".into(), json!(f.read_ms));
    details.insert("processor_ms".into(), json!(f.processor_ms));
    details.insert("triangles".into(), json!(f.triangles));
    details.insert("bricks".into(), json!(f.bricks));
    details.insert("bytes".into(), json!(f.bytes[0]));
    details.insert("adapter".into(), json!(gpu.adapter().name));
    let name = f.name.replacen("gpu/", "csg/", 1);
    let same = workloads()
        .iter()
        .find(|w| w.name() == name)
        .map(|w| w.paper());
    Figure {
        name: f.name.clone(),
        backend: "gpu",
        unit: "ms",
        median: f.total_ms,
        min: f.range_ms[0],
        max: f.range_ms[1],
        runs,
        paper: same.flatten(),
        details,
    }
}
