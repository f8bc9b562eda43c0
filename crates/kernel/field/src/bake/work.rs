use glam::{UVec3, Vec3};
use midair_mesh::{Aabb, TriMesh};
use rayon::prelude::*;

use super::band::Band;
use super::bars::Bars;
use super::frame::{Frame, NODES, SIDE};
use super::points::{BLOCK, NONE};
use super::sign::Signs;
use super::tree::Tree;
use super::triangle::Triangle;
use super::volume::{FAR_LEN, Volume};
use super::{BakeError, BakeOptions, Progress, boundary, repair, wave};

const LAYER: usize = SIDE * SIDE;

/// Bakes the signed distance of a mesh, on every core; the same bytes on any number of them.
///
/// The mesh may be open, inside out, partly flipped, repeated or crossing itself: its pieces are
/// oriented, its holes closed with lids, and a node is inside where the winding number of the result,
/// counted along rays, is not zero. A sheet that bounds nothing, such as a wall within a solid, leaves
/// no trace.
///
/// Distances are exact at the nodes within 1.75 steps of the surface, and so at every corner of a
/// cell it passes. In the rest of a near brick the closest triangle is handed on from node to node,
/// which may claim too much: hundredths of a step on fine meshes, on facets of many steps a quarter of
/// a step at three steps and up to a whole one beyond seven, and no more than a step beyond the next node. At
/// the corners of far bricks the closest triangle is sought in a tree.
///
/// # Errors
/// A mesh without triangles, extent or finite positions, a step or padding that is none, a grid
/// beyond 2 GiB, or [`Progress::cancel`].
pub fn bake(
    mesh: &TriMesh,
    options: &BakeOptions,
    progress: &Progress,
) -> Result<Volume, BakeError> {
    let &BakeOptions { step, padding } = options;
    if !(step.is_finite() && step > 0.0) {
        return Err(BakeError::Step(step));
    }
    if !(padding.is_finite() && padding >= 0.0) {
        return Err(BakeError::Padding(padding));
    }
    // Once for all on a thread that works: the others need no waking between two pieces of work.
    rayon::scope(|_| bake_within(mesh, step, padding, progress))
}

fn bake_within(
    mesh: &TriMesh,
    step: f32,
    padding: f32,
    progress: &Progress,
) -> Result<Volume, BakeError> {
    progress.check()?;
    let closed = repair::close(mesh, 2.0 * step, progress)?;
    let solid = bounds_of(&closed.triangles);
    let frame = Frame::around(solid.grown(padding.max(step)), step)?;
    progress.set_fraction(0.1);
    let inverse = 1.0 / step;
    let in_steps = |t: &[Vec3; 3]| Triangle::new(t.map(|p| (p - frame.origin) * inverse));
    let whole: Vec<Triangle> = closed
        .triangles
        .par_iter()
        .with_min_len(256)
        .map(in_steps)
        .collect();
    progress.set_fraction(0.15);
    if closed.lids < whole.len() {
        let kept = boundary::bounding(&whole, closed.lids, &Tree::new(&whole), progress)?;
        return measure(frame, solid, &kept, &whole, true, progress);
    }
    measure(frame, solid, &whole, &whole, true, progress)
}

/// Distances to the triangles of `surface`, signs by the winding number of `whole`; both in steps.
fn measure(
    frame: Frame,
    solid: Aabb,
    surface: &[Triangle],
    whole: &[Triangle],
    may_cross: bool,
    progress: &Progress,
) -> Result<Volume, BakeError> {
    let plan = || {
        let band = Band::around(frame, surface, progress)?;
        let bars = Bars::new(band.size, surface, progress)?;
        let signs = if std::ptr::eq(surface, whole) {
            Signs::new(&band, &bars, progress)?
        } else {
            Signs::new(&band, &Bars::new(band.size, whole, progress)?, progress)?
        };
        Ok((band, bars, signs))
    };
    let (plan, tree) = rayon::join(plan, || Tree::new(surface));
    let (mut band, bars, signs) = plan?;
    if !signs.simple && may_cross {
        let kept = boundary::bounding(surface, 0, &Tree::new(whole), progress)?;
        if !kept.is_empty() {
            return measure(frame, solid, &kept, whole, false, progress);
        }
    }
    band.measure(&bars, progress)?;
    let corners = far_corners(&band, &signs, &tree, progress)?;
    progress.set_fraction(0.85);
    let slots = || (0..band.blocks.len()).into_par_iter().with_min_len(4);
    let distances: Vec<_> = slots().map(|s| wave::distances(&band, s, &tree)).collect();
    progress.check()?;
    let distances: Vec<[f32; BLOCK]> = slots()
        .map(|slot| {
            let mut own = wave::steadied(&band, slot, &distances);
            let layers = own.as_chunks_mut::<LAYER>().0.iter_mut();
            for (layer, inside) in layers.zip(&signs.blocks[slot]) {
                for (i, d) in layer.iter_mut().enumerate() {
                    // The bit becomes that of the sign.
                    let sign = (inside >> i << 31) as u32 & 1 << 31;
                    *d = f32::from_bits((*d * frame.step).to_bits() | sign);
                }
            }
            own
        })
        .collect();
    progress.check()?;
    progress.set_fraction(0.95);
    let volume = Volume::assemble(frame, solid, &band.near, |b, out| {
        if out.len() == FAR_LEN {
            fill_far(&band, &distances, &corners, &tree, b, out);
        } else {
            fill_near(&band, &distances, b, out);
        }
    })?;
    progress.check()?;
    progress.set_fraction(1.0);
    Ok(volume)
}

/// A corner of far bricks that lies in no block.
#[derive(Clone, Copy)]
struct Corner {
    /// φ, metres.
    distance: f32,
    triangle: u32,
}

fn bounds_of(triangles: &[[Vec3; 3]]) -> Aabb {
    let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for p in triangles.iter().flatten() {
        (min, max) = (min.min(*p), max.max(*p));
    }
    Aabb { min, max }
}

/// The distance of every brick corner that lies in no block.
fn far_corners(
    band: &Band,
    signs: &Signs,
    tree: &Tree,
    progress: &Progress,
) -> Result<Vec<Corner>, BakeError> {
    let none = Corner {
        distance: f32::NEG_INFINITY,
        triangle: NONE,
    };
    let mut corners = vec![none; band.slots.len()];
    let n = band.size;
    corners
        .par_chunks_mut(n.x as usize)
        .enumerate()
        .for_each(|(row, corners)| {
            let mut guess = None;
            for (x, corner) in corners.iter_mut().enumerate() {
                let place = UVec3::new(x as u32, row as u32 % n.y, row as u32 / n.y);
                if band.slot(place) == NONE && !progress.is_cancelled() {
                    let p = (place * SIDE as u32).as_vec3();
                    let (d, t) = tree.closest(p, guess);
                    guess = Some(t);
                    let inside = signs.corners[row * n.x as usize + x];
                    let step = band.frame.step;
                    *corner = Corner {
                        distance: d.sqrt() * if inside { -step } else { step },
                        triangle: t,
                    };
                }
            }
        });
    progress.check()?;
    Ok(corners)
}

fn fill_near(band: &Band, distances: &[[f32; BLOCK]], brick: usize, out: &mut [f32]) {
    let place = band.frame.brick_at(brick);
    for (k, row) in out.chunks_exact_mut(NODES).enumerate() {
        let (y, z) = (k % NODES, k / NODES);
        let at = place + UVec3::new(0, (y / SIDE) as u32, (z / SIDE) as u32);
        let i = SIDE * (y % SIDE + SIDE * (z % SIDE));
        let own = &distances[band.slot(at) as usize];
        row[..SIDE].copy_from_slice(&own[i..i + SIDE]);
        row[SIDE] = distances[band.slot(at + UVec3::X) as usize][i];
    }
}

fn fill_far(
    band: &Band,
    distances: &[[f32; BLOCK]],
    corners: &[Corner],
    tree: &Tree,
    brick: usize,
    out: &mut [f32],
) {
    let place = band.frame.brick_at(brick);
    let mut guess = None;
    for (k, v) in out.iter_mut().enumerate() {
        let k = k as u32;
        let at = place + UVec3::new(k & 1, k >> 1 & 1, k >> 2);
        let slot = band.slot(at);
        let triangle;
        (*v, triangle) = if slot == NONE {
            let c = corners[(at.x + band.size.x * (at.y + band.size.y * at.z)) as usize];
            (c.distance, c.triangle)
        } else {
            let known = band.blocks[slot as usize].triangle[0];
            (distances[slot as usize][0], known)
        };
        // A node that heard of none asked the tree.
        if triangle != NONE {
            guess = Some(triangle);
        }
    }
    let middle = (place * SIDE as u32).as_vec3() + 0.5 * SIDE as f32;
    let claimed = out.iter().sum::<f32>().abs() / FAR_LEN as f32;
    let distance = tree.closest(middle, guess).0.sqrt() * band.frame.step;
    if claimed > distance {
        out.iter_mut().for_each(|v| *v *= distance / claimed);
    }
}
