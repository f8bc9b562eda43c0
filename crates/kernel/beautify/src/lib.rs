//! Lines that come out right and strokes that come out fair (ScaffoldSketch §4).
//!
//! - [`correct_line`] brings a drawn construction line into the relations it almost has: ends that
//!   meet, right angles, parallels, equal lengths (§4.1).
//! - [`fair_stroke`] turns a free stroke into a curve through keypoints of the scaffold, of minimum
//!   variation of curvature (§4.2).
//!
//! Both say what they kept and what they dropped. Metres and radians, double precision throughout.
//!
//! What is guaranteed: a kept constraint holds to 1e-9, a dropped one leaves no trace; a line that
//! would end up farther away than its thresholds allow stays as it was drawn. What is not: that the
//! relations found are those the person meant.

pub mod line;
pub mod stroke;

pub use line::{Constraint, Corrected, End, Line, LineOptions, Scaffold, correct_line, readings};
pub use stroke::{Fair, Segment, StrokeOptions, fair_stroke};
