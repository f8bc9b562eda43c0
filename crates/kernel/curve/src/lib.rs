//! Curves in space, in metres and double precision.
//!
//! - [`CubicBezier`] and [`Spline`]: one cubic segment, and a chain of them.
//! - [`Hermite`]: the curve between two controllers, with [`Lengths`] that keep its speed even.
//! - [`Frames`]: a frame along it that turns as little as it can and ends as the right one is held.
//! - [`Even`]: where along it a share of its length lies.
//! - [`Pace`]: how evenly counted points are spread along it.
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
mod even;
mod frames;
mod hermite;
mod pace;
mod polyline;

pub use bezier::{CubicBezier, Spline};
pub use even::Even;
pub use frames::{Frames, unwound};
pub use hermite::{End, Hermite, Lengths};
pub use pace::Pace;
pub use polyline::Polyline;
