//! The line nearest to the drawn one that meets a set of relations exactly.

use glam::DVec3;
use nalgebra::{Matrix6, SymmetricEigen, Vector6};

use super::{Constraint, Line};

/// A relation holds when its residual is smaller than this: metres, radians, a ratio.
pub(super) const HOLDS: f64 = 1e-10;
/// Directions in which relations have this little to say are free.
const RANK: f64 = 1e-9;

/// Meets all of `constraints` while it moves `drawn` as little as can be; `None` where they
/// contradict each other. Says how many of the six freedoms are left.
pub(super) fn solve(drawn: &Line, constraints: &[Constraint], scale: f64) -> Option<(Line, usize)> {
    let mut line = *drawn;
    let mut free = 6;
    for _ in 0..40 {
        let (mut matrix, mut vector) = (Matrix6::zeros(), Vector6::zeros());
        let mut worst = 0.0_f64;
        let mut linear = Vec::with_capacity(constraints.len());
        for constraint in constraints {
            let residual = constraint.residual(&line, scale)?;
            worst = worst.max(residual.value.length());
            linear.push(residual);
        }
        // min ‖x − x₀‖ with J (x − xₖ) = −r: the shift from the drawn line is J⁺ (J (xₖ − x₀) − r).
        for residual in &mut linear {
            residual.value = residual.by_a * (line.a - drawn.a)
                + residual.by_b * (line.b - drawn.b)
                - residual.value;
            residual.add_to(1.0, &mut matrix, &mut vector);
        }
        let eigen = SymmetricEigen::new(matrix);
        let least = RANK * eigen.eigenvalues.max();
        let mut shift = Vector6::zeros();
        free = 6;
        for (value, direction) in eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter())
        {
            if *value > least {
                shift += direction * (direction.dot(&vector) / value);
                free -= 1;
            }
        }
        let next = Line::new(
            drawn.a + DVec3::new(shift[0], shift[1], shift[2]),
            drawn.b + DVec3::new(shift[3], shift[4], shift[5]),
        );
        if !next.a.is_finite() || !next.b.is_finite() {
            return None;
        }
        let moved = next.a.distance(line.a).max(next.b.distance(line.b)) * scale;
        line = next;
        if moved < 1e-13 || worst < 1e-13 && moved < 1e-10 {
            break;
        }
    }
    let met = |c: &Constraint| c.energy(&line, scale) < HOLDS * HOLDS;
    (line.length() > 0.2 * drawn.length() && constraints.iter().all(met)).then_some((line, free))
}
