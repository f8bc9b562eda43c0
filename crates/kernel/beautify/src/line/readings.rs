//! What else a line could have been meant to be.

use super::{
    Constraint, Corrected, Line, LineOptions, Scaffold, correct::correct_where, correct_line,
};

/// What can be read into one line in several ways is told apart by its ends: they differ by this many
/// physical metres at least.
const APART: f64 = 1e-3;

/// The readings of a drawn line: first what [`correct_line`] makes of it, then others, the nearest to
/// what was drawn first, last the line as it was drawn; at most `most`, which is at least 2, and no two
/// of them look alike.
///
/// Another reading is what comes out when one of the relations kept so far is not meant.
pub fn readings(
    drawn: &Line,
    scaffold: &Scaffold,
    options: &LineOptions,
    most: usize,
) -> Vec<Corrected> {
    let scale = options.metres_per_world;
    let moved = |a: &Line, b: &Line| a.a.distance(b.a).max(a.b.distance(b.b)) * scale;
    let best = correct_line(drawn, scaffold, options);
    let raw = Corrected {
        line: *drawn,
        kept: Vec::new(),
        dropped: Vec::new(),
        iterations: 0,
        refused: best.refused,
    };
    let mut others: Vec<Corrected> = Vec::new();
    // What is asked for by several lines at once is one thing to leave out.
    let mut asked: Vec<Constraint> = Vec::new();
    for constraint in &best.kept {
        if !asked.iter().any(|a| a.is_like(constraint)) {
            asked.push(*constraint);
        }
    }
    let mut consider = |may: &dyn Fn(&Constraint) -> bool| {
        let out = correct_where(drawn, scaffold, options, may);
        let known = [&best, &raw]
            .into_iter()
            .chain(&others)
            .any(|o| moved(&o.line, &out.line) < APART);
        if !known && !out.refused {
            others.push(out);
        }
    };
    for left_out in &asked {
        consider(&|c| !c.is_like(left_out));
    }
    // Ends alone, and directions alone.
    consider(&|c| {
        matches!(
            c,
            Constraint::PointPoint { .. } | Constraint::PointLine { .. }
        )
    });
    consider(&|c| {
        !matches!(
            c,
            Constraint::PointPoint { .. } | Constraint::PointLine { .. }
        )
    });
    others.sort_by(|a, b| moved(&a.line, drawn).total_cmp(&moved(&b.line, drawn)));
    others.truncate(most.saturating_sub(2));
    let changed = moved(&best.line, drawn) >= APART;
    let mut all = vec![best];
    all.extend(others);
    if changed {
        all.push(raw);
    }
    all
}
