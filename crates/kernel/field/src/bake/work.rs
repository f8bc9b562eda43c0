use glam::{UVec3, Vec3};
use midair_mesh::{Aabb, TriMesh};
use rayon::prelude::*;

use super::band::{Band, NONE};
use super::frame::{Frame, NODES, SIDE};
use super::sign::{Corner, Regions};
use super::tree::Tree;
use super::triangle::Triangle;
use super::volume::{FAR_LEN, Volume};
use super::{BakeError, BakeOptions, Progress, boundary, repair};

/// Bakes the signed distance of a mesh, on every core; the same bytes on any number of them.
///
/// The mesh may be open, inside out, partly flipped, repeated or crossing itself: its pieces are
/// oriented, its holes closed with lids, and a node is inside where the generalised winding number
/// of the result (Jacobson et al. 2013, by the fast sums of Barill et al. 2018) is not zero. A
/// sheet that bounds nothing, such as a wall within a solid, leaves no trace.
///
/// Distances are exact at the nodes within 1.75 steps of the surface, and so at every corner of a
/// cell it passes. In the rest of a near brick the closest triangle is handed on from node to node,
/// which may claim up to a tenth of a step too much. At the corners of far bricks the closest
/// triangle is sought in a tree.
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
    progress.check()?;
    let closed = repair::close(mesh, 2.0 * step, progress)?;
    let solid = bounds_of(&closed.triangles);
    let frame = Frame::around(solid.grown(padding.max(step)), step)?;
    progress.set_fraction(0.1);

    let whole = Tree::new(&closed.triangles);
    progress.check()?;
    progress.set_fraction(0.15);
    if closed.lids < closed.triangles.len() {
        let kept = boundary::bounding(&closed.triangles, closed.lids, &whole, step, progress)?;
        let tree = Tree::new(&kept);
        return measure(frame, solid, &tree, &whole, true, progress);
    }
    measure(frame, solid, &whole, &whole, true, progress)
}

/// Distances to the triangles of `surface`, signs by the winding number of `whole`.
fn measure(
    frame: Frame,
    solid: Aabb,
    surface: &Tree,
    whole: &Tree,
    may_cross: bool,
    progress: &Progress,
) -> Result<Volume, BakeError> {
    let mut band = Band::new(frame, surface, progress)?;
    let mut corners = far_corners(&band, surface, progress)?;
    progress.set_fraction(0.85);
    let mut regions = Regions::find(&band, &corners, progress)?;
    let (inside, simple) = regions.inside(whole, progress)?;
    if !simple && may_cross {
        let kept = boundary::bounding(surface.triangles(), 0, whole, frame.step, progress)?;
        if !kept.is_empty() {
            let tree = Tree::new(&kept);
            return measure(frame, solid, &tree, whole, false, progress);
        }
    }
    progress.set_fraction(0.95);
    band.blocks
        .par_iter_mut()
        .enumerate()
        .for_each(|(s, b)| regions.sign(&inside, s, &mut b.distance));
    for (i, c) in corners.iter_mut().enumerate() {
        if c.triangle != NONE && regions.corner_inside(&inside, i) {
            c.distance = -c.distance;
        }
    }
    let volume = Volume::assemble(frame, solid, &band.near, |b, out| {
        if out.len() == FAR_LEN {
            fill_far(&band, &corners, surface, b, out);
        } else {
            fill_near(&band, b, out);
        }
    })?;
    progress.check()?;
    progress.set_fraction(1.0);
    Ok(volume)
}

fn bounds_of(triangles: &[Triangle]) -> Aabb {
    triangles
        .iter()
        .flat_map(|t| t.v)
        .fold(Aabb::EMPTY, |b, p| b.including(p))
}

/// The distance of every brick corner that lies in no block.
fn far_corners(band: &Band, tree: &Tree, progress: &Progress) -> Result<Vec<Corner>, BakeError> {
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
                    let p = band.frame.node(place * SIDE as u32);
                    let (d, t) = tree.closest(p, guess);
                    guess = Some(t);
                    *corner = Corner {
                        distance: d.sqrt(),
                        triangle: t,
                    };
                }
            }
        });
    progress.check()?;
    Ok(corners)
}

fn fill_near(band: &Band, brick: usize, out: &mut [f32]) {
    let place = band.frame.brick_at(brick);
    for (k, row) in out.chunks_exact_mut(NODES).enumerate() {
        let (y, z) = (k % NODES, k / NODES);
        let at = place + UVec3::new(0, (y / SIDE) as u32, (z / SIDE) as u32);
        let i = SIDE * (y % SIDE + SIDE * (z % SIDE));
        let own = &band.blocks[band.slot(at) as usize].distance;
        row[..SIDE].copy_from_slice(&own[i..i + SIDE]);
        row[SIDE] = band.blocks[band.slot(at + UVec3::X) as usize].distance[i];
    }
}

fn fill_far(band: &Band, corners: &[Corner], tree: &Tree, brick: usize, out: &mut [f32]) {
    let place = band.frame.brick_at(brick);
    let mut guess = None;
    for (k, v) in out.iter_mut().enumerate() {
        let k = k as u32;
        let at = place + UVec3::new(k & 1, k >> 1 & 1, k >> 2);
        let slot = band.slot(at);
        *v = if slot == NONE {
            let c = corners[(at.x + band.size.x * (at.y + band.size.y * at.z)) as usize];
            guess = Some(c.triangle);
            c.distance
        } else {
            let b = &band.blocks[slot as usize];
            guess = Some(b.triangle[0]);
            b.distance[0]
        };
    }
    let middle =
        band.frame.node(place * SIDE as u32) + Vec3::splat(0.5 * SIDE as f32 * band.frame.step);
    let claimed = out.iter().sum::<f32>().abs() / FAR_LEN as f32;
    let distance = tree.closest(middle, guess).0.sqrt();
    if claimed > distance {
        out.iter_mut().for_each(|v| *v *= distance / claimed);
    }
}
