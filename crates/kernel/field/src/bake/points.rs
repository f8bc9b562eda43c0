//! What the nodes of a block know of the surface.

use glam::UVec3;

use super::eight::{Found, dot, offsets};
use super::frame::SIDE;
use super::lanes::{EIGHT, F8, Simd, U8};
use super::triangle::Triangle;

pub(super) const BLOCK: usize = SIDE * SIDE * SIDE;
pub(super) const NONE: u32 = u32::MAX;
/// An offset for what is not known yet, steps.
pub(super) const FAR: f32 = 1.0e15;
pub(super) const FAR_SQUARE: f32 = 3.0 * FAR * FAR;
/// What is hardly closer is not taken over.
const WORTH_TAKING: f32 = 0.998;

/// For each node of a block: the offset from the closest known point of a triangle, steps, and the
/// triangle.
#[derive(Clone)]
pub(super) struct Points {
    pub x: [f32; BLOCK],
    pub y: [f32; BLOCK],
    pub z: [f32; BLOCK],
    pub triangle: [u32; BLOCK],
}

/// Eight nodes in a row.
#[derive(Clone, Copy)]
pub(super) struct Row<S: Simd> {
    pub square: F8<S>,
    pub by: [F8<S>; 3],
    pub triangle: U8<S>,
}

impl<S: Simd> Row<S> {
    #[inline(always)]
    pub fn unknown(s: S) -> Self {
        Self {
            square: F8::splat(s, FAR_SQUARE),
            by: [F8::splat(s, FAR); 3],
            triangle: U8::splat(s, NONE),
        }
    }

    /// What the nodes at `at` measure from the triangles named.
    #[inline(always)]
    pub fn measured(s: S, triangle: U8<S>, at: [F8<S>; 3], triangles: &[Triangle]) -> Self {
        let none = triangle.same(U8::splat(s, NONE));
        let known = none.choose_ids(U8::splat(s, 0), triangle);
        let Found { square, by, .. } = offsets(s, triangles, &known.ids(), at);
        Self {
            square: none.choose(F8::splat(s, FAR_SQUARE), square),
            by: [
                none.choose(F8::splat(s, FAR), by[0]),
                none.choose(F8::splat(s, FAR), by[1]),
                none.choose(F8::splat(s, FAR), by[2]),
            ],
            triangle,
        }
    }

    /// Eight of the sixteen nodes of two rows end to end.
    #[inline(always)]
    pub fn end_to_end<const AT: usize>(&self, then: &Self) -> Self {
        Self {
            square: self.square.end_to_end::<AT>(then.square),
            by: [
                self.by[0].end_to_end::<AT>(then.by[0]),
                self.by[1].end_to_end::<AT>(then.by[1]),
                self.by[2].end_to_end::<AT>(then.by[2]),
            ],
            triangle: self.triangle.end_to_end::<AT>(then.triangle),
        }
    }

    /// Takes over what is closer in a row that lies `step` before this one along `AXIS`; whether
    /// anything was.
    #[inline(always)]
    pub fn take<const AXIS: usize>(&mut self, s: S, from: &Self, step: f32) -> bool {
        let mut by = from.by;
        by[AXIS] = by[AXIS] + F8::splat(s, step);
        let square = dot(by, by);
        let closer = square.less(self.square * F8::splat(s, WORTH_TAKING));
        if closer.bits() == 0 {
            return false;
        }
        self.square = closer.choose(square, self.square);
        for (own, by) in self.by.iter_mut().zip(by) {
            *own = closer.choose(by, *own);
        }
        self.triangle = closer.choose_ids(from.triangle, self.triangle);
        true
    }
}

impl Points {
    pub const UNKNOWN: Self = Self {
        x: [FAR; BLOCK],
        y: [FAR; BLOCK],
        z: [FAR; BLOCK],
        triangle: [NONE; BLOCK],
    };

    #[inline(always)]
    pub fn row<S: Simd>(&self, s: S, at: usize) -> Row<S> {
        let by = [
            F8::load(s, &self.x, at),
            F8::load(s, &self.y, at),
            F8::load(s, &self.z, at),
        ];
        Row {
            // Sooner had again than kept: what moves through memory is what takes time.
            square: dot(by, by),
            by,
            triangle: U8::load(s, &self.triangle, at),
        }
    }

    #[inline(always)]
    pub fn put<S: Simd>(&mut self, at: usize, row: &Row<S>) {
        row.by[0].store(&mut self.x, at);
        row.by[1].store(&mut self.y, at);
        row.by[2].store(&mut self.z, at);
        row.triangle.store(&mut self.triangle, at);
    }
}

/// Where the nodes of a row of a block are.
#[inline(always)]
pub(super) fn of_row<S: Simd>(s: S, first: UVec3, row: usize) -> [F8<S>; 3] {
    let (y, z) = (first.y + (row % SIDE) as u32, first.z + (row / SIDE) as u32);
    [
        F8::from(s, first.x as f32),
        F8::splat(s, y as f32),
        F8::splat(s, z as f32),
    ]
}

const _: () = assert!(SIDE == EIGHT);
