use std::fmt;

use serde::Serialize;
use serde_json::{Map, Value};

use crate::measure::{Times, median};

/// What else is known of a measurement, by name.
pub type Details = Map<String, Value>;

/// One benchmark's outcome.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// Which workload.
    pub name: String,
    /// Where the work was done: `cpu` or `gpu`.
    pub backend: &'static str,
    /// What the numbers count: `ms`.
    pub unit: &'static str,
    /// The middle of all runs.
    pub median: f64,
    /// The shortest run.
    pub min: f64,
    /// The longest run.
    pub max: f64,
    /// How many runs, the first, which warms up, not counted.
    pub runs: usize,
    /// What the paper gives for the same work; none where it gives nothing.
    pub paper: Option<f64>,
    /// The medians of the parts, and how large the work was.
    pub details: Details,
}

impl Figure {
    pub(crate) fn new(name: &str, paper: Option<f64>, times: &Times, mut details: Details) -> Self {
        for (part, all) in &times.parts {
            details.insert((*part).to_owned(), median(all).into());
        }
        details.insert("threads".to_owned(), rayon::current_num_threads().into());
        Self {
            name: name.to_owned(),
            backend: "cpu",
            unit: "ms",
            median: median(&times.total),
            min: times.total.first().copied().unwrap_or(f64::NAN),
            max: times.total.last().copied().unwrap_or(f64::NAN),
            runs: times.total.len(),
            paper,
            details,
        }
    }
}

/// Rows of figures in columns that fit the given names.
///
/// ```
/// use midair_bench::Table;
/// let table = Table::for_names(["fuse/5x64-in-256"]);
/// assert!(table.header().starts_with("fuse") || table.header().starts_with("name"));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Table {
    width: usize,
}

impl Table {
    /// A table for these workloads.
    pub fn for_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        let longest = names.into_iter().map(str::len).max().unwrap_or(0);
        Self {
            width: longest.max("name".len()),
        }
    }

    /// The line above the rows.
    pub fn header(&self) -> String {
        format!(
            "{:width$} {:>11} {:>11} {:>11} {:>6} {:>9} {:>9}  details",
            "name",
            "median ms",
            "min ms",
            "max ms",
            "runs",
            "paper ms",
            "of paper",
            width = self.width
        )
    }

    /// One figure as a line.
    pub fn row(&self, f: &Figure) -> String {
        let (paper, ratio) = match f.paper {
            Some(p) => (format!("{p:.0}"), format!("{:.3}x", f.median / p)),
            None => ("-".to_owned(), "-".to_owned()),
        };
        format!(
            "{:width$} {:>11.3} {:>11.3} {:>11.3} {:>6} {paper:>9} {ratio:>9}  {}",
            f.name,
            f.median,
            f.min,
            f.max,
            f.runs,
            Listed(&f.details),
            width = self.width
        )
    }
}

/// Details as `name value`, numbers short.
struct Listed<'a>(&'a Details);

impl fmt::Display for Listed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (name, value)) in self.0.iter().enumerate() {
            let comma = if i == 0 { "" } else { ", " };
            match value.as_f64() {
                Some(x) if value.is_f64() => write!(f, "{comma}{name} {x:.3}")?,
                _ => write!(f, "{comma}{name} {value}")?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_has_every_field() {
        let times = Times {
            total: vec![1.0, 2.0, 4.0],
            parts: vec![("fuse_ms", vec![0.5, 1.0, 2.0])],
        };
        let figure = Figure::new("csg/cup/0.010", Some(61.0), &times, Details::new());
        let json = serde_json::to_value([&figure]).unwrap();
        for (name, value) in [("median", 2.0), ("min", 1.0), ("max", 4.0), ("paper", 61.0)] {
            assert_eq!(json[0][name], value);
        }
        assert_eq!(json[0]["runs"], 3);
        assert_eq!(json[0]["details"]["fuse_ms"], 1.0);
        let none = Figure::new("fuse", None, &times, Details::new());
        assert!(serde_json::to_value(none).unwrap()["paper"].is_null());
        let row = Table::for_names(["csg/cup/0.010"]).row(&figure);
        assert!(row.contains("0.033x"), "{row}");
    }
}
