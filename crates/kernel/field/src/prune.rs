use glam::Vec3;

use crate::Program;
use crate::program::Instr;

/// Bounds of φ over a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    pub low: f32,
    pub high: f32,
}

impl Interval {
    fn negated(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }
}

impl Program {
    /// Bounds φ no further than `around` from the cube of half side `half` about `centre`, each leaf's
    /// bounds widened by `slack`, and writes to `out` the part of `tape` that can matter there.
    ///
    /// An operand is left out where the other side of its operator wins at every point of the cube,
    /// so what remains has the very same values. Since nested solids are stretches of the same
    /// tape, they are thinned out the same way.
    pub(crate) fn prune(
        &self,
        tape: &[Instr],
        (centre, half): (Vec3, f32),
        around: f32,
        slack: f32,
        out: &mut Vec<Instr>,
    ) -> Interval {
        let mut stack: Vec<(Interval, usize)> = Vec::with_capacity(8);
        out.clear();
        for &instr in tape {
            match instr {
                Instr::Load(leaf) => {
                    let (low, high) =
                        self.leaves[leaf as usize].range(centre, half, around, self.step());
                    let range = Interval {
                        low: low - slack,
                        high: high + slack,
                    };
                    stack.push((range, out.len()));
                    out.push(instr);
                }
                Instr::Negate => {
                    if let Some((top, _)) = stack.last_mut() {
                        *top = top.negated();
                    }
                    out.push(instr);
                }
                Instr::Min | Instr::Max | Instr::MaxNegated => {
                    let (Some((b, at)), Some((a, start))) = (stack.pop(), stack.last_mut()) else {
                        continue;
                    };
                    *a = join(instr, *a, b, *start, at, out);
                }
            }
        }
        stack.pop().map_or(
            Interval {
                low: f32::INFINITY,
                high: f32::INFINITY,
            },
            |(all, _)| all,
        )
    }
}

/// Joins the operands pushed by `out[start..at]` and `out[at..]`, or leaves out one of them.
fn join(
    instr: Instr,
    a: Interval,
    b: Interval,
    start: usize,
    at: usize,
    out: &mut Vec<Instr>,
) -> Interval {
    let b = if instr == Instr::MaxNegated {
        b.negated()
    } else {
        b
    };
    let (a_wins, b_wins) = match instr {
        Instr::Min => (a.high <= b.low, b.high <= a.low),
        _ => (a.low >= b.high, b.low >= a.high),
    };
    if a_wins {
        out.truncate(at);
        return a;
    }
    if b_wins {
        out.drain(start..at);
        if instr == Instr::MaxNegated {
            out.push(Instr::Negate);
        }
        return b;
    }
    out.push(instr);
    if instr == Instr::Min {
        Interval {
            low: a.low.min(b.low),
            high: a.high.min(b.high),
        }
    } else {
        Interval {
            low: a.low.max(b.low),
            high: a.high.max(b.high),
        }
    }
}
