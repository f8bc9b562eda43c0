use std::ops::Range;

use glam::Vec3;
use midair_mesh::Aabb;
use rustc_hash::FxHashSet;

use crate::fuse::{Cube, Still, bricks_touching, fuse_within};
use crate::leaf::Leaf;
use crate::program::{Instr, Outline};
use crate::{BrickCoord, FuseError, FuseOptions, Grid, Op, Program};

/// Steps by which a changed operand's box is widened: nodes next to the surface, and those that
/// normals at them are taken from, lie within three steps of it.
const MARGIN: f32 = 4.0;

/// The box outside which no node's sign, and no value within three steps of the surface, differs
/// between two programs of the same step. Empty where they are the same.
///
/// Operands are matched by what they are and where they stand. Outside its box an operand is
/// positive: one that is united or subtracted leaves the surface there alone, and so does one that
/// is intersected, as long as it was there before and after; one that comes or goes changes
/// everything it cuts.
pub fn changed_box(before: &Program, after: &Program) -> Aabb {
    let changed = match (&before.outline, &after.outline) {
        (None, None) => Aabb::EMPTY,
        (Some(o), None) | (None, Some(o)) => o.bounds,
        (Some(a), Some(b)) => difference(a, b).intersection(&a.bounds.union(&b.bounds)),
    };
    if changed.is_empty() {
        Aabb::EMPTY
    } else {
        changed.grown(MARGIN * after.step())
    }
}

fn difference(a: &Outline, b: &Outline) -> Aabb {
    let both = a.bounds.union(&b.bounds);
    if a.key == b.key {
        return Aabb::EMPTY;
    }
    if a.parts.is_empty() || b.parts.is_empty() {
        return both;
    }
    let (head, tail) = unchanged(a, b);
    let olds = &a.parts[head..a.parts.len() - tail];
    let news = &b.parts[head..b.parts.len() - tail];
    let paired = olds.len() == news.len() && olds.iter().zip(news).all(|(x, y)| x.0 == y.0);
    if paired {
        let each = olds.iter().zip(news).map(|(x, y)| difference(&x.1, &y.1));
        return each.fold(Aabb::EMPTY, |all, d| all.union(&d));
    }
    let mut changed = Aabb::EMPTY;
    for (op, part) in olds.iter().chain(news) {
        if *op == Op::Intersect {
            // Bounds of what stood before it count as well: later cuts do not bring back more.
            let all = a.parts.iter().chain(&b.parts);
            return all.fold(Aabb::EMPTY, |all, (_, p)| all.union(&p.bounds));
        }
        changed = changed.union(&part.bounds);
    }
    changed
}

/// How many parts at the head and at the tail are the same.
fn unchanged(a: &Outline, b: &Outline) -> (usize, usize) {
    let same = |x: &(Op, Outline), y: &(Op, Outline)| x.0 == y.0 && x.1.key == y.1.key;
    let shorter = a.parts.len().min(b.parts.len());
    let pairs = a.parts.iter().zip(&b.parts);
    let head = pairs.take_while(|(x, y)| same(x, y)).count();
    let pairs = a.parts.iter().rev().zip(b.parts.iter().rev());
    let pairs = pairs.take(shorter - head);
    (head, pairs.take_while(|(x, y)| same(x, y)).count())
}

/// Brings `grid`, the field of an earlier program, up to date with `program` within the `dirty`
/// box (from [`changed_box`]), and returns the bricks that now hold something else, sorted.
///
/// A grid of another step is replaced altogether. On error the grid is left as it was.
///
/// # Errors
/// Cancelled, or too many bricks.
pub fn refuse(
    grid: &mut Grid,
    program: &Program,
    dirty: &Aabb,
    options: &FuseOptions,
) -> Result<Vec<BrickCoord>, FuseError> {
    renew(grid, program, dirty, None, options)
}

/// As [`refuse`] with the box in which `before`, whose field `grid` is, and `after` differ. In a painting only
/// the bricks are evaluated in which a changed stroke is felt, however large its box is.
///
/// # Errors
/// Cancelled, or too many bricks.
pub fn refuse_from(
    grid: &mut Grid,
    before: &Program,
    after: &Program,
    options: &FuseOptions,
) -> Result<Vec<BrickCoord>, FuseError> {
    let dirty = changed_box(before, after);
    let step = after.step();
    let Some((olds, news)) = strokes_changed(before, after).filter(|_| grid.step() == step) else {
        return renew(grid, after, &dirty, None, options);
    };
    let still = |centre: Vec3, half: f32| {
        let quiet = |leaf: &Leaf, chunks: &Range<usize>| {
            let block = leaf.block(centre, half, after.around() + 1.0e-3 * step);
            let painting = leaf.painting();
            painting.is_some_and(|p| !p.reaches(chunks.clone(), &block, leaf.local(step)))
        };
        quiet(&before.leaves[0], &olds) && quiet(&after.leaves[0], &news)
    };
    renew(grid, after, &dirty, Some(&still), options)
}

/// Changed chunks beyond which it is not worth asking each of them about every block.
const FEW: usize = 64;

/// The chunks of a painting that are not as they were, in the one before and the one after; `None` where more
/// is different than a few of them.
fn strokes_changed(before: &Program, after: &Program) -> Option<(Range<usize>, Range<usize>)> {
    let ([Instr::Load(0)], [Instr::Load(0)]) = (&before.tape[..], &after.tape[..]) else {
        return None;
    };
    let (a, b) = (before.leaves.first()?, after.leaves.first()?);
    let (old, new) = (before.outline.as_ref()?, after.outline.as_ref()?);
    let known =
        a.painting()?.chunks() == old.parts.len() && b.painting()?.chunks() == new.parts.len();
    if !known || !a.stands_as(b) {
        return None;
    }
    let (head, tail) = unchanged(old, new);
    let (olds, news) = (head..old.parts.len() - tail, head..new.parts.len() - tail);
    (olds.len() + news.len() <= FEW).then_some((olds, news))
}

/// Cubes of bricks, each looked up by its size: a large one is one entry.
struct Kept {
    cubes: FxHashSet<(BrickCoord, u32)>,
    levels: Vec<u32>,
}

impl Kept {
    fn of(cubes: &[Cube]) -> Self {
        let level = |side: i32| side.trailing_zeros();
        let cubes: FxHashSet<_> = cubes
            .iter()
            .map(|&(first, side)| (first >> level(side), level(side)))
            .collect();
        let mut levels: Vec<u32> = cubes.iter().map(|c| c.1).collect();
        levels.sort_unstable();
        levels.dedup();
        Self { cubes, levels }
    }

    fn holds(&self, c: BrickCoord) -> bool {
        let within = |&level: &u32| self.cubes.contains(&(c >> level, level));
        self.levels.iter().any(within)
    }
}

fn renew(
    grid: &mut Grid,
    program: &Program,
    dirty: &Aabb,
    still: Option<Still>,
    options: &FuseOptions,
) -> Result<Vec<BrickCoord>, FuseError> {
    let everywhere = Aabb::new(Vec3::splat(f32::MIN), Vec3::splat(f32::MAX));
    let other = grid.step() != program.step();
    let dirty = if other { &everywhere } else { dirty };
    if dirty.is_empty() {
        return Ok(Vec::new());
    }
    let (low, high) = bricks_touching(dirty, program.step());
    let (mut fresh, kept) = fuse_within(program, Some((low, high)), still, options)?;
    let kept = Kept::of(&kept);
    let mut changed = Vec::new();
    if other {
        changed.extend(grid.bricks().map(|(c, _)| c));
        *grid = Grid::new(program.step());
    }
    for c in grid.coords_within(low, high) {
        if fresh.brick(c).is_none() && !kept.holds(c) {
            grid.set(c, None);
            changed.push(c);
        }
    }
    for c in fresh.coords_within(low, high) {
        if fresh.brick(c) != grid.brick(c) {
            grid.set(c, fresh.take(c));
            changed.push(c);
        }
    }
    changed.sort_unstable_by_key(|c| (c.z, c.y, c.x));
    changed.dedup();
    Ok(changed)
}
