//! Closed formulas. All are branch-free, so that eight nodes are computed at once.

use glam::Vec3;

/// The larger; one instruction where `f32::max` takes three to mind NaN.
#[inline(always)]
pub(crate) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller, likewise.
#[inline(always)]
pub(crate) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(crate) fn hypot(x: f32, y: f32) -> f32 {
    (x * x + y * y).sqrt()
}

/// Distance to the quadrant x ≤ 0, y ≤ 0.
#[inline(always)]
fn quadrant(x: f32, y: f32) -> f32 {
    hypot(greater(x, 0.0), greater(y, 0.0)) + lesser(greater(x, y), 0.0)
}

#[inline(always)]
pub(super) fn sphere(radius: f32, x: f32, y: f32, z: f32) -> f32 {
    (x * x + y * y + z * z).sqrt() - radius
}

#[inline(always)]
pub(super) fn cuboid(half: Vec3, rounding: f32, x: f32, y: f32, z: f32) -> f32 {
    let (a, b, c) = (x.abs() - half.x, y.abs() - half.y, z.abs() - half.z);
    let (p, q, r) = (greater(a, 0.0), greater(b, 0.0), greater(c, 0.0));
    let outside = (p * p + q * q + r * r).sqrt();
    outside + lesser(greater(a, greater(b, c)), 0.0) - rounding
}

#[inline(always)]
pub(super) fn cylinder(radius: f32, half: f32, rounding: f32, x: f32, y: f32, z: f32) -> f32 {
    quadrant(hypot(x, z) - radius, y.abs() - half) - rounding
}

#[inline(always)]
pub(super) fn torus(major: f32, minor: f32, x: f32, y: f32, z: f32) -> f32 {
    hypot(hypot(x, z) - major, y) - minor
}

#[inline(always)]
pub(super) fn capsule(radius: f32, half: f32, x: f32, y: f32, z: f32) -> f32 {
    let along = greater(y.abs() - half, 0.0);
    (x * x + along * along + z * z).sqrt() - radius
}

/// A plane figure's distance `d` extruded to ±(`half` + `rounding`), its rims rounded.
#[inline(always)]
pub(super) fn slab(d: f32, half: f32, rounding: f32, z: f32) -> f32 {
    quadrant(d + rounding, z.abs() - half) - rounding
}

/// A capped cone: the distance to a trapezium in (radius, y).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frustum {
    bottom: f32,
    top: f32,
    half: f32,
    /// From the top rim to the bottom rim.
    side: (f32, f32),
    inverse: f32,
}

impl Frustum {
    pub fn new(bottom: f32, top: f32, half: f32) -> Self {
        let side = (bottom - top, -2.0 * half);
        let inverse = 1.0 / (side.0 * side.0 + side.1 * side.1);
        Self {
            bottom,
            top,
            half,
            side,
            inverse,
        }
    }

    /// Bottom radius, top radius, half height.
    pub fn numbers(&self) -> [f32; 3] {
        [self.bottom, self.top, self.half]
    }

    #[inline(always)]
    pub fn at(&self, x: f32, y: f32, z: f32) -> f32 {
        let r = hypot(x, z);
        let rim = if y < 0.0 { self.bottom } else { self.top };
        let (cap_r, cap_y) = (r - lesser(r, rim), y.abs() - self.half);
        let (dr, dy) = (r - self.top, y - self.half);
        let t = (dr * self.side.0 + dy * self.side.1) * self.inverse;
        let t = lesser(greater(t, 0.0), 1.0);
        let (side_r, side_y) = (dr - t * self.side.0, dy - t * self.side.1);
        let cap = cap_r * cap_r + cap_y * cap_y;
        let d = lesser(cap, side_r * side_r + side_y * side_y).sqrt();
        let inside = (side_r < 0.0) & (cap_y < 0.0);
        if inside { -d } else { d }
    }
}

/// The closest point by Newton's method on the Lagrange multiplier (D. Eberly, "Distance from a
/// point to an ellipse, an ellipsoid, or a hyperellipsoid"), in units of the smallest half extent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ellipsoid {
    unit: f32,
    half: Vec3,
    /// half² − 1: exactly 0 along the shortest axis, so that nothing cancels there.
    excess: Vec3,
}

impl Ellipsoid {
    pub fn new(half: Vec3) -> Self {
        let unit = half.min_element();
        let half = half / unit;
        Self {
            unit,
            half,
            excess: (half - 1.0) * (half + 1.0),
        }
    }

    /// Smallest half extent, half extents in units of it, their squares less 1.
    pub fn numbers(&self) -> (f32, Vec3, Vec3) {
        (self.unit, self.half, self.excess)
    }

    #[inline(always)]
    pub fn at(&self, x: f32, y: f32, z: f32) -> f32 {
        let (e, s) = (self.half, self.excess);
        let scale = 1.0 / self.unit;
        // Off the symmetry planes by less than matters: on them the closest point may not be
        // reached by the formula.
        let lift = 1.0e-6;
        let (x, y, z) = (
            greater(x.abs() * scale, lift * e.x),
            greater(y.abs() * scale, lift * e.y),
            greater(z.abs() * scale, lift * e.z),
        );
        let (ax, ay, az) = (e.x * x, e.y * y, e.z * z);
        // The multiplier is w − 1. Here one term of F(w) = Σ (e·p / (w + e² − 1))² − 1 is exactly
        // one, so F ≥ 0; F is convex and falls, so that Newton's method rises to the root without
        // passing it.
        let mut w = greater(ax - s.x, greater(ay - s.y, az - s.z));
        for _ in 0..10 {
            let (ix, iy, iz) = (1.0 / (w + s.x), 1.0 / (w + s.y), 1.0 / (w + s.z));
            let (rx, ry, rz) = (ax * ix, ay * iy, az * iz);
            let (qx, qy, qz) = (rx * rx, ry * ry, rz * rz);
            let f = qx + qy + qz - 1.0;
            let slope = 2.0 * (qx * ix + qy * iy + qz * iz);
            w += greater(f, 0.0) / slope;
        }
        let t = w - 1.0;
        let (dx, dy, dz) = (x * t / (w + s.x), y * t / (w + s.y), z * t / (w + s.z));
        let d = (dx * dx + dy * dy + dz * dz).sqrt() * self.unit;
        if t < 0.0 { -d } else { d }
    }
}
