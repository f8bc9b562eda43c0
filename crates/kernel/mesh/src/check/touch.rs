use glam::DVec3;
use parry3d::bounding_volume::Aabb;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use rayon::prelude::*;

use super::cells::Cells;
use super::predicates::{Triangle, folded, meet, meet_beyond_corner, open_axis};
use crate::TriMesh;

/// Triangles searched before the bounds below are looked at. Fixed, so that where the search stops
/// does not depend on the number of threads.
const BATCH: usize = 2048;
/// Pairs found, and pairs looked at, after which the search stops.
const ENOUGH: usize = 100_000;
const PATIENCE: usize = 300_000_000;
/// Pairs of one triangle after which it is left alone.
const ENOUGH_OF_ONE: usize = 1000;

/// What the search for touching triangles found.
pub(super) struct Touching {
    /// Pairs of triangles, the smaller number first, in order.
    pub pairs: Vec<[u32; 2]>,
    /// Whether all pairs were looked at.
    pub complete: bool,
}

/// Pairs of triangles that have more in common than the corners they share. Triangles that are a
/// line take no part: they are reported as such.
pub(super) fn touching(mesh: &TriMesh) -> Touching {
    let boxes: Vec<Aabb> = (0..mesh.triangles.len())
        .into_par_iter()
        .map(|t| bounds(mesh, t))
        .collect();
    let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
    let real: Vec<bool> = (0..mesh.triangles.len())
        .into_par_iter()
        .map(|t| open_axis(&corners(mesh, t)).is_some())
        .collect();
    let mut found = Touching {
        pairs: Vec::new(),
        complete: true,
    };
    let mut seen = 0;
    for start in (0..boxes.len()).step_by(BATCH) {
        if found.pairs.len() >= ENOUGH || seen >= PATIENCE {
            found.complete = false;
            break;
        }
        let end = boxes.len().min(start + BATCH);
        let (pairs, looks) = (start..end)
            .into_par_iter()
            .filter(|&i| real[i])
            .map(|i| {
                let around = BvhNode::leaf(boxes[i], 0);
                let mut pairs = Vec::new();
                let mut looks = 0;
                for j in tree
                    .leaves(|node| node.intersects(&around))
                    .filter(|&j| j as usize > i && real[j as usize])
                {
                    looks += 1;
                    if touch(mesh, i, j as usize) {
                        pairs.push([i as u32, j]);
                        if pairs.len() == ENOUGH_OF_ONE {
                            // Too many to be worth the count: the next look at the bounds stops.
                            looks = PATIENCE;
                            break;
                        }
                    }
                }
                (pairs, looks)
            })
            .reduce(
                || (Vec::new(), 0),
                |(mut pairs, looks), (more, again)| {
                    pairs.extend(more);
                    (pairs, looks + again)
                },
            );
        found.pairs.extend(pairs);
        seen += looks;
        found.complete &= looks < PATIENCE;
    }
    found.pairs.sort_unstable();
    found
}

impl TriMesh {
    /// Pairs of triangles, of which at least one is among `some`, that have more in common than the corners they
    /// share: what [`crate::check`](crate::check()) would count of them. In order, without repeats.
    ///
    /// All triangles must name vertices that are there and finite, and `some` triangles.
    #[must_use]
    pub fn touching(&self, some: &[u32]) -> Vec<[u32; 2]> {
        let boxes: Vec<Aabb> = some.iter().map(|&t| bounds(self, t as usize)).collect();
        let cells = Cells::new(&boxes);
        let mut among = vec![false; self.triangles.len()];
        for &t in some {
            among[t as usize] = true;
        }
        let mut pairs: Vec<[u32; 2]> = (0..self.triangles.len() as u32)
            .into_par_iter()
            .flat_map_iter(|i| {
                let mut pairs = Vec::new();
                cells.each_near(&bounds(self, i as usize), |b| {
                    let j = some[b];
                    // Two of them are looked at from one of the two.
                    let looked = j == i || (among[i as usize] && j < i);
                    if !looked && touch(self, i as usize, j as usize) {
                        pairs.push([i.min(j), i.max(j)]);
                    }
                });
                pairs
            })
            .collect();
        pairs.par_sort_unstable();
        pairs.dedup();
        pairs
    }
}

fn bounds(mesh: &TriMesh, t: usize) -> Aabb {
    let [a, b, c] = mesh.corners(t);
    Aabb::new(a.min(b).min(c), a.max(b).max(c))
}

fn corners(mesh: &TriMesh, t: usize) -> Triangle {
    mesh.corners(t).map(|p| p.as_dvec3())
}

fn touch(mesh: &TriMesh, i: usize, j: usize) -> bool {
    let (of_i, of_j) = (mesh.triangles[i], mesh.triangles[j]);
    let shared = of_i.map(|v| of_j.contains(&v));
    let (a, b) = (corners(mesh, i), corners(mesh, j));
    match shared.iter().filter(|&&s| s).count() {
        0 => meet(&a, &b),
        1 => {
            let k = shared.iter().position(|&s| s).unwrap_or(0);
            let l = of_j.iter().position(|&v| v == of_i[k]).unwrap_or(0);
            meet_beyond_corner(&from(&a, k), &from(&b, l))
        }
        2 => {
            let k = shared.iter().position(|&s| !s).unwrap_or(0);
            let l = of_j.iter().position(|v| !of_i.contains(v)).unwrap_or(0);
            let a = from(&a, (k + 1) % 3);
            let apex: DVec3 = b[l];
            folded(&a, &[a[0], a[1], apex])
        }
        // The same three corners are a duplicate, reported as such.
        _ => false,
    }
}

/// `t` turned so that its corner `k` comes first.
fn from(t: &Triangle, k: usize) -> Triangle {
    [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]
}
