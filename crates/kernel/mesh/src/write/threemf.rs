use std::io::Cursor;

use threemf::model::{
    Build, Item, Mesh, Metadata, Model, Object, Resources, Triangle, Triangles, Unit as FileUnit,
    Vertex, Vertices,
};

use super::{Part, WriteReason};
use crate::Unit;

/// A 3MF package with one object and one build item per mesh.
pub(super) fn encode(parts: &[Part], unit: Unit) -> Result<Vec<u8>, WriteReason> {
    let model = Model {
        xmlns_m: None,
        metadata: vec![Metadata {
            name: "Application".into(),
            value: Some("Midair".into()),
        }],
        resources: Resources {
            object: parts
                .iter()
                .enumerate()
                .map(|(i, part)| object(i + 1, part))
                .collect(),
            basematerials: None,
        },
        build: Build {
            item: (1..=parts.len())
                .map(|objectid| Item {
                    objectid,
                    transform: None,
                    partnumber: None,
                })
                .collect(),
        },
        unit: match unit {
            Unit::Mm => FileUnit::Millimeter,
            Unit::Cm => FileUnit::Centimeter,
            Unit::M => FileUnit::Meter,
            Unit::Inch => FileUnit::Inch,
        },
        ..Model::default()
    };
    let mut file = Cursor::new(Vec::new());
    threemf::write(&mut file, model).map_err(|error| WriteReason::Io(error.to_string()))?;
    Ok(file.into_inner())
}

fn object(id: usize, part: &Part) -> Object {
    let vertex = part
        .positions
        .iter()
        .map(|p| p.to_array().map(shortest))
        .map(|[x, y, z]| Vertex { x, y, z })
        .collect();
    let triangle = part
        .mesh
        .triangles
        .iter()
        .map(|t| t.map(|v| v as usize))
        .map(|[v1, v2, v3]| Triangle { v1, v2, v3 })
        .collect();
    // XML knows no control characters, not even escaped.
    let name: String = part.name.chars().filter(|c| !c.is_control()).collect();
    Object {
        id,
        name: (!name.is_empty()).then_some(name),
        mesh: Some(Mesh {
            vertices: Vertices { vertex },
            triangles: Triangles { triangle },
        }),
        ..Object::default()
    }
}

/// The f64 that prints as the few digits `x` itself needs: the file is half as long, and whoever
/// reads it as f32 gets the same vertex.
fn shortest(x: f32) -> f64 {
    x.to_string().parse().unwrap_or(f64::from(x))
}
