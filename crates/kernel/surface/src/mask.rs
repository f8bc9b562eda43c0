use glam::IVec3;
use midair_field::BrickCoord;
use rustc_hash::FxHashMap;

use crate::region::split;

/// A set of bricks: one word for each block, one bit for each slot.
#[derive(Clone, Default)]
pub(crate) struct Mask(FxHashMap<IVec3, u64>);

/// By axis: how far apart neighbouring slots are, and the slots with neighbours in the block before.
const AXES: [(IVec3, u32, u64); 3] = [
    (IVec3::X, 1, 0x1111_1111_1111_1111),
    (IVec3::Y, 4, 0x000f_000f_000f_000f),
    (IVec3::Z, 16, 0x0000_0000_0000_ffff),
];

impl Mask {
    pub fn of(bricks: &[BrickCoord]) -> Self {
        let mut mask = Self::default();
        for &c in bricks {
            let (block, slot) = split(c);
            mask.add(block, 1 << slot);
        }
        mask
    }

    fn add(&mut self, block: IVec3, bits: u64) {
        if bits != 0 {
            *self.0.entry(block).or_default() |= bits;
        }
    }

    /// The set with the bricks before it, after it or both along every axis, diagonals too.
    pub fn dilated(&self, before: bool, after: bool) -> Self {
        let mut now = self.clone();
        for (axis, stride, first) in AXES {
            let (across, last) = (3 * stride, first << (3 * stride));
            let mut next = now.clone();
            for (block, m) in now.blocks() {
                if before {
                    next.add(block, (m & !first) >> stride);
                    next.add(block - axis, (m & first) << across);
                }
                if after {
                    next.add(block, (m & !last) << stride);
                    next.add(block + axis, (m & last) >> across);
                }
            }
            now = next;
        }
        now
    }

    /// The slots of a block that belong to the set.
    pub fn bits(&self, block: IVec3) -> u64 {
        self.0.get(&block).copied().unwrap_or(0)
    }

    /// All blocks with a slot in the set, in no particular order.
    pub fn blocks(&self) -> impl Iterator<Item = (IVec3, u64)> {
        self.0.iter().map(|(&block, &bits)| (block, bits))
    }
}

/// The set bits of a word, lowest first.
pub(crate) fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (word != 0).then(|| word.trailing_zeros() as usize);
        word &= word.wrapping_sub(1);
        bit
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::region::join;

    #[test]
    fn dilation_reaches_every_neighbour_and_no_other() {
        for at in [IVec3::new(-1, 3, 4), IVec3::ZERO, IVec3::new(7, -4, 2)] {
            for (before, after) in [(true, false), (false, true), (true, true)] {
                let mask = Mask::of(&[at]).dilated(before, after);
                let mut found: Vec<_> = mask
                    .blocks()
                    .flat_map(|(b, w)| bits(w).map(move |s| join(b, s) - at))
                    .collect();
                found.sort_by_key(|d| d.to_array());
                let (low, high) = (-i32::from(before), i32::from(after));
                let span = || low..=high;
                let wanted: Vec<_> = span()
                    .flat_map(|x| {
                        span().flat_map(move |y| span().map(move |z| IVec3::new(x, y, z)))
                    })
                    .collect();
                assert_eq!(found, wanted);
            }
        }
    }
}
