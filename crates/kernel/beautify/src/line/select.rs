//! Iteratively re-weighted least squares: which relations hold together (Eq. 6–7).

use nalgebra::{Matrix6, Vector6};

use super::{Constraint, Line};

/// ε of Eq. 7: below a millimetre, or a milliradian, a relation counts as met.
const EPSILON: f64 = 1e-6;
/// A relation met before anything moved; it is not weighed against others.
const MET: f64 = 1e-18;
const MOST: usize = 30;

/// The line on which the weights settle, and after how many iterations.
pub(super) fn settle(line: &Line, constraints: &[Constraint], scale: f64) -> (Line, usize) {
    let mut line = *line;
    let mut weights: Vec<f64> = constraints
        .iter()
        .map(|c| {
            if c.energy(&line, scale) < MET {
                1.0 / EPSILON
            } else {
                c.prior()
            }
        })
        .collect();
    for iteration in 1..=MOST {
        let before = line;
        // Angles and lengths bend: a second step of Newton's follows the first.
        for _ in 0..2 {
            step(&mut line, constraints, &weights, scale);
        }
        for (weight, constraint) in weights.iter_mut().zip(constraints) {
            *weight = 1.0 / (EPSILON + constraint.energy(&line, scale));
        }
        let moved = line.a.distance(before.a).max(line.b.distance(before.b)) * scale;
        if moved < 1e-5 {
            return (line, iteration);
        }
    }
    (line, MOST)
}

fn step(line: &mut Line, constraints: &[Constraint], weights: &[f64], scale: f64) {
    let (mut matrix, mut vector) = (Matrix6::zeros(), Vector6::zeros());
    for (constraint, &weight) in constraints.iter().zip(weights) {
        if let Some(residual) = constraint.residual(line, scale) {
            residual.add_to(weight, &mut matrix, &mut vector);
        }
    }
    // What no relation speaks of stays where it was drawn.
    let hold = 1e-9 * matrix.diagonal().max().max(1.0);
    for i in 0..6 {
        matrix[(i, i)] += hold;
    }
    let Some(solution) = matrix.cholesky().map(|c| c.solve(&vector)) else {
        return;
    };
    let next = Line::new(
        line.a - glam::DVec3::new(solution[0], solution[1], solution[2]),
        line.b - glam::DVec3::new(solution[3], solution[4], solution[5]),
    );
    if next.a.is_finite() && next.b.is_finite() && next.length() > 0.2 * line.length() {
        *line = next;
    }
}
