use std::borrow::Cow;

use glam::{Vec3, Vec4};

use crate::program::Instr;
use crate::shape::{NODES, Points};
use crate::{Brick, BrickCoord, Program};

/// Buffers of one thread.
pub(crate) struct Scratch {
    points: Box<Points>,
    stack: Vec<[f32; NODES]>,
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
        }
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
        self.leaves[leaf as usize].range(centre, 3.5 * self.step())
    }

    /// The tape of a plain union with the leaf that goes lowest first, so that the others have the
    /// least left to say; any other tape as it is. The order does not change a minimum.
    fn ordered<'t>(&self, coord: BrickCoord, tape: &'t [Instr]) -> Cow<'t, [Instr]> {
        let plain = |pair: &[Instr]| matches!(pair, [Instr::Load(_), Instr::Min]);
        let [Instr::Load(first), pairs @ ..] = tape else {
            return Cow::Borrowed(tape);
        };
        if pairs.is_empty() || !pairs.chunks(2).all(plain) {
            return Cow::Borrowed(tape);
        }
        let others = pairs.iter().filter_map(|i| match i {
            Instr::Load(leaf) => Some(*leaf),
            _ => None,
        });
        let all = std::iter::once(*first).chain(others);
        let mut all: Vec<_> = all
            .map(|leaf| (self.leaf_range(leaf, coord).1, leaf))
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut tape = Vec::with_capacity(2 * all.len());
        for (i, (_, leaf)) in all.into_iter().enumerate() {
            tape.push(Instr::Load(leaf));
            if i > 0 {
                tape.push(Instr::Min);
            }
        }
        Cow::Owned(tape)
    }

    /// The greatest |∇φ| on a brick and a cell around it, if known.
    fn slope(&self, coord: BrickCoord, tape: &[Instr]) -> Option<f32> {
        let centre = (coord.as_vec3() * 8.0 + 3.5) * self.step();
        let mut most = 1.0f32;
        for instr in tape {
            if let Instr::Load(leaf) = instr {
                let leaf = &self.leaves[*leaf as usize];
                most = most.max(leaf.slope(centre, 4.5 * self.step())?);
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
        let tape = &*self.ordered(coord, tape);
        let values = self.brick_values(coord, tape, slack, scratch)?;
        let least = 1.0e-4 * step;
        for v in values.iter_mut() {
            *v = if v.abs() < least { least } else { *v };
        }
        let (min, max) = extremes(values);
        // No node a cell away, √3 steps at most, can have the other sign if φ is not too steep.
        let clear = min.max(-max) / (1.75 * step);
        if clear > 1.0 && self.slope(coord, tape).is_some_and(|slope| clear > slope) {
            return (max < 0.0).then_some(Brick::Inside);
        }
        Some(Brick::Values {
            values: Box::new(*values),
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
