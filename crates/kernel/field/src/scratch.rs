use std::cell::RefCell;
use std::sync::Arc;

use glam::{Vec3, Vec4};

use crate::program::Instr;
use crate::shape::{NODES, Points};
use crate::{Brick, BrickCoord, Program};

/// Steps from the surface of a union within which φ is exact. Further away an operand that comes no
/// nearer in a brick is not evaluated there, and φ may be that of the others.
pub(crate) const EXACT: f32 = 3.0;

/// Buffers of one thread.
pub(crate) struct Scratch {
    points: Box<Points>,
    stack: Vec<[f32; NODES]>,
    /// The leaves of a union with their bounds.
    order: Vec<(u32, f32, f32)>,
}

impl Default for Scratch {
    fn default() -> Self {
        Self {
            points: Box::new(Points {
                x: [0.0; NODES],
                y: [0.0; NODES],
                z: [0.0; NODES],
                centre: Vec3::ZERO,
                radius: 0.0,
            }),
            stack: Vec::new(),
            order: Vec::new(),
        }
    }
}

thread_local! {
    /// Buffers that were used before, for solids within others.
    static SPARE: RefCell<Vec<Scratch>> = const { RefCell::new(Vec::new()) };
}

impl Scratch {
    /// Buffers for a solid within another.
    pub(crate) fn spare() -> Self {
        SPARE.with_borrow_mut(Vec::pop).unwrap_or_default()
    }

    /// Keeps them for the next one of this thread.
    pub(crate) fn give_back(self) {
        SPARE.with_borrow_mut(|all| all.push(self));
    }
}

impl Program {
    /// φ at the nodes of a brick, in `scratch.stack[0]`.
    ///
    /// A leaf that is joined to what stands so far is not evaluated if its bounds on the brick's
    /// nodes, `slack` wide of rounding, say that it changes nothing.
    fn brick_values<'s>(
        &self,
        coord: BrickCoord,
        tape: &[Instr],
        slack: f32,
        scratch: &'s mut Scratch,
    ) -> Option<&'s mut [f32; NODES]> {
        let mut depth = 0;
        let mut rest = tape;
        while let [instr, after @ ..] = rest {
            rest = after;
            match *instr {
                Instr::Load(leaf) => {
                    if depth > 0
                        && let [next, beyond @ ..] = after
                        && *next != Instr::Negate
                        && !matches!(next, Instr::Load(_))
                    {
                        let (low, high) = self.leaf_range(leaf, coord);
                        let so_far = extremes(&scratch.stack[depth - 1]);
                        if loses(*next, so_far, low - slack, high + slack) {
                            rest = beyond;
                            continue;
                        }
                    }
                    if scratch.stack.len() == depth {
                        scratch.stack.push([0.0; NODES]);
                    }
                    let out = &mut scratch.stack[depth];
                    let leaf = &self.leaves[leaf as usize];
                    leaf.brick(coord * 8, self.step(), &mut scratch.points, out);
                    depth += 1;
                }
                Instr::Negate => {
                    let top = scratch.stack.get_mut(depth.checked_sub(1)?)?;
                    top.iter_mut().for_each(|v| *v = -*v);
                }
                Instr::Min | Instr::Max | Instr::MaxNegated => {
                    depth = depth.checked_sub(1)?;
                    let (below, top) = scratch.stack.split_at_mut(depth);
                    combine(*instr, below.last_mut()?, top.first()?);
                }
            }
        }
        (depth == 1).then(|| &mut scratch.stack[0])
    }

    fn leaf_range(&self, leaf: u32, coord: BrickCoord) -> (f32, f32) {
        let centre = (coord.as_vec3() * 8.0 + 3.5) * self.step();
        self.leaves[leaf as usize].range(centre, 3.5 * self.step(), 0.0, self.step())
    }

    /// φ of a union of leaves at the nodes of a brick, in `scratch.stack[0]`: as
    /// [`Self::brick_values`], the leaf that goes lowest first, so that the others have the least
    /// left to say. The order does not change a minimum. `None` for any other tape.
    fn union_values<'s>(
        &self,
        coord: BrickCoord,
        tape: &[Instr],
        slack: f32,
        scratch: &'s mut Scratch,
    ) -> Option<&'s mut [f32; NODES]> {
        let [Instr::Load(first), pairs @ ..] = tape else {
            return None;
        };
        let Scratch {
            points,
            stack,
            order,
        } = scratch;
        order.clear();
        order.push((*first, 0.0, 0.0));
        for pair in pairs.chunks(2) {
            let [Instr::Load(leaf), Instr::Min] = pair else {
                return None;
            };
            order.push((*leaf, 0.0, 0.0));
        }
        if order.len() > 1 {
            for (leaf, low, high) in order.iter_mut() {
                (*low, *high) = self.leaf_range(*leaf, coord);
            }
            order.sort_by(|a, b| a.2.total_cmp(&b.2));
        }
        stack.resize(stack.len().max(2), [0.0; NODES]);
        let [all, one, ..] = &mut stack[..] else {
            return None;
        };
        let mut most = f32::INFINITY;
        for (i, (leaf, low, _)) in order.iter().enumerate() {
            let out = if i == 0 { &mut *all } else { &mut *one };
            if i > 0 && low - slack >= most.min(EXACT * self.step()) {
                continue;
            }
            self.leaves[*leaf as usize].brick(coord * 8, self.step(), points, out);
            if i > 0 {
                combine(Instr::Min, all, one);
            }
            if i + 1 < order.len() {
                most = extremes(all).1;
            }
        }
        Some(all)
    }

    /// How far from its nodes a zero of φ makes a brick hold values, metres: the differences along
    /// the axes at the ends of a crossed edge reach two steps from the crossing at most.
    pub(crate) fn around(&self) -> f32 {
        2.0 * self.step()
    }

    /// φ at every node of a brick, as [`Program::at`].
    pub(crate) fn values<'s>(
        &self,
        coord: BrickCoord,
        scratch: &'s mut Scratch,
    ) -> Option<&'s mut [f32; NODES]> {
        self.brick_values(coord, &self.tape, self.rounding(), scratch)
    }

    /// Bounds of φ no further than `around` from a cube.
    pub(crate) fn bounds_of(&self, centre: Vec3, half: f32, around: f32) -> (f32, f32) {
        let mut thin = Vec::new();
        let range = self.prune(
            &self.tape,
            (centre, half),
            around,
            self.rounding(),
            &mut thin,
        );
        (range.low, range.high)
    }

    /// The greatest |∇φ| no further than `around` from a cube, if known.
    pub(crate) fn steepest(&self, centre: Vec3, half: f32, around: f32) -> Option<f32> {
        self.leaves.iter().try_fold(1.0f32, |most, leaf| {
            Some(most.max(leaf.slope(centre, half, around)?))
        })
    }

    /// How far bounds may be off by rounding.
    pub(crate) fn rounding(&self) -> f32 {
        let b = self.bounds();
        1.0e-3 * self.step() + 4.0e-6 * b.min.abs().max(b.max.abs()).max_element()
    }

    /// The greatest |∇φ| on a brick and two steps around it, if known.
    fn slope(&self, coord: BrickCoord, tape: &[Instr]) -> Option<f32> {
        let centre = (coord.as_vec3() * 8.0 + 3.5) * self.step();
        let mut most = 1.0f32;
        for instr in tape {
            if let Instr::Load(leaf) = instr {
                let leaf = &self.leaves[*leaf as usize];
                most = most.max(leaf.slope(centre, 3.5 * self.step(), self.around())?);
            }
        }
        Some(most)
    }

    /// What the brick at `coord` holds, unless it is nowhere near the surface.
    pub(crate) fn brick(
        &self,
        coord: BrickCoord,
        tape: &[Instr],
        slack: f32,
        scratch: &mut Scratch,
    ) -> Option<Brick> {
        let step = self.step();
        let plain = self.union_values(coord, tape, slack, scratch).is_some();
        let values = if plain {
            &mut scratch.stack[0]
        } else {
            self.brick_values(coord, tape, slack, scratch)?
        };
        let least = 1.0e-4 * step;
        for v in values.iter_mut() {
            *v = if v.abs() < least { least } else { *v };
        }
        let (min, max) = extremes(values);
        // Nothing so near can have the other sign if φ is not too steep.
        let clear = min.max(-max) / (1.01 * self.around());
        if clear > 1.0 && self.slope(coord, tape).is_some_and(|slope| clear > slope) {
            return (max < 0.0).then_some(Brick::Inside);
        }
        Some(Brick::Values {
            values: Arc::new(*values),
            min,
            max,
        })
    }

    /// The brick at `coord` from all operands, whether they matter or not.
    #[cfg(test)]
    pub(crate) fn brute_brick(&self, coord: BrickCoord) -> Box<[f32; NODES]> {
        let mut scratch = Scratch::default();
        match self.brick_values(coord, &self.tape, f32::INFINITY, &mut scratch) {
            None => Box::new([f32::INFINITY; NODES]),
            Some(values) => {
                let least = 1.0e-4 * self.step();
                Box::new(values.map(|v| if v.abs() < least { least } else { v }))
            }
        }
    }
}

fn combine(instr: Instr, a: &mut [f32; NODES], b: &[f32; NODES]) {
    let pairs = a.iter_mut().zip(b);
    match instr {
        Instr::Min => pairs.for_each(|(a, b)| *a = if *b < *a { *b } else { *a }),
        Instr::MaxNegated => pairs.for_each(|(a, b)| *a = if -*b > *a { -*b } else { *a }),
        _ => pairs.for_each(|(a, b)| *a = if *b > *a { *b } else { *a }),
    }
}

fn extremes(values: &[f32; NODES]) -> (f32, f32) {
    let start = Vec4::from_slice(values);
    let (mut low, mut high) = ([start; 2], [start; 2]);
    for pair in values.chunks_exact(8) {
        // Two chains, so that one need not wait for the other.
        for (k, v) in [Vec4::from_slice(pair), Vec4::from_slice(&pair[4..])]
            .into_iter()
            .enumerate()
        {
            low[k] = low[k].min(v);
            high[k] = high[k].max(v);
        }
    }
    (
        low[0].min(low[1]).min_element(),
        high[0].max(high[1]).max_element(),
    )
}

/// Whether joining values between `low` and `high` to those between the extremes `so_far` leaves
/// them all as they are.
fn loses(instr: Instr, so_far: (f32, f32), low: f32, high: f32) -> bool {
    match instr {
        Instr::Min => low >= so_far.1,
        Instr::MaxNegated => -low <= so_far.0,
        _ => high <= so_far.0,
    }
}
