//! The papers' tables as benchmarks, on this machine.
//!
//! A [`Workload`] calls what the app calls for the same work, and nothing else, so that its
//! [`Figure`] is the one that `midair play --report` gives. [`workloads`] lists them all, [`select`]
//! those whose names begin with the names asked for.
//!
//! - `measure`: warm up, repeat, take the median.
//! - `figure`: what comes out, as JSON and as a table.
//! - `report`: one after the other, a row for each.
//! - `catalogue`: every workload by name.
//! - `card`: those that the graphics card does as well.
//! - `csg`, `surface`, `bake`, `fuse`, `many`, `scaffold`, `sweep`: the work itself.
//!
//! ```
//! use midair_bench::{Budget, Outcome, select};
//!
//! let short = Budget { runs: 1, seconds: 0.0 };
//! for workload in select(&["csg/cube-sphere/0.012".to_owned()])? {
//!     if let Outcome::Figure(figure) = workload.run(&short)? {
//!         assert_eq!(figure.paper, Some(22.0));
//!     }
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bake;
mod brush;
mod card;
mod catalogue;
mod csg;
mod figure;
mod fuse;
mod many;
mod measure;
mod report;
mod scaffold;
mod surface;
mod sweep;

pub use card::{report_on_card, select_on_card};
pub use catalogue::{BenchError, Outcome, UnknownName, Workload, select, workloads};
pub use figure::{Details, Figure, Table};
pub use measure::Budget;
pub use report::{ReportError, report};
