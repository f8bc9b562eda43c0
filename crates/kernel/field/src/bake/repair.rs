//! From any list of triangles to a closed, oriented one.

use glam::{DVec3, Vec3};
use midair_mesh::TriMesh;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::lids;
use super::tree::Tree;
use super::triangle::Triangle;
use super::{BakeError, Progress};

/// A chain of triangles without boundary: every edge is passed as often one way as the other, so
/// that the winding number is whole everywhere off the surface.
pub(super) struct Closed {
    pub triangles: Vec<[Vec3; 3]>,
    /// Triangles from here on are lids, laid over holes.
    pub lids: usize,
}

/// A use of an undirected edge by a triangle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct EdgeUse {
    pub low: u32,
    pub high: u32,
    /// Whether the triangle passes it from `low` to `high`.
    pub forward: bool,
    pub triangle: u32,
}

/// Joins what lies at one place, drops repeated faces, gives every piece one orientation, and lays
/// lids over the holes, whose triangles have sides of about `lid` metres where they must bend.
pub(super) fn close(mesh: &TriMesh, lid: f32, progress: &Progress) -> Result<Closed, BakeError> {
    let (positions, mut faces) = weld(mesh)?;
    progress.check()?;
    let (whole, (size, mut closed)) = rayon::join(
        || paired(&faces, positions.len()),
        || (volume(&positions, &faces), without_lids(&positions, &faces)),
    );
    if let Some(pieces) = whole.filter(|_| size > 0.0) {
        let inverted = inverted_pieces(&positions, &faces, &pieces, &[], &closed);
        if !inverted.is_empty() {
            turn(&mut faces, &pieces, &inverted);
            closed = without_lids(&positions, &faces);
        }
        return Ok(closed);
    }
    drop_repeated(&mut faces);
    let edges = edge_uses(&faces);
    let pieces = orient(&positions, &mut faces, &edges);
    let edges = edge_uses(&faces);
    progress.check()?;
    closed = with_lids(&positions, &faces, &edges, lid, progress)?;
    let inverted = inverted_pieces(&positions, &faces, &pieces, &edges, &closed);
    if !inverted.is_empty() {
        turn(&mut faces, &pieces, &inverted);
        closed = with_lids(&positions, &faces, &edge_uses(&faces), lid, progress)?;
    }
    Ok(closed)
}

fn turn(faces: &mut [[u32; 3]], pieces: &Pieces, which: &[u32]) {
    for (f, &p) in faces.iter_mut().zip(&pieces.of_face) {
        if which.binary_search(&p).is_ok() {
            f.swap(1, 2);
        }
    }
}

fn without_lids(positions: &[Vec3], faces: &[[u32; 3]]) -> Closed {
    let corners = |f: &[u32; 3]| f.map(|v| positions[v as usize]);
    Closed {
        triangles: faces.iter().map(corners).collect(),
        lids: faces.len(),
    }
}

fn with_lids(
    positions: &[Vec3],
    faces: &[[u32; 3]],
    edges: &[EdgeUse],
    lid: f32,
    progress: &Progress,
) -> Result<Closed, BakeError> {
    let mut closed = without_lids(positions, faces);
    let lids = lids::over_holes(positions, edges, lid, progress)?;
    closed.triangles.extend(lids);
    Ok(closed)
}

/// Vertices at one place become one; triangles that then name a vertex twice are dropped.
fn weld(mesh: &TriMesh) -> Result<(Vec<Vec3>, Vec<[u32; 3]>), BakeError> {
    if mesh.triangles.is_empty() {
        return Err(BakeError::NoTriangles);
    }
    let vertices = mesh.positions.len();
    let mut new = vec![u32::MAX; vertices];
    let mut positions: Vec<Vec3> = Vec::with_capacity(vertices);
    let mut known = FxHashMap::with_capacity_and_hasher(vertices, Default::default());
    let mut faces = Vec::with_capacity(mesh.triangles.len());
    for (triangle, t) in mesh.triangles.iter().enumerate() {
        let mut f = [0; 3];
        for (k, &v) in t.iter().enumerate() {
            let Some(&p) = mesh.positions.get(v as usize) else {
                return Err(BakeError::NoSuchVertex {
                    triangle,
                    vertex: v,
                    vertices,
                });
            };
            if new[v as usize] == u32::MAX {
                // The square of a length must stay a number.
                if !(p.is_finite() && p.abs().max_element() < 1e15) {
                    return Err(BakeError::NotFinite);
                }
                // + 0 makes one zero of the two.
                let key = (p + Vec3::ZERO).to_array().map(f32::to_bits);
                new[v as usize] = *known.entry(key).or_insert_with(|| {
                    positions.push(p);
                    positions.len() as u32 - 1
                });
            }
            f[k] = new[v as usize];
        }
        if f[0] != f[1] && f[1] != f[2] && f[2] != f[0] {
            faces.push(f);
        }
    }
    let solid = |f: &[u32; 3]| {
        let [a, b, c] = f.map(|v| positions[v as usize]);
        (b - a).cross(c - a) != Vec3::ZERO
    };
    if !faces.iter().any(solid) {
        return Err(BakeError::NoExtent);
    }
    Ok((positions, faces))
}

/// Every use of every edge, those of one edge together.
fn edge_uses(faces: &[[u32; 3]]) -> Vec<EdgeUse> {
    let mut edges: Vec<EdgeUse> = faces
        .par_iter()
        .enumerate()
        .flat_map_iter(|(t, f)| {
            (0..3).map(move |k| {
                let (a, b) = (f[k], f[(k + 1) % 3]);
                EdgeUse {
                    low: a.min(b),
                    high: a.max(b),
                    forward: a < b,
                    triangle: t as u32,
                }
            })
        })
        .collect();
    edges.par_sort_unstable();
    edges
}

pub(super) fn by_edge(edges: &[EdgeUse]) -> impl Iterator<Item = &[EdgeUse]> {
    edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high))
}

/// The pieces of a mesh each of whose edges is shared by two triangles that pass it in opposite
/// directions; `None` for any other.
fn paired(faces: &[[u32; 3]], vertices: usize) -> Option<Pieces> {
    let sides = |f: &[u32; 3]| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])];
    let mut ends = vec![0u32; vertices + 1];
    for (a, b) in faces.iter().flat_map(sides) {
        ends[a.min(b) as usize + 1] += 1;
    }
    for i in 1..ends.len() {
        ends[i] += ends[i - 1];
    }
    // The other end, whether that is where the triangle goes, and the triangle.
    let mut uses = vec![(0u32, false, 0u32); 3 * faces.len()];
    let mut cursor = ends.clone();
    for (t, f) in faces.iter().enumerate() {
        for (a, b) in sides(f) {
            let c = &mut cursor[a.min(b) as usize];
            uses[*c as usize] = (a.max(b), a < b, t as u32);
            *c += 1;
        }
    }
    let mut up: Vec<u32> = (0..faces.len() as u32).collect();
    for v in 0..vertices {
        let own = &mut uses[ends[v] as usize..ends[v + 1] as usize];
        own.sort_unstable();
        for edge in own.chunk_by(|a, b| a.0 == b.0) {
            let &[(_, back, one), (_, forth, other)] = edge else {
                return None;
            };
            if back == forth {
                return None;
            }
            let (a, b) = (root(&mut up, one), root(&mut up, other));
            up[a.max(b) as usize] = a.min(b);
        }
    }
    Some(Pieces::numbered(up))
}

fn six_volumes(p: &[Vec3], f: &[u32; 3], from: DVec3) -> f64 {
    let [a, b, c] = f.map(|v| p[v as usize].as_dvec3() - from);
    a.dot(b.cross(c))
}

fn volume(positions: &[Vec3], faces: &[[u32; 3]]) -> f64 {
    let from = positions[0].as_dvec3();
    // A plain sum: a parallel one would depend on how the work was cut.
    faces.iter().map(|f| six_volumes(positions, f, from)).sum()
}

/// Faces on the same three vertices, whichever way round, become the first of them.
fn drop_repeated(faces: &mut Vec<[u32; 3]>) {
    let mut seen = rustc_hash::FxHashSet::default();
    faces.retain(|f| {
        let mut key = *f;
        key.sort_unstable();
        seen.insert(key)
    });
}

/// Faces joined over edges that exactly two of them share.
struct Pieces {
    of_face: Vec<u32>,
    count: usize,
}

impl Pieces {
    fn of(faces: &[[u32; 3]], edges: &[EdgeUse]) -> Self {
        let mut up: Vec<u32> = (0..faces.len() as u32).collect();
        for e in by_edge(edges).filter(|e| e.len() == 2) {
            let (a, b) = (root(&mut up, e[0].triangle), root(&mut up, e[1].triangle));
            up[a.max(b) as usize] = a.min(b);
        }
        Self::numbered(up)
    }

    /// From a forest of parents, by the first face of each.
    fn numbered(mut up: Vec<u32>) -> Self {
        let mut number = vec![u32::MAX; up.len()];
        let mut count = 0;
        let of_face = (0..up.len() as u32)
            .map(|f| {
                let r = root(&mut up, f) as usize;
                if number[r] == u32::MAX {
                    number[r] = count;
                    count += 1;
                }
                number[r]
            })
            .collect();
        Self {
            of_face,
            count: count as usize,
        }
    }
}

/// The root of `i` in a forest of parents, its path halved on the way.
pub(super) fn root(up: &mut [u32], mut i: u32) -> u32 {
    while up[i as usize] != i {
        up[i as usize] = up[up[i as usize] as usize];
        i = up[i as usize];
    }
    i
}

/// Gives each piece one orientation: the one most of its area has where the piece agrees with
/// itself, outward where it did not. A mesh inside out as a whole is turned.
fn orient(positions: &[Vec3], faces: &mut [[u32; 3]], edges: &[EdgeUse]) -> Pieces {
    let pieces = Pieces::of(faces, edges);
    // Neighbours over edges of two faces, and whether they disagree.
    let mut neighbours = vec![[(u32::MAX, false); 3]; faces.len()];
    let mut used = vec![0u8; faces.len()];
    for e in by_edge(edges).filter(|e| e.len() == 2) {
        let clash = e[0].forward == e[1].forward;
        for (a, b) in [(e[0], e[1]), (e[1], e[0])] {
            let slot = &mut used[a.triangle as usize];
            neighbours[a.triangle as usize][*slot as usize] = (b.triangle, clash);
            *slot += 1;
        }
    }
    let mut turned: Vec<Option<bool>> = vec![None; faces.len()];
    let mut mixed = vec![false; pieces.count];
    let mut queue = Vec::new();
    for first in 0..faces.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        queue.push(first as u32);
        while let Some(f) = queue.pop() {
            let here = turned[f as usize].unwrap_or(false);
            for &(g, clash) in &neighbours[f as usize][..used[f as usize] as usize] {
                mixed[pieces.of_face[f as usize] as usize] |= clash;
                if turned[g as usize].is_none() {
                    turned[g as usize] = Some(here != clash);
                    queue.push(g);
                }
            }
        }
    }
    for (f, t) in faces.iter_mut().zip(&turned) {
        if *t == Some(true) {
            f.swap(1, 2);
        }
    }
    let volumes = piece_volumes(positions, faces, &pieces, edges);
    let kept: f64 = (0..pieces.count)
        .filter(|&p| !mixed[p])
        .map(|p| volumes[p])
        .sum();
    for (f, &p) in faces.iter_mut().zip(&pieces.of_face) {
        let p = p as usize;
        if (mixed[p] && volumes[p] < 0.0) || (!mixed[p] && kept < 0.0) {
            f.swap(1, 2);
        }
    }
    pieces
}

/// Six times the volume between each piece and the middle of its open edges, or of its corners
/// where it has none.
fn piece_volumes(
    positions: &[Vec3],
    faces: &[[u32; 3]],
    pieces: &Pieces,
    edges: &[EdgeUse],
) -> Vec<f64> {
    let mut rim = vec![(DVec3::ZERO, 0.0f64); pieces.count];
    let mut all = rim.clone();
    for e in by_edge(edges).filter(|e| e.len() != 2).flatten() {
        let r = &mut rim[pieces.of_face[e.triangle as usize] as usize];
        r.0 += positions[e.low as usize].as_dvec3() + positions[e.high as usize].as_dvec3();
        r.1 += 2.0;
    }
    for (f, &p) in faces.iter().zip(&pieces.of_face) {
        let r = &mut all[p as usize];
        r.0 += f
            .iter()
            .map(|&v| positions[v as usize].as_dvec3())
            .sum::<DVec3>();
        r.1 += 3.0;
    }
    let mut volumes = vec![0.0; pieces.count];
    for (f, &p) in faces.iter().zip(&pieces.of_face) {
        let (sum, n) = if rim[p as usize].1 > 0.0 {
            rim[p as usize]
        } else {
            all[p as usize]
        };
        volumes[p as usize] += six_volumes(positions, f, sum / n);
    }
    volumes
}

/// Pieces that are inside out without being the wall of a cavity: what surrounds them is not solid.
fn inverted_pieces(
    positions: &[Vec3],
    faces: &[[u32; 3]],
    pieces: &Pieces,
    edges: &[EdgeUse],
    closed: &Closed,
) -> Vec<u32> {
    /// Places tried on each piece.
    const SAMPLES: usize = 9;
    if pieces.count < 2 {
        return Vec::new();
    }
    let volumes = {
        // Rims do not matter here: a piece with one is measured with its lids by the sign alone.
        piece_volumes(positions, faces, pieces, edges)
    };
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); pieces.count];
    for (f, &p) in pieces.of_face.iter().enumerate() {
        if volumes[p as usize] < 0.0 {
            members[p as usize].push(f as u32);
        }
    }
    if members.iter().all(Vec::is_empty) {
        return Vec::new();
    }
    let triangles: Vec<Triangle> = closed
        .triangles
        .par_iter()
        .map(|t| Triangle::new(*t))
        .collect();
    let tree = Tree::new(&triangles);
    (0..pieces.count as u32)
        .into_par_iter()
        .filter(|&p| {
            let m = &members[p as usize];
            let solid = (0..SAMPLES)
                .filter(|s| {
                    !m.is_empty() && {
                        let t = &triangles[m[s * m.len() / SAMPLES] as usize];
                        // The normal of an inverted piece points into it: what surrounds it is behind.
                        let c = (t.v[0] + t.v[1] + t.v[2]) / 3.0;
                        let behind = c - t.n * 1e-3 * (t.v[1] - t.v[0]).length();
                        tree.winding(behind) > 0.5
                    }
                })
                .count();
            !m.is_empty() && solid * 2 < SAMPLES
        })
        .collect()
}
