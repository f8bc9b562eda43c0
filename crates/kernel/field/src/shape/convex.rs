use glam::Vec3;
use parry3d::transformation::try_convex_hull;
use rustc_hash::FxHashMap;

use super::round::{greater, lesser};
use super::{NODES, Points};
use crate::{ConvexView, PrimitiveError};

/// A convex polyhedron: its face planes for the inside, its faces and edges for the outside.
#[derive(Clone, Debug)]
pub(crate) struct Convex {
    planes: Vec<Plane>,
    /// For each face the walls that stand on its edges: a point below all of them projects into it.
    walls: Vec<Vec<Plane>>,
    edges: Vec<Edge>,
}

#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: Vec3,
    offset: f32,
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    a: Vec3,
    d: Vec3,
    inverse: f32,
}

impl Plane {
    #[inline(always)]
    fn at(&self, x: f32, y: f32, z: f32) -> f32 {
        self.normal.x * x + self.normal.y * y + self.normal.z * z - self.offset
    }
}

impl Edge {
    #[inline(always)]
    fn square(&self, x: f32, y: f32, z: f32) -> f32 {
        let (px, py, pz) = (x - self.a.x, y - self.a.y, z - self.a.z);
        let t = (px * self.d.x + py * self.d.y + pz * self.d.z) * self.inverse;
        let t = lesser(greater(t, 0.0), 1.0);
        let (dx, dy, dz) = (px - t * self.d.x, py - t * self.d.y, pz - t * self.d.z);
        dx * dx + dy * dy + dz * dz
    }
}

impl Convex {
    pub fn new(points: &[Vec3]) -> Result<Self, PrimitiveError> {
        let flat = PrimitiveError::Flat("convex hull");
        let centre = points.iter().sum::<Vec3>() / points.len() as f32;
        let size = points
            .iter()
            .map(|p| (p - centre).length())
            .fold(0.0, f32::max);
        // Thinner than this, the planes cannot be told from rounding.
        if size <= 0.0 || thickness(points, centre) < 1.0e-4 * size {
            return Err(flat);
        }
        // Hulls are found about the origin at unit size, where tolerances mean the same for all.
        let unit: Vec<Vec3> = points.iter().map(|p| (p - centre) / size).collect();
        let (corners, faces) = try_convex_hull(&unit).map_err(|_| flat.clone())?;
        let corners: Vec<Vec3> = corners.iter().map(|c| c * size + centre).collect();
        Self::from_faces(&corners, &faces, points, size).ok_or(flat)
    }

    fn from_faces(
        corners: &[Vec3],
        faces: &[[u32; 3]],
        points: &[Vec3],
        size: f32,
    ) -> Option<Self> {
        let tolerance = 1.0e-5 * size;
        let mut planes: Vec<Plane> = Vec::new();
        // Triangle sides by their ends: the plane on either hand.
        let mut sides: FxHashMap<(u32, u32), usize> = FxHashMap::default();
        for f in faces {
            let [a, b, c] = f.map(|i| corners[i as usize]);
            let normal = (b - a).as_dvec3().cross((c - a).as_dvec3());
            let normal = normal.try_normalize()?.as_vec3();
            // The offset that holds every point, so that no corner is cut off by rounding.
            let offset = points
                .iter()
                .map(|p| normal.dot(*p))
                .fold(f32::MIN, f32::max);
            if offset - normal.dot(a) > 100.0 * tolerance {
                return None;
            }
            let same = |p: &Plane| {
                p.normal.dot(normal) > 1.0 - 1.0e-7 && (p.offset - offset).abs() < tolerance
            };
            let plane = planes.iter().position(same).unwrap_or_else(|| {
                planes.push(Plane { normal, offset });
                planes.len() - 1
            });
            for k in 0..3 {
                sides.insert((f[k], f[(k + 1) % 3]), plane);
            }
        }
        let mut walls = vec![Vec::new(); planes.len()];
        let mut edges = Vec::new();
        let mut ordered: Vec<_> = sides.iter().map(|(&k, &v)| (k, v)).collect();
        ordered.sort_unstable();
        for ((i, j), plane) in ordered {
            let other = *sides.get(&(j, i))?;
            if other == plane {
                continue;
            }
            let (a, b) = (corners[i as usize], corners[j as usize]);
            let outward = (b - a).cross(planes[plane].normal).try_normalize()?;
            walls[plane].push(Plane {
                normal: outward,
                offset: outward.dot(a),
            });
            if i < j {
                let d = b - a;
                edges.push(Edge {
                    a,
                    d,
                    inverse: 1.0 / d.length_squared(),
                });
            }
        }
        (planes.len() >= 4).then_some(Self {
            planes,
            walls,
            edges,
        })
    }

    /// Its planes, walls and edges as numbers.
    pub fn view(&self) -> ConvexView {
        let plane = |p: &Plane| [p.normal.x, p.normal.y, p.normal.z, p.offset];
        let edge = |e: &Edge| [e.a.x, e.a.y, e.a.z, e.d.x, e.d.y, e.d.z, e.inverse];
        ConvexView {
            planes: self.planes.iter().map(plane).collect(),
            walls: self
                .walls
                .iter()
                .map(|w| w.iter().map(plane).collect())
                .collect(),
            edges: self.edges.iter().map(edge).collect(),
        }
    }

    fn highest(&self, p: Vec3) -> f32 {
        self.planes
            .iter()
            .fold(f32::MIN, |m, f| greater(m, f.at(p.x, p.y, p.z)))
    }

    pub fn at(&self, p: Vec3) -> f32 {
        let (x, y, z) = (p.x, p.y, p.z);
        let highest = self.highest(p);
        if highest <= 0.0 {
            return highest;
        }
        let edges = self
            .edges
            .iter()
            .fold(f32::INFINITY, |b, e| lesser(b, e.square(x, y, z)));
        let mut best = edges.sqrt();
        for (face, walls) in self.planes.iter().zip(&self.walls) {
            let d = face.at(x, y, z);
            if d > 0.0 && d < best && walls.iter().all(|w| w.at(x, y, z) <= 0.0) {
                best = d;
            }
        }
        greater(best, highest)
    }

    /// As [`Convex::at`], with the faces and edges that no node of the brick is closest to left out.
    #[inline(always)]
    pub fn brick(&self, p: &Points, out: &mut [f32; NODES]) {
        let (c, r) = (p.centre, p.radius);
        let highest = self.highest(c);
        let slack = 1.0e-5 * (r + highest.abs() + c.abs().max_element());
        out.fill(f32::MIN);
        for f in &self.planes {
            if f.at(c.x, c.y, c.z) >= highest - 2.0 * r - slack {
                for (i, o) in out.iter_mut().enumerate() {
                    *o = greater(*o, f.at(p.x[i], p.y[i], p.z[i]));
                }
            }
        }
        if highest < -r - slack {
            return;
        }
        let reach = self.at(c).abs() + 2.0 * r + slack;
        let mut best = [f32::INFINITY; NODES];
        for e in &self.edges {
            if e.square(c.x, c.y, c.z) <= reach * reach {
                for (i, b) in best.iter_mut().enumerate() {
                    *b = lesser(*b, e.square(p.x[i], p.y[i], p.z[i]));
                }
            }
        }
        for b in &mut best {
            *b = b.sqrt();
        }
        for (face, walls) in self.planes.iter().zip(&self.walls) {
            let d = face.at(c.x, c.y, c.z);
            let near = |w: &Plane| w.at(c.x, c.y, c.z) <= r + slack;
            if d > reach || d < -r - slack || !walls.iter().all(near) {
                continue;
            }
            let mut wall = [f32::MIN; NODES];
            for w in walls {
                for (i, v) in wall.iter_mut().enumerate() {
                    *v = greater(*v, w.at(p.x[i], p.y[i], p.z[i]));
                }
            }
            for i in 0..NODES {
                let d = face.at(p.x[i], p.y[i], p.z[i]);
                let closer = (wall[i] <= 0.0) & (d > 0.0) & (d < best[i]);
                best[i] = if closer { d } else { best[i] };
            }
        }
        for i in 0..NODES {
            out[i] = if out[i] <= 0.0 {
                out[i]
            } else {
                greater(best[i], out[i])
            };
        }
    }
}

/// The least extent over the directions that three far points span: 0 for points on one plane.
fn thickness(points: &[Vec3], centre: Vec3) -> f32 {
    let far = |score: &dyn Fn(Vec3) -> f32| {
        points
            .iter()
            .map(|p| p - centre)
            .max_by(|a, b| score(*a).total_cmp(&score(*b)))
            .unwrap_or(Vec3::ZERO)
    };
    let a = far(&|p| p.length_squared()).normalize_or_zero();
    let b = far(&|p| p.reject_from(a).length_squared())
        .reject_from(a)
        .normalize_or_zero();
    let n = a.cross(b);
    let along = points.iter().map(|p| (p - centre).dot(n));
    let (lo, hi) = along.fold((f32::MAX, f32::MIN), |(l, h), d| (l.min(d), h.max(d)));
    hi - lo
}
