//! Curves in space, in metres and double precision.
//!
//! - [`CubicBezier`] and [`Spline`]: one cubic segment, and a chain of them.
//! - [`Polyline`]: points joined by straight lines, measured and resampled by arc length.
//!
//! What is *not* promised: a spline is as smooth as its control points make it; nothing here
//! changes them.
//!
//! ```
//! use glam::DVec3;
//! use midair_curve::Polyline;
//!
//! let line = Polyline::new(vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y]);
//! assert_eq!(line.length(), 2.0);
//! assert_eq!(line.spaced(0.5).len(), 5);
//! ```

mod bezier;
mod polyline;

pub use bezier::{CubicBezier, Spline};
pub use polyline::Polyline;
