//! The closest triangle of every node near the surface. All in steps from the frame's first node.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::UVec3;
use rayon::prelude::*;

use super::bars::Bars;
use super::frame::{Frame, SIDE, at};
use super::lanes::{after, before};
use super::points::{NONE, Points};
use super::triangle::Triangle;
use super::volume::{BAND, MOST_VALUES, NEAR_LEN, too_many_values};
use super::{BakeError, Progress};

/// Steps from a triangle within which every node measures it; what lies beyond hears of it from
/// its neighbours. More than √3, so that all corners of a cell that the surface passes are exact.
pub(super) const SPLAT: f32 = 1.75;

/// The nodes of all near bricks, by blocks of eight by eight by eight. A block holds the nodes at
/// the low corner of the brick of the same coordinates; the nodes at a brick's high faces belong to
/// the blocks after it, so there is one layer of blocks more than of bricks.
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
    pub blocks: Vec<Points>,
}

impl Band {
    /// The nodes that are needed, without what they know.
    pub fn around(
        frame: Frame,
        triangles: &[Triangle],
        progress: &Progress,
    ) -> Result<Self, BakeError> {
        let near = near_bricks(&frame, triangles, progress)?;
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
        Ok(band)
    }

    /// Finds the closest triangle of each node.
    pub fn measure(&mut self, bars: &Bars, progress: &Progress) -> Result<(), BakeError> {
        self.blocks = super::splat::blocks(self, bars, progress)?;
        super::wave::run(self, progress)
    }

    pub fn slot(&self, place: UVec3) -> u32 {
        self.slots[(place.x + self.size.x * (place.y + self.size.y * place.z)) as usize]
    }

    /// The slots of the bar that begins at `place`.
    pub fn bar(&self, place: UVec3) -> &[u32] {
        let first = self.size.x * (place.y + self.size.y * place.z);
        &self.slots[first as usize..(first + self.size.x) as usize]
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
    }
}

/// The needed nodes of row `row` (y + 8 z) of a block, a bit for each.
#[inline(always)]
pub(super) fn needed(mask: &[u64; SIDE], row: usize) -> u8 {
    (mask[row / SIDE] >> (8 * (row % SIDE))) as u8
}

/// Whether each brick has a triangle within [`BAND`], or nearly so.
fn near_bricks(
    frame: &Frame,
    triangles: &[Triangle],
    progress: &Progress,
) -> Result<Vec<bool>, BakeError> {
    let near: Vec<AtomicBool> = (0..frame.brick_count())
        .map(|_| AtomicBool::new(false))
        .collect();
    let last = frame.bricks() - UVec3::ONE;
    let side = SIDE as f32;
    let half = 0.5 * side;
    let ball = BAND + half * 3.0f32.sqrt();
    let one = |t: &Triangle| {
        let v = &t.v;
        let (min, max) = (
            v[0].min(v[1]).min(v[2]) - BAND,
            v[0].max(v[1]).max(v[2]) + BAND,
        );
        let range = |k: usize| {
            let low = (after(min[k] / side) - 1).max(0) as u32;
            low..=(before(max[k] / side).max(0) as u32).min(last[k])
        };
        let (xs, ys, zs) = (range(0), range(1), range(2));
        let alone = [&xs, &ys, &zs].iter().all(|r| r.start() == r.end());
        let level = t.n.dot(v[0]);
        let slab = BAND + half * t.n.abs().element_sum();
        for z in zs {
            for y in ys.clone() {
                for x in xs.clone() {
                    let place = UVec3::new(x, y, z);
                    let mark = &near[frame.brick_index(place)];
                    if mark.load(Ordering::Relaxed) {
                        continue;
                    }
                    let centre = place.as_vec3() * side + half;
                    let beyond = || {
                        (t.n.dot(centre) - level).abs() > slab
                            || t.distance_squared(centre) > ball * ball * 1.0001
                    };
                    if alone || !beyond() {
                        mark.store(true, Ordering::Relaxed);
                    }
                }
            }
        }
    };
    triangles.par_chunks(256).for_each(|chunk| {
        if !progress.is_cancelled() {
            chunk.iter().for_each(one);
        }
    });
    progress.check()?;
    Ok(near.into_iter().map(AtomicBool::into_inner).collect())
}
