use glam::{DMat3, DVec3};
use nalgebra::{Matrix6, Vector6};

use super::Line;

/// One of the two ends of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum End {
    /// Where it begins.
    A,
    /// Where it ends.
    B,
}

/// A relation that a line can stand in. Indices are those of [`super::Scaffold::lines`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constraint {
    /// An end lies on a keypoint (Eq. 1).
    PointPoint {
        /// Which end.
        end: End,
        /// The keypoint.
        point: DVec3,
    },
    /// An end lies on a line, or where it would go on (Eq. 2).
    PointLine {
        /// Which end.
        end: End,
        /// Which line.
        line: usize,
        /// A point of it.
        through: DVec3,
        /// Its unit direction.
        direction: DVec3,
    },
    /// Square to a unit direction (Eq. 3).
    Perpendicular {
        /// The direction.
        direction: DVec3,
        /// The line that has it; `None` for the vertical: level.
        line: Option<usize>,
    },
    /// Parallel to a unit direction (Eq. 4, as a sine).
    Parallel {
        /// The direction.
        direction: DVec3,
        /// The line that has it; `None` for the vertical.
        line: Option<usize>,
    },
    /// At an angle to a unit direction that is a whole part of a turn: what makes a hexagon regular.
    /// Not one of the paper's; weaker than all of those.
    Angle {
        /// The direction.
        direction: DVec3,
        /// The cosine of the angle between the two, with its sign.
        cosine: f64,
        /// The line that has it.
        line: usize,
    },
    /// As long as another line (Eq. 5).
    EqualLength {
        /// Its length in metres.
        length: f64,
        /// Which line.
        line: usize,
    },
}

/// The residual of a constraint, up to three numbers, and its derivative by both ends.
pub(super) struct Residual {
    pub value: DVec3,
    /// By the beginning.
    pub by_a: DMat3,
    /// By the end.
    pub by_b: DMat3,
}

impl Constraint {
    /// C(l): the squared deviation. Lengths count in metres times `scale`.
    pub fn energy(&self, line: &Line, scale: f64) -> f64 {
        self.residual(line, scale)
            .map_or(f64::INFINITY, |r| r.value.length_squared())
    }

    /// `None` where the line has no direction.
    pub(super) fn residual(&self, line: &Line, scale: f64) -> Option<Residual> {
        let of_end = |end: End, value: DVec3, by: DMat3| {
            let (by_a, by_b) = match end {
                End::A => (by, DMat3::ZERO),
                End::B => (DMat3::ZERO, by),
            };
            Residual { value, by_a, by_b }
        };
        Some(match *self {
            Self::PointPoint { end, point } => of_end(
                end,
                (line.end(end) - point) * scale,
                DMat3::from_diagonal(DVec3::splat(scale)),
            ),
            Self::PointLine {
                end,
                through,
                direction,
                ..
            } => {
                let across = across(direction) * scale;
                of_end(end, across * (line.end(end) - through), across)
            }
            Self::Perpendicular { direction, .. } => {
                let (unit, turn) = unit(line)?;
                let row = turn.transpose() * direction;
                let by = DMat3::from_cols(row.x * DVec3::X, row.y * DVec3::X, row.z * DVec3::X);
                Residual {
                    value: DVec3::X * unit.dot(direction),
                    by_a: -by,
                    by_b: by,
                }
            }
            Self::Angle {
                direction, cosine, ..
            } => {
                let (unit, turn) = unit(line)?;
                let row = turn.transpose() * direction;
                let by = DMat3::from_cols(row.x * DVec3::X, row.y * DVec3::X, row.z * DVec3::X);
                Residual {
                    value: DVec3::X * (unit.dot(direction) - cosine),
                    by_a: -by,
                    by_b: by,
                }
            }
            Self::Parallel { direction, .. } => {
                let (unit, turn) = unit(line)?;
                // d × as a matrix: l̂ × d = −[d]× l̂.
                let by = -cross(direction) * turn;
                Residual {
                    value: unit.cross(direction),
                    by_a: -by,
                    by_b: by,
                }
            }
            Self::EqualLength { length, .. } => {
                let (unit, _) = unit(line)?;
                let row = unit / length;
                let by = DMat3::from_cols(row.x * DVec3::X, row.y * DVec3::X, row.z * DVec3::X);
                Residual {
                    value: DVec3::X * (line.length() / length - 1.0),
                    by_a: -by,
                    by_b: by,
                }
            }
        })
    }

    /// The same in a world that is so many times as large.
    pub(super) fn scaled(&self, by: f64) -> Self {
        let mut scaled = *self;
        match &mut scaled {
            Self::PointPoint { point, .. } => *point *= by,
            Self::PointLine { through, .. } => *through *= by,
            Self::EqualLength { length, .. } => *length *= by,
            Self::Perpendicular { .. } | Self::Parallel { .. } | Self::Angle { .. } => {}
        }
        scaled
    }

    /// In which order relations are taken up: points, then what the paper has, then angles.
    pub(super) fn rank(&self) -> u8 {
        match self {
            Self::PointPoint { .. } => 0,
            Self::Angle { .. } => 2,
            _ => 1,
        }
    }

    /// Whether two relations ask for the same: the same point, direction, length or line.
    pub fn is_like(&self, other: &Self) -> bool {
        let near = |a: DVec3, b: DVec3| a.distance_squared(b) < 1e-16;
        let along = |a: DVec3, b: DVec3| a.cross(b).length_squared() < 1e-16;
        match (self, other) {
            (Self::PointPoint { end: e, point: p }, Self::PointPoint { end: f, point: q }) => {
                e == f && near(*p, *q)
            }
            (
                Self::PointLine {
                    end: e, line: i, ..
                },
                Self::PointLine {
                    end: f, line: j, ..
                },
            ) => e == f && i == j,
            (
                Self::Perpendicular { direction: d, .. },
                Self::Perpendicular { direction: e, .. },
            )
            | (Self::Parallel { direction: d, .. }, Self::Parallel { direction: e, .. })
            | (Self::Angle { direction: d, .. }, Self::Angle { direction: e, .. }) => along(*d, *e),
            (Self::EqualLength { length: a, .. }, Self::EqualLength { length: b, .. }) => {
                (a - b).abs() < 1e-9
            }
            _ => false,
        }
    }

    /// Its weight before the first iteration.
    pub(super) fn prior(&self) -> f64 {
        match self {
            Self::PointPoint { .. } => 100.0,
            Self::Angle { .. } => 0.25,
            _ => 1.0,
        }
    }
}

impl Residual {
    /// Adds w JᵀJ and w Jᵀr to a system of normal equations.
    pub fn add_to(&self, weight: f64, matrix: &mut Matrix6<f64>, vector: &mut Vector6<f64>) {
        let blocks = [&self.by_a, &self.by_b];
        for (i, left) in blocks.into_iter().enumerate() {
            let left = left.transpose() * weight;
            let gradient = left * self.value;
            for r in 0..3 {
                vector[3 * i + r] += gradient[r];
            }
            for (j, right) in blocks.into_iter().enumerate() {
                let block = left * *right;
                for r in 0..3 {
                    for c in 0..3 {
                        matrix[(3 * i + r, 3 * j + c)] += block.col(c)[r];
                    }
                }
            }
        }
    }
}

/// What is left of a vector when its part along a unit `direction` is taken away.
fn across(direction: DVec3) -> DMat3 {
    let d = direction;
    DMat3::IDENTITY - DMat3::from_cols(d * d.x, d * d.y, d * d.z)
}

/// `cross(v) * u` is v × u.
fn cross(v: DVec3) -> DMat3 {
    DMat3::from_cols(
        DVec3::new(0.0, v.z, -v.y),
        DVec3::new(-v.z, 0.0, v.x),
        DVec3::new(v.y, -v.x, 0.0),
    )
}

/// The unit direction of a line and its derivative by the end.
fn unit(line: &Line) -> Option<(DVec3, DMat3)> {
    let length = line.length();
    let unit = line.direction()?;
    Some((unit, across(unit) * (1.0 / length)))
}
