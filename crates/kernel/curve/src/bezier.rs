use glam::DVec3;

use crate::Polyline;

/// One cubic segment with control points P₀ … P₃.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CubicBezier(pub [DVec3; 4]);

impl CubicBezier {
    /// The point at `t` in [0, 1].
    pub fn at(&self, t: f64) -> DVec3 {
        let [p0, p1, p2, p3] = self.0;
        let s = 1.0 - t;
        p0 * (s * s * s) + p1 * (3.0 * s * s * t) + p2 * (3.0 * s * t * t) + p3 * (t * t * t)
    }

    /// The derivative by `t`, metres.
    pub fn derivative(&self, t: f64) -> DVec3 {
        let [p0, p1, p2, p3] = self.0;
        let s = 1.0 - t;
        ((p1 - p0) * (s * s) + (p2 - p1) * (2.0 * s * t) + (p3 - p2) * (t * t)) * 3.0
    }
}

/// Cubic segments, each beginning where the one before ends.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spline {
    /// From the first to the last.
    pub segments: Vec<CubicBezier>,
}

impl Spline {
    /// A straight segment, its control points at its thirds.
    pub fn straight(a: DVec3, b: DVec3) -> Self {
        Self {
            segments: vec![CubicBezier([
                a,
                a.lerp(b, 1.0 / 3.0),
                a.lerp(b, 2.0 / 3.0),
                b,
            ])],
        }
    }

    /// Straight pieces, `each` of them to a segment.
    pub fn flattened(&self, each: usize) -> Polyline {
        let each = each.max(1);
        let first = self.segments.first().map(|s| s.0[0]);
        let rest = self
            .segments
            .iter()
            .flat_map(|s| (1..=each).map(move |i| s.at(i as f64 / each as f64)));
        Polyline::new(first.into_iter().chain(rest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_runs_from_end_to_end_along_its_tangents() {
        let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::new(2.0, 1.0, 0.0), DVec3::ONE];
        let s = CubicBezier([a, b, c, d]);
        assert_eq!((s.at(0.0), s.at(1.0)), (a, d));
        assert_eq!(
            (s.derivative(0.0), s.derivative(1.0)),
            ((b - a) * 3.0, (d - c) * 3.0)
        );
    }

    #[test]
    fn a_straight_spline_is_as_long_as_its_ends_are_apart() {
        let s = Spline::straight(DVec3::ZERO, DVec3::new(0.0, 3.0, 4.0));
        assert!((s.flattened(24).length() - 5.0).abs() < 1e-12);
    }
}
