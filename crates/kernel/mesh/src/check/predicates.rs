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

/// How far rounding may carry what is computed below, as a share of it, with much to spare.
const ROUNDING: f64 = 1.0e-12;
/// The sine of an angle below which two ways span no plane that can be relied on.
const NEEDLE: f64 = 1.0e-3;

/// Whether a plane through `corner` across `normal` has all of `points` clearly before it, off by `slack` at most.
fn clear(normal: DVec3, corner: DVec3, points: &[DVec3], slack: f64) -> bool {
    let margin = ROUNDING * normal.length();
    let before = |p: &DVec3| {
        let away = *p - corner;
        normal.dot(away) > margin * (away.length() + slack)
    };
    points.iter().all(before)
}

/// Whether a plane along `a`, or across it through one of its sides, leaves all of `b` on the other side. A quick look
/// that may miss it: beside one another in one plane, the exact tests are at their slowest.
fn walled_off(a: &Triangle, b: &Triangle) -> bool {
    let (u, v) = (a[1] - a[0], a[2] - a[0]);
    let normal = u.cross(v);
    // Of a needle rounding may be all there is.
    if normal.length() < NEEDLE * u.length() * v.length() {
        return false;
    }
    if clear(normal, a[0], b, 0.0) || clear(-normal, a[0], b, 0.0) {
        return true;
    }
    (0..3).any(|i| {
        let (from, to, third) = (a[i], a[(i + 1) % 3], a[(i + 2) % 3]);
        let wall = (to - from).cross(normal);
        clear(-wall, from, &[third], 0.0) && clear(wall, from, b, from.distance(to))
    })
}

/// The same of two that share corner 0: a plane through it in the middle of the gap between them.
fn spread(a: &Triangle, b: &Triangle) -> bool {
    let ways = |t: &Triangle| [t[1] - t[0], t[2] - t[0]].map(DVec3::normalize_or_zero);
    let (of_a, of_b) = (ways(a), ways(b));
    let mut nearest = (f64::NEG_INFINITY, DVec3::ZERO);
    for p in of_a {
        for q in of_b {
            if p.dot(q) > nearest.0 {
                nearest = (p.dot(q), p - q);
            }
        }
    }
    clear(nearest.1, a[0], &a[1..], 0.0) && clear(-nearest.1, a[0], &b[1..], 0.0)
}

/// Whether two triangles that share no corner have a point in common.
pub(super) fn meet(a: &Triangle, b: &Triangle) -> bool {
    !walled_off(a, b) && !walled_off(b, a) && meet_exactly(a, b)
}

fn meet_exactly(a: &Triangle, b: &Triangle) -> bool {
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
    !spread(a, b) && meet_beyond_corner_exactly(a, b)
}

fn meet_beyond_corner_exactly(a: &Triangle, b: &Triangle) -> bool {
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
    !unfolded(a, b) && folded_exactly(a, b)
}

/// Whether they lie on either side of what they share, or in planes far from one. A quick look that may miss it.
fn unfolded(a: &Triangle, b: &Triangle) -> bool {
    let along = a[1] - a[0];
    let across = |p: DVec3| {
        let across = along.cross(p - a[0]);
        let known = across.length() > NEEDLE * along.length() * p.distance(a[0]);
        known.then(|| across.normalize_or_zero())
    };
    matches!((across(a[2]), across(b[2])), (Some(of_a), Some(of_b)) if of_a.dot(of_b) < 0.9)
}

fn folded_exactly(a: &Triangle, b: &Triangle) -> bool {
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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, Vec3};
    use proptest::prelude::*;

    /// A corner of a small lattice, so that much is in one plane, on one line or in one place.
    fn corner() -> impl Strategy<Value = DVec3> {
        let along = || -3_i8..=3;
        (along(), along(), -1_i8..=1).prop_map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into()))
    }

    /// The lattice turned and moved, with the rounding that this leaves.
    fn turned(p: [DVec3; 6], turn: [f64; 4]) -> (Triangle, Triangle) {
        let by = DQuat::from_scaled_axis(DVec3::new(turn[0], turn[1], turn[2]));
        let at = |p: DVec3| (by * p + turn[3]).as_vec3().as_dvec3();
        let [a, b, c, d, e, f] = p.map(at);
        ([a, b, c], [d, e, f])
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn a_quick_look_never_parts_what_meets(
            p in prop::array::uniform6(corner()),
            turn in prop::array::uniform4(-2.0..2.0),
            is_turned: bool,
        ) {
            let (a, b) = turned(p, if is_turned { turn } else { [0.0; 4] });
            prop_assume!(open_axis(&a).is_some() && open_axis(&b).is_some());
            if walled_off(&a, &b) {
                prop_assert!(!meet_exactly(&a, &b));
            }
            let b = [a[0], b[1], b[2]];
            if open_axis(&b).is_some() && spread(&a, &b) {
                prop_assert!(!meet_beyond_corner_exactly(&a, &b));
            }
            let b = [a[0], a[1], b[2]];
            if open_axis(&b).is_some() && unfolded(&a, &b) {
                prop_assert!(!folded_exactly(&a, &b));
            }
        }
    }

    #[test]
    fn a_quick_look_parts_neighbours_in_one_plane() {
        // A fan about a corner, turned so that no axis lies in it.
        let by = DQuat::from_scaled_axis(DVec3::new(0.3, 0.7, -0.4));
        let ring = |i: u32| {
            let (y, x) = (f64::from(i) * std::f64::consts::TAU / 7.0).sin_cos();
            (by * DVec3::new(x, y, 0.0)).as_vec3().as_dvec3()
        };
        let middle = Vec3::ZERO.as_dvec3();
        let fan = |i: u32| [middle, ring(i), ring(i + 1)];
        assert!(spread(&fan(0), &fan(2)) && !spread(&fan(0), &fan(0)));
        assert!(unfolded(
            &[middle, ring(1), ring(0)],
            &[middle, ring(1), ring(2)]
        ));
        let away = fan(2).map(|p| p + 1.5 * ring(2));
        assert!(walled_off(&fan(0), &away) && !walled_off(&fan(0), &fan(0)));
    }
}
