use glam::IVec3;
use midair_field::{BRICK, Brick, BrickCoord, Grid};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::mask::{Mask, bits};
use crate::signs::{Signs, State, signs};

/// Bricks along one side of a block.
pub(crate) const BLOCK: i32 = 4;

/// Bricks of a block.
pub(crate) const SLOTS: usize = (BLOCK * BLOCK * BLOCK) as usize;

/// The values of a brick as rows along x: row y + 8·z.
pub(crate) type Rows = [[f32; BRICK]; BRICK * BRICK];

/// What the lattice says about lengths.
#[derive(Clone, Copy)]
pub(crate) struct Lattice {
    /// Metres between nodes.
    pub step: f32,
    /// Smaller magnitudes count as this much outside.
    pub eps: f32,
    /// The magnitude of a node without a stored value.
    pub far: f32,
}

impl Lattice {
    pub fn new(step: f32) -> Self {
        Self {
            step,
            eps: 1e-4 * step,
            far: BRICK as f32 * step,
        }
    }
}

/// 4³ bricks read together.
pub(crate) struct Block<'g> {
    pub bricks: [Option<&'g Brick>; SLOTS],
    pub signs: Box<[Signs; SLOTS]>,
    pub states: [State; SLOTS],
}

impl Block<'_> {
    fn outside() -> Self {
        Self {
            bricks: [None; SLOTS],
            signs: Box::new([[0; BRICK]; SLOTS]),
            states: [State::Outside; SLOTS],
        }
    }
}

/// The part of a field that an extraction reads, found by block instead of by brick.
pub(crate) struct Region<'g> {
    pub lattice: Lattice,
    blocks: Vec<Block<'g>>,
    index: FxHashMap<IVec3, u32>,
    /// Stands for all blocks that hold nothing.
    empty: Block<'g>,
    inside: Box<Rows>,
    outside: Box<Rows>,
}

/// The block of a brick and its slot in it.
#[inline]
pub(crate) fn split(c: BrickCoord) -> (IVec3, usize) {
    (c >> 2, slot(c & 3))
}

/// The brick in a block's slot.
#[inline]
pub(crate) fn join(block: IVec3, slot: usize) -> BrickCoord {
    let s = slot as i32;
    (block << 2) | IVec3::new(s & 3, s >> 2 & 3, s >> 4)
}

#[inline]
fn slot(l: IVec3) -> usize {
    (l.x | l.y << 2 | l.z << 4) as usize
}

impl<'g> Region<'g> {
    /// The whole field.
    pub fn whole(grid: &'g Grid) -> Self {
        Self::of(grid, grid.bricks(), |_| !0)
    }

    /// The bricks `wanted`, signs only of those that `signed` holds.
    pub fn part(grid: &'g Grid, wanted: &Mask, signed: &Mask) -> Self {
        let bricks = wanted.blocks().flat_map(|(block, word)| {
            bits(word).filter_map(move |slot| {
                let c = join(block, slot);
                Some((c, grid.brick(c)?))
            })
        });
        Self::of(grid, bricks, |block| signed.bits(block))
    }

    /// `signed` names the slots of a block whose signs are asked for.
    fn of(
        grid: &'g Grid,
        bricks: impl Iterator<Item = (BrickCoord, &'g Brick)>,
        signed: impl Fn(IVec3) -> u64 + Sync,
    ) -> Self {
        let lattice = Lattice::new(grid.step());
        let mut coords = Vec::new();
        let mut blocks: Vec<Block> = Vec::new();
        let mut index: FxHashMap<IVec3, u32> = FxHashMap::default();
        let mut last = (IVec3::MAX, 0);
        for (c, brick) in bricks {
            let (at, slot) = split(c);
            if at != last.0 {
                let i = *index.entry(at).or_insert_with(|| {
                    coords.push(at);
                    blocks.push(Block::outside());
                    blocks.len() as u32 - 1
                });
                last = (at, i as usize);
            }
            blocks[last.1].bricks[slot] = Some(brick);
        }
        // Few blocks are done sooner than another thread is woken.
        let each = blocks.par_iter_mut().zip(&coords).with_min_len(32);
        each.for_each(|(block, &at)| {
            for s in bits(signed(at)) {
                if let Some(brick) = block.bricks[s] {
                    (block.states[s], block.signs[s]) = signs(brick, lattice.eps);
                }
            }
        });
        let fill = |v| Box::new([[v; BRICK]; BRICK * BRICK]);
        Self {
            lattice,
            blocks,
            index,
            empty: Block::outside(),
            inside: fill(-lattice.far),
            outside: fill(lattice.far),
        }
    }

    /// All blocks that may own crossed edges: those that hold something and the ones before them.
    pub fn candidates(&self) -> Vec<IVec3> {
        let mut all: Vec<_> = self
            .index
            .keys()
            .flat_map(|&b| corners().map(move |d| b - d))
            .map(|c| [c.z, c.y, c.x])
            .collect();
        all.sort_unstable();
        all.dedup();
        all.into_iter()
            .map(|[z, y, x]| IVec3::new(x, y, z))
            .collect()
    }

    /// A block with its 26 neighbours.
    pub fn window(&self, block: IVec3) -> Window<'_, 'g> {
        Window {
            region: self,
            blocks: std::array::from_fn(|i| {
                let i = i as i32;
                let d = IVec3::new(i % 3, i / 3 % 3, i / 9) - 1;
                let found = self.index.get(&(block + d));
                found.map_or(&self.empty, |&b| &self.blocks[b as usize])
            }),
        }
    }
}

/// (0, 0, 0) to (1, 1, 1), x fastest.
pub(crate) fn corners() -> impl Iterator<Item = IVec3> {
    (0..8).map(|i| IVec3::new(i & 1, i >> 1 & 1, i >> 2))
}

/// The neighbourhood of one block; bricks are named by their place in it, −4..8 along each axis.
pub(crate) struct Window<'r, 'g> {
    region: &'r Region<'g>,
    blocks: [&'r Block<'g>; 27],
}

impl<'r, 'g> Window<'r, 'g> {
    #[inline]
    fn find(&self, l: IVec3) -> (&'r Block<'g>, usize) {
        let b: IVec3 = (l >> 2) + IVec3::ONE;
        (self.blocks[(b.x + 3 * b.y + 9 * b.z) as usize], slot(l & 3))
    }

    #[inline]
    pub fn lattice(&self) -> Lattice {
        self.region.lattice
    }

    #[inline]
    pub fn state(&self, l: IVec3) -> State {
        let (b, s) = self.find(l);
        b.states[s]
    }

    #[inline]
    pub fn signs(&self, l: IVec3) -> &'r Signs {
        let (b, s) = self.find(l);
        &b.signs[s]
    }

    #[inline]
    pub fn rows(&self, l: IVec3) -> &'r Rows {
        let (b, s) = self.find(l);
        match b.bricks[s] {
            None => &self.region.outside,
            Some(Brick::Inside) => &self.region.inside,
            Some(Brick::Values { values, .. }) => bytemuck::cast_ref(&**values),
        }
    }
}
