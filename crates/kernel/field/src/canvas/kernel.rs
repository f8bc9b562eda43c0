//! One family of compact kernels and its integrals over skeletons (3DBrushVR §4.1 Eq. 2).
//!
//! f(u) = (1 − u²)² for u < 1, else 0, with u the distance in supports R. The support of a brush of
//! radius r is R = `reach`·r. Every integral is scaled so that it is [`T`] at the distance r from
//! the middle of a skeleton that is long and wide enough to fill the kernel.

use glam::{DVec2, Vec2};

/// The threshold of the surface: inside is where the potential is above (3DBrushVR §4.2.1).
pub const T: f32 = 0.5;

/// What the reach of a canvas makes of the family.
#[derive(Clone, Copy, Debug)]
pub(super) struct Family {
    /// Support over radius, above 1.
    pub reach: f32,
    /// 1/reach².
    pub inverse: f32,
    /// The potential at a point skeleton.
    pub point: f32,
    /// Weight of a line of support 1.
    pub line: f32,
    /// Weight of a polygon of support 1.
    pub polygon: f32,
}

impl Family {
    pub fn new(reach: f32) -> Self {
        let inverse = 1.0 / (reach * reach);
        let a = 1.0 - inverse;
        let root = a.sqrt();
        Self {
            reach,
            inverse,
            point: T / (a * a),
            line: T * 15.0 / (16.0 * a * a * root),
            polygon: 3.0 * T / (std::f32::consts::PI * a * a * a),
        }
    }

    /// Metres for one unit of potential at the surface of a point brush of radius `r`: the inverse
    /// of the slope there.
    pub fn scale(&self, r: f32) -> f32 {
        r * (self.reach * self.reach - 1.0) / (4.0 * T)
    }

    /// Bounds of |∇F|, for support 1, of a point, a line and a polygon.
    pub fn slopes(&self) -> [f32; 3] {
        // The greatest of 4u(1−u²), 5u√(1−u²)³ and 6u(1−u²)²; where a line or polygon ends, its
        // potential also falls along itself, by no more than the kernel or its integral over a line.
        let line = (self.line * 16.0 / 15.0 * 1.6238).hypot(self.line);
        let third = std::f32::consts::FRAC_PI_3;
        let polygon = (self.polygon * third * 1.7174).hypot(self.polygon * 16.0 / 15.0);
        [self.point * 1.5397, line, polygon]
    }

    /// F of a point at the squared distance u² in radii.
    #[inline(always)]
    pub fn at_point(&self, u2: f32) -> f32 {
        let a = 1.0 - u2 * self.inverse;
        let a = if a > 0.0 { a } else { 0.0 };
        self.point * a * a
    }

    /// F of a line from `s0` to `s1` along itself as seen from a place at the squared distance `d2`
    /// from its axis; all in supports.
    #[inline(always)]
    pub fn at_line(&self, d2: f32, s0: f32, s1: f32) -> f32 {
        let a = 1.0 - d2;
        let a = if a > 0.0 { a } else { 0.0 };
        let half = a.sqrt();
        let low = s0.clamp(-half, half);
        let high = s1.clamp(-half, half);
        let whole = |s: f32| {
            let s2 = s * s;
            s * (a * a - s2 * (a * (2.0 / 3.0) - s2 * 0.2))
        };
        let f = self.line * (whole(high) - whole(low));
        if f > 0.0 { f } else { 0.0 }
    }

    /// F of a polygon, its corners in its own plane and in supports, counter-clockwise, as seen
    /// from a place at `p` in that plane and `h` above it.
    ///
    /// By Green's theorem an integral over edges: g(ρ) = (a − ρ²)² with a = 1 − h² has
    /// ∫g ρ dρ = ρ²(a²/2 − aρ²/2 + ρ⁴/6) up to ρ² = a and a³/6 beyond, where an edge counts by the
    /// angle it is seen under.
    pub fn at_polygon(&self, corners: &[Vec2], p: Vec2, h: f32) -> f32 {
        // On an edge the angle it is seen under is not defined: a place beside it will do.
        let aside = DVec2::new(1.7e-7, 1.3e-7);
        (0..4)
            .map(|i| p.as_dvec2() + aside * f64::from(i))
            .find_map(|p| self.beside_edges(corners, p, f64::from(h)))
            .unwrap_or(0.0)
    }

    fn beside_edges(&self, corners: &[Vec2], p: DVec2, h: f64) -> Option<f32> {
        let a = 1.0 - h * h;
        if a <= 0.0 {
            return Some(0.0);
        }
        let inside = contains(corners, p);
        let most = a * a * a / 6.0;
        let mut angle = if inside { std::f64::consts::TAU } else { 0.0 };
        let mut sum = 0.0;
        let mut from = corners[corners.len() - 1].as_dvec2();
        for to in corners.iter().map(|c| c.as_dvec2()) {
            let start = from;
            from = to;
            let along = to - start;
            let length = along.length();
            if length <= 0.0 {
                continue;
            }
            let along = along / length;
            let q = start - p;
            // Positive where the place lies to the left.
            let e = q.perp_dot(along);
            if e * e >= a {
                continue;
            }
            let s0 = q.dot(along);
            let half = (a - e * e).sqrt();
            let low = s0.clamp(-half, half);
            let high = (s0 + length).clamp(-half, half);
            if high <= low {
                continue;
            }
            if e.abs() < 1.0e-8 && low < 1.0e-8 && high > -1.0e-8 {
                return None;
            }
            angle -= libm::atan2(e * (high - low), e * e + high * low);
            // G/ρ² = a²/2 − a(e² + s²)/2 + (e² + s²)²/6 along the edge.
            let e2 = e * e;
            let c0 = a * a / 2.0 - a * e2 / 2.0 + e2 * e2 / 6.0;
            let c2 = e2 / 3.0 - a / 2.0;
            let whole = |s: f64| {
                let s2 = s * s;
                s * (c0 + s2 * (c2 / 3.0 + s2 / 30.0))
            };
            sum += e * (whole(high) - whole(low));
        }
        Some((f64::from(self.polygon) * (sum + most * angle)).max(0.0) as f32)
    }

    /// F of a plane without end at the distance `h`, in supports.
    pub fn at_plane(&self, h: f32) -> f32 {
        let a = (1.0 - h * h).max(0.0);
        self.polygon * std::f32::consts::FRAC_PI_3 * a * a * a
    }

    /// F of a line without end at the distance `d`, in supports.
    pub fn at_axis(&self, d: f32) -> f32 {
        let a = (1.0 - d * d).max(0.0);
        self.line * 16.0 / 15.0 * a * a * a.sqrt()
    }
}

/// The potential next to a solid: the kernel's integral over a half-space whose surface is `x`
/// supports away, negative inside. 1 inside, 0 outside, [`T`] on the surface.
#[inline(always)]
pub(super) fn half_space(x: f32) -> f32 {
    let x = x.clamp(-1.0, 1.0);
    let x2 = x * x;
    let f = 0.5 - 35.0 / 32.0 * x * (1.0 - x2 * (1.0 - x2 * (0.6 - x2 / 7.0)));
    f.clamp(0.0, 1.0)
}

/// The greatest slope of [`half_space`].
pub(super) const HALF_SPACE_SLOPE: f32 = 35.0 / 32.0;

/// Whether a place lies in a polygon.
fn contains(corners: &[Vec2], p: DVec2) -> bool {
    let mut inside = false;
    let mut a = corners[corners.len() - 1].as_dvec2();
    for b in corners.iter().map(|c| c.as_dvec2()) {
        if (a.y > p.y) != (b.y > p.y) {
            let x = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
            inside ^= p.x < x;
        }
        a = b;
    }
    inside
}

/// x^p for x ≥ 0, to about 1e-6 of itself. The same bits on every machine, and free of calls so
/// that loops over it become vector code.
#[inline(always)]
pub(super) fn power(x: f32, p: f32) -> f32 {
    let bits = x.to_bits();
    // The mantissa between √½ and √2.
    let shifted = bits.wrapping_sub(0x3f35_04f3);
    let exponent = (shifted as i32 >> 23) as f32;
    let m = f32::from_bits((shifted & 0x007f_ffff).wrapping_add(0x3f35_04f3));
    let s = (m - 1.0) / (m + 1.0);
    let s2 = s * s;
    let series = 1.0 + s2 * (1.0 / 3.0 + s2 * (0.2 + s2 * (1.0 / 7.0 + s2 / 9.0)));
    let log = exponent + s * series * (2.0 * std::f32::consts::LOG2_E);
    let y = (log * p).clamp(-126.0, 126.0);
    let whole = (y + 12_582_912.0) - 12_582_912.0;
    let f = (y - whole) * std::f32::consts::LN_2;
    let e = 1.0
        + f * (1.0
            + f * (0.5 + f * (1.0 / 6.0 + f * (1.0 / 24.0 + f * (1.0 / 120.0 + f / 720.0)))));
    let raised = e * f32::from_bits(((whole as i32 + 127) << 23) as u32);
    if x > 1.0e-12 { raised } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_right() {
        for x in [1e-6f32, 0.01, 0.3, 0.5, 0.9, 1.0, 1.7, 40.0] {
            for p in [0.1f32, 0.5, 1.0, 2.5, 8.0] {
                let exact = f64::from(x).powf(f64::from(p));
                if exact > 1e-30 {
                    let off = (f64::from(power(x, p)) - exact).abs() / exact;
                    assert!(off < 2e-5, "{x}^{p}: {off}");
                }
            }
        }
        assert_eq!(power(0.0, 2.0), 0.0);
    }

    /// Each closed form is the sum of the kernel over many small parts.
    #[test]
    fn closed_forms_match_quadrature() {
        let family = Family::new(1.75);
        let f = |u2: f64| {
            if u2 < 1.0 {
                (1.0 - u2) * (1.0 - u2)
            } else {
                0.0
            }
        };
        for (d, s0, s1) in [
            (0.1, -0.4, 0.9),
            (0.5, 0.2, 3.0),
            (0.8, -2.0, 2.0),
            (0.0, 0.3, 0.31),
        ] {
            let n = 20_000;
            let h = (s1 - s0) / f64::from(n);
            let sum: f64 = (0..n)
                .map(|i| s0 + (f64::from(i) + 0.5) * h)
                .map(|s| f(d * d + s * s) * h)
                .sum();
            let got = family.at_line((d * d) as f32, s0 as f32, s1 as f32);
            assert!((f64::from(family.line) * sum - f64::from(got)).abs() < 1e-4);
        }
        // A polygon with a bay.
        let corners = [
            (-0.9, -0.5),
            (0.6, -0.7),
            (0.2, 0.0),
            (0.8, 0.6),
            (-0.5, 0.5),
        ];
        let corners = corners.map(|(x, y)| Vec2::new(x, y));
        let (rows, across) = (4000, 200);
        for (x, y, z) in [
            (0.0, 0.0, 0.2),
            (0.3, -0.69, 0.0),
            (-0.9, -0.5, 0.3),
            (0.9, 0.0, 0.1),
        ] {
            let mut sum = 0.0;
            let h = 1.4 / f64::from(rows);
            for row in 0..rows {
                let v = -0.75 + (f64::from(row) + 0.5) * h;
                // Where the row crosses the outline: inside between the first and the second, ...
                let mut cuts: Vec<f64> = (0..5)
                    .map(|i| (corners[i].as_dvec2(), corners[(i + 1) % 5].as_dvec2()))
                    .filter(|(a, b)| (a.y > v) != (b.y > v))
                    .map(|(a, b)| a.x + (v - a.y) / (b.y - a.y) * (b.x - a.x))
                    .collect();
                cuts.sort_by(f64::total_cmp);
                for cut in cuts.chunks(2) {
                    let w = (cut[1] - cut[0]) / f64::from(across);
                    for i in 0..across {
                        let u = cut[0] + (f64::from(i) + 0.5) * w;
                        let (dx, dy) = (u - f64::from(x), v - f64::from(y));
                        sum += f(dx * dx + dy * dy + f64::from(z * z)) * w * h;
                    }
                }
            }
            let got = family.at_polygon(&corners, Vec2::new(x, y), z);
            let off = f64::from(family.polygon) * sum - f64::from(got);
            assert!(off.abs() < 1e-4, "{x} {y} {z}: {off}");
        }
        // The half-space is the ball kernel's integral over what lies beyond a plane.
        for x in [-0.7, -0.2, 0.0, 0.4, 0.95] {
            let n = 4000;
            let sum = |from: f64| {
                let h = (1.0 - from) / f64::from(n);
                (0..n)
                    .map(|i| from + (f64::from(i) + 0.5) * h)
                    .map(|t| (1.0 - t * t).powi(3) * h)
                    .sum::<f64>()
            };
            let exact = sum(x) / sum(-1.0);
            assert!((exact - f64::from(half_space(x as f32))).abs() < 1e-5);
        }
    }

    #[test]
    fn a_brush_of_radius_r_has_its_surface_at_r() {
        for reach in [1.2f32, 1.75, 2.5] {
            let family = Family::new(reach);
            let u = 1.0 / reach;
            assert!((family.at_point(1.0) - T).abs() < 1e-6);
            assert!((family.at_axis(u) - T).abs() < 1e-5);
            assert!((family.at_line(u * u, -5.0, 5.0) - T).abs() < 1e-5);
            assert!((family.at_plane(u) - T).abs() < 1e-5);
            let square = [(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)];
            let square = square.map(|(x, y)| Vec2::new(x, y));
            assert!((family.at_polygon(&square, Vec2::ZERO, u) - T).abs() < 1e-5);
        }
    }
}
