use glam::{IVec3, Vec3};
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use rustc_hash::FxHashMap;

/// Cells that a box reaches into at most; one that reaches further is looked at by all.
const MOST: i64 = 64;

/// Boxes of about one size by the cells of a lattice that they reach into: built and asked in a fraction of the time of
/// a tree.
pub(super) struct Cells<'b> {
    boxes: &'b [Aabb],
    side: f32,
    /// The number of each cell's first entry.
    first: FxHashMap<IVec3, u32>,
    /// A box, and the number of the next entry of its cell.
    entries: Vec<(u32, u32)>,
    large: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl<'b> Cells<'b> {
    pub fn new(boxes: &'b [Aabb]) -> Self {
        let size = |b: &Aabb| f64::from((b.maxs - b.mins).max_element());
        let mean = boxes.iter().map(size).sum::<f64>() / boxes.len().max(1) as f64;
        let mut cells = Self {
            boxes,
            // Most reach into few cells, and few into one.
            side: 2.0 * (mean as f32).max(f32::MIN_POSITIVE),
            first: FxHashMap::default(),
            entries: Vec::new(),
            large: Vec::new(),
        };
        for (i, b) in (0..).zip(boxes) {
            let Some(reach) = cells.reach(b) else {
                cells.large.push(i);
                continue;
            };
            for cell in each(reach) {
                let first = cells.first.entry(cell).or_insert(NONE);
                let next = std::mem::replace(first, cells.entries.len() as u32);
                cells.entries.push((i, next));
            }
        }
        cells
    }

    /// Tells the number of each box that has a point in common with `around`, once.
    pub fn each_near(&self, around: &Aabb, mut tell: impl FnMut(usize)) {
        let touches = |i: u32| self.boxes[i as usize].intersects(around);
        let Some(reach) = self.reach(around) else {
            let near = self.boxes.iter().enumerate();
            near.filter(|(_, b)| b.intersects(around))
                .for_each(|(i, _)| tell(i));
            return;
        };
        for &i in self.large.iter().filter(|&&i| touches(i)) {
            tell(i as usize);
        }
        for cell in each(reach) {
            let mut at = self.first.get(&cell).copied().unwrap_or(NONE);
            while let Some(&(i, next)) = self.entries.get(at as usize) {
                at = next;
                // Both may reach into several cells: only that of the lowest point in common counts.
                if touches(i) && self.cell(self.boxes[i as usize].mins.max(around.mins)) == cell {
                    tell(i as usize);
                }
            }
        }
    }

    fn cell(&self, p: Vec3) -> IVec3 {
        // Towards zero, which is quicker; the cells about it are larger for it.
        (p / self.side).as_ivec3()
    }

    /// The first and the last cell of a box; `None` where there are too many between them.
    fn reach(&self, b: &Aabb) -> Option<[IVec3; 2]> {
        let reach = [b.mins, b.maxs].map(|p| self.cell(p));
        let many = reach[1].as_i64vec3() - reach[0].as_i64vec3() + 1;
        let all = many.x.saturating_mul(many.y).saturating_mul(many.z);
        (all <= MOST).then_some(reach)
    }
}

fn each([from, to]: [IVec3; 2]) -> impl Iterator<Item = IVec3> {
    let along = move |axis: usize| from[axis]..=to[axis];
    let plane = move |x| along(1).flat_map(move |y| along(2).map(move |z| IVec3::new(x, y, z)));
    along(0).flat_map(plane)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes(sizes: f32) -> impl Strategy<Value = Vec<Aabb>> {
        let one = prop::array::uniform6(-1.0_f32..1.0).prop_map(move |p| {
            let at = Vec3::new(p[0], p[1], p[2]);
            // One in several is much larger than the rest.
            let size = if p[3] > 0.8 { 20.0 * sizes } else { sizes };
            Aabb::new(at, at + size * Vec3::new(p[3], p[4], p[5]).abs())
        });
        prop::collection::vec(one, 0..60)
    }

    proptest! {
        #[test]
        fn each_box_that_is_near_is_told_once(of in boxes(0.05), around in boxes(0.1)) {
            let cells = Cells::new(&of);
            for around in around {
                let mut told = Vec::new();
                cells.each_near(&around, |i| told.push(i));
                told.sort_unstable();
                let near = (0..of.len()).filter(|&i| of[i].intersects(&around));
                prop_assert_eq!(told, near.collect::<Vec<_>>());
            }
        }
    }
}
