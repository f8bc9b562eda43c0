//! Which relations a line almost has.

use glam::DVec3;

use super::{Constraint, End, Line, LineOptions, Scaffold};

/// Two directions or lengths nearer than this are one candidate.
const SAME: f64 = 1e-9;
/// Of an upright and a level line only lengths nearer than this share of the reach are taken for equal.
const LESS_ALIKE: f64 = 0.3;

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
    let mut lengths: Vec<(bool, f64, usize)> = Vec::new();
    let mut lines = Vec::new();
    let (mut angles, mut weak) = (Vec::<DVec3>::new(), Vec::new());
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
        // Only where the two meet: an angle to a line far away is seen by nobody.
        let meets = || {
            [other.a, other.b].iter().any(|p| {
                [line.a, line.b]
                    .iter()
                    .any(|q| p.distance_squared(*q) < reach_squared)
            })
        };
        if (options.part_turn > 0.0 || options.own_angle > 0.0)
            && let Some(cosine) = part_turn(unit.dot(direction), options)
            && meets()
            && !angles.iter().any(|&d| parallel(d, direction))
        {
            angles.push(direction);
            weak.push(Constraint::Angle {
                direction,
                cosine,
                line: index,
            });
        }
        // Upright lines and level ones are seldom meant to be as long as each other.
        let alike = !options.vertical || (unit.y.abs() > 0.7) == (direction.y.abs() > 0.7);
        lengths.push((!alike, other.length(), index));
    }
    lengths.sort_by_key(|(other_way, ..)| *other_way);
    let mut equal: Vec<f64> = Vec::new();
    for (other_way, other, line) in lengths {
        // No end is moved farther for a length than it would be for a point: a share of a long line
        // is more than a hand is off by.
        let most = if other_way { LESS_ALIKE * reach } else { reach };
        if (length / other - 1.0).abs() < options.length
            && (length - other).abs() < most
            && !equal.iter().any(|&l| (l / other - 1.0).abs() < SAME)
        {
            equal.push(other);
            lines.push(Constraint::EqualLength {
                length: other,
                line,
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
    found.append(&mut weak);
    found
}

/// The cosine of 60° or 120° where `cosine` is within the threshold of it, or of 30°, 45°, 135° or 150°, which are meant
/// less often, within a part of that. An angle of one's own comes before them.
fn part_turn(cosine: f64, options: &LineOptions) -> Option<f64> {
    const LESS: f64 = 0.55;
    let at = cosine.clamp(-1.0, 1.0).acos();
    let nearest = |wholes: &mut dyn Iterator<Item = (f64, f64)>| {
        wholes
            .map(|(whole, within)| (whole, (whole - at).abs() / within))
            .filter(|(_, off)| *off < 1.0)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(whole, _)| whole.cos())
    };
    let own = [options.own_angle, std::f64::consts::PI - options.own_angle];
    let mut own = own
        .into_iter()
        .filter(|_| options.own_angle > 0.0)
        .map(|whole| (whole, options.angle));
    let usual = [
        (60.0, 1.0),
        (120.0, 1.0),
        (45.0, LESS),
        (135.0, LESS),
        (30.0, LESS),
        (150.0, LESS),
    ];
    let mut usual = usual
        .into_iter()
        .filter(|_| options.part_turn > 0.0)
        .map(|(degrees, share): (f64, f64)| (degrees.to_radians(), options.part_turn * share));
    nearest(&mut own).or_else(|| nearest(&mut usual))
}

fn is_point(c: &Constraint, p: DVec3) -> bool {
    matches!(c, Constraint::PointPoint { point, .. } if point.distance_squared(p) < SAME * SAME)
}

fn parallel(a: DVec3, b: DVec3) -> bool {
    a.cross(b).length_squared() < SAME * SAME
}
