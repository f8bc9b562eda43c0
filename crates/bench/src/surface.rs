use std::f32::consts::TAU;
use std::time::Instant;

use glam::{IVec3, Vec3};
use midair_field::{
    BrickCoord, FuseOptions, Grid, Node, Op, Operand, Placement, Primitive, Program, Recipe, fuse,
};
use midair_surface::{Surface, grid_from_fn};
use serde_json::json;

use crate::catalogue::BenchError;
use crate::figure::Details;
use crate::measure::{Budget, Run, Times, repeat, timed};

/// 256 nodes along the unit cube.
const NODES: usize = 256;
const STEP: f32 = 1.0 / 255.0;

/// What is extracted, on 256³ nodes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Subject {
    /// A sphere of radius 0.4, the field as a fusion leaves it.
    Sphere,
    /// The same with a value at every node, none of them skipped for being far.
    SphereDense,
    /// A gyroid of four periods: nearly every brick is crossed.
    Gyroid,
    /// The sphere again, after an edit within 64³ nodes.
    Dirty,
}

impl Subject {
    pub const ALL: [Self; 4] = [Self::Sphere, Self::SphereDense, Self::Gyroid, Self::Dirty];

    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "surface/sphere/256",
            Self::SphereDense => "surface/sphere-dense/256",
            Self::Gyroid => "surface/gyroid/256",
            Self::Dirty => "surface/dirty-64-in-256",
        }
    }
}

pub(crate) fn run(subject: Subject, budget: &Budget) -> Result<(Times, Details), BenchError> {
    match subject {
        Subject::Sphere => whole(&fused(&ball())?, budget),
        Subject::SphereDense => {
            let sphere = |p: Vec3| p.distance(Vec3::splat(0.5)) - 0.4;
            whole(&dense(sphere), budget)
        }
        Subject::Gyroid => {
            let gyroid = |p: Vec3| {
                let p = 4.0 * TAU * p;
                let (s, c) = (p.map(f32::sin), p.map(f32::cos));
                s.x * c.y + s.y * c.z + s.z * c.x
            };
            whole(&dense(gyroid), budget)
        }
        Subject::Dirty => dirty(budget),
    }
}

fn whole(grid: &Grid, budget: &Budget) -> Result<(Times, Details), BenchError> {
    let times = repeat(budget, || {
        let started = Instant::now();
        let surface = Surface::extract(grid);
        let total = started.elapsed();
        let mesh = timed(|| surface.mesh());
        Ok::<_, BenchError>(Run {
            total,
            parts: [("mesh_ms", mesh)],
        })
    })?;
    Ok((times, details(grid, &Surface::extract(grid))))
}

/// Updates go back and forth between a sphere and one with a dent.
fn dirty(budget: &Budget) -> Result<(Times, Details), BenchError> {
    let grids = [fused(&dented())?, fused(&ball())?];
    let changed = edited();
    let mut surface = Surface::extract(&grids[1]);
    let mut turn = grids.iter().cycle();
    let times = repeat(budget, || {
        let grid = turn.next().unwrap_or(&grids[0]);
        let took = timed(|| surface.update(grid, &changed));
        Ok::<_, BenchError>(took.into())
    })?;
    let mut details = details(&grids[0], &Surface::extract(&grids[0]));
    details.insert("bricks_named".into(), json!(changed.len()));
    Ok((times, details))
}

fn details(grid: &Grid, surface: &Surface) -> Details {
    let mut details = Details::new();
    details.insert("triangles".into(), json!(surface.triangles()));
    details.insert("bricks".into(), json!(grid.near_coords().len()));
    details
}

/// A field with a value at each of the 256³ nodes.
fn dense(f: impl Fn(Vec3) -> f32 + Sync) -> Grid {
    grid_from_fn([NODES; 3], STEP, f32::INFINITY, f)
}

fn fused(recipe: &Recipe) -> Result<Grid, BenchError> {
    let program = Program::compile(recipe, &Placement::IDENTITY, STEP, &())?;
    Ok(fuse(&program, &FuseOptions::default())?)
}

fn operand(op: Op, at: Vec3, radius: f32) -> Operand {
    Operand {
        op,
        placement: Placement::at(at),
        recipe: Primitive::Sphere { radius }.into(),
        muted: false,
    }
}

fn ball() -> Recipe {
    let ball = operand(Op::Union, Vec3::splat(0.5), 0.4);
    Recipe::new(Node::Solid(vec![ball]))
}

/// The dent is nearly as wide as the 64 nodes that [`edited`] names.
fn dented() -> Recipe {
    let ball = operand(Op::Union, Vec3::splat(0.5), 0.4);
    let dent = operand(Op::Subtract, Vec3::new(0.5, 0.5, 0.1), 0.1);
    Recipe::new(Node::Solid(vec![ball, dent]))
}

/// The 8³ bricks of 64³ nodes around the dent.
fn edited() -> Vec<BrickCoord> {
    let low = IVec3::new(12, 12, 0);
    (0..512)
        .map(|i| low + IVec3::new(i % 8, i / 8 % 8, i / 64))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_edit_stays_within_64_nodes() {
        let (before, after) = (fused(&ball()).unwrap(), fused(&dented()).unwrap());
        let changed = edited();
        let all = before.bricks().chain(after.bricks()).map(|(c, _)| c);
        let differ: Vec<_> = all.filter(|&c| before.brick(c) != after.brick(c)).collect();
        assert!(differ.len() > 100);
        assert!(differ.iter().all(|c| changed.contains(c)));
    }

    #[test]
    fn an_update_gives_what_an_extraction_gives() {
        let (before, after) = (fused(&ball()).unwrap(), fused(&dented()).unwrap());
        let mut surface = Surface::extract(&before);
        surface.update(&after, &edited());
        assert_eq!(surface.mesh(), Surface::extract(&after).mesh());
    }
}
