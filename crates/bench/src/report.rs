use std::io::{self, Write};

use crate::catalogue::{BenchError, Outcome, Workload};
use crate::figure::{Figure, Table};
use crate::measure::Budget;

/// Why a row of benchmarks stopped.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A workload could not be carried out.
    #[error("{0}: {1}")]
    Workload(String, Box<BenchError>),
    /// The table could not be written.
    #[error("the table cannot be written: {0}")]
    Write(#[from] io::Error),
}

/// Measures `workloads` one after the other and writes each as a row of a table when it is done.
///
/// # Errors
/// The first workload that fails, or `out`.
pub fn report(
    workloads: &[Workload],
    budget: &Budget,
    out: &mut impl Write,
) -> Result<Vec<Figure>, ReportError> {
    let table = Table::for_names(workloads.iter().map(Workload::name));
    writeln!(out, "{}", table.header())?;
    let mut figures = Vec::new();
    for workload in workloads {
        let name = workload.name();
        let outcome = workload.run(budget);
        match outcome.map_err(|e| ReportError::Workload(name.to_owned(), Box::new(e)))? {
            Outcome::Figure(figure) => {
                writeln!(out, "{}", table.row(&figure))?;
                figures.push(figure);
            }
            Outcome::Skipped(reason) => writeln!(out, "{name}: skipped: {reason}")?,
        }
        out.flush()?;
    }
    Ok(figures)
}
