//! Exact shapes, tessellated: what the training sessions' components are, from their numbers alone.

use midair_field::Primitive;
use midair_mesh::TriMesh;

/// Positions in f64 and triangles, closed once equal positions are joined.
#[derive(Clone, Default)]
pub struct Polyhedron {
    pub positions: Vec<[f64; 3]>,
    pub triangles: Vec<[usize; 3]>,
}

/// Cosine and sine of quarter + i/n quarter turns; exact at whole quarters, so that rings meet.
fn circle(quarter: usize, i: usize, n: usize) -> (f64, f64) {
    let (quarter, i) = (quarter + i / n, i % n);
    let a = std::f64::consts::FRAC_PI_2 * i as f64 / n as f64;
    let (c, s) = if i == 0 {
        (1.0, 0.0)
    } else {
        (a.cos(), a.sin())
    };
    match quarter % 4 {
        0 => (c, s),
        1 => (-s, c),
        2 => (-c, -s),
        _ => (s, -c),
    }
}

impl Polyhedron {
    /// With `n` segments to a quarter turn; `None` for a primitive no training session uses.
    pub fn of(primitive: &Primitive, n: usize) -> Option<Self> {
        Some(match *primitive {
            Primitive::Sphere { radius } => cuboid([0.0; 3], radius.into(), n),
            Primitive::Cuboid { half, rounding } => {
                let r = f64::from(rounding);
                cuboid(half.to_array().map(|h| f64::from(h) - r), r, n)
            }
            Primitive::Cylinder {
                radius,
                half_height,
                rounding,
            } => {
                let r = f64::from(rounding);
                let (x, y) = (f64::from(radius) - r, f64::from(half_height) - r);
                let mut profile = vec![(0.0, -y - r)];
                for (quarter, y) in [(3, -y), (0, y)] {
                    for i in 0..=n {
                        let (c, s) = circle(quarter, i, n);
                        profile.push((x + r * c, y + r * s));
                    }
                }
                profile.push((0.0, y + r));
                revolved(&profile, n)
            }
            Primitive::Torus { major, minor } => {
                let (x, r) = (f64::from(major), f64::from(minor));
                let profile: Vec<_> = (0..=4 * n)
                    .map(|i| circle(i / n, i % n, n))
                    .map(|(c, s)| (x + r * c, r * s))
                    .collect();
                revolved(&profile, n)
            }
            _ => return None,
        })
    }

    /// Rings of equally many points, each joined to the next.
    fn strip(rings: &[Vec<[f64; 3]>]) -> Self {
        let mut p = Self::default();
        let around = rings[0].len();
        p.positions = rings.concat();
        for i in 0..rings.len() - 1 {
            for j in 0..around {
                let (a, b) = (i * around + j, i * around + (j + 1) % around);
                let (c, d) = (a + around, b + around);
                p.triangles.extend([[a, d, b], [a, c, d]]);
            }
        }
        p
    }

    /// Six times the enclosed volume over six.
    pub fn volume(&self) -> f64 {
        let six: f64 = self
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| self.positions[i]);
                a[0] * (b[1] * c[2] - b[2] * c[1])
                    + a[1] * (b[2] * c[0] - b[0] * c[2])
                    + a[2] * (b[0] * c[1] - b[1] * c[0])
            })
            .sum();
        six / 6.0
    }
}

/// A ball of radius `r` at the corners of a box, and what lies between them.
fn cuboid(half: [f64; 3], r: f64, n: usize) -> Polyhedron {
    let mut rings = Vec::new();
    for (quarter, y) in [(3, -half[1]), (0, half[1])] {
        for i in 0..=n {
            let (out, up) = circle(quarter, i, n);
            let mut ring = Vec::new();
            for (quarter, [x, z]) in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
                .into_iter()
                .enumerate()
            {
                for j in 0..=n {
                    let (c, s) = circle(quarter, j, n);
                    ring.push([
                        x * half[0] + r * out * c,
                        y + r * up,
                        z * half[2] + r * out * s,
                    ]);
                }
            }
            rings.push(ring);
        }
    }
    let mut p = Polyhedron::strip(&rings);
    // The top and the bottom: one point of each corner.
    let (step, top) = (n + 1, (rings.len() - 1) * 4 * (n + 1));
    let [a, b, c, d] = [0, step, 2 * step, 3 * step];
    p.triangles.extend([[a, b, c], [a, c, d]]);
    let [a, b, c, d] = [a, b, c, d].map(|i| i + top);
    p.triangles.extend([[a, c, b], [a, d, c]]);
    p
}

/// A profile of (radius, y) from bottom to top, or round in a ring, turned around y.
fn revolved(profile: &[(f64, f64)], n: usize) -> Polyhedron {
    let ring = |&(x, y): &(f64, f64)| {
        let turn = (0..4 * n).map(|j| circle(j / n, j % n, n));
        turn.map(|(c, s)| [x * c, y, x * s]).collect()
    };
    Polyhedron::strip(&profile.iter().map(ring).collect::<Vec<_>>())
}

impl From<&TriMesh> for Polyhedron {
    fn from(mesh: &TriMesh) -> Self {
        Self {
            positions: mesh
                .positions
                .iter()
                .map(|p| p.as_dvec3().to_array())
                .collect(),
            triangles: mesh
                .triangles
                .iter()
                .map(|t| t.map(|i| i as usize))
                .collect(),
        }
    }
}

#[test]
fn the_shapes_have_the_volumes_of_the_solids() {
    use std::f64::consts::PI;
    let cases = [
        (Primitive::Sphere { radius: 0.2 }, 4.0 / 3.0 * PI * 0.008),
        (
            Primitive::Torus {
                major: 0.15,
                minor: 0.05,
            },
            2.0 * PI * PI * 0.15 * 0.0025,
        ),
        (
            Primitive::Cylinder {
                radius: 0.15,
                half_height: 0.2,
                rounding: 0.0,
            },
            PI * 0.0225 * 0.4,
        ),
        (
            Primitive::Cuboid {
                half: glam_vec(0.2, 0.02, 0.2),
                rounding: 0.0,
            },
            0.4 * 0.4 * 0.04,
        ),
        (
            Primitive::Cuboid {
                half: glam_vec(0.2, 0.03, 0.1),
                rounding: 0.02,
            },
            // Steiner: V + S·r + M·r² + 4/3·π·r³ of the box of 0.36 × 0.02 × 0.16.
            0.36 * 0.02 * 0.16
                + 2.0 * (0.36 * 0.02 + 0.02 * 0.16 + 0.36 * 0.16) * 0.02
                + PI * (0.36 + 0.02 + 0.16) * 0.0004
                + 4.0 / 3.0 * PI * 8e-6,
        ),
    ];
    for (primitive, volume) in cases {
        let of = |n| Polyhedron::of(&primitive, n).unwrap().volume();
        let limit = (4.0 * of(64) - of(32)) / 3.0;
        assert!(
            (limit / volume - 1.0).abs() < 1e-5,
            "{primitive:?}: {limit} is not {volume}"
        );
    }
}

fn glam_vec(x: f32, y: f32, z: f32) -> bevy::math::Vec3 {
    bevy::math::Vec3::new(x, y, z)
}
