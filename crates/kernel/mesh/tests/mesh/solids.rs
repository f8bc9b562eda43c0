//! Solids that the tests share.

use std::collections::HashMap;

use glam::Vec3;
use midair_mesh::TriMesh;

/// A box between two corners, eight vertices and twelve triangles.
pub fn cuboid(min: Vec3, max: Vec3) -> TriMesh {
    let positions = (0..8)
        .map(|i| Vec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), max, min))
        .collect();
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    TriMesh {
        positions,
        normals: vec![],
        triangles: quads
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect(),
    }
}

/// The cube of side 1 around the origin.
pub fn cube() -> TriMesh {
    cuboid(Vec3::splat(-0.5), Vec3::splat(0.5))
}

/// A sphere of radius `r`: an octahedron whose faces are cut in four `n` times. 8·4ⁿ triangles.
pub fn sphere(r: f32, n: usize) -> TriMesh {
    let mut positions = vec![
        Vec3::X,
        Vec3::NEG_X,
        Vec3::Y,
        Vec3::NEG_Y,
        Vec3::Z,
        Vec3::NEG_Z,
    ];
    let mut triangles = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    for _ in 0..n {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    TriMesh {
        positions: positions.iter().map(|&p| p * r).collect(),
        normals: vec![],
        triangles,
    }
}

/// A torus of radii 1 and 0.25 with `u` by `v` quads.
pub fn torus(u: u32, v: u32) -> TriMesh {
    let angle = |i: u32, n: u32| i as f32 / n as f32 * std::f32::consts::TAU;
    let mut mesh = TriMesh::default();
    for i in 0..u {
        for j in 0..v {
            let ((s, c), (sj, cj)) = (angle(i, u).sin_cos(), angle(j, v).sin_cos());
            let r = 1.0 + 0.25 * cj;
            mesh.positions.push(Vec3::new(r * c, 0.25 * sj, r * s));
            let at = |i: u32, j: u32| (i % u) * v + j % v;
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// Several meshes in one, vertices at equal positions joined if asked.
pub fn together(parts: &[&TriMesh], join: bool) -> TriMesh {
    let mut whole = TriMesh::default();
    let mut places = HashMap::new();
    for part in parts {
        let names: Vec<u32> = part
            .positions
            .iter()
            .map(|&p| {
                let next = whole.positions.len() as u32;
                let v = match join {
                    true => *places.entry(p.to_array().map(f32::to_bits)).or_insert(next),
                    false => next,
                };
                if v == next {
                    whole.positions.push(p);
                }
                v
            })
            .collect();
        whole
            .triangles
            .extend(part.triangles.iter().map(|t| t.map(|v| names[v as usize])));
    }
    whole
}
