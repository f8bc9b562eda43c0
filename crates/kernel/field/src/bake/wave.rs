//! Closest triangles handed on from node to node.

use glam::{IVec3, UVec3, Vec3};
use rayon::prelude::*;

use super::band::{BLOCK, Band, NONE, SPLAT};
use super::frame::SIDE;
use super::triangle::Triangle;
use super::{BakeError, Progress};

/// Gains below this many steps are not looked for, and below that many not told to the neighbours.
const WORTH_SEEKING: f32 = 1e-3;
const WORTH_TELLING: f32 = 4e-3;
/// The longest way through the near bricks is a few blocks long; a wave that still moves after
/// this many passes moves by little.
const MOST_PASSES: usize = 96;

type Mask = [u64; SIDE];

const BESIDE: [IVec3; 6] = [
    IVec3::NEG_X,
    IVec3::X,
    IVec3::NEG_Y,
    IVec3::Y,
    IVec3::NEG_Z,
    IVec3::Z,
];
/// The bits at x = 0 of a layer.
const LOW_X: u64 = 0x0101_0101_0101_0101;

/// The nodes of a block whose neighbour on each side is in `told`, `told` being the masks of the
/// block and of the blocks on its six sides.
fn beside(own: &Mask, around: [Option<&Mask>; 6]) -> [Mask; 6] {
    let empty = [0; SIDE];
    let around = around.map(|m| m.unwrap_or(&empty));
    let mut out = [[0; SIDE]; 6];
    for z in 0..SIDE {
        let m = own[z];
        out[0][z] = (m & !(LOW_X << 7)) << 1 | (around[0][z] >> 7 & LOW_X);
        out[1][z] = (m & !LOW_X) >> 1 | (around[1][z] & LOW_X) << 7;
        out[2][z] = m << 8 | around[2][z] >> 56;
        out[3][z] = m >> 8 | around[3][z] << 56;
        out[4][z] = if z > 0 {
            own[z - 1]
        } else {
            around[4][SIDE - 1]
        };
        out[5][z] = if z + 1 < SIDE {
            own[z + 1]
        } else {
            around[5][0]
        };
    }
    out
}

struct Update {
    node: u16,
    triangle: u32,
    distance: f32,
    away: Vec3,
    tell: bool,
}

/// Each pass, the nodes beside one that changed in the pass before measure what it is closest to.
/// All passes read the state before them, so that the order of work does not show.
pub(super) fn run(
    band: &mut Band,
    triangles: &[Triangle],
    progress: &Progress,
) -> Result<(), BakeError> {
    let beside_slots: Vec<[u32; 6]> = band
        .places
        .iter()
        .map(|&p| BESIDE.map(|o| band.slot_beside(p, o)))
        .collect();
    let exact = SPLAT * band.frame.step;
    let mut told: Vec<Mask> = Vec::with_capacity(band.blocks.len());
    let mut open: Vec<Mask> = Vec::with_capacity(band.blocks.len());
    for (block, need) in band.blocks.iter().zip(&band.masks) {
        let (mut t, mut o) = ([0; SIDE], *need);
        for i in 0..BLOCK {
            t[i / 64] |= u64::from(block.triangle[i] != NONE) << (i % 64);
            o[i / 64] &= !(u64::from(block.distance[i] <= exact) << (i % 64));
        }
        told.push(t);
        open.push(o);
    }
    aim(band, &beside_slots, &mut told, &open, triangles);
    for pass in 0..MOST_PASSES {
        let updates: Vec<Vec<Update>> = (0..band.blocks.len())
            .into_par_iter()
            .with_min_len(8)
            .map(|s| {
                if progress.is_cancelled() {
                    return Vec::new();
                }
                pull(band, s, &beside_slots[s], &told, &open[s], triangles)
            })
            .collect();
        progress.check()?;
        if updates.iter().all(Vec::is_empty) {
            break;
        }
        let blocks = band.blocks.par_iter_mut().zip(&mut told);
        blocks
            .zip(updates)
            .with_min_len(32)
            .for_each(|((block, told), updates)| {
                *told = [0; SIDE];
                for u in updates {
                    let i = u.node as usize;
                    (block.triangle[i], block.distance[i]) = (u.triangle, u.distance);
                    block.away[i] = u.away;
                    told[i / 64] |= u64::from(u.tell) << (i % 64);
                }
            });
        progress.set_fraction(0.8 - 0.3 * 0.85f32.powi(pass as i32 + 1));
    }
    Ok(())
}

/// Leaves only those nodes told of that lie beside an open one, and finds their directions.
fn aim(
    band: &mut Band,
    slots: &[[u32; 6]],
    told: &mut [Mask],
    open: &[Mask],
    triangles: &[Triangle],
) {
    let (frame, places) = (band.frame, &band.places);
    let blocks = band.blocks.par_iter_mut().zip(told).enumerate();
    blocks.for_each(|(s, (block, told))| {
        let around = slots[s].map(|n| (n != NONE).then(|| &open[n as usize]));
        let near = beside(&open[s], around);
        for z in 0..SIDE {
            told[z] &= near.iter().fold(0, |m, f| m | f[z]);
            let mut nodes = told[z];
            while nodes != 0 {
                let bit = nodes.trailing_zeros() as usize;
                nodes &= nodes - 1;
                let i = bit + SIDE * SIDE * z;
                let p = frame.node(places[s] * SIDE as u32 + super::band::node_in_block(i));
                let offset = triangles[block.triangle[i] as usize].offset(p);
                block.away[i] = offset.normalize_or_zero();
            }
        }
    });
}

fn pull(
    band: &Band,
    s: usize,
    slots: &[u32; 6],
    told: &[Mask],
    open: &Mask,
    triangles: &[Triangle],
) -> Vec<Update> {
    let around = slots.map(|n| (n != NONE).then(|| &told[n as usize]));
    if told[s] == [0; SIDE] && around.iter().all(|m| m.is_none_or(|m| *m == [0; SIDE])) {
        return Vec::new();
    }
    let from = beside(&told[s], around);
    let (frame, block) = (&band.frame, &band.blocks[s]);
    let first = band.places[s] * SIDE as u32;
    let step = frame.step;
    let seek = WORTH_SEEKING * step;
    let mut updates = Vec::new();
    for z in 0..SIDE {
        let mut nodes = from.iter().fold(0, |m, f| m | f[z]) & open[z];
        while nodes != 0 {
            let bit = nodes.trailing_zeros() as usize;
            nodes &= nodes - 1;
            let (x, y) = (bit % SIDE, bit / SIDE);
            let i = bit + SIDE * SIDE * z;
            let (was, had) = (block.distance[i], block.triangle[i]);
            // The closest triangle t of a neighbour lies behind the plane through its closest
            // point across `away`: from here it is no closer than that plane, no further than
            // that point.
            let mut offers = [(0.0f32, NONE); 6];
            let (mut count, mut likely, mut closest) = (0, 0, f32::INFINITY);
            for side in 0..6 {
                if from[side][z] >> bit & 1 == 0 {
                    continue;
                }
                let place = [x, y, z][side / 2];
                let stride = 1 << (3 * (side / 2));
                let (other, j) = match (side % 2 == 0, place) {
                    (true, 0) => (slots[side], i + 7 * stride),
                    (true, _) => (s as u32, i - stride),
                    (false, 7) => (slots[side], i - 7 * stride),
                    (false, _) => (s as u32, i + stride),
                };
                let other = &band.blocks[other as usize];
                let (d, t) = (other.distance[j], other.triangle[j]);
                let along = other.away[j][side / 2] * if side % 2 == 0 { step } else { -step };
                let least = d + along;
                if t != had && least < was - seek {
                    let most = d * d + 2.0 * d * along;
                    if most < closest {
                        (closest, likely) = (most, count);
                    }
                    offers[count] = (least, t);
                    count += 1;
                }
            }
            offers.swap(0, likely);
            let p = frame.node(first + UVec3::new(x as u32, y as u32, z as u32));
            let (mut distance, mut triangle, mut away) = (was, had, Vec3::ZERO);
            for &(least, t) in &offers[..count] {
                if t == triangle || least >= distance - seek {
                    continue;
                }
                let offset = triangles[t as usize].offset(p);
                let found = offset.length();
                if found < distance {
                    (distance, triangle) = (found, t);
                    away = offset * (1.0 / found.max(f32::MIN_POSITIVE));
                }
            }
            if triangle != had {
                updates.push(Update {
                    node: i as u16,
                    triangle,
                    distance,
                    away,
                    tell: had == NONE || was - distance > WORTH_TELLING * step,
                });
            }
        }
    }
    updates
}
