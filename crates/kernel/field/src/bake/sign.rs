//! Which nodes are inside.

use glam::{IVec3, UVec3, Vec3};
use rayon::prelude::*;

use super::band::{BLOCK, Band, NONE, SPLAT, node_in_block};
use super::frame::{SIDE, at};
use super::repair::root;
use super::tree::Tree;
use super::{BakeError, Progress};

/// A corner of far bricks that lies in no block.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub distance: f32,
    pub triangle: u32,
}

/// The nodes that no triangle separates, as far as can be told from their distances.
pub(super) struct Regions {
    /// The region of each node of each block, and of each corner in no block.
    labels: Vec<[u16; BLOCK]>,
    first_label: Vec<u32>,
    first_corner: u32,
    up: Vec<u32>,
    /// For each root its node furthest from the surface.
    deepest: Vec<(f32, Vec3)>,
}

/// Whether a ball around each of two nodes that holds no triangle meets the other, so that nothing
/// lies between them. Only distances below the splat's reach are exact, a longer one stands for it.
#[inline]
fn joined(a: f32, b: f32, apart: f32, step: f32) -> bool {
    let exact = SPLAT * step;
    a.min(exact) + b.min(exact) > apart * 1.0001
}

impl Regions {
    pub fn find(band: &Band, corners: &[Corner], progress: &Progress) -> Result<Self, BakeError> {
        let found: Vec<([u16; BLOCK], Vec<(f32, u16)>)> = (0..band.blocks.len())
            .into_par_iter()
            .map(|s| within_block(band, s))
            .collect();
        progress.check()?;
        let mut first_label = Vec::with_capacity(found.len());
        let mut deepest = Vec::new();
        for (s, (_, regions)) in found.iter().enumerate() {
            first_label.push(deepest.len() as u32);
            let first = band.places[s] * SIDE as u32;
            deepest.extend(
                regions
                    .iter()
                    .map(|&(d, i)| (d, band.frame.node(first + node_in_block(i as usize)))),
            );
        }
        let first_corner = deepest.len() as u32;
        for (i, c) in corners.iter().enumerate() {
            let p = band.frame.node(at(band.size, i) * SIDE as u32);
            deepest.push((c.distance, p));
        }
        let mut regions = Self {
            labels: found.into_iter().map(|f| f.0).collect(),
            first_label,
            first_corner,
            up: (0..deepest.len() as u32).collect(),
            deepest,
        };
        let pairs: Vec<Vec<(u32, u32)>> = (0..band.blocks.len())
            .into_par_iter()
            .map(|s| regions.across_blocks(band, s))
            .collect();
        progress.check()?;
        for (a, b) in pairs.into_iter().flatten() {
            regions.join(a, b);
        }
        // No triangle comes near a far brick: its corners are in one region.
        for b in (0..band.near.len()).filter(|&b| !band.near[b]) {
            let low = band.frame.brick_at(b);
            let first = regions.corner(band, low);
            for k in 1..8 {
                let other = regions.corner(band, low + UVec3::new(k & 1, k >> 1 & 1, k >> 2));
                regions.join(first, other);
            }
        }
        Ok(regions)
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (root(&mut self.up, a), root(&mut self.up, b));
        if a != b {
            let (low, high) = (a.min(b), a.max(b));
            self.up[high as usize] = low;
            if self.deepest[high as usize].0 > self.deepest[low as usize].0 {
                self.deepest[low as usize] = self.deepest[high as usize];
            }
        }
    }

    fn corner(&self, band: &Band, place: UVec3) -> u32 {
        let slot = band.slot(place);
        if slot != NONE {
            return self.label(slot as usize, 0);
        }
        self.first_corner + place.x + band.size.x * (place.y + band.size.y * place.z)
    }

    fn label(&self, slot: usize, node: usize) -> u32 {
        self.first_label[slot] + u32::from(self.labels[slot][node])
    }

    fn across_blocks(&self, band: &Band, s: usize) -> Vec<(u32, u32)> {
        let step = band.frame.step;
        let block = &band.blocks[s];
        let mut pairs = Vec::new();
        let mut add = |i: usize, offset: IVec3| {
            let q = node_in_block(i).as_ivec3() + offset;
            let away = q.div_euclid(IVec3::splat(SIDE as i32));
            if away == IVec3::ZERO {
                return;
            }
            let n = band.slot_beside(band.places[s], away);
            if n == NONE {
                return;
            }
            let q = q - away * SIDE as i32;
            let j = (q.x + 8 * (q.y + 8 * q.z)) as usize;
            let there = self.labels[n as usize][j];
            let apart = (offset.length_squared() as f32).sqrt() * step;
            if there != u16::MAX
                && joined(
                    block.distance[i],
                    band.blocks[n as usize].distance[j],
                    apart,
                    step,
                )
            {
                pairs.push((self.label(s, i), self.label(n as usize, j)));
            }
        };
        for i in 0..BLOCK {
            if self.labels[s][i] == u16::MAX {
                continue;
            }
            let p = node_in_block(i);
            if p.min_element() > 0 && p.max_element() < SIDE as u32 - 1 {
                continue;
            }
            if block.distance[i] < 0.6 * step {
                for o in 0..27 {
                    add(i, at(UVec3::splat(3), o).as_ivec3() - 1);
                }
            } else {
                add(i, IVec3::X);
                add(i, IVec3::Y);
                add(i, IVec3::Z);
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Asks the winding number once in each region. Returns whether each label is inside, and
    /// whether all numbers were 0 or 1, as they are around a surface that does not cross itself.
    pub fn inside(
        &mut self,
        tree: &Tree,
        progress: &Progress,
    ) -> Result<(Inside, bool), BakeError> {
        let roots: Vec<u32> = (0..self.up.len() as u32)
            .filter(|&i| self.up[i as usize] == i && self.deepest[i as usize].0.is_finite())
            .collect();
        let answers: Vec<i32> = roots
            .par_iter()
            .map(|&r| {
                if progress.is_cancelled() {
                    return 0;
                }
                tree.winding(self.deepest[r as usize].1).round() as i32
            })
            .collect();
        progress.check()?;
        let simple = answers.iter().all(|w| (0..=1).contains(w));
        let mut of_root = vec![false; self.up.len()];
        for (&r, &w) in roots.iter().zip(&answers) {
            of_root[r as usize] = w != 0;
        }
        let of_label = (0..self.up.len() as u32)
            .map(|i| of_root[root(&mut self.up, i) as usize])
            .collect();
        Ok((Inside { of_label }, simple))
    }

    /// The signs of the nodes of block `slot`, applied to `distances`.
    pub fn sign(&self, inside: &Inside, slot: usize, distances: &mut [f32; BLOCK]) {
        for (d, &l) in distances.iter_mut().zip(&self.labels[slot]) {
            if l != u16::MAX && inside.of_label[self.first_label[slot] as usize + l as usize] {
                *d = -*d;
            }
        }
    }

    /// Whether corner `i` in no block is inside.
    pub fn corner_inside(&self, inside: &Inside, i: usize) -> bool {
        inside.of_label[self.first_corner as usize + i]
    }
}

/// Whether each region is inside.
pub(super) struct Inside {
    of_label: Vec<bool>,
}

/// The regions among the nodes of one block, numbered from 0, with the deepest node of each.
fn within_block(band: &Band, s: usize) -> ([u16; BLOCK], Vec<(f32, u16)>) {
    let step = band.frame.step;
    let d = &band.blocks[s].distance;
    let needed = |i: usize| band.masks[s][i / 64] >> (i % 64) & 1 == 1;
    let mut up: [u16; BLOCK] = std::array::from_fn(|i| i as u16);
    fn find(up: &mut [u16; BLOCK], mut i: u16) -> u16 {
        while up[i as usize] != i {
            up[i as usize] = up[up[i as usize] as usize];
            i = up[i as usize];
        }
        i
    }
    let mut join = |i: usize, j: usize, apart: f32| {
        if needed(j) && joined(d[i], d[j], apart, step) {
            let (a, b) = (find(&mut up, i as u16), find(&mut up, j as u16));
            up[a.max(b) as usize] = a.min(b);
        }
    };
    for i in (0..BLOCK).filter(|&i| needed(i)) {
        let p = node_in_block(i);
        for (k, stride) in [1, SIDE, SIDE * SIDE].into_iter().enumerate() {
            if p[k] < SIDE as u32 - 1 {
                join(i, i + stride, step);
            }
        }
        if d[i] < 0.6 * step {
            for o in 0..27 {
                let q = p.as_ivec3() + at(UVec3::splat(3), o).as_ivec3() - 1;
                if o != 13 && q.min_element() >= 0 && q.max_element() < SIDE as i32 {
                    let apart = ((q - p.as_ivec3()).length_squared() as f32).sqrt() * step;
                    join(i, (q.x + 8 * (q.y + 8 * q.z)) as usize, apart);
                }
            }
        }
    }
    let mut labels = [u16::MAX; BLOCK];
    let mut regions: Vec<(f32, u16)> = Vec::new();
    for i in (0..BLOCK).filter(|&i| needed(i)) {
        // A root is the lowest of its region, so it was numbered before the rest.
        let r = find(&mut up, i as u16) as usize;
        if r == i {
            labels[i] = regions.len() as u16;
            regions.push((d[i], i as u16));
        } else {
            labels[i] = labels[r];
            let best = &mut regions[labels[r] as usize];
            if d[i] > best.0 {
                *best = (d[i], i as u16);
            }
        }
    }
    (labels, regions)
}
