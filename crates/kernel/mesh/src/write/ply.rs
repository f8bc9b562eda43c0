use glam::Vec3;
use ply_rs_bw::ply::{
    Addable, ElementDef, Encoding, Header, PropertyAccess, PropertyDef, PropertyType, ScalarType,
};
use ply_rs_bw::writer::Writer;

use crate::TriMesh;

/// A binary little-endian PLY of all meshes, each with the positions to write. It has normals
/// where every mesh has them.
pub(crate) fn encode(parts: &[(&TriMesh, &[Vec3])]) -> Vec<u8> {
    let vertices = parts.iter().map(|(_, positions)| positions.len()).sum();
    let triangles = parts.iter().map(|(mesh, _)| mesh.triangles.len()).sum();
    let with_normals = vertices > 0
        && parts
            .iter()
            .all(|(mesh, positions)| mesh.normals.len() == positions.len());
    let names: &[&str] = if with_normals {
        &["x", "y", "z", "nx", "ny", "nz"]
    } else {
        &["x", "y", "z"]
    };
    let float = |name: &&str| (name.to_string(), PropertyType::Scalar(ScalarType::Float));
    let vertex = element("vertex", vertices, names.iter().map(float));
    let list = PropertyType::List(ScalarType::UChar, ScalarType::UInt);
    let face = element(
        "face",
        triangles,
        [("vertex_indices".into(), list)].into_iter(),
    );
    let mut header = Header::new();
    header.encoding = Encoding::BinaryLittleEndian;
    header.elements.add(vertex.clone());
    header.elements.add(face.clone());

    let mut bytes = Vec::with_capacity(256 + 24 * vertices + 13 * triangles);
    // Writing to memory cannot fail.
    let _ = Writer::<Vertex>::new().write_header(&mut bytes, &header);
    let writer = Writer::<Vertex>::new();
    for (mesh, positions) in parts {
        for (v, &position) in positions.iter().enumerate() {
            let normal = mesh.normals.get(v).copied().unwrap_or_default();
            let _ = writer.write_little_endian_element(
                &mut bytes,
                &Vertex { position, normal },
                &vertex,
            );
        }
    }
    let writer = Writer::<Face>::new();
    let mut first = 0;
    for (mesh, positions) in parts {
        for triangle in &mesh.triangles {
            let _ = writer.write_little_endian_element(
                &mut bytes,
                &Face(triangle.map(|v| v + first)),
                &face,
            );
        }
        first += positions.len() as u32;
    }
    bytes
}

fn element(
    name: &str,
    count: usize,
    properties: impl Iterator<Item = (String, PropertyType)>,
) -> ElementDef {
    let mut element = ElementDef::new(name.into());
    element.count = count;
    properties.for_each(|(name, kind)| element.properties.add(PropertyDef::new(name, kind)));
    element
}

struct Vertex {
    position: Vec3,
    normal: Vec3,
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self {
            position: Vec3::ZERO,
            normal: Vec3::ZERO,
        }
    }

    fn get_float(&self, name: &str) -> Option<f32> {
        Some(match name {
            "x" => self.position.x,
            "y" => self.position.y,
            "z" => self.position.z,
            "nx" => self.normal.x,
            "ny" => self.normal.y,
            "nz" => self.normal.z,
            _ => return None,
        })
    }
}

struct Face([u32; 3]);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self([0; 3])
    }

    fn get_list_uint(&self, _: &str) -> Option<&[u32]> {
        Some(&self.0)
    }
}
