use glam::{UVec3, Vec3};
use midair_mesh::Aabb;
use rayon::prelude::*;

use super::BakeError;
use super::frame::{Frame, NODES, SIDE, at};
use super::sample::slope_of;
use crate::VolumeView;

/// Marks a table entry whose brick keeps every node.
pub(super) const NEAR: u32 = 1 << 31;
pub(super) const NEAR_LEN: usize = NODES * NODES * NODES;
pub(super) const FAR_LEN: usize = 8;
/// Steps from the surface within which every node is kept.
pub(super) const BAND: f32 = 3.0;
/// Most node values a volume may keep: 2 GiB.
pub(super) const MOST_VALUES: usize = 1 << 29;

/// A signed distance sampled at the nodes of a grid, in the coordinates of its mesh: metres,
/// negative inside.
///
/// The grid is cut into bricks of 8³ cells. A brick near the surface keeps its 9³ node values, the
/// outer ones again in its neighbours, so that a sample reads one brick only; a brick further than
/// three steps from the surface keeps its 8 corners. Inside the box a sample is the trilinear
/// interpolation of EasyVRModeling §5.2 Eq. 5–6. Outside it is √(r² + φ²), r the distance to the
/// box and φ the sample where the box is closest: finite, positive, continuous where φ is positive
/// at the rim, and no more than the true distance.
///
/// In a near brick φ is kept at every node. In a far one it is scaled down where interpolation
/// would claim more than the distance at the brick's centre; it may jump by as much where two
/// bricks meet, and keeps its sign.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    pub(super) frame: Frame,
    pub(super) solid: Aabb,
    pub(super) table: Vec<u32>,
    /// The least and greatest value of each brick, and how much it changes per cell at most.
    pub(super) ranges: Vec<[f32; 3]>,
    /// The least and greatest value of each [`GROUP`]³ bricks.
    pub(super) groups: Vec<[f32; 2]>,
    pub(super) values: Vec<f32>,
}

/// Bricks along the side of a group.
const GROUP: u32 = 4;

/// What groups of bricks come to.
pub(super) fn groups_of(bricks: UVec3, ranges: &[[f32; 3]]) -> Vec<[f32; 2]> {
    let n = bricks.map(|b| b.div_ceil(GROUP));
    let mut groups = vec![[f32::INFINITY, f32::NEG_INFINITY]; n.element_product() as usize];
    for (i, r) in ranges.iter().enumerate() {
        let g = at(bricks, i) / GROUP;
        let group = &mut groups[(g.x + n.x * (g.y + n.y * g.z)) as usize];
        *group = [group[0].min(r[0]), group[1].max(r[1])];
    }
    groups
}

impl Volume {
    /// Samples `f` (metres, in the coordinates of `bounds`) at the nodes of a grid of the given
    /// step over `bounds`, on every core.
    ///
    /// # Errors
    /// A box or step that is not finite, or a grid beyond the memory limit.
    pub fn from_fn(
        bounds: Aabb,
        step: f32,
        f: impl Fn(Vec3) -> f32 + Sync,
    ) -> Result<Self, BakeError> {
        let frame = Frame::around(bounds, step)?;
        let bricks: Vec<Vec<f32>> = (0..frame.brick_count())
            .into_par_iter()
            .map(|b| {
                let first = frame.brick_at(b) * SIDE as u32;
                let mut v = Vec::with_capacity(NEAR_LEN);
                for z in 0..NODES as u32 {
                    for y in 0..NODES as u32 {
                        for x in 0..NODES as u32 {
                            v.push(f(frame.node(first + UVec3::new(x, y, z))));
                        }
                    }
                }
                coarsened(&v, step).map_or(v, |c| c.to_vec())
            })
            .collect();
        let near: Vec<bool> = bricks.iter().map(|b| b.len() == NEAR_LEN).collect();
        Self::assemble(frame, bounds, &near, |b, out| {
            out.copy_from_slice(&bricks[b])
        })
    }

    /// A volume whose brick `b` is filled by `fill(b, values)`, on every core.
    pub(super) fn assemble(
        frame: Frame,
        solid: Aabb,
        near: &[bool],
        fill: impl Fn(usize, &mut [f32]) + Sync,
    ) -> Result<Self, BakeError> {
        let length = |near: bool| if near { NEAR_LEN } else { FAR_LEN };
        let total: usize = near.iter().map(|&n| length(n)).sum();
        if total > MOST_VALUES {
            return Err(too_many_values(frame.step, total));
        }
        let mut values = vec![0.0f32; total];
        let mut table = Vec::with_capacity(near.len());
        let mut parts = Vec::with_capacity(near.len());
        let (mut rest, mut offset) = (&mut values[..], 0u32);
        for &n in near {
            table.push(offset | if n { NEAR } else { 0 });
            let (part, after) = rest.split_at_mut(length(n));
            offset += part.len() as u32;
            parts.push(part);
            rest = after;
        }
        let ranges = parts
            .into_par_iter()
            .enumerate()
            .with_min_len(16)
            .map(|(b, part)| {
                fill(b, part);
                summary_of(part)
            })
            .collect::<Vec<_>>();
        Ok(Self {
            frame,
            solid,
            table,
            groups: groups_of(frame.bricks(), &ranges),
            ranges,
            values,
        })
    }

    /// The box of the grid. A solid may touch it, but is cut off by it.
    pub fn bounds(&self) -> Aabb {
        self.frame.bounds()
    }

    /// The box of the mesh this was baked from.
    pub fn solid_bounds(&self) -> Aabb {
        self.solid
    }

    /// The distance between two nodes, metres (S_local).
    pub fn step(&self) -> f32 {
        self.frame.step
    }

    /// The number of cells along each axis.
    pub fn cells(&self) -> UVec3 {
        self.frame.cells
    }

    /// What it keeps, for evaluators elsewhere.
    pub fn view(&self) -> VolumeView<'_> {
        VolumeView {
            origin: self.frame.origin,
            step: self.frame.step,
            cells: self.frame.cells,
            table: &self.table,
            ranges: &self.ranges,
            values: &self.values,
        }
    }

    /// The memory it takes, bytes.
    pub fn bytes(&self) -> usize {
        self.values.len() * 4 + self.table.len() * 16
    }

    /// Whether no node lies inside: the mesh encloses nothing, or nothing as thick as a step.
    pub fn is_hollow(&self) -> bool {
        self.ranges.iter().all(|r| r[0] >= 0.0)
    }

    /// φ at `p`, metres.
    #[inline]
    pub fn sample(&self, p: Vec3) -> f32 {
        let g = (p - self.frame.origin) / self.frame.step;
        let inside = g.clamp(Vec3::ZERO, self.frame.cells.as_vec3());
        let beyond = (g - inside).length_squared();
        beyond_box(self.interpolate(inside), beyond, self.frame.step)
    }

    /// φ at `start`, `start + delta`, `start + 2 delta` … into `out`. The same as [`Volume::sample`]
    /// one by one, up to rounding, and several times as fast.
    pub fn sample_row(&self, start: Vec3, delta: Vec3, out: &mut [f32]) {
        let inverse = 1.0 / self.frame.step;
        let g = (start - self.frame.origin) * inverse;
        let d = delta * inverse;
        if d.y == 0.0 && d.z == 0.0 && d.x > 0.0 {
            self.row_along_x(g, d.x, out);
        } else {
            self.row(g, d, out);
        }
    }

    /// The least and the greatest φ that [`Volume::sample`] gives in a box, or a little more on
    /// either side: found from the summaries of bricks, without reading nodes.
    pub fn range(&self, within: &Aabb) -> (f32, f32) {
        let f = &self.frame;
        let own = f.bounds();
        let low = (within.min - f.origin) / f.step;
        let high = (within.max - f.origin) / f.step;
        let last = f.bricks() - UVec3::ONE;
        // Rounding of g may put a sample into the next brick: widened by a thousandth of a cell.
        let lo = ((low - 1e-3).max(Vec3::ZERO) / SIDE as f32)
            .as_uvec3()
            .min(last);
        let hi = ((high + 1e-3).max(Vec3::ZERO) / SIDE as f32)
            .as_uvec3()
            .min(last);
        let n = f.bricks();
        let groups = n.map(|b| b.div_ceil(GROUP));
        let (mut least, mut greatest) = (f32::INFINITY, f32::NEG_INFINITY);
        let (low, high) = (lo / GROUP, hi / GROUP);
        let side = high - low + 1;
        for i in 0..side.element_product() as usize {
            let g = low + at(side, i);
            let [a, b] = self.groups[(g.x + groups.x * (g.y + groups.y * g.z)) as usize];
            if a >= least && b <= greatest {
                continue;
            }
            let first = g * GROUP;
            let end = (first + (GROUP - 1)).min(last);
            let (from, to) = (first.max(lo), end.min(hi));
            if from == first && to == end {
                (least, greatest) = (least.min(a), greatest.max(b));
                continue;
            }
            for z in from.z..=to.z {
                for y in from.y..=to.y {
                    let row = (n.x * (y + n.y * z)) as usize;
                    for r in &self.ranges[row + from.x as usize..=row + to.x as usize] {
                        least = least.min(r[0]);
                        greatest = greatest.max(r[1]);
                    }
                }
            }
        }
        let furthest = (own.min - within.min)
            .max(within.max - own.max)
            .max(Vec3::ZERO);
        if furthest != Vec3::ZERO {
            let gap = (own.min - within.max)
                .max(within.min - own.max)
                .max(Vec3::ZERO);
            let near = gap.length().hypot(least.max(0.0)) * (1.0 - 1e-5);
            let far = furthest.length().hypot(greatest.max(0.0)) * (1.0 + 1e-5);
            if gap == Vec3::ZERO {
                least = least.min(near);
                greatest = greatest.max(far);
            } else {
                (least, greatest) = (near, far);
            }
        }
        (least, greatest)
    }

    /// φ at grid coordinates within the box.
    #[inline]
    pub(super) fn interpolate(&self, g: Vec3) -> f32 {
        let (i, t) = self.cell(g);
        let v = &self.values;
        let (base, dy, dz) = i;
        let x0 = lerp(v[base], v[base + 1], t.x);
        let x1 = lerp(v[base + dy], v[base + dy + 1], t.x);
        let x2 = lerp(v[base + dz], v[base + dz + 1], t.x);
        let x3 = lerp(v[base + dy + dz], v[base + dy + dz + 1], t.x);
        lerp(lerp(x0, x1, t.y), lerp(x2, x3, t.y), t.z)
    }

    /// The first of the eight values around `g` with the strides to the others along y and z, and
    /// the weights of the last ones.
    #[inline]
    fn cell(&self, g: Vec3) -> ((usize, usize, usize), Vec3) {
        let cell = g.as_uvec3().min(self.frame.cells - UVec3::ONE);
        let brick = cell / SIDE as u32;
        let n = self.frame.bricks();
        let entry = self.table[(brick.x + n.x * (brick.y + n.y * brick.z)) as usize];
        if entry & NEAR != 0 {
            let l = cell - brick * SIDE as u32;
            let i = l.x + NODES as u32 * (l.y + NODES as u32 * l.z);
            let base = (entry & !NEAR) as usize + i as usize;
            ((base, NODES, NODES * NODES), g - cell.as_vec3())
        } else {
            let t = (g - (brick * SIDE as u32).as_vec3()) / SIDE as f32;
            ((entry as usize, 2, 4), t)
        }
    }

    /// A row in any direction: places and weights eight at a time in vector registers, the
    /// gathers one by one between them.
    fn row(&self, g: Vec3, d: Vec3, out: &mut [f32]) {
        const LANES: usize = 8;
        let top = self.frame.cells.as_vec3();
        let v = &self.values[..];
        for (c, chunk) in out.chunks_mut(LANES).enumerate() {
            let mut beyond = [0.0f32; LANES];
            let mut t = [[0.0f32; LANES]; 3];
            let mut corner = [[0.0f32; LANES]; 8];
            for i in 0..chunk.len() {
                let at = g + (c * LANES + i) as f32 * d;
                let inside = at.clamp(Vec3::ZERO, top);
                beyond[i] = (at - inside).length_squared();
                let ((base, dy, dz), w) = self.cell(inside);
                (t[0][i], t[1][i], t[2][i]) = (w.x, w.y, w.z);
                // One check of bounds for the eight reads.
                let near = &v[base..=base + dy + dz + 1];
                corner[0][i] = near[0];
                corner[1][i] = near[1];
                corner[2][i] = near[dy];
                corner[3][i] = near[dy + 1];
                corner[4][i] = near[dz];
                corner[5][i] = near[dz + 1];
                corner[6][i] = near[dy + dz];
                corner[7][i] = near[dy + dz + 1];
            }
            let mut value = [0.0f32; LANES];
            for i in 0..LANES {
                let x0 = lerp(corner[0][i], corner[1][i], t[0][i]);
                let x1 = lerp(corner[2][i], corner[3][i], t[0][i]);
                let x2 = lerp(corner[4][i], corner[5][i], t[0][i]);
                let x3 = lerp(corner[6][i], corner[7][i], t[0][i]);
                value[i] = lerp(lerp(x0, x1, t[1][i]), lerp(x2, x3, t[1][i]), t[2][i]);
            }
            for (o, (v, b)) in chunk.iter_mut().zip(value.into_iter().zip(beyond)) {
                *o = beyond_box(v, b, self.frame.step);
            }
        }
    }

    /// A row along x: each brick it passes is first drawn together to the line at (y, z).
    fn row_along_x(&self, g: Vec3, dx: f32, out: &mut [f32]) {
        let top = self.frame.cells.as_vec3();
        let held = g.clamp(Vec3::ZERO, top);
        let beyond_yz = (g.y - held.y).powi(2) + (g.z - held.z).powi(2);
        let mut i = 0;
        while i < out.len() {
            let x = (g.x + i as f32 * dx).clamp(0.0, top.x);
            let first = (x as u32).min(self.frame.cells.x - 1) / SIDE as u32 * SIDE as u32;
            let ((base, dy, dz), t) = self.cell(Vec3::new(first as f32, held.y, held.z));
            let near = dy == NODES;
            let count = if near { NODES } else { 2 };
            let v = &self.values[base..base + dy + dz + count];
            let mut line = [0.0f32; NODES];
            for (j, l) in line.iter_mut().enumerate().take(count) {
                let low = lerp(v[j], v[j + dy], t.y);
                *l = lerp(low, lerp(v[j + dz], v[j + dy + dz], t.y), t.z);
            }
            let cell = if near { 1.0 } else { SIDE as f32 };
            let end = (first + SIDE as u32) as f32;
            let last = end >= top.x;
            loop {
                let at = g.x + i as f32 * dx;
                let inside = at.clamp(0.0, top.x);
                let u = (inside - first as f32) / cell;
                let k = (u as usize).min(count - 2);
                let value = lerp(line[k], line[k + 1], u - k as f32);
                let beyond = beyond_yz + (at - inside) * (at - inside);
                out[i] = beyond_box(value, beyond, self.frame.step);
                i += 1;
                if i == out.len() || (!last && g.x + i as f32 * dx >= end) {
                    break;
                }
            }
        }
    }
}

#[inline]
pub(super) fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// φ outside the box, from φ at its rim and the squared distance to it in steps.
#[inline]
pub(super) fn beyond_box(rim: f32, beyond: f32, step: f32) -> f32 {
    if beyond == 0.0 {
        return rim;
    }
    let rim = rim.max(0.0);
    (beyond * step * step + rim * rim).sqrt()
}

pub(super) fn summary_of(values: &[f32]) -> [f32; 3] {
    let [least, greatest] = range_of(values);
    [least, greatest, slope_of(values)]
}

fn range_of(values: &[f32]) -> [f32; 2] {
    // Eight side by side, in vector registers.
    let (eights, rest) = values.as_chunks::<8>();
    let (mut least, mut most) = ([f32::INFINITY; 8], [f32::NEG_INFINITY; 8]);
    for eight in eights {
        for (k, &v) in eight.iter().enumerate() {
            least[k] = if v < least[k] { v } else { least[k] };
            most[k] = if v > most[k] { v } else { most[k] };
        }
    }
    let rest = rest
        .iter()
        .fold([f32::INFINITY, f32::NEG_INFINITY], |r, &v| {
            [r[0].min(v), r[1].max(v)]
        });
    [
        least.into_iter().fold(rest[0], f32::min),
        most.into_iter().fold(rest[1], f32::max),
    ]
}

pub(super) fn too_many_values(step: f32, values: usize) -> BakeError {
    let over = values as f64 / MOST_VALUES as f64;
    let fits = f64::from(step) * over.sqrt() * 1.05;
    BakeError::TooLarge {
        step,
        fits: fits as f32,
    }
}

/// The eight corners that stand for a brick's nodes, where all are far from the surface and the
/// corners, scaled so that they claim no more, tell nearly as much.
fn coarsened(nodes: &[f32], step: f32) -> Option<[f32; 8]> {
    let [least, greatest] = range_of(nodes);
    // NaN fails every comparison and keeps its nodes.
    if !(least > BAND * step || greatest < -BAND * step) {
        return None;
    }
    let at = |x: usize, y: usize, z: usize| nodes[x + NODES * (y + NODES * z)];
    let corner = |k: usize| at(k % 2 * SIDE, k / 2 % 2 * SIDE, k / 4 * SIDE);
    let corners: [f32; 8] = std::array::from_fn(corner);
    let mut scale = 1.0f32;
    for z in 0..NODES {
        for y in 0..NODES {
            for x in 0..NODES {
                let t = [x, y, z].map(|i| i as f32 / SIDE as f32);
                let e: [f32; 4] =
                    std::array::from_fn(|k| lerp(corners[2 * k], corners[2 * k + 1], t[0]));
                let v = lerp(lerp(e[0], e[1], t[1]), lerp(e[2], e[3], t[1]), t[2]);
                scale = scale.min(at(x, y, z) / v);
            }
        }
    }
    (scale > 0.75).then(|| corners.map(|c| c * scale))
}
