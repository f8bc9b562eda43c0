//! Distances measured by the nodes close to each triangle.

use glam::{UVec3, Vec2};
use rayon::prelude::*;

use super::band::{Band, SPLAT, needed};
use super::bars::{Bars, reach};
use super::eight::Seen;
use super::frame::SIDE;
use super::lanes::{EIGHT, F8, Simd, U8, lanes};
use super::points::{NONE, Points, Row, of_row};
use super::triangle::Triangle;
use super::{BakeError, Progress};

/// Rows of nodes in a bar: the blocks that differ in x alone.
const ROWS: usize = SIDE * SIDE;

/// The nodes of one bar while triangles are measured: for each row those of all blocks, with eight
/// more at both ends.
struct Bar {
    width: usize,
    /// A bit for each row that is needed.
    wanted: u64,
    square: Vec<f32>,
    triangle: Vec<u32>,
}

impl Bar {
    fn new(blocks: u32) -> Self {
        let width = SIDE * (blocks as usize + 2);
        Self {
            width,
            wanted: 0,
            square: vec![f32::INFINITY; ROWS * width],
            triangle: vec![NONE; ROWS * width],
        }
    }
}

/// What nodes near triangles measure, in the order of the band's slots.
pub(super) fn blocks(
    band: &Band,
    bars: &Bars,
    progress: &Progress,
) -> Result<Vec<Box<Points>>, BakeError> {
    let n = band.size;
    let mut blocks = Vec::with_capacity(band.places.len());
    for layers in &bars.groups {
        let group = bars.group(layers, progress)?;
        let one = |bar: &mut Bar, i: usize| {
            if progress.is_cancelled() {
                return Vec::new();
            }
            let place = UVec3::new(0, i as u32 % n.y, layers.start + i as u32 / n.y);
            bar.fill(band, place, group.of(i), bars.triangles)
        };
        let found: Vec<Vec<Box<Points>>> = (0..group.len())
            .into_par_iter()
            .with_max_len(1)
            .map_init(|| Bar::new(n.x), one)
            .collect();
        progress.check()?;
        progress.set_fraction(0.15 + 0.35 * layers.end as f32 / n.z as f32);
        blocks.extend(found.into_iter().flatten());
    }
    Ok(blocks)
}

impl Bar {
    /// The blocks of the bar that begins at `place`.
    fn fill(
        &mut self,
        band: &Band,
        place: UVec3,
        ids: &[u32],
        triangles: &[Triangle],
    ) -> Vec<Box<Points>> {
        let n = band.size;
        let row = (n.x * (place.y + n.y * place.z)) as usize;
        let slots = &band.slots[row..row + n.x as usize];
        let Some(first) = slots.iter().copied().find(|s| *s != NONE) else {
            return Vec::new();
        };
        let count = slots.iter().filter(|s| **s != NONE).count();
        let masks = &band.masks[first as usize..first as usize + count];
        self.wanted = (0..ROWS)
            .filter(|r| masks.iter().any(|m| needed(m, *r) != 0))
            .fold(0, |all, r| all | 1 << r);
        self.square.fill(f32::INFINITY);
        self.triangle.fill(NONE);
        measure(self, place * SIDE as u32, ids, triangles);
        let near = (0..n.x).filter(|x| slots[*x as usize] != NONE);
        near.zip(masks)
            .map(|(x, mask)| {
                let mut block = Box::new(Points::UNKNOWN);
                let first = UVec3::new(x, place.y, place.z) * SIDE as u32;
                offset(self, first, triangles, mask, &mut block);
                block
            })
            .collect()
    }
}

lanes!(measure, measure_avx2, measure_any, (bar: &mut Bar, first: UVec3, ids: &[u32], triangles: &[Triangle]));

/// Measures each triangle from the nodes close to it.
#[inline(always)]
fn measure_any<S: Simd>(s: S, bar: &mut Bar, first: UVec3, ids: &[u32], triangles: &[Triangle]) {
    let width = bar.width;
    let top = (width - 2 * SIDE) as f32 - 1.0;
    let low = Vec2::new(first.y as f32, first.z as f32);
    let high = low + (SIDE - 1) as f32;
    for &id in ids {
        let t = &triangles[id as usize];
        let b = reach(t);
        let seen = Seen::new(t);
        let y = (b.min.y.ceil().max(low.x), b.max.y.floor().min(high.x));
        let z = (b.min.z.ceil().max(low.y), b.max.z.floor().min(high.y));
        let x = (b.min.x.ceil().max(0.0), b.max.x.floor().min(top));
        let steep = if t.n.x.abs() > 1e-3 { 1.0 / t.n.x } else { 0.0 };
        let span = (SPLAT * steep).abs();
        let mut pz = z.0;
        while pz <= z.1 {
            let gz = (b.min.z + SPLAT - pz).max(pz - (b.max.z - SPLAT)).max(0.0);
            let mut py = y.0;
            while py <= y.1 {
                let gy = (b.min.y + SPLAT - py).max(py - (b.max.y - SPLAT)).max(0.0);
                let row = (py - low.x) as usize + SIDE * (pz - low.y) as usize;
                let (mut from, mut to) = x;
                let level = t.n.y * (py - t.v[0].y) + t.n.z * (pz - t.v[0].z);
                if steep != 0.0 {
                    // Where the row passes the triangle's plane.
                    let at = t.v[0].x - level * steep;
                    from = from.max(at - span - 1e-3);
                    to = to.min(at + span + 1e-3);
                } else if level.abs() > SPLAT + 1e-3 * (to - from + 2.0) {
                    to = from - 1.0;
                }
                if gy * gy + gz * gz > SPLAT * SPLAT || bar.wanted >> row & 1 == 0 {
                    to = from - 1.0;
                }
                // The next whole node.
                let mut at = from as usize;
                at += usize::from((at as f32) < from);
                while at as f32 <= to {
                    let d = seen.squares(s, F8::from(s, at as f32), py, pz);
                    let i = row * width + SIDE + at;
                    // Strictly less: among equals the first triangle stays.
                    let before = F8::load(s, &bar.square, i);
                    let closer = d.less(before);
                    if closer.bits() != 0 {
                        d.min(before).store(&mut bar.square, i);
                        let known = U8::load(s, &bar.triangle, i);
                        let known = closer.choose_ids(U8::splat(s, id), known);
                        known.store(&mut bar.triangle, i);
                    }
                    at += EIGHT;
                }
                py += 1.0;
            }
            pz += 1.0;
        }
    }
}

lanes!(offset, offset_avx2, offset_any, (bar: &Bar, first: UVec3, triangles: &[Triangle], mask: &[u64; SIDE], out: &mut Points));

/// Measures the offsets from what the nodes of the block that begins at `first` found closest.
#[inline(always)]
fn offset_any<S: Simd>(
    s: S,
    bar: &Bar,
    first: UVec3,
    triangles: &[Triangle],
    mask: &[u64; SIDE],
    out: &mut Points,
) {
    let none = U8::splat(s, NONE);
    for row in (0..ROWS).filter(|r| needed(mask, *r) != 0) {
        let at = row * bar.width + SIDE + first.x as usize;
        let ids = U8::load(s, &bar.triangle, at);
        if ids.same(none).bits() == 0xff {
            continue;
        }
        let at = of_row(s, first, row);
        out.put(SIDE * row, &Row::measured(s, ids, at, triangles));
    }
}
