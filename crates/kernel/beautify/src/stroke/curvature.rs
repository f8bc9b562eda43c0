//! The curvature of three neighbouring samples and its derivative.

use glam::DVec3;

/// Keeps the curvature of samples on one spot finite.
const TINY: f64 = 1e-12;

/// c(bᵢ) alone, with fewer roots.
pub(super) fn bent(before: DVec3, at: DVec3, after: DVec3) -> f64 {
    let (a, c, e) = (before - at, after - at, after - before);
    let sides = a.length_squared() * c.length_squared() * e.length_squared();
    2.0 * a.cross(c).length() / (sides.sqrt() + TINY)
}

/// c(bᵢ) = 4A / (‖a‖ ‖c‖ ‖e‖) of the triangle before, at, after (Eq. 8), and its derivative by the
/// three points.
pub(super) fn menger(before: DVec3, at: DVec3, after: DVec3) -> (f64, [DVec3; 3]) {
    let (a, c, e) = (before - at, after - at, after - before);
    let cross = a.cross(c);
    // Straight samples have no curvature and no direction to bend in.
    let area = cross.length();
    let (la, lc, le) = (a.length(), c.length(), e.length());
    let below = la * lc * le + TINY;
    let value = 2.0 * area / below;
    if area < 1e-300 || la < 1e-300 || lc < 1e-300 || le < 1e-300 {
        return (value, [DVec3::ZERO; 3]);
    }
    // d area = n·(da × c + a × dc) with n = cross / area.
    let n = cross / area;
    let (by_a, by_c) = (c.cross(n), n.cross(a));
    let factor = -value / below;
    let below_a = a * (lc * le / la);
    let below_c = c * (la * le / lc);
    let below_e = e * (la * lc / le);
    let grad_a = by_a * (2.0 / below) + below_a * factor;
    let grad_c = by_c * (2.0 / below) + below_c * factor;
    let grad_e = below_e * factor;
    (value, [grad_a - grad_e, -grad_a - grad_c, grad_c + grad_e])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_circle_have_its_curvature() {
        let at = |t: f64| DVec3::new(2.0 * t.cos(), 2.0 * t.sin(), 1.0);
        assert!((menger(at(0.1), at(0.4), at(0.9)).0 - 0.5).abs() < 1e-12);
        assert!((bent(at(0.1), at(0.4), at(0.9)) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_derivative_is_that_of_small_differences() {
        let p = [
            DVec3::new(0.1, 0.2, 0.0),
            DVec3::new(0.4, 0.1, 0.3),
            DVec3::new(0.9, 0.5, 0.2),
        ];
        let (_, gradient) = menger(p[0], p[1], p[2]);
        for i in 0..3 {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let h = 1e-6;
                let value = |s: f64| {
                    let mut q = p;
                    q[i] += axis * (s * h);
                    menger(q[0], q[1], q[2]).0
                };
                let difference = (value(1.0) - value(-1.0)) / (2.0 * h);
                assert!((difference - gradient[i].dot(axis)).abs() < 1e-6);
            }
        }
    }
}
