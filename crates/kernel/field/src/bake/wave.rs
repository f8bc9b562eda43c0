//! Closest points handed on from node to node.

use glam::{IVec3, UVec3, Vec3};
use rayon::prelude::*;

use super::band::{BLOCK, Band, Block, NONE, SPLAT, node_in_block};
use super::frame::{Frame, SIDE};
use super::triangle::Triangle;
use super::{BakeError, Progress};

/// The longest way through the near bricks is a few blocks long; what still moves after this many
/// rounds moves by little.
const MOST_ROUNDS: usize = 4;
/// What is hardly closer is not taken over.
const WORTH_TAKING: f32 = 0.998;
/// How often the triangles of neighbours are measured, and the gains that are not looked for, in steps.
const REFINED: usize = 1;
const WORTH_SEEKING: f32 = 1e-3;
/// An offset for what is not known yet, metres.
const FAR: f32 = 1.0e15;
const LAYER: usize = SIDE * SIDE;

const BESIDE: [IVec3; 6] = [
    IVec3::NEG_X,
    IVec3::X,
    IVec3::NEG_Y,
    IVec3::Y,
    IVec3::NEG_Z,
    IVec3::Z,
];

/// For each node of a block: the offset from the closest known point of a triangle, its square, and
/// the triangle.
struct Points {
    square: [f32; BLOCK],
    x: [f32; BLOCK],
    y: [f32; BLOCK],
    z: [f32; BLOCK],
    triangle: [u32; BLOCK],
}

/// Eight nodes of it.
#[derive(Clone, Copy)]
struct Row {
    x: [f32; SIDE],
    y: [f32; SIDE],
    z: [f32; SIDE],
    triangle: [u32; SIDE],
}

/// A row moved up by K nodes, `none` in the place of what is not there.
#[inline(always)]
fn up<const K: usize, T: Copy>(row: &[T; SIDE], none: T) -> [T; SIDE] {
    std::array::from_fn(|i| if i >= K { row[i - K] } else { none })
}

#[inline(always)]
fn down<const K: usize, T: Copy>(row: &[T; SIDE], none: T) -> [T; SIDE] {
    std::array::from_fn(|i| if i + K < SIDE { row[i + K] } else { none })
}

#[inline(always)]
fn part<T: Copy + Default>(all: &[T; BLOCK], at: usize) -> [T; SIDE] {
    all[at..].first_chunk().copied().unwrap_or_default()
}

impl Points {
    #[inline(always)]
    fn row(&self, at: usize) -> Row {
        Row {
            x: part(&self.x, at),
            y: part(&self.y, at),
            z: part(&self.z, at),
            triangle: part(&self.triangle, at),
        }
    }

    /// Takes over for the row at `at` what is closer in a row that lies `by` before it. Returns
    /// whether anything was.
    #[inline(always)]
    fn take(&mut self, at: usize, from: &Row, by: [f32; 3]) -> bool {
        let rows = (
            self.square[at..].first_chunk_mut::<SIDE>(),
            self.x[at..].first_chunk_mut::<SIDE>(),
            self.y[at..].first_chunk_mut::<SIDE>(),
            self.z[at..].first_chunk_mut::<SIDE>(),
            self.triangle[at..].first_chunk_mut::<SIDE>(),
        );
        let (Some(square), Some(x), Some(y), Some(z), Some(triangle)) = rows else {
            return false;
        };
        let mut any = 0u32;
        for i in 0..SIDE {
            let (cx, cy, cz) = (from.x[i] + by[0], from.y[i] + by[1], from.z[i] + by[2]);
            let c = cx * cx + cy * cy + cz * cz;
            let closer = c < square[i] * WORTH_TAKING;
            square[i] = if closer { c } else { square[i] };
            x[i] = if closer { cx } else { x[i] };
            y[i] = if closer { cy } else { y[i] };
            z[i] = if closer { cz } else { z[i] };
            triangle[i] = if closer {
                from.triangle[i]
            } else {
                triangle[i]
            };
            any |= u32::from(closer);
        }
        any != 0
    }

    /// Along x by one, two and four nodes, so that each node hears of all in its row.
    #[inline(always)]
    fn along_x(&mut self, at: usize, step: f32) {
        self.shift::<1>(at, step);
        self.shift::<2>(at, step);
        self.shift::<4>(at, step);
    }

    #[inline(always)]
    fn shift<const K: usize>(&mut self, at: usize, step: f32) {
        let by = K as f32 * step;
        let row = self.row(at);
        let up = Row {
            x: up::<K, _>(&row.x, FAR),
            y: up::<K, _>(&row.y, FAR),
            z: up::<K, _>(&row.z, FAR),
            triangle: up::<K, _>(&row.triangle, NONE),
        };
        let down = Row {
            x: down::<K, _>(&row.x, FAR),
            y: down::<K, _>(&row.y, FAR),
            z: down::<K, _>(&row.z, FAR),
            triangle: down::<K, _>(&row.triangle, NONE),
        };
        self.take(at, &up, [by, 0.0, 0.0]);
        self.take(at, &down, [-by, 0.0, 0.0]);
    }

    /// As [`Self::take`] for one node.
    #[inline(always)]
    fn take_one(&mut self, at: usize, other: &Self, from: usize, by: f32) -> bool {
        let (x, y, z) = (other.x[from] + by, other.y[from], other.z[from]);
        let square = x * x + y * y + z * z;
        let closer = square < self.square[at] * WORTH_TAKING;
        if closer {
            self.square[at] = square;
            (self.x[at], self.y[at], self.z[at]) = (x, y, z);
            self.triangle[at] = other.triangle[from];
        }
        closer
    }

    /// What neighbours know is taken over at the faces; then, if that was anything or this is the
    /// first time, it is handed on within the block. Returns whether it was.
    #[inline(always)]
    fn hear_any(&mut self, around: &[Option<&Self>; 6], step: f32, first: bool) -> bool {
        let mut any = first;
        for (side, other) in around.iter().enumerate() {
            let Some(other) = other else { continue };
            let by = if side % 2 == 0 { step } else { -step };
            let (own, theirs) = if side % 2 == 0 {
                (0, SIDE - 1)
            } else {
                (SIDE - 1, 0)
            };
            for k in 0..SIDE {
                any |= match side / 2 {
                    0 => (0..SIDE).fold(false, |any, y| {
                        let row = SIDE * y + LAYER * k;
                        self.take_one(row + own, other, row + theirs, by) || any
                    }),
                    1 => {
                        let row = other.row(SIDE * theirs + LAYER * k);
                        self.take(SIDE * own + LAYER * k, &row, [0.0, by, 0.0])
                    }
                    _ => {
                        let row = other.row(SIDE * k + LAYER * theirs);
                        self.take(SIDE * k + LAYER * own, &row, [0.0, 0.0, by])
                    }
                };
            }
        }
        if !any {
            return false;
        }
        for row in 0..LAYER {
            self.along_x(SIDE * row, step);
        }
        for z in 0..SIDE {
            for y in 1..SIDE {
                let row = self.row(SIDE * (y - 1) + LAYER * z);
                self.take(SIDE * y + LAYER * z, &row, [0.0, step, 0.0]);
            }
            for y in (1..SIDE).rev() {
                let row = self.row(SIDE * y + LAYER * z);
                self.take(SIDE * (y - 1) + LAYER * z, &row, [0.0, -step, 0.0]);
            }
        }
        for y in 0..SIDE {
            for z in 1..SIDE {
                let row = self.row(SIDE * y + LAYER * (z - 1));
                self.take(SIDE * y + LAYER * z, &row, [0.0, 0.0, step]);
            }
            for z in (1..SIDE).rev() {
                let row = self.row(SIDE * y + LAYER * z);
                self.take(SIDE * y + LAYER * (z - 1), &row, [0.0, 0.0, -step]);
            }
        }
        true
    }

    /// Measures the triangles themselves: from here on `square` holds distances and offsets have length 1.
    fn measure(&mut self, frame: &Frame, first: UVec3, block: &Block, triangles: &[Triangle]) {
        for i in 0..BLOCK {
            let t = self.triangle[i];
            if t == NONE {
                self.square[i] = FAR;
                continue;
            }
            let had = block.triangle[i];
            let mut offset = Vec3::new(self.x[i], self.y[i], self.z[i]);
            // What was measured before is as it was.
            if t != had {
                let p = frame.node(first + node_in_block(i));
                offset = triangles[t as usize].offset(p);
                if block.distance[i] <= offset.length() {
                    offset = triangles[had as usize].offset(p);
                    self.triangle[i] = had;
                }
            }
            let d = offset.length();
            let away = offset * (1.0 / d.max(f32::MIN_POSITIVE));
            self.square[i] = d;
            (self.x[i], self.y[i], self.z[i]) = (away.x, away.y, away.z);
        }
    }

    /// Each open node measures the triangles its neighbours are closest to, where these can be closer.
    fn refine(
        &mut self,
        around: &[Option<&Self>; 6],
        frame: &Frame,
        first: UVec3,
        open: &[u64; SIDE],
        triangles: &[Triangle],
    ) {
        let step = frame.step;
        let seek = WORTH_SEEKING * step;
        for (z, &layer) in open.iter().enumerate() {
            let mut nodes = layer;
            while nodes != 0 {
                let bit = nodes.trailing_zeros() as usize;
                nodes &= nodes - 1;
                let at = [bit % SIDE, bit / SIDE, z];
                let i = bit + LAYER * z;
                let p = frame.node(first + node_in_block(i));
                for side in 0..6 {
                    let stride = 1 << (3 * (side / 2));
                    let (other, j) = match (side % 2 == 0, at[side / 2]) {
                        (true, 0) => (around[side], i + 7 * stride),
                        (true, _) => (Some(&*self), i - stride),
                        (false, 7) => (around[side], i - 7 * stride),
                        (false, _) => (Some(&*self), i + stride),
                    };
                    let Some(other) = other else { continue };
                    let t = other.triangle[j];
                    if t == self.triangle[i] || t == NONE {
                        continue;
                    }
                    // The triangle lies behind the plane through its closest point across `away`:
                    // from here it is no closer than that plane.
                    let away = [other.x[j], other.y[j], other.z[j]][side / 2];
                    let along = if side % 2 == 0 { step } else { -step } * away;
                    if other.square[j] + along >= self.square[i] - seek {
                        continue;
                    }
                    let offset = triangles[t as usize].offset(p);
                    let found = offset.length();
                    if found < self.square[i] {
                        let away = offset * (1.0 / found.max(f32::MIN_POSITIVE));
                        (self.square[i], self.triangle[i]) = (found, t);
                        (self.x[i], self.y[i], self.z[i]) = (away.x, away.y, away.z);
                    }
                }
            }
        }
    }

    fn hear(&mut self, around: &[Option<&Self>; 6], step: f32, first: bool) -> bool {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has AVX2, as just asked.
            return unsafe { self.hear_avx2(around, step, first) };
        }
        self.hear_any(around, step, first)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn hear_avx2(&mut self, around: &[Option<&Self>; 6], step: f32, first: bool) -> bool {
        self.hear_any(around, step, first)
    }
}

/// Blocks of one colour of a chessboard: all their neighbours are of the other.
#[derive(Default)]
struct Colour {
    slots: Vec<u32>,
    points: Vec<Points>,
    /// Which of the other colour are beside.
    beside: Vec<[u32; 6]>,
    /// Whether each changed when it last heard of its neighbours.
    fresh: Vec<bool>,
}

/// Nodes that measured their closest triangle tell its closest point to their neighbours, and these
/// on. A block hears of its neighbours of the other colour only, which rest meanwhile, so that the
/// order of work does not show. In the end each node measures the triangle of the point that came
/// closest, and those of its neighbours.
pub(super) fn run(
    band: &mut Band,
    triangles: &[Triangle],
    progress: &Progress,
) -> Result<(), BakeError> {
    let step = band.frame.step;
    let mut place = vec![0u32; band.places.len()];
    let mut colours = [Colour::default(), Colour::default()];
    for (s, p) in band.places.iter().enumerate() {
        let colour = &mut colours[(p.element_sum() & 1) as usize];
        place[s] = colour.slots.len() as u32;
        colour.slots.push(s as u32);
    }
    for colour in &mut colours {
        let beside = |&s: &u32| {
            BESIDE.map(|o| match band.slot_beside(band.places[s as usize], o) {
                NONE => NONE,
                slot => place[slot as usize],
            })
        };
        colour.beside = colour.slots.iter().map(beside).collect();
        let known = |&s: &u32| known(band, s as usize, triangles);
        colour.points = colour.slots.par_iter().map(known).collect();
        colour.fresh = vec![true; colour.slots.len()];
    }
    progress.check()?;
    for round in 0..2 * MOST_ROUNDS {
        let [a, b] = &mut colours;
        let (own, other) = if round % 2 == 0 { (a, &*b) } else { (b, &*a) };
        let first = round < 2;
        let all = own.points.par_iter_mut().zip(&mut own.fresh);
        all.zip(&own.beside)
            .with_min_len(4)
            .for_each(|((points, fresh), beside)| {
                let told = |n: u32| n != NONE && other.fresh[n as usize];
                *fresh =
                    !progress.is_cancelled() && (first || beside.iter().any(|&n| told(n))) && {
                        let around = beside.map(|n| told(n).then(|| &other.points[n as usize]));
                        points.hear(&around, step, first)
                    };
            });
        progress.check()?;
        progress.set_fraction(0.8 - 0.3 * 0.7f32.powi(round as i32 + 1));
        if !first && own.fresh.iter().all(|f| !f) && other.fresh.iter().all(|f| !f) {
            break;
        }
    }
    let (frame, exact) = (band.frame, SPLAT * step);
    for colour in &mut colours {
        let all = colour.slots.par_iter().zip(&mut colour.points);
        all.for_each(|(&s, points)| {
            let place = band.places[s as usize] * SIDE as u32;
            points.measure(&frame, place, &band.blocks[s as usize], triangles);
        });
    }
    for round in 0..2 * REFINED {
        let [a, b] = &mut colours;
        let (own, other) = if round % 2 == 0 { (a, &*b) } else { (b, &*a) };
        let all = own.slots.par_iter().zip(&own.beside);
        all.zip(&mut own.points).for_each(|((&s, beside), points)| {
            if progress.is_cancelled() {
                return;
            }
            let around = beside.map(|n| (n != NONE).then(|| &other.points[n as usize]));
            let s = s as usize;
            let mut open = band.masks[s];
            for (i, d) in band.blocks[s].distance.iter().enumerate() {
                open[i / LAYER] &= !(u64::from(*d <= exact) << (i % LAYER));
            }
            let place = band.places[s] * SIDE as u32;
            points.refine(&around, &frame, place, &open, triangles);
        });
        progress.check()?;
    }
    let mut heard: Vec<Option<&Points>> = vec![None; band.blocks.len()];
    for colour in &colours {
        for (&s, points) in colour.slots.iter().zip(&colour.points) {
            heard[s as usize] = Some(points);
        }
    }
    let blocks = band.blocks.par_iter_mut().zip(heard);
    blocks.for_each(|(block, points)| {
        let Some(points) = points else { return };
        for i in 0..BLOCK {
            if points.triangle[i] != NONE && points.square[i] < block.distance[i] {
                (block.distance[i], block.triangle[i]) = (points.square[i], points.triangle[i]);
            }
        }
    });
    progress.check()
}

/// What the nodes of a block have measured. Those so close to a triangle that all beside them have
/// measured one too tell nothing.
fn known(band: &Band, s: usize, triangles: &[Triangle]) -> Points {
    let far = FAR * FAR + FAR * FAR + FAR * FAR;
    let mut points = Points {
        square: [far; BLOCK],
        x: [FAR; BLOCK],
        y: [FAR; BLOCK],
        z: [FAR; BLOCK],
        triangle: [NONE; BLOCK],
    };
    let block = &band.blocks[s];
    let silent = (SPLAT - 1.01) * band.frame.step;
    let first = band.places[s] * SIDE as u32;
    for i in 0..BLOCK {
        let t = block.triangle[i];
        if t == NONE || block.distance[i] < silent {
            continue;
        }
        let p = band.frame.node(first + node_in_block(i));
        let offset = triangles[t as usize].offset(p);
        points.square[i] = offset.length_squared();
        (points.x[i], points.y[i], points.z[i]) = (offset.x, offset.y, offset.z);
        points.triangle[i] = t;
    }
    points
}
