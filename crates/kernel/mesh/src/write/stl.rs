use glam::Vec3;
use stl_io::{Triangle, Vector};

use super::{Part, WriteReason};

/// A binary STL of all meshes, with face normals.
pub(super) fn encode(parts: &[Part]) -> Result<Vec<u8>, WriteReason> {
    let triangles: Vec<Triangle> = parts
        .iter()
        .flat_map(|part| {
            part.mesh
                .triangles
                .iter()
                .map(|t| triangle(t.map(|v| part.positions[v as usize])))
        })
        .collect();
    let mut bytes = Vec::with_capacity(84 + 50 * triangles.len());
    stl_io::write_stl(&mut bytes, triangles.iter())
        .map_err(|error| WriteReason::Io(error.kind().to_string()))?;
    Ok(bytes)
}

fn triangle(corners: [Vec3; 3]) -> Triangle {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let normal = (b - a)
        .cross(c - a)
        .try_normalize()
        .unwrap_or_default()
        .as_vec3();
    Triangle {
        normal: Vector::new(normal.to_array()),
        vertices: corners.map(|p| Vector::new(p.to_array())),
    }
}
