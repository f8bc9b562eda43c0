//! Leaving out the parts of a surface that bound nothing.

use glam::Vec3;
use rayon::prelude::*;

use super::tree::Tree;
use super::triangle::Triangle;
use super::{BakeError, Progress};

enum Part {
    All,
    Nothing,
    Some(Vec<Triangle>),
}

/// The parts of `triangles[from..]`, in steps, with the inside on one side and the outside on the other,
/// after the whole of `triangles[..from]`. Walls within a solid and sheets that lie on each other
/// would draw φ to zero where there is no surface.
pub(super) fn bounding(
    triangles: &[Triangle],
    from: usize,
    tree: &Tree,
    progress: &Progress,
) -> Result<Vec<Triangle>, BakeError> {
    let parts: Vec<Part> = triangles[from..]
        .par_iter()
        .map(|t| {
            if t.n == Vec3::ZERO {
                // Too thin to have sides; its neighbours run along the same edges.
                return Part::Nothing;
            }
            part(t.v, t.n, tree, progress)
        })
        .collect();
    progress.check()?;
    let mut kept = triangles[..from].to_vec();
    for (t, part) in triangles[from..].iter().zip(parts) {
        match part {
            Part::All => kept.push(*t),
            Part::Nothing => {}
            Part::Some(pieces) => kept.extend(pieces),
        }
    }
    Ok(kept)
}

fn part(v: [Vec3; 3], n: Vec3, tree: &Tree, progress: &Progress) -> Part {
    if progress.is_cancelled() {
        return Part::All;
    }
    let longest = (0..3)
        .map(|k| v[k].distance(v[(k + 1) % 3]))
        .fold(0.0, f32::max);
    let bounds = |w: [f32; 3]| {
        let p = v[0] * w[0] + v[1] * w[1] + v[2] * w[2];
        let sides = tree.winding_beside(p, n * 2e-3);
        let [above, below] = sides.map(|w| w.round() != 0.0);
        above != below
    };
    if longest < 4.0 {
        let third = 1.0 / 3.0;
        let samples = [
            [third, third, third],
            [0.9, 0.05, 0.05],
            [0.05, 0.9, 0.05],
            [0.05, 0.05, 0.9],
        ];
        let count = samples.into_iter().filter(|&w| bounds(w)).count();
        if count == 0 {
            return Part::Nothing;
        }
        if count == samples.len() || longest < 1.0 {
            return Part::All;
        }
    }
    // Halved across the longest side, so that slivers end too.
    let k = (0..3)
        .find(|&k| v[k].distance(v[(k + 1) % 3]) == longest)
        .unwrap_or(0);
    let (a, b, c) = (v[k], v[(k + 1) % 3], v[(k + 2) % 3]);
    let middle = 0.5 * (a + b);
    let halves = [[a, middle, c], [middle, b, c]];
    let parts = halves.map(|h| part(h, n, tree, progress));
    match &parts {
        [Part::All, Part::All] => Part::All,
        [Part::Nothing, Part::Nothing] => Part::Nothing,
        _ => {
            let mut out = Vec::new();
            for (h, p) in halves.into_iter().zip(parts) {
                match p {
                    Part::All => out.push(Triangle::new(h)),
                    Part::Nothing => {}
                    Part::Some(more) => out.extend(more),
                }
            }
            Part::Some(out)
        }
    }
}
