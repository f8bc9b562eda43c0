//! One family of compact kernels and its integrals over skeletons (3DBrushVR §4.1 Eq. 2).
//!
//! f(u) = (1 − u²)² for u < 1, else 0, with u the distance in supports R. The support of a brush of
//! radius r is R = `reach`·r. Every integral is scaled so that it is [`T`] at the distance r from
//! the middle of a skeleton that is long and wide enough to fill the kernel.

use glam::Vec2;

/// The threshold of the surface: inside is where the potential is above (3DBrushVR §4.2.1).
pub const T: f32 = 0.5;

/// Up to this a potential of a polygon is rounding.
const NOTHING: f32 = 4.0e-6;

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

    /// F of a polygon, its edges in its own plane and in supports, counter-clockwise, as seen from a
    /// place at `p` in that plane and `h` above it.
    ///
    /// By Green's theorem an integral over edges: g(ρ) = (a − ρ²)² with a = 1 − h² has
    /// ∫g ρ dρ = ρ²(a²/2 − aρ²/2 + ρ⁴/6) up to ρ² = a and a³/6 beyond, where an edge counts by the
    /// angle it is seen under.
    pub fn at_polygon(&self, edges: &[Edge], p: Vec2, h: f32) -> f32 {
        let (mut sum, mut angle) = (0.0, 0.0);
        for edge in edges {
            let (s, t) = edge.at(p.x, p.y, h * h);
            sum += s;
            angle += t;
        }
        self.polygon_of(sum, angle, h * h)
    }

    /// What the sums over all edges come to.
    #[inline(always)]
    pub fn polygon_of(&self, sum: f32, angle: f32, h2: f32) -> f32 {
        let a = 1.0 - h2;
        let a = if a > 0.0 { a } else { 0.0 };
        // What rounding leaves of the angles where no part is felt is nothing.
        let f = self.polygon * (sum + a * a * a * (1.0 / 6.0) * angle) - NOTHING;
        if f > 0.0 { f } else { 0.0 }
    }

    /// F of a polygon of which one edge alone is felt, and neither of its ends, as seen from a place at
    /// (x, y) whose height squared is `h2`; `right` is the angle of whole turns that the polygon makes
    /// around what lies right of the edge. As [`Self::at_polygon`] up to rounding.
    #[inline(always)]
    pub fn beside_edge(&self, edge: &Edge, x: f32, y: f32, h2: f32, right: f32) -> f32 {
        let a = 1.0 - h2;
        let a = if a > 0.0 { a } else { 0.0 };
        let e = edge.left(x, y);
        let e2 = e * e;
        let left = a - e2;
        let half = (if left > 0.0 { left } else { 0.0 }).sqrt();
        let whole = edge_integral(a, e2, half);
        // What is not felt of the plane left of the edge: all around behind it, nothing before it.
        self.polygon_of(2.0 * e * whole, 2.0 * turn(half, -e) + right, h2)
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
    // Nothing at all where it ends, whatever the rounding.
    if x < 1.0 { f.clamp(0.0, 1.0) } else { 0.0 }
}

/// The greatest slope of [`half_space`].
pub(super) const HALF_SPACE_SLOPE: f32 = 35.0 / 32.0;

/// One edge of a polygon, in supports.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    from: Vec2,
    along: Vec2,
    length: f32,
}

impl Edge {
    /// Those between corners; an edge without a length is none.
    pub fn all(corners: &[Vec2]) -> Vec<Self> {
        let n = corners.len();
        let one = |i: usize| {
            let (from, way) = (corners[i], corners[(i + 1) % n] - corners[i]);
            let length = way.length();
            (length > 0.0).then(|| Self {
                from,
                along: way / length,
                length,
            })
        };
        (0..n).filter_map(one).collect()
    }

    /// Start, unit direction, length.
    pub fn numbers(&self) -> [f32; 5] {
        let (a, b) = (self.from, self.along);
        [a.x, a.y, b.x, b.y, self.length]
    }

    /// What it adds to a place at (x, y): the integral along the part of it that is felt, and the
    /// angle that the rest of it is seen under. Both angles of an edge jump where it is crossed, so
    /// their difference does not.
    #[inline(always)]
    pub fn at(&self, x: f32, y: f32, h2: f32) -> (f32, f32) {
        let a = 1.0 - h2;
        let a = if a > 0.0 { a } else { 0.0 };
        let (qx, qy) = (self.from.x - x, self.from.y - y);
        let e = self.left(x, y);
        let s0 = qx * self.along.x + qy * self.along.y;
        let s1 = s0 + self.length;
        let e2 = e * e;
        let left = a - e2;
        let half = (if left > 0.0 { left } else { 0.0 }).sqrt();
        let (low, high) = (s0.clamp(-half, half), s1.clamp(-half, half));
        // The angle of the whole less that of what is felt, both within a half turn and to one side, as one.
        let (y0, x0) = (e * self.length, e2 + s0 * s1);
        let (y1, x1) = (e * (high - low), e2 + high * low);
        let rest = turn(y0 * x1 - x0 * y1, x0 * x1 + y0 * y1);
        let whole = edge_integral(a, e2, high) - edge_integral(a, e2, low);
        (e * whole, rest)
    }

    /// How far a place lies to the left of it.
    #[inline(always)]
    pub fn left(&self, x: f32, y: f32) -> f32 {
        (self.from.x - x) * self.along.y - (self.from.y - y) * self.along.x
    }

    /// How far a place lies from it.
    pub fn distance(&self, p: Vec2) -> f32 {
        let q = p - self.from;
        (q - self.along * q.dot(self.along).clamp(0.0, self.length)).length()
    }

    /// A place `left` of it, where `p` is held against its line.
    pub fn beside(&self, p: Vec2, left: f32) -> Vec2 {
        p + self.along.perp() * (left - self.left(p.x, p.y))
    }
}

/// G/ρ² = a²/2 − a(e² + s²)/2 + (e² + s²)²/6 along an edge from its middle, across from the place, to `s`.
#[inline(always)]
fn edge_integral(a: f32, e2: f32, s: f32) -> f32 {
    let c0 = a * a * 0.5 - a * e2 * 0.5 + e2 * e2 * (1.0 / 6.0);
    let c2 = (e2 * (1.0 / 3.0) - a * 0.5) * (1.0 / 3.0);
    let s2 = s * s;
    s * (c0 + s2 * (c2 + s2 * (1.0 / 30.0)))
}

/// How often a polygon goes around a place, anticlockwise.
pub(super) fn turns(corners: &[Vec2], p: Vec2) -> i32 {
    let mut count = 0;
    let mut a = corners[corners.len() - 1];
    for &b in corners {
        if (a.y > p.y) != (b.y > p.y) {
            let x = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
            if p.x < x {
                count += if b.y > a.y { 1 } else { -1 };
            }
        }
        a = b;
    }
    count
}

/// atan2(y, x) to 1e-7, free of calls so that loops over it become vector code; 0 where both are 0.
#[inline(always)]
fn turn(y: f32, x: f32) -> f32 {
    let (ax, ay) = (x.abs(), y.abs());
    let (low, high) = if ax < ay { (ax, ay) } else { (ay, ax) };
    let t = low / (if high > 1.0e-30 { high } else { 1.0e-30 });
    let u = t * t;
    let near = 0.999_999_98 + u * (-0.333_330_37 + u * (0.199_918_72 + u * -0.141_977_98));
    let far = 0.106_183_71
        + u * (-0.074_568_55 + u * (0.042_137_624 + u * (-0.015_731_25 + u * 0.002_766_283_5)));
    let r = t * (near + u * u * u * u * far);
    let r = if ax < ay {
        std::f32::consts::FRAC_PI_2 - r
    } else {
        r
    };
    let r = if x < 0.0 { std::f32::consts::PI - r } else { r };
    if y < 0.0 { -r } else { r }
}

/// How far a place lies from the outline of a polygon: positive inside.
pub(super) fn clearance(corners: &[Vec2], p: Vec2) -> f32 {
    let mut nearest = f32::INFINITY;
    let mut a = corners[corners.len() - 1];
    for &b in corners {
        let way = b - a;
        let t = (p - a).dot(way) / way.length_squared().max(f32::MIN_POSITIVE);
        nearest = nearest.min((p - a - way * t.clamp(0.0, 1.0)).length());
        a = b;
    }
    if contains(corners, p) {
        nearest
    } else {
        -nearest
    }
}

/// Whether a place lies in a polygon.
fn contains(corners: &[Vec2], p: Vec2) -> bool {
    let mut inside = false;
    let mut a = corners[corners.len() - 1];
    for &b in corners {
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
    fn turns_are_right() {
        for i in 0..20_000 {
            let a = i as f32 * 3.142e-4 * if i % 2 == 0 { 1.0 } else { -1.0 };
            let (y, x) = (
                (a * 0.5).sin() * (1.0 + i as f32),
                (a * 0.5).cos() * (1.0 + i as f32),
            );
            let exact = f64::from(y).atan2(f64::from(x));
            assert!((f64::from(turn(y, x)) - exact).abs() < 6e-7, "{y} {x}");
        }
        assert_eq!(turn(0.0, 0.0), 0.0);
    }

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
            let got = family.at_polygon(&Edge::all(&corners), Vec2::new(x, y), z);
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
    fn one_edge_is_as_all_edges_where_it_alone_is_felt() {
        let family = Family::new(1.75);
        let plain = [(-4.0, -3.0), (5.0, -3.5), (4.5, 4.0), (-4.0, 3.0)];
        // Goes around once more within, and crosses itself.
        let wound = [
            (-9.0, -9.0),
            (9.0, -9.0),
            (9.0, 9.0),
            (-4.0, 9.0),
            (-4.0, -5.0),
            (5.0, -5.0),
            (5.0, 4.0),
            (-9.0, 4.0),
        ];
        for corners in [&plain[..], &wound[..]] {
            let corners: Vec<Vec2> = corners.iter().map(|c| Vec2::new(c.0, c.1)).collect();
            let edges = Edge::all(&corners);
            for (i, edge) in edges.iter().enumerate() {
                let next = corners[(i + 1) % corners.len()];
                let middle = 0.3 * corners[i] + 0.7 * next;
                let near = edges.iter().filter(|e| e.distance(middle) < 2.3).count();
                if near != 1 {
                    continue;
                }
                let right = turns(&corners, edge.beside(middle, -0.5)) as f32;
                for k in 0..400 {
                    let (along, off) =
                        ((k % 20) as f32 * 0.05 - 0.5, (k / 20) as f32 * 0.13 - 1.25);
                    let p = edge.beside(middle, off) + (next - middle).normalize() * along;
                    for h in [0.0f32, 0.2, 0.7, 0.99, 1.2] {
                        let one = family.beside_edge(
                            edge,
                            p.x,
                            p.y,
                            h * h,
                            right * std::f32::consts::TAU,
                        );
                        let all = family.at_polygon(&edges, p, h);
                        assert!((one - all).abs() < 1e-5, "{p} {h}: {one}, not {all}");
                    }
                }
            }
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
            assert!((family.at_polygon(&Edge::all(&square), Vec2::ZERO, u) - T).abs() < 1e-5);
        }
    }
}
