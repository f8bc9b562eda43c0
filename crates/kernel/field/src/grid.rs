use std::sync::Arc;

use glam::IVec3;
use rustc_hash::FxHashMap;

/// Nodes along one side of a brick.
pub const BRICK: usize = 8;

/// Which brick: it holds the nodes `8·c .. 8·c + 8` along each axis.
pub type BrickCoord = IVec3;

/// Bricks along one side of a chunk, the unit of storage.
const CHUNK: i32 = 8;

/// A sparse field on the lattice `step · (i, j, k)`, without fixed extent.
///
/// Near the surface, bricks of 8³ nodes hold values; elsewhere a brick is either known to lie
/// inside (`inside`) or, by its absence, outside. Every node has exactly one value, so a surface
/// extracted from it can be closed whatever the values are.
///
/// Bricks are kept in chunks of 8³; a chunk that lies wholly inside is one entry, so that the
/// core of a large solid costs nothing. A copy shares them until it is changed.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    step: f32,
    chunks: FxHashMap<IVec3, Chunk>,
}

#[derive(Clone, Debug)]
enum Chunk {
    Inside,
    /// Shared between copies of a grid until one of them changes it.
    Mixed(Arc<Mixed>),
}

#[derive(Clone, Debug)]
struct Mixed {
    slots: [Option<Brick>; SLOTS],
    used: u32,
}

const SLOTS: usize = (CHUNK * CHUNK * CHUNK) as usize;

/// What a brick holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Brick {
    /// All its nodes lie inside, at least one cell away from the surface.
    Inside,
    /// 8³ values, x fastest: `values[x + 8·(y + 8·z)]`, with their extremes.
    Values {
        /// Signed distances in metres.
        values: Arc<[f32; BRICK * BRICK * BRICK]>,
        /// The smallest value.
        min: f32,
        /// The largest value.
        max: f32,
    },
}

fn split(c: BrickCoord) -> (IVec3, usize) {
    let chunk = IVec3::new(c.x >> 3, c.y >> 3, c.z >> 3);
    let slot = (c.x & 7) | (c.y & 7) << 3 | (c.z & 7) << 6;
    (chunk, slot as usize)
}

fn join(chunk: IVec3, slot: usize) -> BrickCoord {
    let s = slot as i32;
    chunk * CHUNK + IVec3::new(s & 7, s >> 3 & 7, s >> 6)
}

impl Chunk {
    fn get(&self, slot: usize) -> Option<&Brick> {
        match self {
            Self::Inside => Some(&Brick::Inside),
            Self::Mixed(m) => m.slots[slot].as_ref(),
        }
    }
}

impl Mixed {
    fn new(inside: bool) -> Self {
        Self {
            slots: std::array::from_fn(|_| inside.then_some(Brick::Inside)),
            used: if inside { SLOTS as u32 } else { 0 },
        }
    }
}

impl Grid {
    /// An empty field with nodes every `step` metres: outside everywhere.
    pub fn new(step: f32) -> Self {
        Self {
            step,
            chunks: FxHashMap::default(),
        }
    }

    /// Metres between neighbouring nodes.
    pub fn step(&self) -> f32 {
        self.step
    }

    /// The brick at `c`, if it is not wholly outside.
    pub fn brick(&self, c: BrickCoord) -> Option<&Brick> {
        let (chunk, slot) = split(c);
        self.chunks.get(&chunk)?.get(slot)
    }

    /// Puts a brick in place, or takes it away (outside).
    pub fn set(&mut self, c: BrickCoord, brick: Option<Brick>) {
        let (at, slot) = split(c);
        if brick.is_none() && !self.chunks.contains_key(&at) {
            return;
        }
        let chunk = self
            .chunks
            .entry(at)
            .or_insert_with(|| Chunk::Mixed(Arc::new(Mixed::new(false))));
        if let Chunk::Inside = chunk {
            if brick == Some(Brick::Inside) {
                return;
            }
            *chunk = Chunk::Mixed(Arc::new(Mixed::new(true)));
        }
        if let Chunk::Mixed(m) = chunk {
            let m = Arc::make_mut(m);
            let old = std::mem::replace(&mut m.slots[slot], brick);
            m.used += u32::from(m.slots[slot].is_some());
            m.used -= u32::from(old.is_some());
            if m.used == 0 {
                self.chunks.remove(&at);
            }
        }
    }

    /// Marks the `side`³ bricks from `low` as inside; whole chunks at once where they fit.
    pub(crate) fn fill_inside(&mut self, low: BrickCoord, side: i32) {
        if side >= CHUNK {
            let (first, n) = (low / CHUNK, side / CHUNK);
            for at in cube(first, n) {
                self.chunks.insert(at, Chunk::Inside);
            }
        } else {
            for c in cube(low, side) {
                self.set(c, Some(Brick::Inside));
            }
        }
    }

    /// All bricks that are not wholly outside, in no particular order.
    pub fn bricks(&self) -> impl Iterator<Item = (BrickCoord, &Brick)> {
        self.chunks.iter().flat_map(|(&at, chunk)| {
            (0..SLOTS).filter_map(move |s| Some((join(at, s), chunk.get(s)?)))
        })
    }

    /// The coordinates of all bricks that are not wholly outside, in an order that depends on
    /// nothing but themselves: by z, then y, then x.
    pub fn sorted_coords(&self) -> Vec<BrickCoord> {
        let mut all: Vec<_> = self.bricks().map(|(c, _)| c).collect();
        all.sort_unstable_by_key(|c| (c.z, c.y, c.x));
        all
    }

    /// As [`Grid::sorted_coords`], only those bricks that hold values: the ones near the surface.
    pub fn near_coords(&self) -> Vec<BrickCoord> {
        let mut near = Vec::new();
        for (&at, chunk) in &self.chunks {
            if let Chunk::Mixed(m) = chunk {
                let values = |s: &usize| matches!(m.slots[*s], Some(Brick::Values { .. }));
                near.extend((0..SLOTS).filter(values).map(|s| join(at, s)));
            }
        }
        near.sort_unstable_by_key(|c| (c.z, c.y, c.x));
        near
    }

    /// The bricks from `low` to `high`, both included, that are not wholly outside.
    pub(crate) fn coords_within(&self, low: BrickCoord, high: BrickCoord) -> Vec<BrickCoord> {
        let (first, last) = (split(low).0, split(high).0);
        let mut found = Vec::new();
        for (&at, chunk) in &self.chunks {
            if at.cmpge(first).all() && at.cmple(last).all() {
                let held = (0..SLOTS).filter(|&s| chunk.get(s).is_some());
                let held = held.map(|s| join(at, s));
                found.extend(held.filter(|c| c.cmpge(low).all() && c.cmple(high).all()));
            }
        }
        found
    }

    /// Moves a brick out.
    pub(crate) fn take(&mut self, c: BrickCoord) -> Option<Brick> {
        let (at, slot) = split(c);
        match self.chunks.get_mut(&at)? {
            Chunk::Inside => Some(Brick::Inside),
            Chunk::Mixed(m) => {
                let m = Arc::make_mut(m);
                let brick = m.slots[slot].take();
                m.used -= u32::from(brick.is_some());
                brick
            }
        }
    }

    /// Whether the node `n` of the lattice lies inside.
    pub fn is_inside(&self, n: IVec3) -> bool {
        let c = IVec3::new(n.x >> 3, n.y >> 3, n.z >> 3);
        match self.brick(c) {
            None => false,
            Some(Brick::Inside) => true,
            Some(Brick::Values { values, .. }) => {
                let l = n - c * 8;
                values[(l.x + 8 * (l.y + 8 * l.z)) as usize] < 0.0
            }
        }
    }
}

/// All `n`³ coordinates from `low`, x fastest.
pub(crate) fn cube(low: IVec3, n: i32) -> impl Iterator<Item = IVec3> {
    (0..n)
        .flat_map(move |z| (0..n).flat_map(move |y| (0..n).map(move |x| low + IVec3::new(x, y, z))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bricks_come_and_go() {
        let mut g = Grid::new(0.01);
        let c = IVec3::new(-9, 3, 0);
        assert!(g.brick(c).is_none());
        g.set(c, Some(Brick::Inside));
        assert_eq!(g.brick(c), Some(&Brick::Inside));
        assert_eq!(g.sorted_coords(), vec![c]);
        g.set(c, None);
        assert_eq!(g.bricks().count(), 0);
    }

    #[test]
    fn a_chunk_inside_can_be_hollowed() {
        let mut g = Grid::new(0.01);
        g.fill_inside(IVec3::new(-8, 0, 8), 8);
        assert_eq!(g.bricks().count(), 512);
        g.set(IVec3::new(-5, 1, 9), None);
        assert_eq!(g.bricks().count(), 511);
        assert!(g.is_inside(IVec3::new(-64, 0, 64)));
        assert!(!g.is_inside(IVec3::new(-40, 8, 72)));
    }
}
