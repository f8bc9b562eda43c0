use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::{IVec3, Vec3};
use midair_mesh::Aabb;
use rayon::prelude::*;
use thiserror::Error;

use crate::grid::cube;
use crate::program::Instr;
use crate::scratch::Scratch;
use crate::{BRICK, Brick, BrickCoord, Grid, Program};

/// What bounds a fusion.
#[derive(Clone, Copy, Debug)]
pub struct FuseOptions<'a> {
    /// Set from elsewhere to make the work stop soon.
    pub cancel: Option<&'a AtomicBool>,
    /// No more than this many bricks may hold values, at 2 KiB each.
    pub max_bricks: usize,
}

impl Default for FuseOptions<'_> {
    fn default() -> Self {
        Self {
            cancel: None,
            max_bricks: 1 << 19,
        }
    }
}

/// Why there is no field.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FuseError {
    /// The flag was set.
    #[error("cancelled")]
    Cancelled,
    /// More bricks than allowed.
    #[error("at a step of {step} m the solid needs more than {limit} bricks; choose a larger step")]
    TooFine {
        /// The step asked for, metres.
        step: f32,
        /// The most bricks allowed.
        limit: usize,
    },
}

/// Evaluates a program on its lattice, on every core (EasyVRModeling §5.3–5.4).
///
/// From large blocks down to bricks, φ is bounded on each (by the value at its centre and
/// |∇φ| ≤ 1, or by a baked mesh's own summaries): blocks wholly inside or outside are done, and the
/// others hand down only the operands that can win there. A brick holds values exactly where the
/// bounds let φ be zero within two steps of its nodes: wherever a normal of the surface is taken
/// from differences, these are there. The values are those of evaluating
/// everything everywhere, bit for bit, on any number of threads; only in a union, three steps or more
/// outside, may they be those of fewer operands and so larger. |φ| < 1e-4·step becomes
/// +1e-4·step, so that no triangle is without area.
///
/// # Errors
/// Cancelled, or too many bricks.
pub fn fuse(program: &Program, options: &FuseOptions) -> Result<Grid, FuseError> {
    Ok(fuse_within(program, None, None, options)?.0)
}

/// A cube of bricks: its first, and how many are on a side.
pub(crate) type Cube = (BrickCoord, i32);

/// Whether φ is as it was no further than two steps from a cube, given by its centre and half its side.
pub(crate) type Still<'a> = &'a (dyn Fn(Vec3, f32) -> bool + Sync);

/// As [`fuse`], only the bricks from `range.0` to `range.1`, both included, but for the cubes that
/// are `still`: these are named.
pub(crate) fn fuse_within(
    program: &Program,
    range: Option<(BrickCoord, BrickCoord)>,
    still: Option<Still>,
    options: &FuseOptions,
) -> Result<(Grid, Vec<Cube>), FuseError> {
    let step = program.step();
    let mut grid = Grid::new(step);
    let region = program.bounds().grown(step);
    if region.is_empty() {
        return Ok((grid, Vec::new()));
    }
    let too_fine = FuseError::TooFine {
        step,
        limit: options.max_bricks,
    };
    // Beyond this, single precision cannot tell neighbouring nodes apart.
    if region.min.abs().max(region.max.abs()).max_element() / step > 4.0e6 {
        return Err(too_fine);
    }
    let (mut low, mut high) = bricks_touching(&region, step);
    if let Some(range) = range {
        (low, high) = (low.max(range.0), high.min(range.1));
        if low.cmpgt(high).any() {
            return Ok((grid, Vec::new()));
        }
    }
    let reach = region.min.abs().max(region.max.abs()).max_element();
    let slack = 1.0e-3 * step + 4.0e-6 * reach;
    let descent = Descent {
        program,
        low,
        high,
        slack,
        still,
        kept: Mutex::default(),
    };
    let mut level = 3u32;
    while ((high >> level) - (low >> level)).max_element() >= 4 {
        level += 1;
    }
    let (first, last) = (low >> level, high >> level);
    let side = (last - first).max_element() + 1;
    let mut blocks: Vec<Block> = cube(first, side)
        .filter(|c| c.cmple(last).all())
        .filter_map(|c| descent.visit(c, level, &program.tape, &mut grid_inside(&mut grid)))
        .collect();
    while level > 0 {
        level -= 1;
        if cancelled(options) {
            return Err(FuseError::Cancelled);
        }
        let below: Vec<(Vec<Block>, Vec<(IVec3, u32)>)> = blocks
            .par_iter()
            .with_min_len(4)
            .map(|b| descent.children(b, level))
            .collect();
        blocks = Vec::with_capacity(below.iter().map(|b| b.0.len()).sum());
        for (near, inside) in below {
            blocks.extend(near);
            for (c, level) in inside {
                grid.fill_inside(c << level, 1 << level);
            }
        }
        if blocks.len() > options.max_bricks {
            return Err(too_fine);
        }
    }
    let bricks: Vec<Option<Brick>> = blocks
        .par_iter()
        .with_min_len(4)
        .map_init(Scratch::default, |scratch, b| {
            if cancelled(options) {
                return None;
            }
            program.brick(b.coord, &b.tape, slack, scratch)
        })
        .collect();
    if cancelled(options) {
        return Err(FuseError::Cancelled);
    }
    for (block, brick) in blocks.iter().zip(bricks) {
        if brick.is_some() {
            grid.set(block.coord, brick);
        }
    }
    Ok((grid, descent.kept.into_inner().unwrap_or_default()))
}

fn grid_inside(grid: &mut Grid) -> impl FnMut(IVec3, u32) {
    |c, level| grid.fill_inside(c << level, 1 << level)
}

fn cancelled(options: &FuseOptions) -> bool {
    options.cancel.is_some_and(|c| c.load(Ordering::Relaxed))
}

/// The bricks that have a node within a cell of the box.
pub(crate) fn bricks_touching(b: &Aabb, step: f32) -> (BrickCoord, BrickCoord) {
    let side = BRICK as f32 * step;
    let low = (b.min - step).max(Vec3::splat(-1.0e9 * step)) / side;
    let high = (b.max + step).min(Vec3::splat(1.0e9 * step)) / side;
    (low.floor().as_ivec3(), high.floor().as_ivec3())
}

/// A cube of 2^level bricks a side whose surface is yet to be found.
struct Block {
    coord: IVec3,
    tape: Box<[Instr]>,
}

struct Descent<'a> {
    program: &'a Program,
    low: BrickCoord,
    high: BrickCoord,
    /// How far bounds of φ may be off by rounding.
    slack: f32,
    still: Option<Still<'a>>,
    /// What is still.
    kept: Mutex<Vec<Cube>>,
}

impl Descent<'_> {
    fn children(&self, block: &Block, level: u32) -> (Vec<Block>, Vec<(IVec3, u32)>) {
        let mut inside = Vec::new();
        let near = cube(block.coord * 2, 2)
            .filter_map(|c| self.visit(c, level, &block.tape, &mut |c, l| inside.push((c, l))))
            .collect();
        (near, inside)
    }

    /// The block with the operands that matter in it; `None` if it is settled.
    fn visit(
        &self,
        coord: IVec3,
        level: u32,
        tape: &[Instr],
        inside: &mut impl FnMut(IVec3, u32),
    ) -> Option<Block> {
        let (low, high) = (coord << level, ((coord + 1) << level) - 1);
        if low.cmpgt(self.high).any() || high.cmplt(self.low).any() {
            return None;
        }
        let step = self.program.step();
        let nodes = (BRICK << level) as f32;
        let centre = (coord.as_vec3() * nodes + 0.5 * (nodes - 1.0)) * step;
        let half = 0.5 * (nodes - 1.0) * step;
        if self.still.is_some_and(|still| still(centre, half)) {
            if let Ok(mut kept) = self.kept.lock() {
                kept.push((low, 1 << level));
            }
            return None;
        }
        // For rounding, and for values lifted to 1e-4 steps; wider above than below, so that what
        // is settled on a large block would be settled on each of its bricks as well.
        let slack = self.slack * (1.0 + 0.25 * level as f32);
        let mut thin = Vec::with_capacity(tape.len());
        let range = self.program.prune(
            tape,
            (centre, half),
            self.program.around(),
            slack,
            &mut thin,
        );
        if range.low > 0.0 {
            return None;
        }
        if range.high < 0.0 {
            if low.cmpge(self.low).all() && high.cmple(self.high).all() {
                inside(coord, level);
            } else {
                let whole = cube(low, 1 << level);
                whole
                    .filter(|c| c.cmpge(self.low).all() && c.cmple(self.high).all())
                    .for_each(|c| inside(c, 0));
            }
            return None;
        }
        Some(Block {
            coord,
            tape: thin.into_boxed_slice(),
        })
    }
}
