//! Distances from eight places at once.

use super::lanes::{EIGHT, F8, Simd};
use super::triangle::Triangle;

/// What eight places measure of a triangle each.
pub(super) struct Found<S: Simd> {
    /// From the closest point of the triangle to the place, by axis, and the square of that: as
    /// [`Triangle::offset`] up to rounding.
    pub by: [F8<S>; 3],
    pub square: F8<S>,
    /// The triangle's normal, or nothing for one that is too thin, and how high above its plane the
    /// place is.
    pub n: [F8<S>; 3],
    pub height: F8<S>,
}

#[inline(always)]
pub(super) fn offsets<S: Simd>(
    s: S,
    triangles: &[Triangle],
    ids: &[u32; EIGHT],
    at: [F8<S>; 3],
) -> Found<S> {
    let all = s.gather(triangles, ids);
    let n = three(s, &all, 9);
    let mut square = F8::splat(s, f32::INFINITY);
    let mut by = [F8::splat(s, 0.0); 3];
    let mut side = F8::splat(s, f32::NEG_INFINITY);
    for k in 0..3 {
        let (v, w) = (three(s, &all, 3 * k), three(s, &all, 3 * ((k + 1) % 3)));
        let e = [w[0] - v[0], w[1] - v[1], w[2] - v[2]];
        let d = [at[0] - v[0], at[1] - v[1], at[2] - v[2]];
        let t = held(s, dot(e, d) * F8(s, all[12 + k]));
        let r = [d[0] - e[0] * t, d[1] - e[1] * t, d[2] - e[2] * t];
        let found = dot(r, r);
        let closer = found.less(square);
        square = closer.choose(found, square);
        for i in 0..3 {
            by[i] = closer.choose(r[i], by[i]);
        }
        let m = [
            e[1] * n[2] - e[2] * n[1],
            e[2] * n[0] - e[0] * n[2],
            e[0] * n[1] - e[1] * n[0],
        ];
        side = dot(m, d).max(side);
    }
    let v = three(s, &all, 0);
    let height = dot(n, [at[0] - v[0], at[1] - v[1], at[2] - v[2]]);
    // Beyond a side where that is more than the limit.
    let beyond = F8(s, all[15]).less(side);
    square = beyond.choose(square, height * height);
    for i in 0..3 {
        by[i] = beyond.choose(by[i], n[i] * height);
    }
    Found {
        by,
        square,
        n,
        height,
    }
}

#[inline(always)]
fn three<S: Simd>(s: S, all: &[S::F; 16], at: usize) -> [F8<S>; 3] {
    [F8(s, all[at]), F8(s, all[at + 1]), F8(s, all[at + 2])]
}

#[inline(always)]
pub(super) fn dot<S: Simd>(a: [F8<S>; 3], b: [F8<S>; 3]) -> F8<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Within 0 and 1.
#[inline(always)]
fn held<S: Simd>(s: S, t: F8<S>) -> F8<S> {
    t.max(F8::splat(s, 0.0)).min(F8::splat(s, 1.0))
}

/// A triangle seen from rows of eight places along x.
pub(super) struct Seen {
    v: [[f32; 3]; 3],
    /// Along each side, and across it within the plane.
    e: [[f32; 3]; 3],
    m: [[f32; 3]; 3],
    n: [f32; 3],
    inverse: [f32; 3],
    limit: f32,
}

impl Seen {
    #[inline(always)]
    pub fn new(t: &Triangle) -> Self {
        let e = [t.v[1] - t.v[0], t.v[2] - t.v[1], t.v[0] - t.v[2]];
        Self {
            v: t.v.map(|v| v.to_array()),
            e: e.map(|e| e.to_array()),
            m: e.map(|e| e.cross(t.n).to_array()),
            n: t.n.to_array(),
            inverse: t.inverse,
            limit: t.limit,
        }
    }

    /// Squared distances from the places (`x`, `y`, `z`).
    #[inline(always)]
    pub fn squares<S: Simd>(&self, s: S, x: F8<S>, y: f32, z: f32) -> F8<S> {
        let mut nearest = F8::splat(s, f32::INFINITY);
        let mut side = F8::splat(s, f32::NEG_INFINITY);
        for k in 0..3 {
            let (v, e, m) = (&self.v[k], &self.e[k], &self.m[k]);
            let (dy, dz) = (y - v[1], z - v[2]);
            let dx = x - F8::splat(s, v[0]);
            let along = F8::splat(s, e[1] * dy + e[2] * dz);
            let across = F8::splat(s, m[1] * dy + m[2] * dz);
            let inverse = F8::splat(s, self.inverse[k]);
            let t = held(s, (F8::splat(s, e[0]) * dx + along) * inverse);
            let r = [
                dx - F8::splat(s, e[0]) * t,
                F8::splat(s, dy) - F8::splat(s, e[1]) * t,
                F8::splat(s, dz) - F8::splat(s, e[2]) * t,
            ];
            nearest = dot(r, r).min(nearest);
            side = (F8::splat(s, m[0]) * dx + across).max(side);
        }
        let v = &self.v[0];
        let level = F8::splat(s, self.n[1] * (y - v[1]) + self.n[2] * (z - v[2]));
        let height = F8::splat(s, self.n[0]) * (x - F8::splat(s, v[0])) + level;
        let beyond = F8::splat(s, self.limit).less(side);
        beyond.choose(nearest, height * height)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::super::lanes::{Plain, lanes};
    use super::*;

    fn at(i: usize) -> Vec3 {
        let a = i as f32;
        Vec3::new((1.3 * a).sin(), (2.1 * a).cos(), (0.7 * a + 0.3).sin())
    }

    type Seen8 = ([f32; 8], [[f32; 8]; 3], [f32; 8]);

    lanes!(found, found_avx2, found_any, (t: &[Triangle], p: &[[f32; 8]; 3]) -> Seen8);

    #[inline(always)]
    fn found_any<S: Simd>(s: S, t: &[Triangle], p: &[[f32; 8]; 3]) -> Seen8 {
        let places = [0, 1, 2].map(|k| F8::load(s, &p[k], 0));
        let Found { by, square, .. } = offsets(s, t, &[0, 1, 2, 3, 4, 5, 6, 7], places);
        let row = Seen::new(&t[3]).squares(s, places[0], p[1][0], p[2][0]);
        (square.lanes(), by.map(|b| b.lanes()), row.lanes())
    }

    #[test]
    fn eight_are_as_one_by_one_and_as_in_wide_registers() {
        let mut triangles: Vec<Triangle> = (0..6)
            .map(|i| Triangle::new([at(3 * i), at(3 * i + 1), at(3 * i + 2)]))
            .collect();
        let sliver = [Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1e-6, 0.0)];
        triangles.extend([Triangle::new(sliver), Triangle::new([Vec3::X; 3])]);
        for i in 0..200 {
            let p: [Vec3; 8] = std::array::from_fn(|k| 1.5 * at(i + 40 + 7 * k));
            let places = [0, 1, 2].map(|axis| p.map(|p| p[axis]));
            let all = found(&triangles, &places);
            assert_eq!(all, found_any(Plain, &triangles, &places));
            let (square, by, row) = all;
            for (k, t) in triangles.iter().enumerate() {
                let by = Vec3::from_array(by.map(|b| b[k]));
                assert!((square[k] - t.distance_squared(p[k])).abs() < 2e-6);
                assert!((by - t.offset(p[k])).length() < 2e-3);
            }
            for (x, d) in places[0].iter().zip(row) {
                let p = Vec3::new(*x, p[0].y, p[0].z);
                assert!((d - triangles[3].distance_squared(p)).abs() < 2e-6);
            }
        }
    }
}
