//! Which nodes are inside: the triangles that a ray along x passes, counted for each row of nodes.

use glam::{DVec2, UVec2, UVec3, Vec3};
use rayon::prelude::*;

use super::band::Band;
use super::bars::Bars;
use super::frame::SIDE;
use super::lanes::{after, before};
use super::points::NONE;
use super::triangle::Triangle;
use super::{BakeError, Progress};

/// How often a row of nodes is moved a little where it runs so close along a corner that rounding
/// made its triangles disagree.
const TRIES: u32 = 8;

/// The nodes inside a chain of triangles without boundary: where its winding number, which is whole,
/// is not zero.
pub(super) struct Signs {
    /// By slot, a bit for each node, a word for each z.
    pub blocks: Vec<[u64; SIDE]>,
    /// The first node of every block, whether it has a slot or not.
    pub corners: Vec<bool>,
    /// Whether all winding numbers at nodes are 0 or 1, as they are around a surface that does not
    /// cross itself.
    pub simple: bool,
}

/// A passed triangle: the row within its bar, the first node after it, and how the winding number
/// changes.
type Crossing = (u32, u32, i32);

impl Signs {
    pub fn new(band: &Band, bars: &Bars, progress: &Progress) -> Result<Self, BakeError> {
        let n = band.size;
        let mut signs = Self {
            blocks: Vec::with_capacity(band.places.len()),
            corners: Vec::with_capacity(band.slots.len()),
            simple: true,
        };
        for layers in &bars.groups {
            let group = bars.group(layers, progress)?;
            let one = |i: usize| {
                let place = UVec3::new(0, i as u32 % n.y, layers.start + i as u32 / n.y);
                if progress.is_cancelled() {
                    return Self::of(&[], Vec::new(), n.x);
                }
                Self::of(
                    band.bar(place),
                    crossings(place, group.of(i), bars.triangles),
                    n.x,
                )
            };
            let found: Vec<Self> = (0..group.len()).into_par_iter().map(one).collect();
            progress.check()?;
            for bar in found {
                signs.blocks.extend(bar.blocks);
                signs.corners.extend(bar.corners);
                signs.simple &= bar.simple;
            }
        }
        Ok(signs)
    }

    /// Those of one bar, `length` blocks long.
    fn of(slots: &[u32], mut crossings: Vec<Crossing>, length: u32) -> Self {
        let mut signs = Self {
            blocks: vec![[0; SIDE]; slots.iter().filter(|s| **s != NONE).count()],
            corners: vec![false; length as usize],
            simple: true,
        };
        let first = slots.iter().copied().find(|s| *s != NONE).unwrap_or(0);
        let end = length * SIDE as u32;
        crossings.sort_unstable_by_key(|c| (c.0, c.1));
        for row in crossings.chunk_by(|a, b| a.0 == b.0) {
            let mut winding = 0;
            for (i, c) in row.iter().enumerate() {
                winding += c.2;
                let to = row.get(i + 1).map_or(end, |c| c.1).min(end);
                if winding == 0 || c.1 >= to {
                    continue;
                }
                signs.simple &= winding == 1;
                for x in c.1 / SIDE as u32..to.div_ceil(SIDE as u32) {
                    let from = c.1.saturating_sub(SIDE as u32 * x);
                    let to = (to - SIDE as u32 * x).min(SIDE as u32);
                    let bits = (0xffu64 << from) & (0xff >> (SIDE as u32 - to));
                    signs.corners[x as usize] |= c.0 == 0 && from == 0;
                    let slot = slots.get(x as usize).copied().unwrap_or(NONE);
                    if slot != NONE {
                        let (y, z) = (c.0 as usize % SIDE, c.0 as usize / SIDE);
                        signs.blocks[(slot - first) as usize][z] |= bits << (8 * y);
                    }
                }
            }
        }
        signs
    }
}

/// Where triangles pass the rows of the bar that begins with block `place`.
fn crossings(place: UVec3, ids: &[u32], triangles: &[Triangle]) -> Vec<Crossing> {
    let first = UVec2::new(place.y, place.z) * SIDE as u32;
    let low = first.as_ivec2();
    let mut found = Vec::new();
    let mut turns = [0i32; SIDE * SIDE];
    for &id in ids {
        let t = &triangles[id as usize];
        let [a, b, c] = t.v;
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        let ys = after(least.y).max(low.x)..=before(most.y).min(low.x + 7);
        for z in after(least.z).max(low.y)..=before(most.z).min(low.y + 7) {
            for y in ys.clone() {
                let (y, z) = (y as u32, z as u32);
                let at = DVec2::new(f64::from(y), f64::from(z));
                if let Some((x, turn)) = through(t.v, at) {
                    let row = y - first.x + SIDE as u32 * (z - first.y);
                    turns[row as usize] += turn;
                    found.push((row, x, turn));
                }
            }
        }
    }
    for row in (0..turns.len() as u32).filter(|r| turns[*r as usize] != 0) {
        found.retain(|c| c.0 != row);
        let at = first + UVec2::new(row % SIDE as u32, row / SIDE as u32);
        found.extend(beside(row, at, ids, triangles));
    }
    found
}

/// The crossings of a row that was moved until they add up to nothing.
fn beside(row: u32, at: UVec2, ids: &[u32], triangles: &[Triangle]) -> Vec<Crossing> {
    let mut found = Vec::new();
    for k in 1..=TRIES {
        let at = at.as_dvec2() + DVec2::new(1.3e-4, 0.7e-4) * f64::from(k);
        let all = ids
            .iter()
            .filter_map(|id| through(triangles[*id as usize].v, at));
        found = all.map(|(x, turn)| (row, x, turn)).collect();
        if found.iter().map(|c| c.2).sum::<i32>() == 0 {
            break;
        }
    }
    found
}

/// Where the ray along x at (y, z) passes a triangle: the first node after that, and how the winding
/// number changes. A ray through a side or a corner counts as one a little beside it, by the same
/// amount for all triangles.
#[inline]
fn through(v: [Vec3; 3], at: DVec2) -> Option<(u32, i32)> {
    let p = v.map(|v| DVec2::new(f64::from(v.y), f64::from(v.z)));
    let (a, left) = side(p[1], p[2], at);
    let (b, same) = side(p[2], p[0], at);
    if same != left {
        return None;
    }
    let (c, same) = side(p[0], p[1], at);
    let sum = a + b + c;
    if same != left || sum == 0.0 {
        return None;
    }
    let [u, v, w] = v.map(|v| f64::from(v.x));
    let x = ((a * u + b * v + c * w) / sum).clamp(u.min(v).min(w), u.max(v).max(w));
    // Seen against x, what turns anticlockwise faces that way: it is left there. Places are no finer
    // than single precision, in which two sheets at one place are passed together.
    Some(((x as f32).ceil().max(0.0) as u32, if left { -1 } else { 1 }))
}

/// Twice the area between a side and a point, and whether the point lies on its left: the same for the
/// side the other way round, but for the sign.
#[inline]
fn side(a: DVec2, b: DVec2, at: DVec2) -> (f64, bool) {
    let swap = (a.x, a.y) > (b.x, b.y);
    let (from, to) = if swap { (b, a) } else { (a, b) };
    let (way, off) = (to - from, at - from);
    let area = way.x * off.y - way.y * off.x;
    // A point on the side counts as moved by ε along y and ε² along z.
    let left = if area != 0.0 {
        area > 0.0
    } else if way.y != 0.0 {
        way.y < 0.0
    } else {
        way.x > 0.0
    };
    if swap { (-area, !left) } else { (area, left) }
}
