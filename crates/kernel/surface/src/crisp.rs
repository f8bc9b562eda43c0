//! Edges and corners that marching cubes cuts off, put back where the field has them.
//!
//! A vertex of marching cubes lies on an edge of the lattice, so what is sharp between two vertices
//! is bridged by a chamfer whose ends follow the lattice: the rim of a bore looks torn. Here each edge
//! of the mesh that bridges two smooth sides is split where their tangent planes and the surface meet,
//! found with the field itself (the idea of Kobbelt et al. 2001, *Feature Sensitive Surface Extraction*,
//! and of Attene et al. 2003, *Edge-Sharpener*). Nothing is flipped and nothing removed: what was
//! closed and manifold stays so.

use std::sync::OnceLock;

use glam::{IVec3, Mat3, Vec3};
use midair_field::Program;
use midair_mesh::TriMesh;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// The cosine of the angle between two normals from which an edge is looked at: 12°.
const LOOK: f32 = 0.978;
/// The cosine of the angle between two sides from which what lies between them is sharp: 15°.
const SHARP: f32 = 0.966;
/// In steps: for differences of the field.
const DELTA: f32 = 0.03;
/// In steps: from how far beside the edge its sides are looked at, each time nearer.
const BESIDE: [f32; 2] = [0.3, 0.1];
/// The cosine of the angle by which a flat side turns, at most.
const FLAT: f32 = 0.9999;
/// In steps: how far off the surface a point of an edge may lie.
const OFF: f32 = 0.02;
/// In steps: how near to a vertex an edge is too near to be worth a split.
const NEAR: f32 = 0.01;
/// How far from straight the field may run through a vertex, as a share of its slope, before the vertex
/// itself counts as lying on an edge.
const BENT: f32 = 0.04;
/// In steps: how far beside an edge a vertex is set down that would come to lie on it.
const ASIDE: f32 = 0.12;
/// In steps: how far a vertex may be moved to lie on the surface.
const MOST: f32 = 0.4;
/// In steps: how far from the middle of what bridges it an edge or a corner may lie.
const REACH: f32 = 1.5;

/// How often chamfers are given back, until nothing touches.
const ROUNDS: usize = 12;
/// In steps: the side of the cubes in which a program is thinned out.
const CUBE: f32 = 16.0;

/// The same closed surface with its sharp edges and corners: `mesh` is what [`crate::Surface::mesh`] gives for the
/// field of `program`. Vertices beside an edge are moved onto the surface; those of the edges are new and come
/// after all others, with a normal between those of their sides.
///
/// Of a field without sharp edges, and of a painting, nothing changes. Where two sides cannot be told
/// apart within a step, the chamfer stays.
#[must_use]
pub fn crisp(mesh: TriMesh, program: &Program) -> TriMesh {
    if program.is_painting() {
        return mesh;
    }
    let side = CUBE * program.step();
    let cube = |p: Vec3| (p / side).floor().as_ivec3();
    // Thinned out where the first point is asked for: a surface without edges asks for none.
    let parts = OnceLock::new();
    let mut cubes: Vec<IVec3> = mesh.positions.iter().map(|&p| cube(p)).collect();
    cubes.dedup();
    let thin = || {
        let half = 0.5 * side;
        let mut all = FxHashMap::default();
        for &c in &cubes {
            let middle = c.as_vec3() * side + half;
            all.entry(c).or_insert_with(|| program.part(middle, half));
        }
        all
    };
    sharpened(
        mesh,
        program.step(),
        &|p| match parts.get_or_init(thin).get(&cube(p)) {
            Some(part) => part.at(p),
            None => program.at(p),
        },
    )
}

fn sharpened(mesh: TriMesh, step: f32, field: &(impl Fn(Vec3) -> f32 + Sync)) -> TriMesh {
    if mesh.normals.len() != mesh.positions.len() || !(step > 0.0 && step.is_finite()) {
        return mesh;
    }
    // Where normals turn, which the lattice tells only as well as its step allows.
    let look = |a: u32, b: u32| mesh.normals[a as usize].dot(mesh.normals[b as usize]) < LOOK;
    let mut ends: Vec<u32> = mesh
        .triangles
        .par_iter()
        .flat_map_iter(|t| sides(*t).filter(|&[a, b]| look(a, b)).flatten())
        .collect();
    if ends.is_empty() {
        return mesh;
    }
    ends.par_sort_unstable();
    ends.dedup();

    let sampler = Sampler { step, field };
    let feet: Vec<Option<Foot>> = ends
        .par_iter()
        .map(|&v| sampler.footing(mesh.positions[v as usize]))
        .collect();
    let mut foot = vec![None; mesh.positions.len()];
    for (&v, found) in ends.iter().zip(feet) {
        foot[v as usize] = found;
    }
    let end = |v: u32| foot[v as usize];

    // A closed surface runs along each of its edges once in each direction.
    let mut edges: Vec<[u32; 2]> = mesh
        .triangles
        .par_iter()
        .flat_map_iter(|t| sides(*t).filter(|&[a, b]| a < b && end(a).and(end(b)).is_some()))
        .collect();
    edges.par_sort_unstable();
    let mut splits: Vec<Split> = edges
        .par_iter()
        .filter_map(|&[a, b]| {
            let edge = sampler.edge(end(a)?, end(b)?)?;
            Some(Split { ends: [a, b], edge })
        })
        .collect();
    if splits.is_empty() {
        return mesh;
    }
    let mut moved = Moved::new(&mesh, &splits, end);
    for _ in 0..ROUNDS {
        moved.settle(&mesh);
        let cut = Cut {
            mesh: &mesh,
            moved: &moved,
            sampler: &sampler,
        };
        let (sharp, of) = cut.settled(&mut splits);
        let changed: Vec<u32> = (0..)
            .zip(&of)
            .filter(|&(t, &was)| cut.is_changed(&sharp, t, was))
            .map(|(t, _)| t)
            .collect();
        let touching = sharp.touching(&changed);
        if touching.is_empty() {
            return sharp;
        }
        // What touches is given back the chamfer it had.
        let mut back: Vec<u32> = touching.iter().flatten().map(|&t| of[t as usize]).collect();
        back.sort_unstable();
        back.dedup();
        let mut blunt: Vec<[u32; 2]> = back
            .iter()
            .flat_map(|&t| sides(mesh.triangles[t as usize]))
            .map(ascending)
            .collect();
        blunt.sort_unstable();
        splits.retain(|s| blunt.binary_search(&s.ends).is_err());
        for &t in &back {
            moved.take_back(&mesh, t);
        }
    }
    mesh
}

/// The directed sides of a triangle.
fn sides([a, b, c]: [u32; 3]) -> impl Iterator<Item = [u32; 2]> {
    [[a, b], [b, c], [c, a]].into_iter()
}

/// A side by which both triangles know it.
fn ascending([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// A point of the surface, and the normal there.
#[derive(Clone, Copy)]
struct Foot {
    at: Vec3,
    normal: Vec3,
    /// Whether it lies on an edge, so that it belongs to no side.
    edge: bool,
}

/// The field at a point.
struct Sample {
    here: f32,
    gradient: Vec3,
    /// Whether it turns a corner there.
    edge: bool,
}

/// A point where two sides meet.
#[derive(Clone, Copy)]
struct Edge {
    at: Vec3,
    /// Of the side that the first end lies on, and of the other.
    normals: [Vec3; 2],
}

struct Split {
    /// In ascending order.
    ends: [u32; 2],
    edge: Edge,
}

struct Sampler<'f, F> {
    step: f32,
    field: &'f F,
}

impl<F: Fn(Vec3) -> f32> Sampler<'_, F> {
    /// The field around a point; `None` where it is no distance, or the point between two sides.
    fn sample(&self, p: Vec3) -> Option<Sample> {
        let d = DELTA * self.step;
        let here = (self.field)(p);
        let pair = |axis: Vec3| ((self.field)(p + d * axis), (self.field)(p - d * axis));
        let pairs = [pair(Vec3::X), pair(Vec3::Y), pair(Vec3::Z)];
        let gradient = Vec3::from_array(pairs.map(|(a, b)| (a - b) / (2.0 * d)));
        let bend = Vec3::from_array(pairs.map(|(a, b)| (a + b - 2.0 * here) / (2.0 * d)));
        let slope = gradient.length();
        (0.5..2.0).contains(&slope).then_some(Sample {
            here,
            gradient,
            edge: bend.length() > BENT * slope,
        })
    }

    /// The nearest point of the surface, by Newton's method.
    fn foot(&self, from: Vec3) -> Option<Foot> {
        let mut at = from;
        let mut sample = self.sample(at)?;
        for _ in 0..2 {
            if sample.here.abs() < 0.001 * self.step {
                break;
            }
            at -= sample.here * sample.gradient / sample.gradient.length_squared();
            sample = self.sample(at)?;
        }
        let on = sample.here.abs() < OFF * self.step && at.distance(from) < MOST * self.step;
        on.then_some(Foot {
            at,
            normal: sample.gradient.try_normalize()?,
            edge: sample.edge,
        })
    }

    /// As [`Self::foot`]; what would come to lie on an edge is set down beside it, so that it has a side.
    fn footing(&self, from: Vec3) -> Option<Foot> {
        let foot = self.foot(from)?;
        if !foot.edge {
            return Some(foot);
        }
        let (u, v) = foot.normal.any_orthonormal_pair();
        let aside = [u, -u, v, -v].map(|way| self.foot(foot.at + ASIDE * self.step * way));
        let clear = aside.into_iter().flatten().filter(|f| !f.edge);
        let distance = |f: &Foot| f.at.distance_squared(from);
        Some(
            clear
                .min_by(|a, b| distance(a).total_cmp(&distance(b)))
                .unwrap_or(foot),
        )
    }

    /// Where the sides of two points of the surface meet, if what lies between them is sharp.
    fn edge(&self, a: Foot, b: Foot) -> Option<Edge> {
        if a.edge || b.edge {
            return None;
        }
        let middle = 0.5 * (a.at + b.at);
        let mut sides = [a, b];
        let mut at = straight(meet(middle, sides)?, sides)?;
        for beside in BESIDE {
            let mut flat = true;
            for (side, end) in sides.iter_mut().zip([a, b]) {
                let here = self.foot(self.beside(at, end.at, beside)?)?;
                let turned = here.normal.dot(end.normal);
                if turned < 0.7 {
                    return None;
                }
                flat &= turned > FLAT;
                if !here.edge {
                    *side = here;
                }
            }
            at = meet(at, sides)?;
            // From nearer it would look the same.
            if flat {
                break;
            }
        }
        let sharp = (self.field)(at).abs() < OFF * self.step
            && at.distance(middle) < REACH * self.step
            && at.distance(a.at).min(at.distance(b.at)) > NEAR * self.step;
        sharp.then_some(Edge {
            at,
            normals: sides.map(|s| s.normal),
        })
    }

    /// A point a little way from an edge into the side on which `end` lies.
    fn beside(&self, edge: Vec3, end: Vec3, steps: f32) -> Option<Vec3> {
        let length = edge.distance(end);
        let way = (steps * self.step).min(0.7 * length);
        (length > 0.0).then(|| edge + (way / length) * (end - edge))
    }

    /// Where three sides meet, near the triangle between them.
    fn corner(&self, ends: [Foot; 3]) -> Option<Vec3> {
        let middle = (ends[0].at + ends[1].at + ends[2].at) / 3.0;
        let mut sides = ends;
        let mut at = meet_three(sides)?;
        for beside in BESIDE {
            for (side, end) in sides.iter_mut().zip(ends) {
                // Close to an edge of its own it tells nothing new.
                if let Some(here) = self.foot(self.beside(at, end.at, beside)?)
                    && !here.edge
                    && here.normal.dot(end.normal) > 0.7
                {
                    *side = here;
                }
            }
            at = meet_three(sides)?;
        }
        let there = (self.field)(at).abs() < OFF * self.step;
        (there && at.distance(middle) < REACH * self.step).then_some(at)
    }
}

/// The point nearest to `from` in both tangent planes; `None` where they are one side.
fn meet(from: Vec3, [a, b]: [Foot; 2]) -> Option<Vec3> {
    let c = a.normal.dot(b.normal);
    if c > SHARP {
        return None;
    }
    let (ra, rb) = (a.normal.dot(a.at - from), b.normal.dot(b.at - from));
    let det = 1.0 - c * c;
    // Two sides of a sheet have no line in common.
    (det > 0.05).then(|| from + ((ra - c * rb) / det) * a.normal + ((rb - c * ra) / det) * b.normal)
}

/// Where the way from one end to the other crosses the edge through `at`, were the two sides laid flat: so
/// that what is cut keeps the order that it has along the edge.
fn straight(at: Vec3, [a, b]: [Foot; 2]) -> Option<Vec3> {
    let along = a.normal.cross(b.normal).try_normalize()?;
    let place = |end: Foot| {
        let s = (end.at - at).dot(along);
        (s, (end.at - at - s * along).length())
    };
    let ((sa, da), (sb, db)) = (place(a), place(b));
    (da + db > 0.0).then(|| at + (sa * db + sb * da) / (da + db) * along)
}

/// The point in all three tangent planes.
fn meet_three(sides: [Foot; 3]) -> Option<Vec3> {
    let planes = Mat3::from_cols(sides[0].normal, sides[1].normal, sides[2].normal).transpose();
    let offsets = Vec3::from_array(sides.map(|s| s.normal.dot(s.at)));
    (planes.determinant().abs() > 0.1).then(|| planes.inverse() * offsets)
}

/// Vertices beside an edge, on the surface itself.
struct Moved {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// Whether an edge that is split ends there.
    beside: Vec<bool>,
    /// The triangles that have one.
    touched: Vec<u32>,
}

impl Moved {
    fn new(mesh: &TriMesh, splits: &[Split], foot: impl Fn(u32) -> Option<Foot>) -> Self {
        let mut moved = Self {
            positions: mesh.positions.clone(),
            normals: mesh.normals.clone(),
            beside: vec![false; mesh.positions.len()],
            touched: Vec::new(),
        };
        // The lattice blurs normals beside an edge.
        for (v, normal) in (0..).zip(&mut moved.normals) {
            *normal = foot(v).filter(|f| !f.edge).map_or(*normal, |f| f.normal);
        }
        for v in splits.iter().flat_map(|s| s.ends) {
            if let Some(foot) = foot(v) {
                moved.positions[v as usize] = foot.at;
                moved.beside[v as usize] = true;
            }
        }
        let list = (0..).zip(&mesh.triangles);
        moved.touched = list
            .filter(|(_, t)| t.iter().any(|&v| moved.beside[v as usize]))
            .map(|(i, _)| i)
            .collect();
        moved
    }

    /// Takes back what would turn a triangle over.
    fn settle(&mut self, mesh: &TriMesh) {
        loop {
            let turned: Vec<u32> = self
                .touched
                .iter()
                .copied()
                .filter(|&t| {
                    let [a, b, c] = mesh.triangles[t as usize].map(|v| v as usize);
                    let face = |p: &[Vec3]| (p[b] - p[a]).cross(p[c] - p[a]);
                    let (now, before) = (face(&self.positions), face(&mesh.positions));
                    now != before && now.dot(before) < 0.2 * before.length_squared()
                })
                .collect();
            if turned.is_empty() {
                return;
            }
            for t in turned {
                self.take_back(mesh, t);
            }
        }
    }

    /// The corners of a triangle, where they were.
    fn take_back(&mut self, mesh: &TriMesh, t: u32) {
        for v in mesh.triangles[t as usize] {
            self.positions[v as usize] = mesh.positions[v as usize];
        }
    }
}

/// The mesh as it is cut along its edges.
struct Cut<'m, F> {
    mesh: &'m TriMesh,
    moved: &'m Moved,
    sampler: &'m Sampler<'m, F>,
}

impl<F: Fn(Vec3) -> f32 + Sync> Cut<'_, F> {
    /// Whether a triangle of what was cut is not one that was there.
    fn is_changed(&self, cut: &TriMesh, t: u32, was: u32) -> bool {
        let (now, before) = (cut.triangles[t as usize], self.mesh.triangles[was as usize]);
        let place = |v: u32| (cut.positions[v as usize], self.mesh.positions[v as usize]);
        now != before || now.iter().any(|&v| place(v).0 != place(v).1)
    }

    /// Splits again without those that would turn a piece over, until none does. With it, of which triangle
    /// each is a piece.
    fn settled(&self, splits: &mut Vec<Split>) -> (TriMesh, Vec<u32>) {
        loop {
            let (mesh, of, bad) = self.cut(splits);
            if bad.is_empty() {
                return (mesh, of);
            }
            splits.retain(|s| bad.binary_search(&s.ends).is_err());
        }
    }

    /// The mesh, of which triangle each of its is a piece, and the splits that do harm.
    fn cut(&self, splits: &[Split]) -> (TriMesh, Vec<u32>, Vec<[u32; 2]>) {
        let first = self.mesh.positions.len() as u32;
        let mut out = TriMesh {
            positions: self.moved.positions.clone(),
            normals: self.moved.normals.clone(),
            triangles: Vec::with_capacity(self.mesh.triangles.len() + 4 * splits.len()),
        };
        for s in splits {
            let [a, b] = s.edge.normals;
            out.positions.push(s.edge.at);
            out.normals.push((a + b).try_normalize().unwrap_or(a));
        }
        let split = |a: u32, b: u32| {
            let ends = ascending([a, b]);
            let at = splits.binary_search_by_key(&ends, |s| s.ends).ok()?;
            Some(first + at as u32)
        };
        let (mut of, mut bad) = (Vec::new(), Vec::new());
        for (was, &t) in (0..).zip(&self.mesh.triangles) {
            let looked = |a: u32, b: u32| {
                let beside = |v: u32| self.moved.beside[v as usize];
                (beside(a) && beside(b)).then(|| split(a, b)).flatten()
            };
            let [a, b, c] = t;
            let on = [looked(a, b), looked(b, c), looked(c, a)];
            if on == [None; 3] {
                out.triangles.push(t);
                of.push(was);
                continue;
            }
            let from = out.triangles.len();
            self.pieces(t, on, &mut out);
            of.resize(out.triangles.len(), was);
            let fits = |piece: &[u32; 3]| {
                let p = piece.map(|v| out.positions[v as usize]);
                let face = (p[1] - p[0]).cross(p[2] - p[0]);
                let least = 1e-5 * self.sampler.step * self.sampler.step;
                // What belongs to a side looks as that side does.
                face.length() > least
                    && piece
                        .iter()
                        .filter(|&&v| v < first)
                        .all(|&v| face.dot(out.normals[v as usize]) > 0.0)
            };
            if !out.triangles[from..].iter().all(fits) {
                let keys = sides(t).zip(on).filter(|(_, on)| on.is_some());
                bad.extend(keys.map(|(side, _)| ascending(side)));
            }
        }
        bad.sort_unstable();
        (out, of, bad)
    }

    /// The pieces of one triangle whose sides are split at `on`: that from its first corner to the
    /// second, and so on.
    fn pieces(&self, t: [u32; 3], on: [Option<u32>; 3], out: &mut TriMesh) {
        // Turned so that a case need be written once.
        let turn = |k: usize| {
            let at = |i: usize| (i + k) % 3;
            ([0, 1, 2].map(|i| t[at(i)]), [0, 1, 2].map(|i| on[at(i)]))
        };
        for k in 0..3 {
            match turn(k) {
                ([a, b, c], [Some(m), None, None]) => {
                    out.triangles.extend([[a, m, c], [m, b, c]]);
                    return;
                }
                ([a, b, c], [Some(m), None, Some(k)]) => {
                    let p = |v: u32| out.positions[v as usize];
                    let short = p(m).distance_squared(p(c)) < p(b).distance_squared(p(k));
                    let rest = if short {
                        [[m, b, c], [m, c, k]]
                    } else {
                        [[m, b, k], [b, c, k]]
                    };
                    out.triangles.push([a, m, k]);
                    out.triangles.extend(rest);
                    return;
                }
                _ => {}
            }
        }
        let ([a, b, c], [Some(ab), Some(bc), Some(ca)]) = (t, on) else {
            return;
        };
        let foot = |v: u32| Foot {
            at: self.moved.positions[v as usize],
            normal: self.moved.normals[v as usize],
            edge: false,
        };
        if let Some(at) = self.sampler.corner([a, b, c].map(foot)) {
            let tip = out.positions.len() as u32;
            let normal = [a, b, c].map(|v| foot(v).normal).iter().sum::<Vec3>();
            out.positions.push(at);
            out.normals
                .push(normal.try_normalize().unwrap_or(foot(a).normal));
            let ring = [a, ab, b, bc, c, ca];
            let fan = (0..6).map(|i| [ring[i], ring[(i + 1) % 6], tip]);
            out.triangles.extend(fan);
        } else {
            out.triangles
                .extend([[a, ab, ca], [ab, b, bc], [bc, c, ca], [ab, bc, ca]]);
        }
    }
}
