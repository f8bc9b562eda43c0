//! Triangles by the bars of blocks that they come near to: the blocks that differ in x alone.

use std::borrow::Cow;
use std::ops::Range;

use glam::UVec3;
use midair_mesh::Aabb;
use rayon::prelude::*;

use super::band::SPLAT;
use super::frame::SIDE;
use super::lanes::{after, before};
use super::triangle::Triangle;
use super::{BakeError, Progress};

/// Pairs of bar and triangle held at once, where a layer of bars has no more.
const MOST_PAIRS: usize = 1 << 23;
const CHUNK: usize = 1024;

/// The triangles of a mesh by bars, for as many layers of bars at once as are held well.
pub(super) struct Bars<'a> {
    pub triangles: &'a [Triangle],
    /// Blocks along each axis.
    size: UVec3,
    /// Layers of bars along z.
    pub groups: Vec<Range<u32>>,
    only: Option<Group>,
}

/// Some layers of bars.
#[derive(Clone)]
pub(super) struct Group {
    ends: Vec<u32>,
    ids: Vec<u32>,
}

impl Group {
    /// How many bars.
    pub fn len(&self) -> usize {
        self.ends.len() - 1
    }

    /// The triangles near bar `i` of the group, in ascending order.
    pub fn of(&self, i: usize) -> &[u32] {
        &self.ids[self.ends[i] as usize..self.ends[i + 1] as usize]
    }
}

impl<'a> Bars<'a> {
    /// `size` blocks along each axis; the triangles in steps from their first node.
    pub fn new(
        size: UVec3,
        triangles: &'a [Triangle],
        progress: &Progress,
    ) -> Result<Self, BakeError> {
        let mut bars = Self {
            triangles,
            size,
            groups: Vec::new(),
            only: None,
        };
        let mut layers = vec![0usize; size.z as usize + 1];
        for chunk in triangles.chunks(CHUNK * CHUNK) {
            progress.check()?;
            for t in chunk {
                let [y, z] = bars.near(t);
                layers[z.start as usize] += y.len();
                layers[z.end as usize] = layers[z.end as usize].wrapping_sub(y.len());
            }
        }
        let (mut own, mut held, mut first) = (0usize, 0, 0);
        for (z, more) in (0..size.z).zip(layers) {
            own = own.wrapping_add(more);
            if held + own > MOST_PAIRS && z > first {
                bars.groups.push(first..z);
                (first, held) = (z, 0);
            }
            held += own;
        }
        bars.groups.push(first..size.z);
        if bars.groups.len() == 1 {
            bars.only = Some(bars.sort(0..size.z, progress)?);
        }
        Ok(bars)
    }

    /// The bars of one of the groups, y fastest.
    pub fn group(
        &self,
        layers: &Range<u32>,
        progress: &Progress,
    ) -> Result<Cow<'_, Group>, BakeError> {
        match &self.only {
            Some(only) => Ok(Cow::Borrowed(only)),
            None => self.sort(layers.clone(), progress).map(Cow::Owned),
        }
    }

    fn sort(&self, layers: Range<u32>, progress: &Progress) -> Result<Group, BakeError> {
        let chunks = self.triangles.par_chunks(CHUNK).enumerate();
        let pairs = chunks.map(|(c, chunk)| {
            let mut out = Vec::with_capacity(3 * chunk.len());
            if progress.is_cancelled() {
                return out;
            }
            for (i, t) in chunk.iter().enumerate() {
                let [y, z] = self.near(t);
                for z in z.start.max(layers.start)..z.end.min(layers.end) {
                    for y in y.clone() {
                        let bar = y + self.size.y * (z - layers.start);
                        out.push((bar, (c * CHUNK + i) as u32));
                    }
                }
            }
            out
        });
        let pairs: Vec<Vec<(u32, u32)>> = pairs.collect();
        progress.check()?;
        let mut ends = vec![0u32; self.size.y as usize * layers.len() + 1];
        for &(bar, _) in pairs.iter().flatten() {
            ends[bar as usize + 1] += 1;
        }
        for i in 1..ends.len() {
            ends[i] += ends[i - 1];
        }
        let mut cursor = ends.clone();
        let mut ids = vec![0u32; ends.last().map_or(0, |n| *n as usize)];
        for &(bar, id) in pairs.iter().flatten() {
            let c = &mut cursor[bar as usize];
            ids[*c as usize] = id;
            *c += 1;
        }
        Ok(Group { ends, ids })
    }

    /// The bars along y and z whose nodes may measure a triangle.
    #[inline(always)]
    fn near(&self, t: &Triangle) -> [Range<u32>; 2] {
        let b = reach(t);
        [
            blocks(b.min.y, b.max.y, self.size.y),
            blocks(b.min.z, b.max.z, self.size.z),
        ]
    }
}

/// The blocks along one axis that have nodes from `low` to `high`.
#[inline(always)]
fn blocks(low: f32, high: f32, size: u32) -> Range<u32> {
    let first = after(low).max(0) as u32 / SIDE as u32;
    let end = before(high).max(0) as u32 / SIDE as u32 + 1;
    first.min(size)..end.clamp(first.min(size), size)
}

/// The box of the places that measure a triangle.
#[inline(always)]
pub(super) fn reach(t: &Triangle) -> Aabb {
    let [a, b, c] = t.v;
    let (min, max) = (a.min(b).min(c) - SPLAT, a.max(b).max(c) + SPLAT);
    Aabb { min, max }
}
