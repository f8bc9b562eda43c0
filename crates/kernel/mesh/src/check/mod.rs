mod cells;
mod predicates;
mod report;
mod touch;

use glam::DVec3;
use parry3d::bounding_volume::Aabb as TreeBox;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use rayon::prelude::*;

pub use report::Report;

use crate::pieces::{Joined, by_edge, edge_uses};
use crate::{Aabb, TriMesh};

/// Pairs of touching triangles that a report lists.
const LISTED: usize = 16;

/// Looks a mesh over as it is: its connectivity is taken from its indices, so vertices at one
/// place count as one only where the triangles name the same one ([`crate::read`] joins them).
///
/// The result is the same on any number of threads. Triangles that name a vertex that is not
/// there, or one that is not a number, are counted and otherwise left out. The search for touching
/// triangles stops where a mesh touches itself nearly everywhere, and says so.
pub fn check(mesh: &TriMesh) -> Report {
    let n = mesh.positions.len();
    let is_sound = |t: &[u32; 3]| {
        t.iter().all(|&v| {
            mesh.positions
                .get(v as usize)
                .is_some_and(|p| p.is_finite())
        })
    };
    let sound: Vec<[u32; 3]> = mesh.triangles.iter().copied().filter(is_sound).collect();
    let unsound = mesh.triangles.len() - sound.len();
    let mut used = vec![false; n];
    sound
        .iter()
        .flatten()
        .for_each(|&v| used[v as usize] = true);
    let used = used.iter().filter(|&&u| u).count();
    let kept;
    let mesh = match unsound {
        0 => mesh,
        _ => {
            let positions = mesh
                .positions
                .iter()
                .map(|&p| if p.is_finite() { p } else { glam::Vec3::ZERO })
                .collect();
            kept = TriMesh {
                positions,
                normals: Vec::new(),
                triangles: sound,
            };
            &kept
        }
    };

    let links = Links::of(mesh);
    let (piece_of, pieces) = links.pieces;
    let volumes = piece_volumes(mesh, &piece_of, pieces);
    let duplicate = duplicates(&mesh.triangles);
    let degenerate = mesh
        .triangles
        .par_iter()
        .filter(|t| is_degenerate(mesh, t))
        .count();
    let touching = touch::touching(mesh);
    let watertight = !mesh.triangles.is_empty() && links.open == 0;
    let manifold = links.crowded == 0 && links.pinched == 0;
    let euler = used as i64 - links.edges as i64 + mesh.triangles.len() as i64;
    let closed = watertight && manifold && links.miswound == 0;
    Report {
        vertices: n,
        unused_vertices: n - used,
        triangles: mesh.triangles.len(),
        unsound_triangles: unsound,
        edges: links.edges,
        watertight,
        open_edges: links.open,
        edge_manifold: links.crowded == 0,
        crowded_edges: links.crowded,
        vertex_manifold: links.pinched == 0,
        pinched_vertices: links.pinched,
        consistently_wound: links.miswound == 0,
        miswound_edges: links.miswound,
        outward: mesh.volume() > 0.0,
        inside_out_pieces: if closed {
            inside_out(mesh, &piece_of, &volumes)
        } else {
            0
        },
        duplicate_faces: duplicate,
        degenerate_faces: degenerate,
        self_touching: touching.pairs.len(),
        self_touching_complete: touching.complete,
        self_touching_pairs: touching.pairs.into_iter().take(LISTED).collect(),
        pieces,
        euler,
        genus: closed.then_some((2 * pieces as i64 - euler) / 2),
        volume: mesh.volume(),
        area: mesh.area(),
        bounds: bounds(mesh),
    }
}

/// The box around the vertices that triangles use.
fn bounds(mesh: &TriMesh) -> Aabb {
    mesh.triangles
        .iter()
        .flatten()
        .fold(Aabb::EMPTY, |b, &v| b.including(mesh.positions[v as usize]))
}

/// What the edges tell.
struct Links {
    edges: usize,
    open: usize,
    crowded: usize,
    miswound: usize,
    pinched: usize,
    /// The piece of each triangle, and how many there are.
    pieces: (Vec<u32>, usize),
}

impl Links {
    fn of(mesh: &TriMesh) -> Self {
        let uses = edge_uses(&mesh.triangles);
        let mut links = Self {
            edges: 0,
            open: 0,
            crowded: 0,
            miswound: 0,
            pinched: 0,
            pieces: (Vec::new(), 0),
        };
        let mut pieces = Joined::new(mesh.triangles.len());
        // The corners of one vertex hang together where their triangles share an edge at it.
        let mut fans = Joined::new(3 * mesh.triangles.len());
        for edge in by_edge(&uses) {
            let forward = edge.iter().filter(|u| u.forward).count();
            links.edges += 1;
            links.open += edge.len() % 2;
            links.crowded += usize::from(edge.len() > 2);
            links.miswound += usize::from(edge.len() > 1 && 2 * forward != edge.len());
            for pair in edge.windows(2) {
                pieces.join(pair[0].triangle() as u32, pair[1].triangle() as u32);
                for (here, there) in pair[0].ends().into_iter().zip(pair[1].ends()) {
                    fans.join(here, there);
                }
            }
        }
        let mut fans_at = vec![0_u32; mesh.positions.len()];
        for corner in 0..3 * mesh.triangles.len() as u32 {
            if fans.find(corner) == corner {
                fans_at[mesh.triangles[corner as usize / 3][corner as usize % 3] as usize] += 1;
            }
        }
        links.pinched = fans_at.iter().filter(|&&fans| fans > 1).count();
        links.pieces = pieces.numbered();
        links
    }
}

/// Triangles with the same three corners as one before them, whichever way they run.
fn duplicates(triangles: &[[u32; 3]]) -> usize {
    let mut sorted: Vec<[u32; 3]> = triangles
        .par_iter()
        .map(|&t| {
            let mut t = t;
            t.sort_unstable();
            t
        })
        .collect();
    sorted.par_sort_unstable();
    sorted.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

/// Whether f32 cannot tell a triangle from a line: its height over its longest side is at most
/// half a unit in the last place of its largest coordinate, 2⁻²⁴ of it.
fn is_degenerate(mesh: &TriMesh, t: &[u32; 3]) -> bool {
    let [a, b, c] = t.map(|v| mesh.positions[v as usize].as_dvec3());
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let largest = a.abs().max(b.abs()).max(c.abs()).max_element();
    // Twice the area is the height times the side.
    (b - a).cross(c - a).length() <= longest * largest * f64::from(f32::EPSILON) / 2.0
}

/// Six times the volume of each piece, about the middle of everything.
fn piece_volumes(mesh: &TriMesh, piece_of: &[u32], pieces: usize) -> Vec<f64> {
    let mut volumes = vec![0.0; pieces];
    if pieces == 0 {
        return volumes;
    }
    let middle: DVec3 = bounds(mesh).centre().as_dvec3();
    for (t, &piece) in piece_of.iter().enumerate() {
        let [a, b, c] = mesh.corners(t).map(|p| p.as_dvec3() - middle);
        volumes[piece as usize] += a.dot(b.cross(c));
    }
    volumes
}

/// Pieces that wind inwards and cannot be a hollow, since no other piece's box holds theirs.
fn inside_out(mesh: &TriMesh, piece_of: &[u32], volumes: &[f64]) -> usize {
    let mut boxes = vec![Aabb::EMPTY; volumes.len()];
    for (t, &piece) in piece_of.iter().enumerate() {
        for p in mesh.corners(t) {
            boxes[piece as usize] = boxes[piece as usize].including(p);
        }
    }
    let solid: Vec<TreeBox> = boxes
        .iter()
        .zip(volumes)
        .filter(|&(_, &v)| v > 0.0)
        .map(|(b, _)| TreeBox::new(b.min, b.max))
        .collect();
    let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &solid);
    boxes
        .iter()
        .zip(volumes)
        .filter(|&(_, &volume)| volume < 0.0)
        .filter(|&(b, _)| {
            tree.leaves(|node: &BvhNode| node.contains_aabb(&TreeBox::new(b.min, b.max)))
                .next()
                .is_none()
        })
        .count()
}
