//! What the tests of the surface share.
#![allow(dead_code)]

use std::collections::HashMap;

use glam::{DVec3, IVec3, Vec3};
use midair_field::{Brick, Grid};
use midair_mesh::TriMesh;

/// Repeatable noise.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [−1, 1).
    pub fn signed(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    pub fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }
}

/// A brick with its true summary.
pub fn values(f: impl FnMut(usize) -> f32) -> Brick {
    let mut values = Box::new([0.0; 512]);
    values
        .iter_mut()
        .zip((0..).map(f))
        .for_each(|(v, f)| *v = f);
    Brick::Values {
        min: values.iter().copied().fold(f32::INFINITY, f32::min),
        max: values.iter().copied().fold(f32::NEG_INFINITY, f32::max),
        values: values.into(),
    }
}

/// One of many kinds of hostile brick, or none at all.
pub fn any_brick(kind: u64, step: f32, r: &mut Random) -> Option<Brick> {
    Some(match kind % 12 {
        0 => return None,
        1 => Brick::Inside,
        2 => values(|_| r.signed() * step),
        3 => values(|_| 1e-4 * step * r.signed().signum()),
        4 => values(|_| 0.0),
        5 => values(|_| -step),
        6 => values(|_| [0.0, -0.0, step, -step, 1e-9, -1e-9][r.below(6) as usize]),
        7 => values(|_| {
            let odd = [
                f32::NAN,
                f32::INFINITY,
                f32::NEG_INFINITY,
                f32::MAX,
                f32::MIN,
            ];
            let v = r.signed() * step;
            odd.get(r.below(8) as usize).copied().unwrap_or(v)
        }),
        8 => values(|i| {
            // A checkerboard: all faces ambiguous.
            let odd = (i ^ (i >> 3) ^ (i >> 6)) & 1;
            (odd as f32 - 0.5) * step * (1.0 + 0.5 * r.signed())
        }),
        9 => values(|_| {
            // Values that differ by orders of magnitude: vertices press against the nodes.
            r.signed().signum() * step * 10f32.powf(5.0 * r.signed())
        }),
        10 => values(|_| (r.signed() + 0.9) * step),
        _ => values(|i| step * ((i % 8) as f32 - 3.5) + 0.1 * step * r.signed()),
    })
}

/// A block of hostile bricks anywhere.
pub fn any_grid(kinds: &[u64], low: IVec3, step: f32, seed: u64) -> Grid {
    let mut r = Random(seed);
    let mut grid = Grid::new(step);
    for (i, &kind) in kinds.iter().enumerate() {
        let i = i as i32;
        let c = low + IVec3::new(i % 3, i / 3 % 2, i / 6);
        grid.set(c, any_brick(kind, step, &mut r));
    }
    grid
}

/// Fails unless the mesh is closed, edge- and vertex-manifold, consistently wound outward, without
/// unused vertices or triangles without area, and its normals are of unit length.
pub fn assert_sound(mesh: &TriMesh) {
    let n = mesh.positions.len();
    assert_eq!(mesh.normals.len(), n);
    let mut edges: HashMap<[u32; 2], u32> = HashMap::new();
    let mut around: Vec<Vec<[u32; 2]>> = vec![Vec::new(); n];
    for (i, t) in mesh.triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b, c) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            assert_ne!(a, b);
            *edges.entry([a, b]).or_default() += 1;
            around[a as usize].push([b, c]);
        }
        let [a, b, c] = mesh.corners(i);
        for scale in [1.0, 1e3] {
            let [a, b, c] = [a * scale, b * scale, c * scale];
            assert!((b - a).cross(c - a).length() > 0.0, "{a} {b} {c}");
        }
    }
    for (&[a, b], &count) in &edges {
        assert_eq!(count, 1, "a directed edge is used twice");
        assert!(edges.contains_key(&[b, a]), "an edge is open");
    }
    for fan in &around {
        assert!(!fan.is_empty(), "a vertex is unused");
        // The triangles around a vertex form one ring.
        let next: HashMap<u32, u32> = fan.iter().map(|&[b, c]| (b, c)).collect();
        let mut at = fan[0][0];
        for i in 0..fan.len() {
            at = next[&at];
            assert_eq!(at == fan[0][0], i + 1 == fan.len(), "a vertex is pinched");
        }
    }
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        assert!(p.is_finite() && (n.length() - 1.0).abs() < 1e-4);
    }
    if !mesh.triangles.is_empty() {
        assert!(volume(mesh) > 0.0);
    }
}

/// The enclosed volume in cubic metres.
pub fn volume(mesh: &TriMesh) -> f64 {
    // Relative to a vertex, so that nothing is lost far from the origin.
    let origin = mesh.positions.first().copied().unwrap_or(Vec3::ZERO);
    let six: f64 = (0..mesh.triangles.len())
        .map(|t| {
            let [a, b, c]: [DVec3; 3] = mesh.corners(t).map(|p| (p - origin).as_dvec3());
            a.dot(b.cross(c))
        })
        .sum();
    six / 6.0
}
