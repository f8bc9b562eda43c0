use glam::{IVec3, Vec3};
use midair_field::{BRICK, Brick, Grid};
use rayon::prelude::*;

/// A field sampled from a function of the position in metres, at the nodes (0, 0, 0) to
/// `nodes` − 1 times `step`; beyond them all is outside.
///
/// Bricks whose values all lie at least `band` metres from zero keep nothing but their side, as a
/// solid's own field does; an infinite `band` keeps every value. `band` must not be less than a
/// cell's diagonal if `f` is a distance.
pub fn grid_from_fn(
    nodes: [usize; 3],
    step: f32,
    band: f32,
    f: impl Fn(Vec3) -> f32 + Sync,
) -> Grid {
    let count = nodes.map(|n| n.div_ceil(BRICK));
    let bricks: Vec<_> = (0..count[0] * count[1] * count[2])
        .into_par_iter()
        .filter_map(|i| {
            let c = [
                i % count[0],
                i / count[0] % count[1],
                i / (count[0] * count[1]),
            ];
            let mut values = Box::new([f32::INFINITY; BRICK * BRICK * BRICK]);
            for (j, v) in values.iter_mut().enumerate() {
                let l = [j % BRICK, j / BRICK % BRICK, j / (BRICK * BRICK)];
                let n = std::array::from_fn::<_, 3, _>(|a| c[a] * BRICK + l[a]);
                if (0..3).all(|a| n[a] < nodes[a]) {
                    *v = f(Vec3::from(n.map(|n| n as f32)) * step);
                }
            }
            let min = values.iter().copied().fold(f32::INFINITY, f32::min);
            let max = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
            let brick = if min >= band {
                return None;
            } else if max <= -band {
                Brick::Inside
            } else {
                Brick::Values {
                    values: values.into(),
                    min,
                    max,
                }
            };
            Some((IVec3::from(c.map(|c| c as i32)), brick))
        })
        .collect();
    let mut grid = Grid::new(step);
    for (c, brick) in bricks {
        grid.set(c, Some(brick));
    }
    grid
}
