//! Exact tests between triangles. Their corners are f32, so every sign below is that of the real
//! number, not of its rounding (Shewchuk's adaptive predicates).

use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

pub(super) type Triangle = [DVec3; 3];

/// On which side of the plane of `t` the point `p` lies, as a sign; 0 is on it.
pub(super) fn side(t: &Triangle, p: DVec3) -> f64 {
    // Flat faces along an axis are common, and the exact stage is slow just there.
    for axis in 0..3 {
        let at = p[axis];
        if t[0][axis] == at && t[1][axis] == at && t[2][axis] == at {
            return 0.0;
        }
    }
    let coord = |p: DVec3| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    orient3d(coord(t[0]), coord(t[1]), coord(t[2]), coord(p))
}

/// The turn of `a`, `b`, `c` seen along `axis`.
fn turn(axis: usize, a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let coord = |p: DVec3| Coord {
        x: p[(axis + 1) % 3],
        y: p[(axis + 2) % 3],
    };
    orient2d(coord(a), coord(b), coord(c))
}

/// An axis along which `t` does not look like a line; `None` where `t` is one.
pub(super) fn open_axis(t: &Triangle) -> Option<usize> {
    let normal = (t[1] - t[0]).cross(t[2] - t[0]).abs();
    let largest = (0..3)
        .max_by(|&i, &j| normal[i].total_cmp(&normal[j]))
        .unwrap_or(0);
    [largest, 0, 1, 2]
        .into_iter()
        .find(|&axis| turn(axis, t[0], t[1], t[2]) != 0.0)
}

/// Whether two triangles that share no corner have a point in common.
pub(super) fn meet(a: &Triangle, b: &Triangle) -> bool {
    let of_b = b.map(|p| side(a, p));
    if apart(&of_b) {
        return false;
    }
    let of_a = a.map(|p| side(b, p));
    if apart(&of_a) {
        return false;
    }
    (0..3).any(|i| {
        let j = (i + 1) % 3;
        crosses(a[i], of_a[i], a[j], of_a[j], b) || crosses(b[i], of_b[i], b[j], of_b[j], a)
    })
}

/// Whether two triangles that share corner 0 have another point in common. Whatever they share
/// runs from the corner to the far side of one of them, so only the far sides need a look.
pub(super) fn meet_beyond_corner(a: &Triangle, b: &Triangle) -> bool {
    let of_b = [side(a, b[1]), side(a, b[2])];
    if apart(&of_b) {
        return false;
    }
    let of_a = [side(b, a[1]), side(b, a[2])];
    if apart(&of_a) {
        return false;
    }
    crosses(a[1], of_a[0], a[2], of_a[1], b) || crosses(b[1], of_b[0], b[2], of_b[1], a)
}

/// Whether two triangles that share corners 0 and 1 lie on one another.
pub(super) fn folded(a: &Triangle, b: &Triangle) -> bool {
    side(a, b[2]) == 0.0
        && open_axis(a)
            .is_some_and(|axis| turn(axis, a[0], a[1], a[2]) * turn(axis, a[0], a[1], b[2]) > 0.0)
}

fn apart(sides: &[f64]) -> bool {
    sides.iter().all(|&s| s > 0.0) || sides.iter().all(|&s| s < 0.0)
}

/// Whether the segment from `p` to `q`, on the given sides of the plane of `t`, meets `t`.
fn crosses(p: DVec3, of_p: f64, q: DVec3, of_q: f64, t: &Triangle) -> bool {
    if (of_p > 0.0 && of_q > 0.0) || (of_p < 0.0 && of_q < 0.0) {
        return false;
    }
    match (of_p == 0.0, of_q == 0.0) {
        (true, true) => crosses_flat(p, q, t),
        (true, false) => holds(t, p),
        (false, true) => holds(t, q),
        (false, false) => {
            let turns = [0, 1, 2].map(|i| side(&[p, q, t[i]], t[(i + 1) % 3]));
            turns.iter().all(|&s| s >= 0.0) || turns.iter().all(|&s| s <= 0.0)
        }
    }
}

/// Whether `t` holds the point `p` of its plane.
fn holds(t: &Triangle, p: DVec3) -> bool {
    open_axis(t).is_some_and(|axis| holds_along(axis, t, p))
}

fn holds_along(axis: usize, t: &Triangle, p: DVec3) -> bool {
    let turns = [0, 1, 2].map(|i| turn(axis, t[i], t[(i + 1) % 3], p));
    turns.iter().all(|&s| s >= 0.0) || turns.iter().all(|&s| s <= 0.0)
}

/// Whether the segment from `p` to `q` in the plane of `t` meets `t`.
fn crosses_flat(p: DVec3, q: DVec3, t: &Triangle) -> bool {
    let Some(axis) = open_axis(t) else {
        return false;
    };
    holds_along(axis, t, p)
        || holds_along(axis, t, q)
        || (0..3).any(|i| {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            // With both ends outside, a segment that meets the triangle crosses a side properly
            // or runs through one of its corners.
            let (of_a, of_b) = (turn(axis, p, q, a), turn(axis, p, q, b));
            let (of_p, of_q) = (turn(axis, a, b, p), turn(axis, a, b, q));
            opposite(of_a, of_b) && opposite(of_p, of_q) && (of_a != 0.0 || of_b != 0.0)
        })
}

fn opposite(a: f64, b: f64) -> bool {
    (a >= 0.0 && b <= 0.0) || (a <= 0.0 && b >= 0.0)
}
