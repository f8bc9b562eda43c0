//! The line around an open surface: where it ends, it is drawn outwards in the surface itself. Along the normal, as around
//! a solid, it would be drawn over the surface and nowhere else.

use std::collections::HashMap;

use bevy::math::Vec3;
use midair_mesh::TriMesh;

/// For each vertex which way the line around it lies: away from the surface at its rim, elsewhere along the normal.
pub(crate) fn outward(mesh: &TriMesh) -> Vec<Vec3> {
    let mut sides: HashMap<(u32, u32), (u32, usize)> = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (a, b, across) in [(a, b, c), (b, c, a), (c, a, b)] {
            let side = sides.entry((a.min(b), a.max(b))).or_insert((across, 0));
            side.1 += 1;
        }
    }
    let at = |v: u32| mesh.positions.get(v as usize).copied().unwrap_or_default();
    let mut away = vec![Vec3::ZERO; mesh.positions.len()];
    for ((a, b), (across, _)) in sides.into_iter().filter(|s| s.1.1 == 1) {
        let along = (at(b) - at(a)).normalize_or_zero();
        let from = at(a) - at(across);
        let out = (from - along * from.dot(along)).normalize_or_zero();
        for v in [a, b] {
            if let Some(sum) = away.get_mut(v as usize) {
                *sum += out;
            }
        }
    }
    let normals = mesh
        .normals
        .iter()
        .copied()
        .chain(std::iter::repeat(Vec3::Y));
    let pairs = away.into_iter().zip(normals);
    pairs
        .map(|(away, normal)| away.try_normalize().unwrap_or(normal))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_its_rim_a_flat_sheet_has_its_line_beside_it() {
        let corner = |i: u32| Vec3::new((i % 3) as f32, 0.0, (i / 3) as f32);
        let squares = [0, 1, 3, 4];
        let mesh = TriMesh {
            positions: (0..9).map(corner).collect(),
            normals: vec![Vec3::Y; 9],
            triangles: squares
                .into_iter()
                .flat_map(|i| [[i, i + 3, i + 1], [i + 1, i + 3, i + 4]])
                .collect(),
        };
        let out = outward(&mesh);
        assert_eq!(out[4], Vec3::Y, "in the middle as around a solid");
        for (i, out) in out.iter().enumerate().filter(|(i, _)| *i != 4) {
            let from_middle = mesh.positions[i] - mesh.positions[4];
            assert!(
                out.y.abs() < 1e-6 && out.dot(from_middle) > 0.9,
                "{i}: {out}"
            );
        }
    }
}
