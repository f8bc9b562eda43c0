//! Eight triangles at once, in loops over them that become vector code.

use glam::Vec3;

use super::triangle::Triangle;

/// Triangles in a leaf of the tree.
pub(super) const EIGHT: usize = 8;

type Lanes = [f32; EIGHT];

/// Up to eight triangles, coordinate by coordinate; the last one again where there are fewer.
#[derive(Clone, Debug)]
pub(super) struct Eight {
    /// By corner and axis.
    v: [[Lanes; 3]; 3],
    n: [Lanes; 3],
    /// One over the squared length of the side that starts at each corner.
    inverse: [Lanes; 3],
    /// What is not above lies over the triangle itself: 0, or less than all numbers for a thin one.
    limit: Lanes,
}

impl Eight {
    /// `ids` must not be empty.
    pub fn new(ids: &[u32], triangles: &[Triangle]) -> Self {
        let mut all = Self {
            v: [[[0.0; EIGHT]; 3]; 3],
            n: [[0.0; EIGHT]; 3],
            inverse: [[0.0; EIGHT]; 3],
            limit: [0.0; EIGHT],
        };
        for i in 0..EIGHT {
            let t = &triangles[ids[i.min(ids.len() - 1)] as usize];
            for k in 0..3 {
                for axis in 0..3 {
                    all.v[k][axis][i] = t.v[k][axis];
                }
                all.n[k][i] = t.n[k];
                all.inverse[k][i] = t.inverse[k];
            }
            all.limit[i] = if t.thin() { f32::NEG_INFINITY } else { 0.0 };
        }
        all
    }

    /// The squared distance of each from `p`, as [`Triangle::distance_squared`] up to rounding.
    pub fn distances(&self, p: Vec3) -> Lanes {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has AVX2, as just asked.
            return unsafe { self.distances_avx2(p) };
        }
        self.distances_any(p)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn distances_avx2(&self, p: Vec3) -> Lanes {
        self.distances_any(p)
    }

    #[inline(always)]
    fn distances_any(&self, p: Vec3) -> Lanes {
        let mut nearest = [f32::INFINITY; EIGHT];
        let mut side = [f32::NEG_INFINITY; EIGHT];
        let [nx, ny, nz] = &self.n;
        for k in 0..3 {
            let ([x, y, z], [u, v, w]) = (&self.v[k], &self.v[(k + 1) % 3]);
            let inverse = &self.inverse[k];
            for i in 0..EIGHT {
                let (ex, ey, ez) = (u[i] - x[i], v[i] - y[i], w[i] - z[i]);
                let (dx, dy, dz) = (p.x - x[i], p.y - y[i], p.z - z[i]);
                let t = ((ex * dx + ey * dy + ez * dz) * inverse[i]).clamp(0.0, 1.0);
                let (rx, ry, rz) = (dx - ex * t, dy - ey * t, dz - ez * t);
                let d = rx * rx + ry * ry + rz * rz;
                nearest[i] = if d < nearest[i] { d } else { nearest[i] };
                let (mx, my, mz) = (
                    ey * nz[i] - ez * ny[i],
                    ez * nx[i] - ex * nz[i],
                    ex * ny[i] - ey * nx[i],
                );
                let s = mx * dx + my * dy + mz * dz;
                side[i] = if s > side[i] { s } else { side[i] };
            }
        }
        let [x, y, z] = &self.v[0];
        for i in 0..EIGHT {
            let height = nx[i] * (p.x - x[i]) + ny[i] * (p.y - y[i]) + nz[i] * (p.z - z[i]);
            let over = side[i] <= self.limit[i];
            nearest[i] = if over { height * height } else { nearest[i] };
        }
        nearest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_are_as_one_by_one() {
        let at = |i: usize| {
            let a = i as f32;
            Vec3::new((1.3 * a).sin(), (2.1 * a).cos(), (0.7 * a + 0.3).sin())
        };
        let mut triangles: Vec<Triangle> = (0..6)
            .map(|i| Triangle::new([at(3 * i), at(3 * i + 1), at(3 * i + 2)]))
            .collect();
        triangles.push(Triangle::new([
            Vec3::ZERO,
            Vec3::X,
            Vec3::new(0.5, 1e-6, 0.0),
        ]));
        let ids: Vec<u32> = (0..triangles.len() as u32).collect();
        let eight = Eight::new(&ids, &triangles);
        for i in 0..200 {
            let p = 1.5 * at(i + 40);
            let d = eight.distances(p);
            for (t, d) in triangles.iter().zip(d) {
                assert!((d - t.distance_squared(p)).abs() < 2e-6);
            }
        }
    }
}
