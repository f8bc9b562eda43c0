//! Auto-correcting scaffold lines (ScaffoldSketch §4.1).

mod candidates;
mod constraint;
mod correct;
mod exact;
mod readings;
mod select;
#[cfg(test)]
pub(crate) mod tests;

use glam::DVec3;

pub use constraint::{Constraint, End};
pub use correct::{Corrected, correct_line};
pub use readings::readings;

/// A straight line with two ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Where it begins.
    pub a: DVec3,
    /// Where it ends.
    pub b: DVec3,
}

impl Line {
    /// From `a` to `b`.
    pub const fn new(a: DVec3, b: DVec3) -> Self {
        Self { a, b }
    }

    /// Metres from end to end.
    pub fn length(&self) -> f64 {
        self.a.distance(self.b)
    }

    /// The unit vector from its beginning to its end; `None` where it has no length.
    pub fn direction(&self) -> Option<DVec3> {
        (self.b - self.a).try_normalize()
    }

    /// One of its ends.
    pub fn end(&self, end: End) -> DVec3 {
        match end {
            End::A => self.a,
            End::B => self.b,
        }
    }
}

/// What is drawn already.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scaffold {
    /// Its lines.
    pub lines: Vec<Line>,
    /// Tick marks: keypoints on lines beside their ends and middles.
    pub ticks: Vec<DVec3>,
}

impl Scaffold {
    /// Ends and middles of the lines, then the tick marks.
    pub fn keypoints(&self) -> impl Iterator<Item = DVec3> {
        let of_lines = |l: &Line| [l.a, l.b, l.a.midpoint(l.b)];
        self.lines
            .iter()
            .flat_map(of_lines)
            .chain(self.ticks.iter().copied())
    }
}

/// How near to a relation a line has to be drawn to be brought into it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineOptions {
    /// Physical metres between an end and a keypoint or a line (§4.1: 5 cm).
    pub distance: f64,
    /// Radians off parallel or square (§4.1: 10°).
    pub angle: f64,
    /// Off equal length, as a share (§4.1: 25 %).
    pub length: f64,
    /// Radians off a sixth or a third of a turn to a line that it meets, and a part of it off 30°, 45°, 135°
    /// and 150°; 0 where only square and parallel lines are meant, as in the paper.
    pub part_turn: f64,
    /// An angle of one's own at which a line is to meet another, in radians up to a right angle, wanted within
    /// [`LineOptions::angle`] whatever `part_turn` is; 0 for none.
    pub own_angle: f64,
    /// Whether the vertical is a direction like those of lines: to be parallel or square to.
    pub vertical: bool,
    /// Physical metres per metre of world: zooming in makes the thresholds finer.
    pub metres_per_world: f64,
}

impl LineOptions {
    /// The same with thresholds that are `strength` times as wide, within what makes sense.
    #[must_use]
    pub fn stronger(&self, strength: f64) -> Self {
        Self {
            distance: self.distance * strength,
            angle: (self.angle * strength).min(0.6),
            length: (self.length * strength).min(0.9),
            part_turn: (self.part_turn * strength).min(0.24),
            ..*self
        }
    }
}

impl Default for LineOptions {
    fn default() -> Self {
        Self {
            distance: 0.05,
            angle: 10.0_f64.to_radians(),
            length: 0.25,
            part_turn: 10.0_f64.to_radians(),
            own_angle: 0.0,
            vertical: true,
            metres_per_world: 1.0,
        }
    }
}
