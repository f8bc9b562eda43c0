use std::f32::consts::PI;

use glam::Vec2;

/// Turns of less than this are part of a curve, not corners: 20°.
const CORNER: f32 = 0.35;
/// An arc is drawn with a chord for every so many radians; its sagitta is then 0.0012 radii.
const CHORD: f32 = PI / 32.0;

/// Replaces the convex corners of even-odd `contours` by arcs of the given radius, or of as large
/// a one as the neighbouring edges leave room for. Only corners for which `may` holds.
pub(super) fn fillet(
    contours: &[Vec<Vec2>],
    radius: f32,
    may: impl Fn(Vec2) -> bool,
) -> Vec<Vec<Vec2>> {
    if radius <= 0.0 {
        return contours.to_vec();
    }
    (0..contours.len())
        .map(|i| {
            let ring = &contours[i];
            let around = contours.iter().enumerate().filter(|&(j, _)| j != i);
            let depth = around.filter(|(_, c)| holds(c, ring[0])).count();
            // +1 where the solid lies to the left of the contour.
            let side = if (area(ring) > 0.0) == (depth % 2 == 0) {
                1.0
            } else {
                -1.0
            };
            let mut out = Vec::with_capacity(ring.len());
            for k in 0..ring.len() {
                let before = ring[(k + ring.len() - 1) % ring.len()];
                let after = ring[(k + 1) % ring.len()];
                corner(before, ring[k], after, side, radius, &may, &mut out);
            }
            out
        })
        .collect()
}

fn corner(
    before: Vec2,
    at: Vec2,
    after: Vec2,
    side: f32,
    radius: f32,
    may: &impl Fn(Vec2) -> bool,
    out: &mut Vec<Vec2>,
) {
    let (a, b) = (
        (at - before).normalize_or_zero(),
        (after - at).normalize_or_zero(),
    );
    let turn = libm::atan2f(a.perp_dot(b), a.dot(b)) * side;
    if !(turn > CORNER && turn < PI - 1.0e-3 && may(at)) {
        out.push(at);
        return;
    }
    let tangent = libm::tanf(0.5 * turn);
    let room = 0.5 * at.distance(before).min(at.distance(after));
    let reach = (radius * tangent).min(room);
    let radius = reach / tangent;
    let start = at - a * reach;
    let centre = start + a.perp() * (side * radius);
    let chords = (turn / CHORD).ceil().max(1.0) as usize;
    for k in 0..=chords {
        let angle = side * turn * k as f32 / chords as f32;
        let spoke = Vec2::new(libm::cosf(angle), libm::sinf(angle));
        out.push(centre + spoke.rotate(start - centre));
    }
}

fn area(ring: &[Vec2]) -> f32 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
}

fn holds(ring: &[Vec2], p: Vec2) -> bool {
    let next = ring.iter().cycle().skip(1);
    let crossed = ring.iter().zip(next).filter(|(a, b)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)
    });
    crossed.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_loses_its_corners_only() {
        let square = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(Vec2::from);
        for ring in [square.to_vec(), square.iter().rev().copied().collect()] {
            let out = fillet(&[ring], 0.5, |_| true);
            let exact = 4.0 - (4.0 - PI) * 0.25;
            assert!((0.5 * area(&out[0]).abs() - exact).abs() < 2e-3);
        }
    }

    #[test]
    fn a_hole_keeps_its_corners() {
        let ring = |h: f32| {
            [(h, h), (-h, h), (-h, -h), (h, -h)]
                .map(Vec2::from)
                .to_vec()
        };
        let out = fillet(&[ring(1.0), ring(0.5)], 0.1, |_| true);
        assert!(out[0].len() > 4);
        assert_eq!(out[1].len(), 4);
    }
}
