//! Which relations a line almost has.

use glam::DVec3;

use super::{Constraint, End, Line, LineOptions, Scaffold};

/// Two directions or lengths nearer than this are one candidate.
const SAME: f64 = 1e-9;

/// Every relation within its threshold, nearest first within its kind.
pub(super) fn candidates(
    line: &Line,
    scaffold: &Scaffold,
    options: &LineOptions,
) -> Vec<Constraint> {
    let mut found = Vec::new();
    let Some(unit) = line.direction() else {
        return found;
    };
    let reach = options.distance / options.metres_per_world;
    let reach_squared = reach * reach;
    for end in [End::A, End::B] {
        let at = line.end(end);
        let first = found.len();
        for point in scaffold.keypoints() {
            if at.distance_squared(point) < reach_squared
                && !found[first..].iter().any(|c| is_point(c, point))
            {
                found.push(Constraint::PointPoint { end, point });
            }
        }
    }
    let (least_sine, least_cosine) = (options.angle.sin(), options.angle.cos());
    let length = line.length();
    let mut directions: Vec<DVec3> = Vec::new();
    let mut lengths: Vec<f64> = Vec::new();
    let mut lines = Vec::new();
    for (index, other) in scaffold.lines.iter().enumerate() {
        let Some(direction) = other.direction() else {
            continue;
        };
        for end in [End::A, End::B] {
            let off = line.end(end) - other.a;
            let off = off - direction * off.dot(direction);
            if off.length_squared() < reach_squared {
                lines.push(Constraint::PointLine {
                    end,
                    line: index,
                    through: other.a,
                    direction,
                });
            }
        }
        let cosine = unit.dot(direction).abs();
        if (cosine < least_sine || cosine > least_cosine)
            && !directions.iter().any(|&d| parallel(d, direction))
        {
            directions.push(direction);
            lines.push(if cosine < least_sine {
                Constraint::Perpendicular {
                    direction,
                    line: Some(index),
                }
            } else {
                Constraint::Parallel {
                    direction,
                    line: Some(index),
                }
            });
        }
        let other = other.length();
        // No end is moved farther for a length than it would be for a point: a share of a long line
        // is more than a hand is off by.
        if (length / other - 1.0).abs() < options.length
            && (length - other).abs() < reach
            && !lengths.iter().any(|&l| (l / other - 1.0).abs() < SAME)
        {
            lengths.push(other);
            lines.push(Constraint::EqualLength {
                length: other,
                line: index,
            });
        }
    }
    // Upright or level, as if a line stood there.
    let (up, cosine) = (DVec3::Y, unit.y.abs());
    if options.vertical && !directions.iter().any(|&d| parallel(d, up)) {
        if cosine > least_cosine {
            lines.push(Constraint::Parallel {
                direction: up,
                line: None,
            });
        } else if cosine < least_sine {
            lines.push(Constraint::Perpendicular {
                direction: up,
                line: None,
            });
        }
    }
    found.append(&mut lines);
    found
}

fn is_point(c: &Constraint, p: DVec3) -> bool {
    matches!(c, Constraint::PointPoint { point, .. } if point.distance_squared(p) < SAME * SAME)
}

fn parallel(a: DVec3, b: DVec3) -> bool {
    a.cross(b).length_squared() < SAME * SAME
}
