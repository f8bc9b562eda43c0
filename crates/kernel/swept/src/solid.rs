use glam::{Vec2, Vec3};
use midair_mesh::{TriMesh, check};

use crate::lattice::Skin;
use crate::{Profile, Sweep, SweepError};

/// A sweep as the boundary of a solid.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Closed, manifold and consistently wound.
    pub mesh: TriMesh,
    /// (u, metres swept) for each vertex.
    pub uv: Vec<Vec2>,
    /// Where the thickness had to be taken back since the surface bends more sharply than that, and
    /// where that was not enough: its faces there look the wrong way.
    pub inverted: Vec<Vec3>,
    /// Where the profile of a full tube crosses itself, as a figure of eight does: one of its loops runs
    /// the other way round than the other, and both are inside.
    pub crossed: Option<Vec3>,
}

/// Rounds in which a thickness is taken back where it is too much.
const ROUNDS: usize = 40;
/// What is left of it in each.
const BACK: f32 = 0.7;
/// And at least.
const LEAST: f32 = 0.001;

impl Sweep {
    /// A sheet with its thickness, a tube with its caps or the thickness of its wall.
    ///
    /// # Errors
    /// [`SweepError`], where it is open or encloses nothing.
    pub fn solid(&self) -> Result<Solid, SweepError> {
        self.validate()?;
        if !self.is_closed() {
            return Err(SweepError::Open);
        }
        let points = self.points();
        let mut skin = self.skin(&points);
        let mut uv = self.uv(&points, &skin);
        let full = self.profile == Profile::Tube && self.caps;
        let (bulk, crossed) = if full {
            self.bulk(&points)
        } else {
            (0.0, None)
        };
        let (mesh, inverted) = if full {
            self.cap(&mut skin);
            skin.split(&mut uv);
            if skin.volume() < 0.0 {
                skin.triangles.iter_mut().for_each(|t| t.swap(1, 2));
            }
            (finished(skin.positions, skin.triangles), Vec::new())
        } else {
            skin.split(&mut uv);
            // Both sides lie on the same picture.
            uv.extend_from_within(..);
            thickened(&skin, self.thickness)
        };
        // What is flatter than a hair over its whole area is no solid. Loops that run the other way
        // round count as well.
        let (volume, area) = (mesh.volume().max(bulk), mesh.area());
        if mesh.triangles.is_empty() || volume <= 1.0e-7 * area {
            return Err(SweepError::Flat);
        }
        Ok(Solid {
            mesh,
            uv,
            inverted,
            crossed,
        })
    }

    /// The volume of a full tube whichever way round its profile runs, and where it changes that: the
    /// sum over what lies between four points of one rib, two and two opposite, and those of the next.
    pub(crate) fn bulk(&self, points: &[Vec3]) -> (f64, Option<Vec3>) {
        let columns = self.columns();
        let strips = columns / 2;
        let mut cells = Vec::with_capacity(points.len() / 2);
        for pair in points.windows(2 * columns).step_by(columns) {
            let (here, next) = pair.split_at(columns);
            for i in 0..strips {
                let corners = [i, i + 1, columns - i - 1, (columns - i) % columns];
                let [a, b, c, d] = corners.map(|k| here[k].as_dvec3());
                let [e, f, g, h] = corners.map(|k| next[k].as_dvec3());
                // Six tetrahedra around the diagonal from a to g.
                let around = [[b, c], [c, d], [d, h], [h, e], [e, f], [f, b]];
                let six: f64 = around
                    .iter()
                    .map(|[p, q]| (p - a).cross(q - a).dot(g - a))
                    .sum();
                cells.push((six / 6.0, (a + b + c + d) * 0.25));
            }
        }
        let (mut ahead, mut back) = (0.0, 0.0);
        for &(volume, _) in &cells {
            *(if volume > 0.0 { &mut ahead } else { &mut back }) += volume.abs();
        }
        let bulk = ahead + back;
        // Less than this part of it is the rounding of a bend.
        let both_ways = ahead.min(back) > 1.0e-3 * bulk;
        let largest = cells.iter().fold(0.0f64, |m, c| m.max(c.0.abs()));
        let place = cells.chunks(strips).find_map(|row| {
            // Where the curves meet the cells have next to nothing in them.
            let mut full = row.iter().filter(|c| c.0.abs() > 1.0e-4 * largest);
            let mut before = full.next()?;
            let after = full.find(|c| {
                let turned = c.0 * before.0 < 0.0;
                if !turned {
                    before = c;
                }
                turned
            })?;
            Some(before.1.midpoint(after.1).as_vec3())
        });
        (bulk, place.filter(|_| both_ways))
    }

    /// Strips from each point of the first and the last rib to its opposite.
    fn cap(&self, skin: &mut Skin) {
        let columns = self.columns();
        let last = columns / 2;
        let rows = skin.vertex.len() / columns;
        for (row, first) in [(0, true), (rows - 1, false)] {
            let vertex = |i: usize| skin.vertex[row * columns + i % columns];
            let strips: Vec<[u32; 4]> = (0..last)
                .map(|i| {
                    [
                        vertex(i + 1),
                        vertex(i),
                        vertex(columns - i),
                        vertex(columns - i - 1),
                    ]
                })
                .collect();
            for [a, b, c, d] in strips {
                if first {
                    skin.quad(a, b, c, d);
                } else {
                    skin.quad(d, c, b, a);
                }
            }
        }
    }
}

/// Both sides of a surface, half its thickness away from it, and the wall along its rim.
fn thickened(skin: &Skin, thickness: f32) -> (TriMesh, Vec<Vec3>) {
    let normals = skin.normals();
    let count = skin.positions.len();
    let mut share = vec![1.0f32; count];
    let half = 0.5 * thickness;
    let offset = |v: usize, side: f32, share: &[f32]| {
        let p = skin.positions[v] + normals[v] * (half * side * share[v]);
        p.as_dvec3()
    };
    let looks_back = |t: &[u32; 3], share: &[f32]| {
        let own = skin.area(t);
        [1.0, -1.0].into_iter().any(|side| {
            let [a, b, c] = t.map(|v| offset(v as usize, side, share));
            (b - a).cross(c - a).dot(own) <= 0.0
        })
    };
    let mut inverted: Vec<usize> = (0..skin.triangles.len()).collect();
    for _ in 0..ROUNDS {
        inverted.retain(|&t| looks_back(&skin.triangles[t], &share));
        if inverted.is_empty() {
            break;
        }
        let mut less = vec![false; count];
        for &t in &inverted {
            for v in skin.triangles[t] {
                less[v as usize] = true;
            }
        }
        for (s, _) in share.iter_mut().zip(&less).filter(|(_, l)| **l) {
            *s = (*s * BACK).max(LEAST);
        }
        // A neighbour of what was taken back may look back now.
        inverted = (0..skin.triangles.len())
            .filter(|&t| skin.triangles[t].iter().any(|&v| less[v as usize]))
            .collect();
    }
    inverted.retain(|&t| looks_back(&skin.triangles[t], &share));
    let places = inverted
        .iter()
        .map(|&t| skin.triangles[t].map(|v| skin.positions[v as usize]))
        .map(|[a, b, c]| (a + b + c) / 3.0)
        .collect();
    let side = |side: f32| (0..count).map(move |v| (v, side));
    let positions: Vec<Vec3> = side(1.0)
        .chain(side(-1.0))
        .map(|(v, s)| offset(v, s, &share).as_vec3())
        .collect();
    let under = |v: u32| v + count as u32;
    let mut triangles = skin.triangles.clone();
    triangles.extend(
        skin.triangles
            .iter()
            .map(|t| [under(t[0]), under(t[2]), under(t[1])]),
    );
    for [a, b] in rim(&skin.triangles) {
        triangles.push([b, a, under(a)]);
        triangles.push([b, under(a), under(b)]);
    }
    (finished(positions, triangles), places)
}

/// Edges of one triangle only, as it runs along them.
fn rim(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mut edges: Vec<([u32; 2], [u32; 2])> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[a, b]| ([a.min(b), a.max(b)], [a, b]))
        .collect();
    edges.sort_unstable();
    edges
        .chunk_by(|x, y| x.0 == y.0)
        .filter(|same| same.len() == 1)
        .map(|same| same[0].1)
        .collect()
}

fn finished(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> TriMesh {
    let mut mesh = TriMesh {
        positions,
        normals: Vec::new(),
        triangles,
    };
    mesh.compute_normals();
    mesh
}

/// Where a mesh touches or crosses itself: how many pairs of triangles do, and the places of the
/// first few.
pub fn touches(mesh: &TriMesh) -> (usize, Vec<Vec3>) {
    let report = check(mesh);
    let middle = |t: u32| {
        let [a, b, c] = mesh.corners(t as usize);
        (a + b + c) / 3.0
    };
    let places = report.self_touching_pairs.iter();
    let places = places.map(|&[a, b]| middle(a).midpoint(middle(b)));
    (report.self_touching, places.collect())
}
