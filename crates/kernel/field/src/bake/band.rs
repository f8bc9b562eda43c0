//! The closest triangle of every node near the surface.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::{UVec3, Vec3};
use midair_mesh::Aabb;
use rayon::prelude::*;

use super::frame::{Frame, SIDE, at};
use super::tree::Tree;
use super::triangle::Triangle;
use super::volume::{BAND, MOST_VALUES, NEAR_LEN, too_many_values};
use super::{BakeError, Progress};

/// Steps from a triangle within which every node measures it; what lies beyond hears of it from
/// its neighbours. More than √3, so that all corners of a cell that the surface passes are exact.
pub(super) const SPLAT: f32 = 1.75;
/// Pairs of block and triangle held at once.
const MOST_PAIRS: usize = 1 << 23;
pub(super) const NONE: u32 = u32::MAX;
pub(super) const BLOCK: usize = SIDE * SIDE * SIDE;

/// Eight by eight by eight nodes: the closest triangle and the distance to it, metres.
#[derive(Clone)]
pub(super) struct Block {
    pub triangle: [u32; BLOCK],
    pub distance: [f32; BLOCK],
}

/// The nodes of all near bricks, by blocks. A block holds the nodes at the low corner of the brick
/// of the same coordinates; the nodes at a brick's high faces belong to the blocks after it, so
/// there is one layer of blocks more than of bricks.
pub(super) struct Band {
    pub frame: Frame,
    /// Whether each brick keeps all its nodes.
    pub near: Vec<bool>,
    /// Blocks along each axis, and which of `blocks` each is, or [`NONE`].
    pub size: UVec3,
    pub slots: Vec<u32>,
    pub places: Vec<UVec3>,
    /// A bit for each node that some near brick needs, a word for each z.
    pub masks: Vec<[u64; SIDE]>,
    pub blocks: Vec<Block>,
}

impl Band {
    pub fn new(frame: Frame, tree: &Tree, progress: &Progress) -> Result<Self, BakeError> {
        let near = near_bricks(&frame, tree.triangles(), progress)?;
        let values = near.iter().filter(|&&n| n).count() * NEAR_LEN;
        if values > MOST_VALUES {
            return Err(too_many_values(frame.step, values));
        }
        let size = frame.bricks() + UVec3::ONE;
        let mut band = Self {
            frame,
            near,
            size,
            slots: vec![NONE; (size.x * size.y * size.z) as usize],
            places: Vec::new(),
            masks: Vec::new(),
            blocks: Vec::new(),
        };
        band.allocate();
        band.splat(tree.triangles(), progress)?;
        super::wave::run(&mut band, tree.triangles(), progress)?;
        band.fill(tree, progress)?;
        Ok(band)
    }

    pub fn slot(&self, place: UVec3) -> u32 {
        self.slots[(place.x + self.size.x * (place.y + self.size.y * place.z)) as usize]
    }

    /// The slot `offset` blocks away, or [`NONE`].
    pub fn slot_beside(&self, place: UVec3, offset: glam::IVec3) -> u32 {
        let q = place.as_ivec3() + offset;
        if q.min_element() < 0 || q.cmpge(self.size.as_ivec3()).any() {
            NONE
        } else {
            self.slot(q.as_uvec3())
        }
    }

    fn allocate(&mut self) {
        let bricks = self.frame.bricks();
        for i in 0..self.slots.len() {
            let place = at(self.size, i);
            let mut mask = [0u64; SIDE];
            let mut any = false;
            for k in 0..8u32 {
                let back = UVec3::new(k & 1, k >> 1 & 1, k >> 2);
                if place.cmplt(back).any() || (place - back).cmpge(bricks).any() {
                    continue;
                }
                if !self.near[self.frame.brick_index(place - back)] {
                    continue;
                }
                any = true;
                let x = if back.x == 1 { 1 } else { 0xff };
                let rows = if back.y == 1 { 1 } else { SIDE };
                let layer = (0..rows).fold(0u64, |m, y| m | x << (8 * y));
                let layers = if back.z == 1 { 1 } else { SIDE };
                for m in &mut mask[..layers] {
                    *m |= layer;
                }
            }
            if any {
                self.slots[i] = self.places.len() as u32;
                self.places.push(place);
                self.masks.push(mask);
            }
        }
        let empty = Block {
            triangle: [NONE; BLOCK],
            distance: [f32::INFINITY; BLOCK],
        };
        self.blocks = (0..self.places.len())
            .into_par_iter()
            .map(|_| empty.clone())
            .collect();
    }

    /// Measures each triangle from the nodes close to it.
    fn splat(&mut self, triangles: &[Triangle], progress: &Progress) -> Result<(), BakeError> {
        const CHUNK: usize = 512;
        let mut first = 0;
        while first < triangles.len() {
            progress.check()?;
            let mut pairs: Vec<Vec<(u32, u32)>> = Vec::new();
            let mut held = 0;
            while first < triangles.len() && held < MOST_PAIRS {
                let end = (first + 16 * CHUNK).min(triangles.len());
                let found: Vec<Vec<(u32, u32)>> = triangles[first..end]
                    .par_chunks(CHUNK)
                    .enumerate()
                    .map(|(c, chunk)| {
                        let mut out = Vec::with_capacity(4 * chunk.len());
                        for (i, t) in chunk.iter().enumerate() {
                            let id = (first + c * CHUNK + i) as u32;
                            let span = (SIDE - 1) as f32;
                            visit(&self.frame, self.size, t, SPLAT, span, |place| {
                                let slot = self.slot(place);
                                if slot != NONE {
                                    out.push((slot, id));
                                }
                            });
                        }
                        out
                    })
                    .collect();
                held += found.iter().map(Vec::len).sum::<usize>();
                pairs.extend(found);
                first = end;
                progress.check()?;
            }
            let mut ends = vec![0u32; self.blocks.len() + 1];
            for &(slot, _) in pairs.iter().flatten() {
                ends[slot as usize + 1] += 1;
            }
            for i in 1..ends.len() {
                ends[i] += ends[i - 1];
            }
            let mut cursor = ends.clone();
            let mut ids = vec![0u32; held];
            for &(slot, id) in pairs.iter().flatten() {
                let c = &mut cursor[slot as usize];
                ids[*c as usize] = id;
                *c += 1;
            }
            let (frame, places) = (self.frame, &self.places);
            self.blocks
                .par_iter_mut()
                .enumerate()
                .for_each(|(s, block)| {
                    if progress.is_cancelled() {
                        return;
                    }
                    let ids = &ids[ends[s] as usize..ends[s + 1] as usize];
                    splat_block(&frame, places[s] * SIDE as u32, block, ids, triangles);
                });
            progress.check()?;
            progress.set_fraction(0.15 + 0.35 * first as f32 / triangles.len() as f32);
        }
        let blocks = &mut self.blocks;
        blocks.par_iter_mut().for_each(|b| {
            for d in &mut b.distance {
                *d = d.sqrt();
            }
        });
        Ok(())
    }

    /// Asks the tree for what no neighbour could tell.
    fn fill(&mut self, tree: &Tree, progress: &Progress) -> Result<(), BakeError> {
        let (frame, places, masks) = (self.frame, &self.places, &self.masks);
        self.blocks
            .par_iter_mut()
            .enumerate()
            .for_each(|(s, block)| {
                for i in 0..BLOCK {
                    let needed = masks[s][i / 64] >> (i % 64) & 1 == 1;
                    if needed && block.triangle[i] == NONE && !progress.is_cancelled() {
                        let p = frame.node(places[s] * SIDE as u32 + node_in_block(i));
                        let (d, t) = tree.closest(p, None);
                        (block.distance[i], block.triangle[i]) = (d.sqrt(), t);
                    }
                }
            });
        progress.check()
    }
}

pub(super) fn node_in_block(i: usize) -> UVec3 {
    at(UVec3::splat(SIDE as u32), i)
}

/// Calls `f` with every cube of nodes, `span` steps wide and eight apart, that comes within `reach`
/// steps of a triangle; perhaps with some that come only nearly so close.
fn visit(
    frame: &Frame,
    size: UVec3,
    t: &Triangle,
    reach: f32,
    span: f32,
    mut f: impl FnMut(UVec3),
) {
    let inverse = 1.0 / frame.step;
    let side = SIDE as f32;
    let v = t.v.map(|p| (p - frame.origin) * inverse);
    let box_ = Aabb::new(v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2])).grown(reach);
    let lo = ((box_.min - span) / side).ceil().max(Vec3::ZERO).as_uvec3();
    let hi = (box_.max / side)
        .floor()
        .max(Vec3::ZERO)
        .as_uvec3()
        .min(size - UVec3::ONE);
    let alone = lo == hi;
    let half = 0.5 * span;
    let level = t.n.dot(v[0]);
    let slab = reach + half * t.n.abs().element_sum();
    let ball = (reach + half * 3.0f32.sqrt()) * frame.step;
    for z in lo.z..=hi.z {
        for y in lo.y..=hi.y {
            for x in lo.x..=hi.x {
                let place = UVec3::new(x, y, z);
                if !alone {
                    let centre = place.as_vec3() * side + half;
                    let height = t.n.dot(centre) - level;
                    if height.abs() > slab {
                        continue;
                    }
                    let p = frame.origin + centre * frame.step;
                    if t.distance_squared(p) > ball * ball * 1.0001 {
                        continue;
                    }
                }
                f(place);
            }
        }
    }
}

fn near_bricks(
    frame: &Frame,
    triangles: &[Triangle],
    progress: &Progress,
) -> Result<Vec<bool>, BakeError> {
    let near: Vec<AtomicBool> = (0..frame.brick_count())
        .map(|_| AtomicBool::new(false))
        .collect();
    let bricks = frame.bricks();
    triangles.par_chunks(256).for_each(|chunk| {
        for t in chunk {
            if progress.is_cancelled() {
                return;
            }
            visit(frame, bricks, t, BAND, SIDE as f32, |place| {
                near[frame.brick_index(place)].store(true, Ordering::Relaxed);
            });
        }
    });
    progress.check()?;
    Ok(near.into_iter().map(AtomicBool::into_inner).collect())
}

fn splat_block(
    frame: &Frame,
    first: UVec3,
    block: &mut Block,
    ids: &[u32],
    triangles: &[Triangle],
) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has AVX2, as just asked.
        return unsafe { splat_block_avx2(frame, first, block, ids, triangles) };
    }
    splat_block_any(frame, first, block, ids, triangles);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn splat_block_avx2(
    frame: &Frame,
    first: UVec3,
    block: &mut Block,
    ids: &[u32],
    triangles: &[Triangle],
) {
    splat_block_any(frame, first, block, ids, triangles);
}

#[inline(always)]
fn splat_block_any(
    frame: &Frame,
    first: UVec3,
    block: &mut Block,
    ids: &[u32],
    triangles: &[Triangle],
) {
    let reach = SPLAT * frame.step;
    let low = frame.node(first);
    let inverse = 1.0 / frame.step;
    let x: [f32; SIDE] = std::array::from_fn(|i| frame.node(first + UVec3::new(i as u32, 0, 0)).x);
    let half = 3.5 * frame.step;
    for &id in ids {
        let t = &triangles[id as usize];
        let [a, b, c] = t.v;
        let lo = ((a.min(b).min(c) - reach - low) * inverse)
            .ceil()
            .max(Vec3::ZERO)
            .as_uvec3();
        let hi = ((a.max(b).max(c) + reach - low) * inverse)
            .floor()
            .max(Vec3::ZERO)
            .as_uvec3();
        let slab = reach + half * t.n.x.abs();
        for z in lo.z..=hi.z.min(SIDE as u32 - 1) {
            for y in lo.y..=hi.y.min(SIDE as u32 - 1) {
                let p = frame.node(first + UVec3::new(0, y, z));
                let middle = Vec3::new(p.x + half, p.y, p.z);
                if t.n.dot(middle - a).abs() > slab {
                    continue;
                }
                let d = t.distance_squared_row(&x, p.y, p.z);
                let row = (y + SIDE as u32 * z) as usize * SIDE;
                let distance = &mut block.distance[row..row + SIDE];
                let triangle = &mut block.triangle[row..row + SIDE];
                // Strictly less: among equals the first triangle stays.
                for i in 0..SIDE {
                    let closer = d[i] < distance[i];
                    distance[i] = if closer { d[i] } else { distance[i] };
                    triangle[i] = if closer { id } else { triangle[i] };
                }
            }
        }
    }
}
