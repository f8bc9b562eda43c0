use std::sync::LazyLock;

use glam::Vec3;

/// Identifiers of edges in the lattice of a brick: axis·729 + x + 9·y + 81·z, nodes 0..=8.
pub(crate) const EDGE_IDS: usize = 3 * 729;

/// The most triangles in one cell.
pub(crate) const MOST: usize = 5;

/// Corners in a row: one more than needed, so that it fills whole registers.
pub(crate) const WIDTH: usize = 3 * MOST + 1;

/// The triangles of one cell case, as edge identifiers relative to the cell's node 0.
#[derive(Clone, Copy)]
pub(crate) struct Row {
    /// Three to a triangle; what is beyond `count` triangles means nothing.
    pub corners: [u16; WIDTH],
    /// How many triangles.
    pub count: usize,
}

/// The 256 cases. Bit x + 2y + 4z of a case says that the corner (x, y, z) lies inside.
pub(crate) static TABLE: LazyLock<[Row; 256]> =
    LazyLock::new(|| std::array::from_fn(|case| Row::new(case as u8)));

/// The most triangles in one of the [`cases`].
pub const MOST_TRIANGLES: usize = MOST;

/// The triangles of the 256 cases, for evaluators elsewhere. Bit x + 2y + 4z of a case says that the corner
/// (x, y, z) lies inside; a triangle's corners are cell edges 4·axis + u + 2·v, (u, v) being the coordinates of
/// the edge's first corner along the two following axes, cyclically.
pub fn cases() -> [Vec<[u8; 3]>; 256] {
    std::array::from_fn(|case| triangles(case as u8))
}

/// The axis of a cell edge and the corner it starts from. Edges are numbered 4·axis + u + 2·v,
/// (u, v) being the corner's coordinates along the two following axes, cyclically.
const fn edge(e: u8) -> (usize, [usize; 3]) {
    let axis = (e / 4) as usize;
    let mut corner = [0; 3];
    corner[(axis + 1) % 3] = (e & 1) as usize;
    corner[(axis + 2) % 3] = (e >> 1 & 1) as usize;
    (axis, corner)
}

/// The identifier of a cell edge relative to the cell's node 0.
const fn edge_id(e: u8) -> u16 {
    let (axis, c) = edge(e);
    (axis * 729 + c[0] + 9 * c[1] + 81 * c[2]) as u16
}

/// Where the vertex of a cell edge lies in the unit cell.
fn edge_point(e: u8, t: f32) -> Vec3 {
    let (axis, c) = edge(e);
    let mut p = Vec3::new(c[0] as f32, c[1] as f32, c[2] as f32);
    p[axis] = t;
    p
}

/// The edge that starts at `corner` along `axis`.
fn edge_at(axis: usize, corner: [usize; 3]) -> u8 {
    (4 * axis + corner[(axis + 1) % 3] + 2 * corner[(axis + 2) % 3]) as u8
}

/// The two faces a cell edge lies on, as bits 2·axis + side.
fn faces(e: u8) -> u8 {
    let (axis, c) = edge(e);
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    1 << (2 * u + c[u]) | 1 << (2 * v + c[v])
}

impl Row {
    fn new(case: u8) -> Self {
        let triangles = triangles(case);
        let mut corners = [0; WIDTH];
        for (to, &from) in corners.iter_mut().zip(triangles.as_flattened()) {
            *to = edge_id(from);
        }
        Self {
            corners,
            count: triangles.len(),
        }
    }
}

/// The triangles of a case, corners as cell edges.
fn triangles(case: u8) -> Vec<[u8; 3]> {
    loops(case).iter().flat_map(|l| triangulate(l)).collect()
}

/// The closed polygons in which the surface meets the faces of a cell, counter-clockwise seen from
/// outside the solid.
///
/// One rule for every face: each run of outside corners is cut off by a segment of its own. On a
/// face with two inside corners across a diagonal this separates the outside corners; it reads the
/// face alone, so both cells of a face agree and the surface has no holes.
fn loops(case: u8) -> Vec<Vec<u8>> {
    let mut next = [None; 12];
    for axis in 0..3 {
        for side in 0..2 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |i: usize| {
                // Counter-clockwise seen from outside the cell.
                let i = if side == 1 { i % 4 } else { 3 - i % 4 };
                let mut c = [0; 3];
                c[axis] = side;
                (c[u], c[v]) = [(0, 0), (1, 0), (1, 1), (0, 1)][i];
                c
            };
            let inside = |i: usize| {
                let c = corner(i);
                case >> (c[0] + 2 * c[1] + 4 * c[2]) & 1 == 1
            };
            let between = |i: usize| {
                let (a, b) = (corner(i), corner(i + 1));
                let along = if a[u] != b[u] { u } else { v };
                edge_at(along, if a[along] == 0 { a } else { b })
            };
            for i in 0..4 {
                if inside(i) && !inside(i + 1) {
                    let mut j = i + 1;
                    while !inside(j + 1) {
                        j += 1;
                    }
                    // From the far edge to the near one: this turns the loop's normal outward.
                    next[between(j) as usize] = Some(between(i));
                }
            }
        }
    }
    let mut found = Vec::new();
    for start in 0..12 {
        let mut ring = Vec::new();
        let mut at = start;
        while let Some(to) = next[at as usize].take() {
            ring.push(at);
            at = to;
        }
        if !ring.is_empty() {
            found.push(ring);
        }
    }
    found
}

/// Triangulates a loop without a diagonal inside a cell face (the cell beyond might draw the same
/// one, and four triangles would meet in it), its smallest triangle quality as large as can be at
/// edge midpoints. Every loop of the 256 cases has such a triangulation, so that no vertex inside
/// a cell is ever needed.
fn triangulate(ring: &[u8]) -> Vec<[u8; 3]> {
    let n = ring.len();
    let allowed = |i: usize, j: usize| {
        j == i + 1 || (i == 0 && j == n - 1) || faces(ring[i]) & faces(ring[j]) == 0
    };
    let quality = |i: usize, j: usize, k: usize| {
        let [a, b, c] = [i, j, k].map(|i| edge_point(ring[i], 0.5));
        let area = (b - a).cross(c - a).length();
        area / (a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a))
    };
    // best[i][j]: the polygon ring[i..=j], its worst quality and the apex on the side (i, j).
    let mut best = vec![vec![(f32::INFINITY, 0); n]; n];
    for span in 2..n {
        for i in 0..n - span {
            let j = i + span;
            best[i][j] = (-1.0, 0);
            if !allowed(i, j) {
                continue;
            }
            for k in i + 1..j {
                let worst = quality(i, k, j).min(best[i][k].0).min(best[k][j].0);
                if worst > best[i][j].0 {
                    best[i][j] = (worst, k);
                }
            }
        }
    }
    debug_assert!(best[0][n - 1].0 > 0.0);
    let mut triangles = Vec::with_capacity(n - 2);
    let mut open = vec![(0, n - 1)];
    while let Some((i, j)) = open.pop() {
        if j > i + 1 {
            let k = best[i][j].1;
            triangles.push([ring[i], ring[k], ring[j]]);
            open.extend([(i, k), (k, j)]);
        }
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    struct Random(u64);

    impl Random {
        /// In [0, 1).
        fn next(&mut self) -> f64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        }

        /// An edge parameter, often at its ends.
        fn parameter(&mut self) -> f64 {
            match (self.next() * 4.0) as u32 {
                0 => 1e-3,
                1 => 1.0 - 1e-3,
                _ => 1e-3 + 0.998 * self.next(),
            }
        }
    }

    fn volume(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
        (b - a).cross(c - a).dot(d - a)
    }

    /// Whether the segment p–q passes through the inside of a triangle.
    fn pierces(p: DVec3, q: DVec3, t: [DVec3; 3]) -> bool {
        const TINY: f64 = 1e-15;
        let side = |x| volume(t[0], t[1], t[2], x);
        if side(p) * side(q) >= 0.0 || side(p).abs() < TINY || side(q).abs() < TINY {
            return false;
        }
        let s = [
            volume(p, q, t[0], t[1]),
            volume(p, q, t[1], t[2]),
            volume(p, q, t[2], t[0]),
        ];
        s.iter().all(|&x| x > TINY) || s.iter().all(|&x| x < -TINY)
    }

    fn cell(case: u8, t: &[f64; 12]) -> Vec<[DVec3; 3]> {
        let point = |e: u8| {
            let (axis, c) = edge(e);
            let mut p = DVec3::new(c[0] as f64, c[1] as f64, c[2] as f64);
            p[axis] = t[e as usize];
            p
        };
        triangles(case).iter().map(|t| t.map(point)).collect()
    }

    #[test]
    fn piercing_is_seen() {
        let t = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let p = DVec3::new(0.2, 0.2, -0.1);
        assert!(pierces(p, p + 0.3 * DVec3::Z, t));
        assert!(!pierces(p, p + 0.05 * DVec3::Z, t));
        assert!(!pierces(p + DVec3::X, p + DVec3::X + DVec3::Z, t));
    }

    #[test]
    fn no_two_triangles_of_a_cell_cross() {
        let mut random = Random(0x9e37_79b9_7f4a_7c15);
        for case in 0..=255 {
            for _ in 0..400 {
                let t = std::array::from_fn(|_| random.parameter());
                let triangles = cell(case, &t);
                for (i, a) in triangles.iter().enumerate() {
                    for (j, b) in triangles.iter().enumerate() {
                        let crosses = (0..3).any(|k| pierces(a[k], a[(k + 1) % 3], *b));
                        assert!(i == j || !crosses, "case {case}: {t:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn every_triangle_has_area() {
        let mut random = Random(7);
        for case in 0..=255 {
            for _ in 0..100 {
                let t = std::array::from_fn(|_| random.parameter());
                for [a, b, c] in cell(case, &t) {
                    assert!((b - a).cross(c - a).length() > 1e-8);
                }
            }
        }
    }

    #[test]
    fn loops_use_every_crossed_edge_once() {
        for case in 0..=255u8 {
            let mut used: Vec<u8> = loops(case).concat();
            used.sort_unstable();
            let crossed: Vec<u8> = (0..12)
                .filter(|&e| {
                    let (axis, c) = edge(e);
                    let at = c[0] + 2 * c[1] + 4 * c[2];
                    (case >> at ^ case >> (at + (1 << axis))) & 1 == 1
                })
                .collect();
            assert_eq!(used, crossed);
        }
    }

    #[test]
    fn no_diagonal_lies_in_a_face() {
        for case in 0..=255 {
            let rings = loops(case);
            let side = |a: u8, b: u8| {
                rings
                    .iter()
                    .any(|r| (0..r.len()).any(|i| (r[i], r[(i + 1) % r.len()]) == (a, b)))
            };
            for t in triangles(case) {
                for k in 0..3 {
                    let (a, b) = (t[k], t[(k + 1) % 3]);
                    assert!(side(a, b) || faces(a) & faces(b) == 0, "case {case}");
                }
            }
        }
    }

    #[test]
    fn a_single_inside_corner_faces_outward() {
        let t = triangles(1);
        assert_eq!(t.len(), 1);
        let [a, b, c] = t[0].map(|e| edge_point(e, 0.5));
        assert!((b - a).cross(c - a).min_element() > 0.0);
    }

    #[test]
    fn no_case_has_more_triangles_than_a_row_holds() {
        assert!((0..=255).all(|case| triangles(case).len() <= MOST));
    }
}
