use super::{Constraint, Line, LineOptions, Scaffold, candidates::candidates, exact, select};

/// What became of a drawn line.
#[derive(Clone, Debug, PartialEq)]
pub struct Corrected {
    /// The line to show.
    pub line: Line,
    /// The relations it stands in now, to 1e-10 (metres, radians, a ratio).
    pub kept: Vec<Constraint>,
    /// Those it was near to and does not stand in.
    pub dropped: Vec<Constraint>,
    /// How often relations were weighed against each other.
    pub iterations: usize,
    /// Whether correcting would have moved it farther than its thresholds allow, so that it stays
    /// as it was drawn.
    pub refused: bool,
}

/// Energies below this say no more than that a relation holds.
const HELD: f64 = 1e-10;
/// How often the corrected line is looked at again for relations that came within reach.
const ROUNDS: usize = 6;

/// Brings `drawn` into the relations it almost has to `scaffold` (ScaffoldSketch §4.1).
///
/// Iteratively re-weighted least squares find which relations hold together; the line nearest to
/// the drawn one that meets those exactly is the result. A relation that contradicts them has no
/// part in it.
///
/// A line without length, or that is not finite, comes back as it is.
pub fn correct_line(drawn: &Line, scaffold: &Scaffold, options: &LineOptions) -> Corrected {
    correct_where(drawn, scaffold, options, &|_| true)
}

/// The same with those relations only for which `may` holds.
pub(super) fn correct_where(
    drawn: &Line,
    scaffold: &Scaffold,
    options: &LineOptions,
    may: &dyn Fn(&Constraint) -> bool,
) -> Corrected {
    let as_drawn = |refused| Corrected {
        line: *drawn,
        kept: Vec::new(),
        dropped: Vec::new(),
        iterations: 0,
        refused,
    };
    let scale = options.metres_per_world;
    let sound = drawn.a.is_finite() && drawn.b.is_finite() && scale.is_finite() && scale > 0.0;
    if !sound {
        return as_drawn(false);
    }
    if scale != 1.0 {
        // In physical metres: a zoomed world is the same world.
        let there = |l: &Line| Line::new(l.a * scale, l.b * scale);
        let scaled = Scaffold {
            lines: scaffold.lines.iter().map(there).collect(),
            ticks: scaffold.ticks.iter().map(|t| *t * scale).collect(),
        };
        let options = LineOptions {
            metres_per_world: 1.0,
            ..*options
        };
        // What is asked about is known by its own numbers.
        let may = |c: &Constraint| may(&c.scaled(1.0 / scale));
        let out = correct_where(&there(drawn), &scaled, &options, &may);
        if out.refused {
            return as_drawn(true);
        }
        let back = |all: Vec<Constraint>| all.iter().map(|c| c.scaled(1.0 / scale)).collect();
        return Corrected {
            line: Line::new(out.line.a / scale, out.line.b / scale),
            kept: back(out.kept),
            dropped: back(out.dropped),
            ..out
        };
    }
    let mut line = *drawn;
    let mut kept: Vec<Constraint> = Vec::new();
    let mut dropped = Vec::new();
    let mut iterations = 0;
    for _ in 0..ROUNDS {
        let mut found = candidates(&line, scaffold, options);
        found.retain(may);
        let (settled, took) = select::settle(&line, &found, scale);
        iterations += took;
        let before = line;
        (line, kept, dropped) = meet(drawn, &line, &settled, &found, &kept, scale);
        let moved = line.a.distance(before.a).max(line.b.distance(before.b));
        if moved * scale < 1e-12 {
            break;
        }
    }
    // An end moves by what brings it to a point, and by what turns and stretches the line.
    let farthest =
        options.distance / scale + drawn.length() * (options.angle.sin() + options.length);
    if line.a.distance(drawn.a).max(line.b.distance(drawn.b)) > farthest {
        return as_drawn(true);
    }
    Corrected {
        line,
        kept,
        dropped,
        iterations,
        refused: false,
    }
}

/// The largest set of relations that is met exactly: first what held before, then what the weights
/// settled on, nearest first, then whatever else does not contradict.
fn meet(
    drawn: &Line,
    now: &Line,
    settled: &Line,
    found: &[Constraint],
    held: &[Constraint],
    scale: f64,
) -> (Line, Vec<Constraint>, Vec<Constraint>) {
    // What settled holds to rounding: among such the nearest to what was drawn comes first.
    let weigh = |c: &Constraint| {
        let energy = c.energy(settled, scale);
        if energy < HELD {
            c.energy(drawn, scale) * HELD
        } else {
            energy
        }
    };
    let mut order: Vec<(f64, &Constraint)> = found.iter().map(|c| (weigh(c), c)).collect();
    let holds_now = |c: &Constraint| c.energy(now, scale) < exact::HOLDS * exact::HOLDS;
    order.sort_by(|(a, x), (b, y)| {
        (!holds_now(x), x.rank(), *a)
            .partial_cmp(&(!holds_now(y), y.rank(), *b))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    let mut kept = held.to_vec();
    let (mut line, mut free) = exact::solve(drawn, &kept, scale).unwrap_or((*drawn, 6));
    let mut dropped = Vec::new();
    for &(_, &constraint) in &order {
        if kept.contains(&constraint) {
            continue;
        }
        // Nothing is free: it holds already or it never will.
        if constraint.energy(&line, scale) < exact::HOLDS * exact::HOLDS {
            kept.push(constraint);
            continue;
        }
        let mut with = kept.clone();
        with.push(constraint);
        match (free > 0)
            .then(|| exact::solve(drawn, &with, scale))
            .flatten()
        {
            Some((next, left)) => {
                (line, free, kept) = (next, left, with);
            }
            None => dropped.push(constraint),
        }
    }
    (line, kept, dropped)
}
