//! Workloads on the graphics card.

use std::io::Write;
use std::sync::Arc;

use midair_gpu::measure::{self, Figures, Work};
use midair_gpu::{Gpu, SolidOptions};
use serde_json::json;

use crate::brush;
use crate::catalogue::{BenchError, MANY, STEPS, UnknownName, workloads};
use crate::figure::{Details, Figure, Table};
use crate::many;
use crate::measure::Budget;
use crate::report::ReportError;

/// Every workload of the card: those of the small program, then the processor's that bake or draw nothing.
fn all() -> Vec<Work> {
    let mut all = measure::all();
    for count in MANY {
        let heap = |(spelt, step): (&str, f32)| {
            many::on_card(count, step, format!("gpu/many-{count}/{spelt}"))
        };
        all.extend(STEPS.map(heap));
    }
    all.extend(brush::on_card());
    all
}

/// The card's name for a workload of the processor.
fn on_card(name: &str) -> String {
    match name.strip_prefix("csg/") {
        Some(rest) => format!("gpu/{rest}"),
        None if name.starts_with("brush") => format!("gpu/{name}"),
        None => name.to_owned(),
    }
}

/// What the card is to do: `gpu/…`, and `csg/…` and `brush/…` under the processor's names.
///
/// # Errors
/// A name that no workload of the card begins with.
pub fn select_on_card(names: &[String]) -> Result<Vec<Work>, UnknownName> {
    let all = all();
    let begins = |work: &Work, name: &str| work.name.starts_with(&on_card(name));
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
/// A card that is lost, or `out`.
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
        let measured = match work.run(gpu, SolidOptions::default(), budget.runs) {
            Ok(measured) => measured,
            // A card that is too small for one is not for the next; a lost one is.
            Err(line) if gpu.check().is_ok() => {
                writeln!(out, "{}: skipped: {line}", work.name)?;
                continue;
            }
            Err(line) => {
                let error = Box::new(BenchError::Card(line));
                return Err(ReportError::Workload(work.name.clone(), error));
            }
        };
        let figure = figure(&measured, gpu);
        writeln!(out, "{}", table.row(&figure))?;
        out.flush()?;
        figures.push(figure);
    }
    Ok(figures)
}

fn figure(f: &Figures, gpu: &Gpu) -> Figure {
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
    let same = workloads()
        .iter()
        .find(|w| on_card(w.name()) == f.name)
        .map(|w| w.paper());
    Figure {
        name: f.name.clone(),
        backend: "gpu",
        unit: "ms",
        median: f.total_ms,
        min: f.range_ms[0],
        max: f.range_ms[1],
        runs: f.runs,
        paper: same.flatten(),
        details,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_card_does_what_the_processor_does_under_its_names() {
        let named = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|n| n.to_string()).collect();
            let found = select_on_card(&names).unwrap();
            found.into_iter().map(|w| w.name).collect::<Vec<_>>()
        };
        assert_eq!(named(&["csg/chair"]).len(), 4);
        assert_eq!(named(&["csg/many"]).len(), 8);
        assert_eq!(named(&["brush/horse"]).len(), 3);
        assert!(named(&["brush"]).contains(&"gpu/brush/erase/256".to_owned()));
        let all = named(&[]);
        for name in [
            "gpu/chair/0.006",
            "gpu/full-256",
            "gpu/dab-in-512",
            "gpu/dab-32-in-256",
            "gpu/brush-25k/128",
            "gpu/many-30/0.006",
            "gpu/brush/wings/512",
            "gpu/brush/point-stroke/256",
        ] {
            assert!(all.iter().any(|n| n == name), "{name}");
        }
        let mut once = all.clone();
        once.sort();
        once.dedup();
        assert_eq!(once.len(), all.len());
    }
}
