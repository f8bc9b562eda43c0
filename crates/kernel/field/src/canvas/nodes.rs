//! What is done at every node of a brick, in loops that become vector code.

use std::cell::RefCell;

use glam::{Affine3A, Vec3};
use midair_mesh::Aabb;

use super::area::Area;
use super::kernel::{Edge, Family, T, half_space, power};
use super::paint::{Inked, Segment};
use super::stroke::HARD;
use crate::shape::{NODES, Points};

/// Potential and inverse scale at the nodes of a brick.
pub(super) struct Layers {
    /// Σ F of what was painted, and Σ F/scale.
    pub felt: [f32; NODES],
    pub fine: [f32; NODES],
    /// The potential so far; its p-th power while strokes are painted.
    pub all: [f32; NODES],
    pub one: [f32; NODES],
}

thread_local! {
    /// Layers that were used before.
    static SPARE: RefCell<Vec<Box<Layers>>> = const { RefCell::new(Vec::new()) };
}

impl Layers {
    /// Layers with nothing felt and nothing painted in them; `one` holds anything.
    pub fn spare() -> Box<Self> {
        let used = SPARE.with_borrow_mut(Vec::pop);
        let Some(mut layers) = used else {
            return Box::new(Self {
                felt: [0.0; NODES],
                fine: [0.0; NODES],
                all: [0.0; NODES],
                one: [0.0; NODES],
            });
        };
        layers.felt.fill(0.0);
        layers.fine.fill(0.0);
        layers.all.fill(0.0);
        layers
    }

    /// Keeps them for the next brick of this thread.
    pub fn give_back(self: Box<Self>) {
        SPARE.with_borrow_mut(|all| all.push(self));
    }
}

/// The squared distance from a line's axis and where its start lies along it, in supports.
#[inline(always)]
pub(super) fn axis(from: Vec3, along: Vec3, inverse: f32, x: f32, y: f32, z: f32) -> (f32, f32) {
    let (qx, qy, qz) = (
        (from.x - x) * inverse,
        (from.y - y) * inverse,
        (from.z - z) * inverse,
    );
    let s = qx * along.x + qy * along.y + qz * along.z;
    let (ex, ey, ez) = (qx - s * along.x, qy - s * along.y, qz - s * along.z);
    (ex * ex + ey * ey + ez * ez, s)
}

pub(super) fn moved(points: &Points, m: &Affine3A) -> Points {
    let mut out = Points {
        x: [0.0; NODES],
        y: [0.0; NODES],
        z: [0.0; NODES],
        centre: m.transform_point3(points.centre),
        radius: 0.0,
    };
    let c = m.matrix3;
    let most = [c.x_axis, c.y_axis, c.z_axis]
        .iter()
        .map(|c| c.length_squared())
        .sum::<f32>();
    out.radius = points.radius * most.sqrt();
    for i in 0..NODES {
        let p = m.transform_point3(Vec3::new(points.x[i], points.y[i], points.z[i]));
        (out.x[i], out.y[i], out.z[i]) = (p.x, p.y, p.z);
    }
    out
}

/// (aᵖ + bᵖ)^(1/p).
pub(super) fn blended(a: f32, b: f32, p: f32) -> f32 {
    if p >= HARD {
        a.max(b)
    } else if p == 1.0 {
        a + b
    } else {
        power(power(a, p) + power(b, p), 1.0 / p)
    }
}

/// What is left of the potential `f` where `e` is taken away: (held below 2T) − e, not below 0.
/// What lies above 2T goes first, so that nothing changes where e is 0.
#[inline(always)]
pub(super) fn erased(f: f32, e: f32) -> f32 {
    let over = f - held(f);
    let ramp = (4.0 * e).clamp(0.0, 1.0);
    let left = f - e - over * (ramp * ramp * (3.0 - 2.0 * ramp));
    if left > 0.0 { left } else { 0.0 }
}

/// f below T, 2T from 2T on, smooth between and at both ends.
#[inline(always)]
fn held(f: f32) -> f32 {
    let x = ((f - T) / T).clamp(0.0, 1.0);
    let low = if f < T { f } else { T };
    low + T * x * (1.0 + x - x * x)
}

pub(super) fn erase_from(all: &mut [f32; NODES], one: &[f32; NODES]) {
    for (a, e) in all.iter_mut().zip(one) {
        *a = erased(*a, *e);
    }
}

pub(super) fn join_inner(layers: &mut Layers, fine: &[f32; NODES], stroke: &Inked) {
    let scale = 1.0 / stroke.scale;
    for (i, fine) in fine.iter().enumerate() {
        layers.felt[i] += layers.one[i];
        layers.fine[i] += layers.one[i] * fine * scale;
    }
}

wide!(pub(super) nearest, nearest_avx2, nearest_any, (s: &Segment, p: &Points, out: &mut [f32; NODES]));
wide!(pub(super) profile, profile_avx2, profile_any, (family: &Family, weight: f32, out: &mut [f32; NODES]));
wide!(pub(super) join, join_avx2, join_any, (layers: &mut Layers, fine: f32));
wide!(pub(super) level, level_avx2, level_any, (layers: &Layers, out: &mut [f32; NODES]));
wide!(pub(super) away, away_avx2, away_any, (bounds: &Aabb, rim: f32, p: &Points, least: &mut [f32; NODES]));
wide!(pub(super) beside, beside_avx2, beside_any, (weight: f32, inverse: f32, phi: &[f32; NODES], out: &mut [f32; NODES]));
wide!(pub(super) raise, raise_avx2, raise_any, (out: &mut [f32; NODES], p: f32));
wide!(pub(super) polygon, polygon_avx2, polygon_any, (family: &Family, area: &Area, weight: f32, p: &Points, out: &mut [f32; NODES]));
wide!(pub(super) edge, edge_avx2, edge_any, (family: &Family, area: &Area, only: &Edge, right: f32, weight: f32, p: &Points, out: &mut [f32; NODES]));
wide!(pub(super) line, line_avx2, line_any, (family: &Family, from: Vec3, along: Vec3, length: f32, inverse: f32, weight: f32, p: &Points, out: &mut [f32; NODES]));

#[inline(always)]
fn nearest_any(s: &Segment, p: &Points, out: &mut [f32; NODES]) {
    for (i, o) in out.iter_mut().enumerate() {
        let u = s.at(p.x[i], p.y[i], p.z[i]);
        *o = if u < *o { u } else { *o };
    }
}

#[inline(always)]
fn profile_any(family: &Family, weight: f32, out: &mut [f32; NODES]) {
    for o in out {
        *o = weight * family.at_point(*o);
    }
}

/// Adds what one stroke makes felt, `fine` for each metre of it.
#[inline(always)]
fn join_any(layers: &mut Layers, fine: f32) {
    for i in 0..NODES {
        layers.felt[i] += layers.one[i];
        layers.fine[i] += layers.one[i] * fine;
    }
}

/// φ = (T − F) at the scale of what is felt; 0 where nothing is.
#[inline(always)]
fn level_any(layers: &Layers, out: &mut [f32; NODES]) {
    for (i, o) in out.iter_mut().enumerate() {
        let (felt, fine) = (layers.felt[i], layers.fine[i]);
        let scale = if fine > 0.0 { felt / fine } else { 0.0 };
        *o = (T - layers.all[i]) * scale;
    }
}

/// How far each node lies from a box, `rim` at least, where that is less.
#[inline(always)]
fn away_any(bounds: &Aabb, rim: f32, p: &Points, least: &mut [f32; NODES]) {
    let (low, high) = (bounds.min, bounds.max);
    for (i, l) in least.iter_mut().enumerate() {
        let x = (low.x - p.x[i]).max(p.x[i] - high.x).max(0.0);
        let y = (low.y - p.y[i]).max(p.y[i] - high.y).max(0.0);
        let z = (low.z - p.z[i]).max(p.z[i] - high.z).max(0.0);
        *l = l.min((x * x + y * y + z * z).sqrt().max(rim));
    }
}

/// The potential beside a solid whose φ is known.
#[inline(always)]
fn beside_any(weight: f32, inverse: f32, phi: &[f32; NODES], out: &mut [f32; NODES]) {
    for (o, v) in out.iter_mut().zip(phi) {
        *o = weight * half_space(*v * inverse);
    }
}

#[inline(always)]
fn raise_any(out: &mut [f32; NODES], p: f32) {
    for o in out {
        *o = power(*o, p);
    }
}

#[inline(always)]
fn line_any(
    family: &Family,
    from: Vec3,
    along: Vec3,
    length: f32,
    inverse: f32,
    weight: f32,
    p: &Points,
    out: &mut [f32; NODES],
) {
    for (i, o) in out.iter_mut().enumerate() {
        let (d2, s0) = axis(from, along, inverse, p.x[i], p.y[i], p.z[i]);
        *o = weight * family.at_line(d2, s0, s0 + length * inverse);
    }
}

/// A polygon of which one edge alone is felt.
#[inline(always)]
fn edge_any(
    family: &Family,
    area: &Area,
    only: &Edge,
    right: f32,
    weight: f32,
    p: &Points,
    out: &mut [f32; NODES],
) {
    let [x, y, z] = area.axes.map(|a| a * area.inverse);
    let o = area.axes.map(|a| a.dot(area.origin) * area.inverse);
    for (i, out) in out.iter_mut().enumerate() {
        let (px, py, pz) = (p.x[i], p.y[i], p.z[i]);
        let u = px * x.x + py * x.y + pz * x.z - o[0];
        let v = px * y.x + py * y.y + pz * y.z - o[1];
        let h = px * z.x + py * z.y + pz * z.z - o[2];
        *out = weight * family.beside_edge(only, u, v, h * h, right);
    }
}

#[inline(always)]
fn polygon_any(family: &Family, area: &Area, weight: f32, p: &Points, out: &mut [f32; NODES]) {
    let [x, y, z] = area.axes.map(|a| a * area.inverse);
    let o = area.axes.map(|a| a.dot(area.origin) * area.inverse);
    // A layer of nodes at a time, so that what is summed up stays at hand.
    for from in (0..NODES).step_by(64) {
        let (mut u, mut v, mut h2) = ([0.0f32; 64], [0.0f32; 64], [0.0f32; 64]);
        for k in 0..64 {
            let (px, py, pz) = (p.x[from + k], p.y[from + k], p.z[from + k]);
            u[k] = px * x.x + py * x.y + pz * x.z - o[0];
            v[k] = px * y.x + py * y.y + pz * y.z - o[1];
            let h = px * z.x + py * z.y + pz * z.z - o[2];
            h2[k] = h * h;
        }
        let (mut sum, mut angle) = ([0.0f32; 64], [0.0f32; 64]);
        for edge in &area.edges {
            for k in 0..64 {
                let (s, t) = edge.at(u[k], v[k], h2[k]);
                sum[k] += s;
                angle[k] += t;
            }
        }
        for k in 0..64 {
            out[from + k] = weight * family.polygon_of(sum[k], angle[k], h2[k]);
        }
    }
}
