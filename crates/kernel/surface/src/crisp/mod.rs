//! Edges and corners that marching cubes cuts off, put back where the field has them.
//!
//! A vertex of marching cubes lies on an edge of the lattice, so what is sharp between two vertices
//! is bridged by a chamfer whose ends follow the lattice: the rim of a bore looks torn. Here each edge
//! of the mesh that bridges two smooth sides is split where their tangent planes and the surface meet,
//! found with the field itself (the idea of Kobbelt et al. 2001, *Feature Sensitive Surface Extraction*,
//! and of Attene et al. 2003, *Edge-Sharpener*). Nothing is flipped and nothing removed: what was
//! closed and manifold stays so.
//!
//! - `near`: the field, thinned out.
//! - `find`: feet on the surface, edges and corners, found with it.
//! - `moved`: vertices beside an edge, on the surface itself.
//! - `cut`: triangles, cut along the edges.

mod cut;
mod find;
mod moved;
mod near;

use std::sync::atomic::{AtomicBool, Ordering};

use midair_field::Program;
use midair_mesh::TriMesh;
use rayon::prelude::*;

use crate::Cancelled;
use cut::{Cut, Split};
use find::{Foot, Sampler};
use moved::Moved;
use near::Near;

/// The cosine of the angle between two normals from which an edge is looked at: 12°.
const LOOK: f32 = 0.978;
/// How often chamfers are given back, until nothing touches.
const ROUNDS: usize = 12;

/// The same closed surface with its sharp edges and corners: `mesh` is what [`crate::Surface::mesh`] gives for the
/// field of `program`. Vertices beside an edge are moved onto the surface; those of the edges are new and come
/// after all others, with a normal between those of their sides.
///
/// Of a field without sharp edges, and of a painting, nothing changes. Where two sides cannot be told
/// apart within a step, the chamfer stays.
#[must_use]
pub fn crisp(mesh: TriMesh, program: &Program) -> TriMesh {
    crisp_unless(&mesh, program, &AtomicBool::new(false))
        .ok()
        .flatten()
        .unwrap_or(mesh)
}

/// As [`crisp`], and gives up soon after `cancel` is set; `None` where nothing changes.
///
/// # Errors
///
/// [`Cancelled`].
pub fn crisp_unless(
    mesh: &TriMesh,
    program: &Program,
    cancel: &AtomicBool,
) -> Result<Option<TriMesh>, Cancelled> {
    let step = program.step();
    let fits = mesh.normals.len() == mesh.positions.len() && step > 0.0 && step.is_finite();
    if program.is_painting() || !fits {
        return Ok(None);
    }
    let go_on = || match cancel.load(Ordering::Relaxed) {
        true => Err(Cancelled),
        false => Ok(()),
    };
    go_on()?;
    // Where normals turn, which the lattice tells only as well as its step allows.
    let look = |a: u32, b: u32| mesh.normals[a as usize].dot(mesh.normals[b as usize]) < LOOK;
    let mut ends: Vec<u32> = mesh
        .triangles
        .par_iter()
        .flat_map_iter(|t| sides(*t).filter(|&[a, b]| look(a, b)).flatten())
        .collect();
    if ends.is_empty() {
        return Ok(None);
    }
    ends.par_sort_unstable();
    ends.dedup();

    let places = ends.iter().map(|&v| mesh.positions[v as usize]);
    let near = Near::new(program, places);
    let sampler = Sampler::new(&near);
    let footing =
        |&v: &u32| go_on().map(|()| sampler.footing(mesh.positions[v as usize]).map(|f| (v, f)));
    let found: Result<Vec<_>, Cancelled> = ends.par_iter().map(footing).collect();
    let feet = Feet::new(mesh.positions.len(), found?.into_iter().flatten().collect());

    // A closed surface runs along each of its edges once in each direction.
    let mut edges: Vec<[u32; 2]> = mesh
        .triangles
        .par_iter()
        .flat_map_iter(|t| sides(*t).filter(|&[a, b]| a < b && feet.has(a) && feet.has(b)))
        .collect();
    edges.par_sort_unstable();
    let split = |&ends: &[u32; 2]| {
        go_on().map(|()| {
            let [a, b] = ends.map(|v| feet.of(v));
            let edge = sampler.edge(a?, b?)?;
            Some(Split { ends, edge })
        })
    };
    let found: Result<Vec<_>, Cancelled> = edges.par_iter().map(split).collect();
    let mut splits: Vec<Split> = found?.into_iter().flatten().collect();
    if splits.is_empty() {
        return Ok(None);
    }
    let mut moved = Moved::new(mesh, &splits, &feet);
    for _ in 0..ROUNDS {
        go_on()?;
        moved.settle(mesh);
        let cut = Cut {
            mesh,
            moved: &moved,
            sampler: &sampler,
        };
        let sharp = cut.settled(&mut splits);
        go_on()?;
        let touching = sharp.mesh.touching(&sharp.changed);
        if touching.is_empty() {
            return Ok(Some(sharp.mesh));
        }
        // What touches is given back the chamfer it had.
        let mut back: Vec<u32> = touching
            .iter()
            .flatten()
            .map(|&t| sharp.origin(t))
            .collect();
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
            moved.take_back(mesh, t);
        }
    }
    Ok(None)
}

/// The directed sides of a triangle.
fn sides([a, b, c]: [u32; 3]) -> impl Iterator<Item = [u32; 2]> {
    [[a, b], [b, c], [c, a]].into_iter()
}

/// A side by which both triangles know it.
fn ascending([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Points of the surface, by the vertices that they are for.
struct Feet {
    /// In the order of the vertices.
    list: Vec<(u32, Foot)>,
    /// Of each vertex, its place in the list, counted from one.
    places: Vec<u32>,
}

impl Feet {
    fn new(vertices: usize, list: Vec<(u32, Foot)>) -> Self {
        let mut places = vec![0; vertices];
        for (place, &(v, _)) in (1..).zip(&list) {
            places[v as usize] = place;
        }
        Self { list, places }
    }

    fn all(&self) -> impl Iterator<Item = (u32, Foot)> {
        self.list.iter().copied()
    }

    fn has(&self, v: u32) -> bool {
        self.places[v as usize] > 0
    }

    fn of(&self, v: u32) -> Option<Foot> {
        let place = self.places[v as usize].checked_sub(1)?;
        Some(self.list[place as usize].1)
    }
}
