//! Distances measured by the nodes close to each triangle.

use std::sync::Mutex;

use glam::UVec3;
use rayon::prelude::*;

use super::band::{Band, SPLAT, needed};
use super::bars::{Bars, reach};
use super::eight::Seen;
use super::frame::SIDE;
use super::lanes::{EIGHT, F8, Simd, U8, after, before, lanes};
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
) -> Result<Vec<Points>, BakeError> {
    let n = band.size;
    // All in one piece of memory, which is had again sooner than many small ones.
    let all = (0..band.places.len()).into_par_iter().with_min_len(16);
    let mut blocks: Vec<Points> = all.map(|_| Points::UNKNOWN).collect();
    let spare = Mutex::new(Vec::new());
    let mut rest = &mut blocks[..];
    for layers in &bars.groups {
        let group = bars.group(layers, progress)?;
        let mut parts = Vec::with_capacity(group.len());
        for i in 0..group.len() {
            let place = UVec3::new(0, i as u32 % n.y, layers.start + i as u32 / n.y);
            let count = band.bar(place).iter().filter(|s| **s != NONE).count();
            let (own, after) = rest.split_at_mut(count);
            parts.push((place, group.of(i), own));
            rest = after;
        }
        let one = |(place, ids, out): (UVec3, &[u32], &mut [Points])| {
            if out.is_empty() || progress.is_cancelled() {
                return;
            }
            let taken = spare.lock().ok().and_then(|mut s| s.pop());
            let mut bar = taken.unwrap_or_else(|| Bar::new(n.x));
            bar.fill(band, place, ids, bars.triangles, out);
            if let Ok(mut spare) = spare.lock() {
                spare.push(bar);
            }
        };
        parts.into_par_iter().with_max_len(1).for_each(one);
        progress.check()?;
        progress.set_fraction(0.15 + 0.35 * layers.end as f32 / n.z as f32);
    }
    Ok(blocks)
}

impl Bar {
    /// Measures the blocks of the bar that begins at `place`.
    fn fill(
        &mut self,
        band: &Band,
        place: UVec3,
        ids: &[u32],
        triangles: &[Triangle],
        out: &mut [Points],
    ) {
        let slots = band.bar(place);
        let first = slots.iter().copied().find(|s| *s != NONE).unwrap_or(0) as usize;
        let masks = &band.masks[first..first + out.len()];
        self.wanted = (0..ROWS)
            .filter(|r| masks.iter().any(|m| needed(m, *r) != 0))
            .fold(0, |all, r| all | 1 << r);
        self.square.fill(f32::INFINITY);
        self.triangle.fill(NONE);
        measure(self, place * SIDE as u32, ids, triangles);
        let near = (0..).zip(slots).filter(|(_, s)| **s != NONE);
        for ((x, _), (mask, block)) in near.zip(masks.iter().zip(out)) {
            let first = UVec3::new(x, place.y, place.z) * SIDE as u32;
            offset(self, first, triangles, mask, block);
        }
    }
}

lanes!(measure, measure_avx2, measure_any, (bar: &mut Bar, first: UVec3, ids: &[u32], triangles: &[Triangle]));

/// Measures each triangle from the nodes close to it.
#[inline(always)]
fn measure_any<S: Simd>(s: S, bar: &mut Bar, first: UVec3, ids: &[u32], triangles: &[Triangle]) {
    let width = bar.width;
    let top = (width - 2 * SIDE) as i32 - 1;
    let (y0, z0) = (first.y as i32, first.z as i32);
    for &id in ids {
        let t = &triangles[id as usize];
        let b = reach(t);
        let seen = Seen::new(t);
        let x = [after(b.min.x).max(0), before(b.max.x).min(top)];
        let y = [after(b.min.y).max(y0), before(b.max.y).min(y0 + 7)];
        let z = [after(b.min.z).max(z0), before(b.max.z).min(z0 + 7)];
        let name = U8::splat(s, id);
        // How far the plane of the triangle may be from the middle of a row.
        let (middle, half) = (0.5 * (x[0] + x[1]) as f32, 0.5 * (x[1] - x[0]) as f32);
        let slab = SPLAT + t.n.x.abs() * half + 1e-3;
        let steep = x[1] - x[0] >= 2 * EIGHT as i32 && t.n.x.abs() > 1e-3;
        for pz in z[0]..=z[1] {
            let fz = pz as f32;
            let gz = gap(fz, b.min.z, b.max.z);
            let level = t.n.z * (fz - t.v[0].z) + t.n.x * (middle - t.v[0].x);
            for py in y[0]..=y[1] {
                let fy = py as f32;
                let gy = gap(fy, b.min.y, b.max.y);
                let row = (py - y0 + SIDE as i32 * (pz - z0)) as usize;
                let height = level + t.n.y * (fy - t.v[0].y);
                if gy * gy + gz * gz > SPLAT * SPLAT
                    || height.abs() > slab
                    || bar.wanted >> row & 1 == 0
                {
                    continue;
                }
                let [mut from, mut to] = x;
                if steep {
                    // A long row is near only around where it passes the plane.
                    let (at, span) = (middle - height / t.n.x, SPLAT / t.n.x.abs() + 1e-3);
                    from = from.max(after((at - span).max(0.0)));
                    to = to.min(before((at + span).min(top as f32)));
                }
                while from <= to {
                    let d = seen.squares(s, F8::from(s, from as f32), fy, fz);
                    let i = row * width + SIDE + from as usize;
                    // Strictly less: among equals the first triangle stays.
                    let known = F8::load(s, &bar.square, i);
                    let closer = d.less(known);
                    let ids = U8::load(s, &bar.triangle, i);
                    // Written back where nothing changed as well: whether anything does cannot be foreseen.
                    d.min(known).store(&mut bar.square, i);
                    closer.choose_ids(name, ids).store(&mut bar.triangle, i);
                    from += EIGHT as i32;
                }
            }
        }
    }
}

/// How far a node is beyond a triangle whose box, and [`SPLAT`] around, goes from `low` to `high`.
#[inline(always)]
fn gap(at: f32, low: f32, high: f32) -> f32 {
    let (below, above) = (low + SPLAT - at, at - (high - SPLAT));
    let most = if below > above { below } else { above };
    if most > 0.0 { most } else { 0.0 }
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
