//! Volumes as operands: whole bricks of samples, and how steep φ is.

use glam::Vec3;
use midair_mesh::Aabb;

use super::Volume;
use super::frame::{NODES, SIDE};
use super::volume::{NEAR, beyond_box, lerp};

/// Samples worked on at once: one layer of a brick.
const LAYER: usize = 64;
/// From the first of a cell's eight values in a near brick to the last.
const SPAN: usize = 1 + NODES + NODES * NODES;

/// Where the samples of a layer lie.
struct Cells {
    brick: [i32; LAYER],
    /// The cell within its brick, as an offset into its values and along each axis.
    offset: [i32; LAYER],
    local: [[f32; LAYER]; 3],
    weight: [[f32; LAYER]; 3],
    beyond: [f32; LAYER],
}

impl Volume {
    /// φ at the 8³ places `first + x·axes[0] + y·axes[1] + z·axes[2]`, x fastest; as
    /// [`Volume::sample`] up to rounding.
    pub(crate) fn sample_brick(&self, first: Vec3, axes: [Vec3; 3], out: &mut [f32; 512]) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has AVX2, as just asked.
            return unsafe { self.sample_brick_avx2(first, axes, out) };
        }
        self.sample_brick_any(first, axes, out);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn sample_brick_avx2(&self, first: Vec3, axes: [Vec3; 3], out: &mut [f32; 512]) {
        self.sample_brick_any(first, axes, out);
    }

    #[inline(always)]
    fn sample_brick_any(&self, first: Vec3, axes: [Vec3; 3], out: &mut [f32; 512]) {
        let inverse = 1.0 / self.frame.step;
        let first = (first - self.frame.origin) * inverse;
        let axes = axes.map(|a| a * inverse);
        if self.is_plain(first, axes) {
            self.layers::<true>(first, axes, out);
        } else {
            self.layers::<false>(first, axes, out);
        }
    }

    /// Whether all samples, in grid coordinates, lie within near bricks.
    fn is_plain(&self, first: Vec3, axes: [Vec3; 3]) -> bool {
        let spans = axes.map(|a| 7.0 * a);
        let sum = |f: fn(Vec3) -> Vec3| spans.iter().map(|s| f(*s)).sum::<Vec3>();
        let low = first + sum(|s| s.min(Vec3::ZERO)) - 1e-3;
        let high = first + sum(|s| s.max(Vec3::ZERO)) + 1e-3;
        if low.min_element() < 0.0 || high.cmpge(self.frame.cells.as_vec3()).any() {
            return false;
        }
        let n = self.frame.bricks();
        let (lo, hi) = (low.as_uvec3() / SIDE as u32, high.as_uvec3() / SIDE as u32);
        (lo.z..=hi.z).all(|z| {
            (lo.y..=hi.y).all(|y| {
                let row = (n.x * (y + n.y * z)) as usize;
                let entries = &self.table[row + lo.x as usize..=row + hi.x as usize];
                entries.iter().all(|e| e & NEAR != 0)
            })
        })
    }

    #[inline(always)]
    fn layers<const PLAIN: bool>(&self, first: Vec3, axes: [Vec3; 3], out: &mut [f32; 512]) {
        let mut cells = Cells {
            brick: [0; LAYER],
            offset: [0; LAYER],
            local: [[0.0; LAYER]; 3],
            weight: [[0.0; LAYER]; 3],
            beyond: [0.0; LAYER],
        };
        let mut corners = [[0.0f32; LAYER]; 8];
        for (z, out) in out.chunks_exact_mut(LAYER).enumerate() {
            self.place::<PLAIN>(first + axes[2] * z as f32, axes[0], axes[1], &mut cells);
            self.fetch::<PLAIN>(&mut cells, &mut corners);
            let [tx, ty, tz] = &cells.weight;
            for i in 0..LAYER {
                let c = |k: usize| corners[k][i];
                let low = lerp(lerp(c(0), c(1), tx[i]), lerp(c(2), c(3), tx[i]), ty[i]);
                let high = lerp(lerp(c(4), c(5), tx[i]), lerp(c(6), c(7), tx[i]), ty[i]);
                out[i] = lerp(low, high, tz[i]);
            }
            if !PLAIN {
                for (o, b) in out.iter_mut().zip(&cells.beyond) {
                    *o = beyond_box(*o, *b, self.frame.step);
                }
            }
        }
    }

    /// Finds the cells of a layer; without branches or reads, so that it is compiled to vector code.
    #[inline(always)]
    fn place<const PLAIN: bool>(&self, first: Vec3, x_axis: Vec3, y_axis: Vec3, cells: &mut Cells) {
        let top = self.frame.cells.as_vec3();
        let last = self.frame.cells.as_ivec3() - 1;
        let n = self.frame.bricks().as_ivec3();
        let hold = |g: f32, top: f32| {
            let g = if g > 0.0 { g } else { 0.0 };
            if g < top { g } else { top }
        };
        for i in 0..LAYER {
            let (x, y) = ((i & 7) as f32, (i >> 3) as f32);
            let gx = first.x + y * y_axis.x + x * x_axis.x;
            let gy = first.y + y * y_axis.y + x * x_axis.y;
            let gz = first.z + y * y_axis.z + x * x_axis.z;
            let (hx, hy, hz) = (hold(gx, top.x), hold(gy, top.y), hold(gz, top.z));
            if !PLAIN {
                let (bx, by, bz) = (gx - hx, gy - hy, gz - hz);
                cells.beyond[i] = bx * bx + by * by + bz * bz;
            }
            let cx = whole(hx).min(last.x);
            let cy = whole(hy).min(last.y);
            let cz = whole(hz).min(last.z);
            cells.brick[i] = (cx >> 3) + n.x * ((cy >> 3) + n.y * (cz >> 3));
            let (lx, ly, lz) = (cx & 7, cy & 7, cz & 7);
            cells.offset[i] = lx + NODES as i32 * (ly + NODES as i32 * lz);
            cells.weight[0][i] = hx - cx as f32;
            cells.weight[1][i] = hy - cy as f32;
            cells.weight[2][i] = hz - cz as f32;
            if !PLAIN {
                cells.local[0][i] = lx as f32;
                cells.local[1][i] = ly as f32;
                cells.local[2][i] = lz as f32;
            }
        }
    }

    #[inline(always)]
    fn fetch<const PLAIN: bool>(&self, cells: &mut Cells, corners: &mut [[f32; LAYER]; 8]) {
        for i in 0..LAYER {
            let entry = self.table[cells.brick[i] as usize];
            if PLAIN || entry & NEAR != 0 {
                let base = (entry & !NEAR) as usize + cells.offset[i] as usize;
                // One check of bounds for the eight reads.
                let v = &self.values[base..base + SPAN + 1];
                corners[0][i] = v[0];
                corners[1][i] = v[1];
                corners[2][i] = v[NODES];
                corners[3][i] = v[NODES + 1];
                corners[4][i] = v[NODES * NODES];
                corners[5][i] = v[NODES * NODES + 1];
                corners[6][i] = v[NODES * NODES + NODES];
                corners[7][i] = v[SPAN];
            } else {
                let v = &self.values[entry as usize..entry as usize + 8];
                for (k, c) in corners.iter_mut().enumerate() {
                    c[i] = v[k];
                }
                for k in 0..3 {
                    let t = &mut cells.weight[k][i];
                    *t = (cells.local[k][i] + *t) / SIDE as f32;
                }
            }
        }
    }

    /// As [`Volume::range`], tighter: where the surface passes through a brick, φ on the part of it
    /// within the box is also bounded by its value in the middle and the brick's steepest slope.
    /// `radius` is how far the places asked about lie from the middle of the box at most.
    pub(crate) fn bound(&self, within: &Aabb, radius: f32) -> (f32, f32) {
        let f = &self.frame;
        let low = (within.min - f.origin) / f.step - 1e-3;
        let high = (within.max - f.origin) / f.step + 1e-3;
        let n = f.bricks();
        let lo = (low.max(Vec3::ZERO) / SIDE as f32).as_uvec3();
        let hi = (high.max(Vec3::ZERO) / SIDE as f32).as_uvec3().min(n - 1);
        let outside = low.min_element() < 0.0 || high.cmpgt(f.cells.as_vec3()).any();
        // On boxes that hold whole bricks the summaries alone are as good.
        if outside || (hi - lo).max_element() > 2 {
            return self.range(within);
        }
        let alone = lo == hi;
        let (mut least, mut greatest) = (f32::INFINITY, f32::NEG_INFINITY);
        for z in lo.z..=hi.z {
            for y in lo.y..=hi.y {
                for x in lo.x..=hi.x {
                    let [mut a, mut b, slope] = self.ranges[(x + n.x * (y + n.y * z)) as usize];
                    if a <= 0.0 && b >= 0.0 && slope < f32::INFINITY {
                        let first = glam::UVec3::new(x, y, z).as_vec3() * SIDE as f32;
                        let (p, q) = (low.max(first), high.min(first + SIDE as f32));
                        let middle = 0.5 * (p + q);
                        // In this brick, not in the next one, from its shared last layer.
                        let at = middle.min(first + (SIDE as f32 - 1e-3));
                        let all = radius / f.step + 2e-3;
                        let reach = 0.5 * (q - p).length() + 2e-3;
                        let reach = slope * if alone { reach.min(all) } else { reach };
                        let v = self.interpolate(at);
                        (a, b) = (a.max(v - reach), b.min(v + reach));
                    }
                    least = least.min(a);
                    greatest = greatest.max(b);
                }
            }
        }
        (least, greatest)
    }

    /// The greatest |∇φ| within a box, where every node around it is kept; `None` elsewhere.
    pub(crate) fn steepest(&self, within: &Aabb) -> Option<f32> {
        let f = &self.frame;
        let low = (within.min - f.origin) / f.step - 1e-3;
        let high = (within.max - f.origin) / f.step + 1e-3;
        if low.min_element() < 0.0 || high.cmpgt(f.cells.as_vec3()).any() {
            return None;
        }
        let n = f.bricks();
        let lo = (low / SIDE as f32).as_uvec3();
        let hi = (high / SIDE as f32).as_uvec3().min(n - 1);
        let mut most = 0.0f32;
        for z in lo.z..=hi.z {
            for y in lo.y..=hi.y {
                let row = (n.x * (y + n.y * z)) as usize;
                for r in &self.ranges[row + lo.x as usize..=row + hi.x as usize] {
                    if r[2] == f32::INFINITY {
                        return None;
                    }
                    most = most.max(r[2]);
                }
            }
        }
        Some(most / f.step)
    }
}

/// The whole part of a coordinate within the grid.
#[inline(always)]
fn whole(g: f32) -> i32 {
    // SAFETY: held between 0 and the number of cells, less than 2²⁴, and NaN was made 0. The
    // checked conversion is not compiled to vector code, and takes half of the sampling time.
    unsafe { g.to_int_unchecked() }
}

/// The most that φ can change per cell in a brick: in each cell its largest differences along the
/// three axes bound the slopes of the trilinear interpolation. Infinite for corners only, since φ
/// may jump where these meet other bricks.
pub(super) fn slope_of(values: &[f32]) -> f32 {
    if values.len() != NODES * NODES * NODES {
        return f32::INFINITY;
    }
    // The largest of the four differences along one axis around each cell of a row.
    let around = |from: usize, along: usize, others: [usize; 2]| {
        let mut most = [0.0f32; SIDE];
        for first in [0, others[0], others[1], others[0] + others[1]] {
            let a = &values[from + first..][..SIDE];
            let b = &values[from + first + along..][..SIDE];
            for k in 0..SIDE {
                let d = (b[k] - a[k]).abs();
                most[k] = if d > most[k] { d } else { most[k] };
            }
        }
        most
    };
    let (y, z) = (NODES, NODES * NODES);
    let mut most = [0.0f32; SIDE];
    for row in 0..SIDE * SIDE {
        let from = row % SIDE * y + row / SIDE * z;
        let (dx, dy, dz) = (
            around(from, 1, [y, z]),
            around(from, y, [1, z]),
            around(from, z, [1, y]),
        );
        for k in 0..SIDE {
            let square = dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k];
            most[k] = if square > most[k] { square } else { most[k] };
        }
    }
    let square = most.into_iter().fold(0.0, f32::max);
    square.sqrt() * 1.000_01
}
