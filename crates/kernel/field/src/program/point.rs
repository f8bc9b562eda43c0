use glam::Vec3;

use super::{Instr, Program};

/// Points whose φ is worked out together, in about the time of two by themselves.
pub const TOGETHER: usize = 8;

impl Program {
    /// φ at a point, in metres; infinite for a solid without operands.
    pub fn at(&self, p: Vec3) -> f32 {
        run(&self.tape, |leaf| self.leaves[leaf as usize].at(p))
    }

    /// The same at some points: as many bits alike as there are.
    pub fn at_all(&self, points: &[Vec3; TOGETHER]) -> [f32; TOGETHER] {
        self.run_all(&self.tape, points)
    }

    /// φ in the cube of half side `half` metres about `centre` and two steps around it, without the
    /// operands that cannot matter there.
    pub fn part(&self, centre: Vec3, half: f32) -> Part<'_> {
        let mut tape = Vec::new();
        self.prune(
            &self.tape,
            (centre, half),
            self.around(),
            self.rounding(),
            &mut tape,
        );
        Part {
            program: self,
            tape,
        }
    }

    fn run_all(&self, tape: &[Instr], points: &[Vec3; TOGETHER]) -> [f32; TOGETHER] {
        run(tape, |leaf| {
            Together(self.leaves[leaf as usize].at_all(points))
        })
        .0
    }
}

/// A [`Program`] near one place.
#[derive(Clone, Debug)]
pub struct Part<'p> {
    program: &'p Program,
    tape: Vec<Instr>,
}

impl Part<'_> {
    /// As [`Program::at`], for a point of the cube or no further than two steps from it.
    pub fn at(&self, p: Vec3) -> f32 {
        run(&self.tape, |leaf| self.program.leaves[leaf as usize].at(p))
    }

    /// As [`Program::at_all`], for such points.
    pub fn at_all(&self, points: &[Vec3; TOGETHER]) -> [f32; TOGETHER] {
        self.program.run_all(&self.tape, points)
    }
}

/// What a tape leaves on the stack.
trait Value: Copy {
    const ZERO: Self;
    const NOTHING: Self;
    fn negated(self) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
}

impl Value for f32 {
    const ZERO: Self = 0.0;
    const NOTHING: Self = Self::INFINITY;
    fn negated(self) -> Self {
        -self
    }
    fn min(self, other: Self) -> Self {
        Self::min(self, other)
    }
    fn max(self, other: Self) -> Self {
        Self::max(self, other)
    }
}

#[derive(Clone, Copy)]
struct Together([f32; TOGETHER]);

impl Together {
    fn with(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

impl Value for Together {
    const ZERO: Self = Self([0.0; TOGETHER]);
    const NOTHING: Self = Self([f32::INFINITY; TOGETHER]);
    fn negated(self) -> Self {
        Self(self.0.map(|x| -x))
    }
    fn min(self, other: Self) -> Self {
        self.with(other, f32::min)
    }
    fn max(self, other: Self) -> Self {
        self.with(other, f32::max)
    }
}

fn run<V: Value>(tape: &[Instr], load: impl Fn(u32) -> V) -> V {
    // A tape leaves no more values at once than it has instructions.
    let (mut few, mut many) = ([V::ZERO; 32], Vec::new());
    let stack = if tape.len() <= few.len() {
        &mut few[..]
    } else {
        many.resize(tape.len(), V::ZERO);
        &mut many[..]
    };
    let mut top = 0;
    for &instr in tape {
        match instr {
            Instr::Load(leaf) => {
                stack[top] = load(leaf);
                top += 1;
            }
            Instr::Negate if top > 0 => stack[top - 1] = stack[top - 1].negated(),
            Instr::Min | Instr::Max | Instr::MaxNegated if top > 1 => {
                let (a, b) = (stack[top - 2], stack[top - 1]);
                top -= 1;
                stack[top - 1] = match instr {
                    Instr::Min => a.min(b),
                    Instr::Max => a.max(b),
                    _ => a.max(b.negated()),
                };
            }
            _ => {}
        }
    }
    if top == 0 { V::NOTHING } else { stack[top - 1] }
}
