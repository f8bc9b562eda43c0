use glam::Vec3;

/// Height over longest side below which a triangle is measured by its sides alone: the normal of
/// a thinner one is lost in rounding.
const THINNEST: f32 = 1e-4;

/// A triangle made ready for distances: one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Triangle {
    pub v: [Vec3; 3],
    /// Unit normal; zero where the triangle is too thin to have one.
    pub n: Vec3,
    /// One over the squared length of the side that starts at each corner; 0 for no length.
    pub inverse: [f32; 3],
    /// What is not above, measured by the sides, lies over the triangle itself: 0, or less than all
    /// numbers for a thin one.
    pub limit: f32,
}

impl Triangle {
    pub fn new(v: [Vec3; 3]) -> Self {
        let cross = (v[1] - v[0]).cross(v[2] - v[0]);
        let mut longest = 0.0f32;
        let inverse = std::array::from_fn(|k| {
            let l = (v[(k + 1) % 3] - v[k]).length_squared();
            longest = longest.max(l);
            if l > 0.0 { 1.0 / l } else { 0.0 }
        });
        let area = cross.length();
        let n = if area > THINNEST * longest {
            cross / area
        } else {
            Vec3::ZERO
        };
        let limit = if n == Vec3::ZERO {
            f32::NEG_INFINITY
        } else {
            0.0
        };
        Self {
            v,
            n,
            inverse,
            limit,
        }
    }

    /// Whether it is too thin to have a normal.
    #[inline]
    pub fn thin(&self) -> bool {
        self.n == Vec3::ZERO
    }

    /// From the closest point of the triangle to `p`.
    #[inline]
    pub fn offset(&self, p: Vec3) -> Vec3 {
        let [a, b, c] = self.v;
        let e = [b - a, c - b, a - c];
        let q = [p - a, p - b, p - c];
        let turn = self.n.cross(q[0]);
        let sides = [e[0].dot(turn), e[1].dot(self.n.cross(q[1])), e[2].dot(turn)];
        let thin = self.thin();
        if !thin && sides.iter().all(|&s| s <= 0.0) {
            return self.n * self.n.dot(q[0]);
        }
        let mut nearest = (f32::INFINITY, Vec3::ZERO);
        for k in 0..3 {
            // The closest side is one that `p` lies beyond.
            if thin || sides[k] > 0.0 {
                let t = (e[k].dot(q[k]) * self.inverse[k]).clamp(0.0, 1.0);
                let r = q[k] - e[k] * t;
                let d = r.length_squared();
                if d < nearest.0 {
                    nearest = (d, r);
                }
            }
        }
        nearest.1
    }

    /// Squared distance from `p`, metres².
    #[inline]
    pub fn distance_squared(&self, p: Vec3) -> f32 {
        self.offset(p).length_squared()
    }

    /// Half the solid angle seen from `p` as the angle of a complex number, its real part first; positive
    /// where `p` lies behind the triangle (van Oosterom and Strackee 1983).
    #[inline]
    pub fn angle(&self, p: Vec3) -> (f64, f64) {
        let [a, b, c] = self.v.map(|v| (v - p).as_dvec3());
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let numerator = a.dot(b.cross(c));
        let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        (denominator, numerator)
    }
}
