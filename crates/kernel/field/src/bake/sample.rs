//! Volumes as operands: whole bricks of samples, and how steep φ is.

use glam::{Vec3, Vec4, Vec4Swizzles as _};
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
    /// The first of the eight values around, as an offset into those of its brick, then into all.
    offset: [i32; LAYER],
    /// From there to the next along y and z.
    stride: [[u32; LAYER]; 2],
    /// The cell within its brick.
    local: [[f32; LAYER]; 3],
    weight: [[f32; LAYER]; 3],
    beyond: [f32; LAYER],
}

impl Cells {
    /// The values from the first to the last around sample `i`, and the strides along y and z.
    #[inline(always)]
    fn around<'v, const PLAIN: bool>(
        &self,
        values: &'v [f32],
        i: usize,
    ) -> (&'v [f32], usize, usize) {
        let (dy, dz) = if PLAIN {
            (NODES, NODES * NODES)
        } else {
            (self.stride[0][i] as usize, self.stride[1][i] as usize)
        };
        let first = self.offset[i] as u32 as usize;
        // One check of bounds for the eight reads.
        (&values[first..first + dy + dz + 2], dy, dz)
    }
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
        let (first, axes) = self.in_cells(first, axes);
        let (plain, inside) = self.kind(first, axes);
        if plain {
            self.layers::<true, true>(first, axes, out, |v, c, o| blend_avx2::<true>(v, c, o));
        } else if inside {
            self.layers::<false, true>(first, axes, out, |v, c, o| blend_avx2::<false>(v, c, o));
        } else {
            self.layers::<false, false>(first, axes, out, |v, c, o| blend_avx2::<false>(v, c, o));
        }
    }

    fn sample_brick_any(&self, first: Vec3, axes: [Vec3; 3], out: &mut [f32; 512]) {
        let (first, axes) = self.in_cells(first, axes);
        let (plain, inside) = self.kind(first, axes);
        if plain {
            self.layers::<true, true>(first, axes, out, blend_any::<true>);
        } else if inside {
            self.layers::<false, true>(first, axes, out, blend_any::<false>);
        } else {
            self.layers::<false, false>(first, axes, out, blend_any::<false>);
        }
    }

    fn in_cells(&self, first: Vec3, axes: [Vec3; 3]) -> (Vec3, [Vec3; 3]) {
        let inverse = 1.0 / self.frame.step;
        let first = (first - self.frame.origin) * inverse;
        (first, axes.map(|a| a * inverse))
    }

    /// Whether all samples, in grid coordinates, lie within near bricks, and whether all lie within
    /// the grid.
    fn kind(&self, first: Vec3, axes: [Vec3; 3]) -> (bool, bool) {
        let spans = axes.map(|a| 7.0 * a);
        let sum = |f: fn(Vec3) -> Vec3| spans.iter().map(|s| f(*s)).sum::<Vec3>();
        let low = first + sum(|s| s.min(Vec3::ZERO)) - 1e-3;
        let high = first + sum(|s| s.max(Vec3::ZERO)) + 1e-3;
        if low.min_element() < 0.0 || high.cmpge(self.frame.cells.as_vec3()).any() {
            return (false, false);
        }
        let n = self.frame.bricks();
        let (lo, hi) = (low.as_uvec3() / SIDE as u32, high.as_uvec3() / SIDE as u32);
        let plain = (lo.z..=hi.z).all(|z| {
            (lo.y..=hi.y).all(|y| {
                let row = (n.x * (y + n.y * z)) as usize;
                let entries = &self.table[row + lo.x as usize..=row + hi.x as usize];
                entries.iter().all(|e| e & NEAR != 0)
            })
        });
        (plain, true)
    }

    #[inline(always)]
    fn layers<const PLAIN: bool, const INSIDE: bool>(
        &self,
        first: Vec3,
        axes: [Vec3; 3],
        out: &mut [f32; 512],
        blend: impl Fn(&[f32], &Cells, &mut [f32]),
    ) {
        let mut cells = Cells {
            brick: [0; LAYER],
            offset: [0; LAYER],
            stride: [[NODES as u32; LAYER], [(NODES * NODES) as u32; LAYER]],
            local: [[0.0; LAYER]; 3],
            weight: [[0.0; LAYER]; 3],
            beyond: [0.0; LAYER],
        };
        for (z, out) in out.chunks_exact_mut(LAYER).enumerate() {
            self.place::<PLAIN, INSIDE>(first + axes[2] * z as f32, axes[0], axes[1], &mut cells);
            self.find::<PLAIN>(&mut cells);
            blend(&self.values, &cells, out);
            if !INSIDE {
                for (o, b) in out.iter_mut().zip(&cells.beyond) {
                    *o = beyond_box(*o, *b, self.frame.step);
                }
            }
        }
    }

    /// Finds the cells of a layer; without branches or reads, so that it is compiled to vector code.
    #[inline(always)]
    fn place<const PLAIN: bool, const INSIDE: bool>(
        &self,
        first: Vec3,
        x_axis: Vec3,
        y_axis: Vec3,
        cells: &mut Cells,
    ) {
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
            if !INSIDE {
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

    /// Turns offsets within bricks into offsets into all values, with strides and weights.
    #[inline(always)]
    fn find<const PLAIN: bool>(&self, cells: &mut Cells) {
        for i in 0..LAYER {
            let entry = self.table[cells.brick[i] as usize];
            if PLAIN || entry & NEAR != 0 {
                cells.offset[i] += (entry & !NEAR) as i32;
                if !PLAIN {
                    cells.stride[0][i] = NODES as u32;
                    cells.stride[1][i] = (NODES * NODES) as u32;
                }
            } else {
                cells.offset[i] = entry as i32;
                (cells.stride[0][i], cells.stride[1][i]) = (2, 4);
                for k in 0..3 {
                    let t = &mut cells.weight[k][i];
                    *t = (cells.local[k][i] + *t) / SIDE as f32;
                }
            }
        }
    }

    /// As [`Volume::range`], tighter: for places no further than `radius` from the middle of the
    /// box. Where a brick keeps every node, φ is also bounded by its value at the place nearest to
    /// that middle and the brick's steepest slope; where it keeps corners, by the corners of the
    /// box, between which the interpolation has no extremes.
    ///
    /// A smaller ball and box within this one have bounds within these, up to rounding.
    pub(crate) fn bound(&self, within: &Aabb, radius: f32) -> (f32, f32) {
        let f = &self.frame;
        let top = f.cells.as_vec3();
        let inverse = 1.0 / f.step;
        let low = (within.min - f.origin) * inverse - 1e-3;
        let high = (within.max - f.origin) * inverse + 1e-3;
        // φ beyond the grid depends on the place of the grid that is nearest.
        let (p, q) = (low.clamp(Vec3::ZERO, top), high.clamp(Vec3::ZERO, top));
        let n = f.bricks();
        let side = 1.0 / SIDE as f32;
        let lo = (p * side).as_uvec3().min(n - 1);
        let hi = (q * side).as_uvec3().min(n - 1);
        // On boxes that hold whole bricks the summaries alone are as good.
        if (hi - lo).max_element() > 2 {
            return self.range(within);
        }
        let centre = (0.5 * (low + high)).clamp(Vec3::ZERO, top);
        let radius = radius * inverse + 2e-3;
        let (mut least, mut greatest) = (f32::INFINITY, f32::NEG_INFINITY);
        for z in lo.z..=hi.z {
            for y in lo.y..=hi.y {
                for x in lo.x..=hi.x {
                    let index = (x + n.x * (y + n.y * z)) as usize;
                    let first = glam::UVec3::new(x, y, z).as_vec3() * SIDE as f32;
                    let at = centre.clamp(first, (first + SIDE as f32).min(top));
                    // What the ball reaches in a convex brick lies across from its middle.
                    let reach = radius * radius - centre.distance_squared(at);
                    if reach < 0.0 {
                        continue;
                    }
                    let [mut a, mut b, slope] = self.ranges[index];
                    if a >= least && b <= greatest {
                        continue;
                    }
                    let entry = self.table[index];
                    if entry & NEAR != 0 {
                        if slope < f32::INFINITY {
                            let v = self.near_value(entry, at - first);
                            let most = slope * reach.sqrt();
                            (a, b) = (a.max(v - most), b.min(v + most));
                        }
                    } else {
                        (a, b) = self.far_bound(entry, (p - first) * side, (q - first) * side);
                    }
                    least = least.min(a);
                    greatest = greatest.max(b);
                }
            }
        }
        let above = (-low).max(high - top).max(Vec3::ZERO);
        if above != Vec3::ZERO {
            let below = (-high).max(low - top).max(Vec3::ZERO);
            let gap = below.length() * f.step * (1.0 - 1e-5);
            let far = above.length() * f.step * (1.0 + 1e-5);
            if gap > 0.0 {
                least = least.max(0.0);
                least = (gap * gap + least * least).sqrt();
            }
            greatest = greatest.max(0.0);
            greatest = (far * far + greatest * greatest).sqrt();
        }
        (least, greatest)
    }

    /// φ in a brick that keeps every node, `g` cells from its first node.
    fn near_value(&self, entry: u32, g: Vec3) -> f32 {
        let cell = g.as_uvec3().min(glam::UVec3::splat(SIDE as u32 - 1));
        let t = g - cell.as_vec3();
        let offset = cell.x as usize + NODES * (cell.y as usize + NODES * cell.z as usize);
        let base = (entry & !NEAR) as usize + offset;
        let v = &self.values[base..base + SPAN + 1];
        let row = |i: usize| lerp(v[i], v[i + 1], t.x);
        let layer = |i: usize| lerp(row(i), row(i + NODES), t.y);
        lerp(layer(0), layer(NODES * NODES), t.z)
    }

    /// The extremes of φ on the box from `p` to `q`, in sides of a brick that keeps its corners.
    fn far_bound(&self, entry: u32, p: Vec3, q: Vec3) -> (f32, f32) {
        let v = &self.values[entry as usize..entry as usize + 8];
        let v = [Vec4::from_slice(v), Vec4::from_slice(&v[4..])];
        let (p, q) = (
            p.clamp(Vec3::ZERO, Vec3::ONE),
            q.clamp(Vec3::ZERO, Vec3::ONE),
        );
        // Drawn together to the ends of the box along z, then y, then x.
        let ends = [p.z, q.z].map(|t| v[0] + (v[1] - v[0]) * t);
        let (mut least, mut greatest) = (f32::INFINITY, f32::NEG_INFINITY);
        for e in ends {
            for t in [p.y, q.y] {
                let row = e.xy() + (e.zw() - e.xy()) * t;
                for t in [p.x, q.x] {
                    let v = lerp(row.x, row.y, t);
                    least = least.min(v);
                    greatest = greatest.max(v);
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

/// The trilinear interpolation between the values around each sample of a layer.
fn blend_any<const PLAIN: bool>(values: &[f32], cells: &Cells, out: &mut [f32]) {
    let [tx, ty, tz] = &cells.weight;
    for (i, o) in out.iter_mut().enumerate().take(LAYER) {
        let (v, dy, dz) = cells.around::<PLAIN>(values, i);
        let row = |k: usize| lerp(v[k], v[k + 1], tx[i]);
        let low = lerp(row(0), row(dy), ty[i]);
        let high = lerp(row(dz), row(dz + dy), ty[i]);
        *o = lerp(low, high, tz[i]);
    }
}

/// As [`blend_any`], to the bit: reads the values in pairs, and blends those of four samples at once.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
#[inline]
fn blend_avx2<const PLAIN: bool>(values: &[f32], cells: &Cells, out: &mut [f32]) {
    use std::arch::x86_64::*;
    let pairs = |i: usize| {
        let (v, dy, dz) = cells.around::<PLAIN>(values, i);
        let v = v.as_ptr();
        // SAFETY: `v` has dy + dz + 2 values, so that two can be read at each of the four places;
        // these reads ask for no alignment.
        unsafe {
            let pair = |k: usize| v.add(k).cast::<f64>();
            let low = _mm_loadh_pd(_mm_load_sd(pair(0)), pair(dy));
            let high = _mm_loadh_pd(_mm_load_sd(pair(dz)), pair(dz + dy));
            _mm256_castpd_ps(_mm256_set_m128d(high, low))
        }
    };
    let blend =
        |a: __m256, b: __m256, t: __m256| _mm256_add_ps(a, _mm256_mul_ps(_mm256_sub_ps(b, a), t));
    for (n, out) in out.chunks_exact_mut(4).enumerate() {
        let i = 4 * n;
        // Each holds x0y0, x1y0, x0y1, x1y1 of a sample, at z0 and at z1.
        let (a, b, c, d) = (pairs(i), pairs(i + 1), pairs(i + 2), pairs(i + 3));
        let y0 = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
        let y1 = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
        let ends = |(p, q): (__m256, __m256)| {
            let (p, q) = (_mm256_castps_pd(p), _mm256_castps_pd(q));
            let x0 = _mm256_castpd_ps(_mm256_unpacklo_pd(p, q));
            (x0, _mm256_castpd_ps(_mm256_unpackhi_pd(p, q)))
        };
        let weight = |k: usize| {
            let w = &cells.weight[k][i..i + 4];
            // SAFETY: four values, no alignment asked for.
            unsafe { _mm_loadu_ps(w.as_ptr()) }
        };
        let (tx, ty, tz) = (weight(0), weight(1), weight(2));
        let (tx, ty) = (_mm256_set_m128(tx, tx), _mm256_set_m128(ty, ty));
        let ((x0, x1), (x2, x3)) = (ends(y0), ends(y1));
        let both = blend(blend(x0, x1, tx), blend(x2, x3, tx), ty);
        let (low, high) = (
            _mm256_castps256_ps128(both),
            _mm256_extractf128_ps::<1>(both),
        );
        let value = _mm_add_ps(low, _mm_mul_ps(_mm_sub_ps(high, low), tz));
        // SAFETY: a chunk of four values, no alignment asked for.
        unsafe { _mm_storeu_ps(out.as_mut_ptr(), value) };
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

#[cfg(test)]
mod tests {
    use glam::{Mat3, Quat};

    use super::*;

    #[test]
    fn wide_registers_change_nothing() {
        let ring = |p: Vec3| (p.x.hypot(p.y) - 0.28).hypot(p.z) - 0.12;
        let around = Aabb::around(Vec3::ZERO, Vec3::splat(0.5));
        let volume = Volume::from_fn(around, 1.0 / 63.0, ring).expect("fits");
        let turn = Mat3::from_quat(Quat::from_scaled_axis(Vec3::new(0.3, -0.7, 1.1))) * 0.008;
        let axes = [turn.x_axis, turn.y_axis, turn.z_axis];
        for i in 0..600 {
            let n = glam::IVec3::new(i % 10, i / 10 % 10, i / 100);
            let first = n.as_vec3() * 0.12 - Vec3::new(0.6, 0.6, 0.36);
            let (mut wide, mut narrow) = ([0.0; 512], [0.0; 512]);
            volume.sample_brick(first, axes, &mut wide);
            volume.sample_brick_any(first, axes, &mut narrow);
            assert_eq!(wide, narrow);
        }
    }
}
