use glam::Vec3;
use midair_mesh::Aabb;

use crate::fuse::{bricks_touching, fuse_within};
use crate::program::Outline;
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
    let same = |x: &(Op, Outline), y: &(Op, Outline)| x.0 == y.0 && x.1.key == y.1.key;
    let shorter = a.parts.len().min(b.parts.len());
    let pairs = a.parts.iter().zip(&b.parts);
    let head = pairs.take_while(|(x, y)| same(x, y)).count();
    let pairs = a.parts.iter().rev().zip(b.parts.iter().rev());
    let pairs = pairs.take(shorter - head);
    let tail = pairs.take_while(|(x, y)| same(x, y)).count();
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
    let everywhere = Aabb::new(Vec3::splat(f32::MIN), Vec3::splat(f32::MAX));
    let other = grid.step() != program.step();
    let dirty = if other { &everywhere } else { dirty };
    if dirty.is_empty() {
        return Ok(Vec::new());
    }
    let (low, high) = bricks_touching(dirty, program.step());
    let mut fresh = fuse_within(program, Some((low, high)), options)?;
    let mut changed = Vec::new();
    if other {
        changed.extend(grid.bricks().map(|(c, _)| c));
        *grid = Grid::new(program.step());
    }
    for c in grid.coords_within(low, high) {
        if fresh.brick(c).is_none() {
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
