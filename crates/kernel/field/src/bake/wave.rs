//! Closest points handed on from node to node.

use glam::{IVec3, UVec3};
use rayon::prelude::*;

use super::band::{Band, SPLAT, needed};
use super::eight::{Found, dot, offsets};
use super::frame::SIDE;
use super::lanes::{F8, Simd, U8, lanes, whole};
use super::points::{BLOCK, NONE, Points, Row, of_row};
use super::tree::Tree;
use super::triangle::Triangle;
use super::{BakeError, Progress};

const ROWS: usize = SIDE * SIDE;

/// A block of a column with its place in it and its nodes that are needed.
type Member<'a> = (u32, &'a [u64; SIDE], &'a mut Points);

/// Nodes that measured their closest triangle tell its closest point to their neighbours, and these
/// on, along one axis after the other. Then each node measures the triangle of the point that came
/// closest; one that heard of none asks the tree.
pub(super) fn run(band: &mut Band, progress: &Progress) -> Result<(), BakeError> {
    // A closest point lies in any direction, and on the way to there each node keeps what is closest to
    // itself: once more along y and z what came along x last finds its place.
    sweep::<1>(band, progress)?;
    sweep::<2>(band, progress)?;
    progress.set_fraction(0.6);
    sweep::<0>(band, progress)?;
    sweep::<1>(band, progress)?;
    sweep::<2>(band, progress)?;
    progress.set_fraction(0.7);
    Ok(())
}

/// Hands on along an axis, each column of blocks by itself.
fn sweep<const AXIS: usize>(band: &mut Band, progress: &Progress) -> Result<(), BakeError> {
    let n = band.size;
    let [size, wide] = match AXIS {
        0 => [n.y, n.z],
        1 => [n.x, n.z],
        _ => [n.x, n.y],
    };
    let count = size * wide;
    let mut columns: Vec<Vec<Member>> = (0..count).map(|_| Vec::new()).collect();
    let all = band.blocks.iter_mut().zip(&band.places).zip(&band.masks);
    for ((block, place), mask) in all {
        let (along, a, b) = match AXIS {
            0 => (place.x, place.y, place.z),
            1 => (place.y, place.x, place.z),
            _ => (place.z, place.x, place.y),
        };
        columns[(a + size * b) as usize].push((along, mask, block));
    }
    columns.into_par_iter().for_each(|mut column| {
        if !progress.is_cancelled() {
            match AXIS {
                0 => along_x(&mut column),
                1 => along_y(&mut column),
                _ => along_z(&mut column),
            }
        }
    });
    progress.check()
}

lanes!(along_x, along_x_avx2, along_x_any, (column: &mut [Member]));
lanes!(along_y, along_y_avx2, along_y_any, (column: &mut [Member]));
lanes!(along_z, along_z_avx2, along_z_any, (column: &mut [Member]));

#[inline(always)]
fn along_x_any<S: Simd>(s: S, column: &mut [Member]) {
    let none = Row::unknown(s);
    for row in 0..ROWS {
        let mut told = none;
        let mut next = None;
        for (along, mask, block) in column.iter_mut() {
            if next != Some(*along) {
                told = none;
            }
            if needed(mask, row) == 0 {
                continue;
            }
            next = Some(*along + 1);
            let mut own = block.row(s, SIDE * row);
            // Along by one, two, four and eight, so that each node hears of the last fifteen.
            let mut any = own.take::<0>(s, &told.end_to_end::<7>(&own), 1.0);
            any |= own.take::<0>(s, &told.end_to_end::<6>(&own), 2.0);
            any |= own.take::<0>(s, &told.end_to_end::<4>(&own), 4.0);
            any |= own.take::<0>(s, &told, 8.0);
            if any {
                block.put(SIDE * row, &own);
            }
            told = own;
        }
        told = none;
        next = None;
        for (along, mask, block) in column.iter_mut().rev() {
            if next != Some(*along) {
                told = none;
            }
            if needed(mask, row) == 0 {
                continue;
            }
            next = along.checked_sub(1);
            let mut own = block.row(s, SIDE * row);
            let mut any = own.take::<0>(s, &own.end_to_end::<1>(&told), -1.0);
            any |= own.take::<0>(s, &own.end_to_end::<2>(&told), -2.0);
            any |= own.take::<0>(s, &own.end_to_end::<4>(&told), -4.0);
            any |= own.take::<0>(s, &told, -8.0);
            if any {
                block.put(SIDE * row, &own);
            }
            told = own;
        }
    }
}

#[inline(always)]
fn along_y_any<S: Simd>(s: S, column: &mut [Member]) {
    up_and_down::<1, S>(s, column);
}

#[inline(always)]
fn along_z_any<S: Simd>(s: S, column: &mut [Member]) {
    up_and_down::<2, S>(s, column);
}

#[inline(always)]
fn up_and_down<const AXIS: usize, S: Simd>(s: S, column: &mut [Member]) {
    let none = Row::unknown(s);
    let mut told = [none; SIDE];
    let mut next = None;
    for (along, mask, block) in column.iter_mut() {
        if next != Some(*along) {
            told = [none; SIDE];
        }
        next = Some(*along + 1);
        for (line, told) in told.iter_mut().enumerate() {
            for k in 0..SIDE {
                hear::<AXIS, S>(s, block, mask, line, k, told, 1.0);
            }
        }
    }
    told = [none; SIDE];
    next = None;
    for (along, mask, block) in column.iter_mut().rev() {
        if next != Some(*along) {
            told = [none; SIDE];
        }
        next = along.checked_sub(1);
        for (line, told) in told.iter_mut().enumerate() {
            for k in (0..SIDE).rev() {
                hear::<AXIS, S>(s, block, mask, line, k, told, -1.0);
            }
        }
    }
}

/// A row hears of the one before it and is the next to tell.
#[inline(always)]
fn hear<const AXIS: usize, S: Simd>(
    s: S,
    block: &mut Points,
    mask: &[u64; SIDE],
    line: usize,
    k: usize,
    told: &mut Row<S>,
    step: f32,
) {
    let row = if AXIS == 1 {
        k + SIDE * line
    } else {
        line + SIDE * k
    };
    if needed(mask, row) == 0 {
        *told = Row::unknown(s);
        return;
    }
    let mut own = block.row(s, SIDE * row);
    if own.take::<AXIS>(s, told, step) {
        block.put(SIDE * row, &own);
    }
    *told = own;
}

/// The distance of every node of block `slot`, steps.
pub(super) fn distances(band: &Band, slot: usize, tree: &Tree) -> [f32; BLOCK] {
    // What is not needed is beyond all measure for the nodes beside it.
    let mut out = UNKNOWN;
    measure(band, slot, tree.triangles(), &mut out);
    let (place, mask) = (band.places[slot] * SIDE as u32, &band.masks[slot]);
    let block = &band.blocks[slot];
    for i in (0..BLOCK).filter(|i| block.triangle[*i] == NONE) {
        out[i] = f32::INFINITY;
        // What no neighbour could tell.
        if mask[i / ROWS] >> (i % ROWS) & 1 == 1 {
            let at = UVec3::new(i as u32 % 8, i as u32 / 8 % 8, i as u32 / 64);
            out[i] = tree.closest((place + at).as_vec3(), None).0.sqrt();
        }
    }
    out
}

lanes!(measure, measure_avx2, measure_any, (band: &Band, slot: usize, triangles: &[Triangle], out: &mut [f32; BLOCK]));

/// Each node measures the triangle that it heard of, and then what the node knows that is nearest to its
/// own foot on the plane of that triangle: where a surface bends little, the closest one is there.
#[inline(always)]
fn measure_any<S: Simd>(
    s: S,
    band: &Band,
    slot: usize,
    triangles: &[Triangle],
    out: &mut [f32; BLOCK],
) {
    let (own, mask) = (&band.blocks[slot], &band.masks[slot]);
    let first = band.places[slot] * SIDE as u32;
    let exact = F8::splat(s, SPLAT * SPLAT);
    let low = F8::splat(s, 0.0);
    let top = (band.size * SIDE as u32 - 1).as_vec3();
    let high = [
        F8::splat(s, top.x),
        F8::splat(s, top.y),
        F8::splat(s, top.z),
    ];
    let none = U8::splat(s, NONE);
    let zero = U8::splat(s, 0);
    for row in (0..ROWS).filter(|r| needed(mask, *r) != 0) {
        let at = SIDE * row;
        let p = of_row(s, first, row);
        let ids = U8::load(s, &own.triangle, at);
        let ids = ids.same(none).choose_ids(zero, ids);
        let found = offsets(s, triangles, &ids.ids(), p);
        let mut square = found.square;
        let left = exact.less(square);
        if left.bits() != 0 {
            let near = beside_foot(s, p, &found);
            let x = near[0].max(low).min(high[0]).lanes();
            let y = near[1].max(low).min(high[1]).lanes();
            let z = near[2].max(low).min(high[2]).lanes();
            // All eight, whether they are left or not: that is had sooner than a choice among them.
            let mut tried = ids.ids();
            for (i, tried) in tried.iter_mut().enumerate() {
                let there = known(band, x[i], y[i], z[i]);
                *tried = if there == NONE { *tried } else { there };
            }
            let found = offsets(s, triangles, &tried, p).square;
            square = left.choose(found.min(square), square);
        }
        square.sqrt().store(out, at);
    }
}

/// The node nearest to the line along the normal through each place's foot on its plane, not far from
/// there.
#[inline(always)]
fn beside_foot<S: Simd>(s: S, p: [F8<S>; 3], found: &Found<S>) -> [F8<S>; 3] {
    let mut best = p;
    let mut least = F8::splat(s, f32::INFINITY);
    for off in [0.0, 0.5, -0.5, 1.0, -1.0] {
        let down = found.height + F8::splat(s, off);
        let n = &found.n;
        let at = [p[0] - n[0] * down, p[1] - n[1] * down, p[2] - n[2] * down];
        let node = [at[0].round(), at[1].round(), at[2].round()];
        let by = [at[0] - node[0], at[1] - node[1], at[2] - node[2]];
        let square = dot(by, by);
        let closer = square.less(least);
        least = square.min(least);
        best = [
            closer.choose(node[0], best[0]),
            closer.choose(node[1], best[1]),
            closer.choose(node[2], best[2]),
        ];
    }
    best
}

/// The triangle that a node heard of.
#[inline(always)]
fn known(band: &Band, x: f32, y: f32, z: f32) -> u32 {
    let at = [whole(x) as u32, whole(y) as u32, whole(z) as u32];
    let [x, y, z] = [at[0] / 8, at[1] / 8, at[2] / 8];
    let slot = band.slots[(x + band.size.x * (y + band.size.y * z)) as usize];
    if slot == NONE {
        return NONE;
    }
    let i = at[0] % 8 + 8 * (at[1] % 8) + 64 * (at[2] % 8);
    band.blocks[slot as usize].triangle[i as usize]
}

const BESIDE: [IVec3; 6] = [
    IVec3::NEG_X,
    IVec3::X,
    IVec3::NEG_Y,
    IVec3::Y,
    IVec3::NEG_Z,
    IVec3::Z,
];

/// The distances of block `slot`, none more than a step beyond those beside it.
pub(super) fn steadied(band: &Band, slot: usize, all: &[[f32; BLOCK]]) -> [f32; BLOCK] {
    let around = BESIDE.map(|o| match band.slot_beside(band.places[slot], o) {
        NONE => &UNKNOWN,
        other => &all[other as usize],
    });
    let mut out = [0.0; BLOCK];
    steady(&all[slot], around, &band.masks[slot], &mut out);
    out
}

static UNKNOWN: [f32; BLOCK] = [f32::INFINITY; BLOCK];

lanes!(steady, steady_avx2, steady_any, (own: &[f32; BLOCK], around: [&[f32; BLOCK]; 6], mask: &[u64; SIDE], out: &mut [f32; BLOCK]));

#[inline(always)]
fn steady_any<S: Simd>(
    s: S,
    own: &[f32; BLOCK],
    around: [&[f32; BLOCK]; 6],
    mask: &[u64; SIDE],
    out: &mut [f32; BLOCK],
) {
    for row in (0..ROWS).filter(|r| needed(mask, *r) != 0) {
        let at = SIDE * row;
        let distance = F8::load(s, own, at);
        let mut least = F8::load(s, around[0], at).end_to_end::<7>(distance);
        least = distance
            .end_to_end::<1>(F8::load(s, around[1], at))
            .min(least);
        for (axis, stride) in [SIDE, SIDE * SIDE].into_iter().enumerate() {
            let last = (SIDE - 1) * stride;
            let line = at / stride % SIDE;
            let before = if line == 0 {
                F8::load(s, around[2 + 2 * axis], at + last)
            } else {
                F8::load(s, own, at - stride)
            };
            let after = if line == SIDE - 1 {
                F8::load(s, around[3 + 2 * axis], at - last)
            } else {
                F8::load(s, own, at + stride)
            };
            least = before.min(after).min(least);
        }
        (least + F8::splat(s, 1.0)).min(distance).store(out, at);
    }
}
