use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use glam::{Affine3A, Mat4, Vec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::{Accessor, Document, Gltf, Primitive, buffer::Source};

use super::load;
use super::reason::{ReadReason, line};
use crate::TriMesh;
use crate::weld::{MAX_TRIANGLES, Soup};

/// Extensions that do not change the shape, so that a file may require them.
const HARMLESS: [&str; 3] = ["KHR_materials_", "KHR_texture_", "KHR_lights_"];

/// Triangles of all meshes in the default scene, or in all scenes where there is no default, each
/// moved by its node. External buffers lie in `folder`; without one they are refused.
pub(super) fn parse(bytes: &[u8], folder: Option<&Path>) -> Result<Soup, ReadReason> {
    let file = open(bytes)?;
    let buffers = buffers(&file, folder)?;
    let mut soup = Soup::default();
    let mut skipped = BTreeMap::<&str, usize>::new();
    let mut seen = vec![false; file.nodes().len()];
    let mut open: Vec<(gltf::Node, Mat4)> =
        match file.default_scene().or_else(|| file.scenes().next()) {
            Some(scene) => scene.nodes().map(|node| (node, Mat4::IDENTITY)).collect(),
            None => Vec::new(),
        };
    open.reverse();
    while let Some((node, above)) = open.pop() {
        // The nodes of a scene form a tree; a second visit means that they do not.
        if std::mem::replace(&mut seen[node.index()], true) {
            return Err(ReadReason::Damaged("its nodes do not form a tree".into()));
        }
        let placed = above * Mat4::from_cols_array_2d(&node.transform().matrix());
        for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
            match primitive.mode() {
                Mode::Points => *skipped.entry("sets of points").or_default() += 1,
                Mode::Lines | Mode::LineLoop | Mode::LineStrip => {
                    *skipped.entry("sets of lines").or_default() += 1
                }
                _ => add(
                    &mut soup,
                    &primitive,
                    &buffers,
                    &Affine3A::from_mat4(placed),
                )?,
            }
        }
        if node.skin().is_some() {
            *skipped.entry("skins").or_default() += 1;
        }
        let below: Vec<_> = node.children().collect();
        open.extend(below.into_iter().rev().map(|child| (child, placed)));
    }
    soup.warnings.extend(
        skipped
            .into_iter()
            .map(|(what, n)| format!("{n} {what} were left out")),
    );
    if soup.normals.len() != soup.positions.len() {
        soup.normals.clear();
    }
    Ok(soup)
}

/// The file, its description checked.
fn open(bytes: &[u8]) -> Result<Gltf, ReadReason> {
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(of_parser)?;
    let mut root = document.into_json();
    let harmless = |name: &String| HARMLESS.iter().any(|known| name.starts_with(known));
    if let Some(name) = root.extensions_required.iter().find(|name| !harmless(name)) {
        return Err(ReadReason::Unsupported(format!(
            "the glTF extension {}",
            line(name)
        )));
    }
    // The check below would refuse those that do no harm.
    root.extensions_required.clear();
    // The check below looks these up without asking.
    let count = root.accessors.len();
    let mut named = root
        .meshes
        .iter()
        .flat_map(|mesh| &mesh.primitives)
        .flat_map(|primitive| primitive.attributes.values());
    if named.any(|accessor| accessor.value() >= count) {
        return Err(ReadReason::Damaged(
            "a mesh names data that is not there".into(),
        ));
    }
    let document = Document::from_json(root).map_err(of_parser)?;
    Ok(Gltf { document, blob })
}

fn add(
    soup: &mut Soup,
    primitive: &Primitive,
    buffers: &[Vec<u8>],
    placed: &Affine3A,
) -> Result<(), ReadReason> {
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let missing = || ReadReason::CutOff("a buffer is shorter than its data".into());
    let accessor = primitive
        .get(&gltf::Semantic::Positions)
        .ok_or(ReadReason::NoFaces)?;
    let count = accessor.count();
    sound(&accessor, Dimensions::Vec3, &[DataType::F32])?;
    let mut part = TriMesh {
        positions: reader
            .read_positions()
            .ok_or_else(missing)?
            .map(Vec3::from_array)
            .collect(),
        ..TriMesh::default()
    };
    if let Some(normals) = primitive.get(&gltf::Semantic::Normals)
        && normals.count() == count
        && sound(&normals, Dimensions::Vec3, &[DataType::F32]).is_ok()
    {
        part.normals = reader
            .read_normals()
            .ok_or_else(missing)?
            .map(Vec3::from_array)
            .collect();
    }
    let indices: Vec<u32> = match primitive.indices() {
        Some(indices) => {
            sound(
                &indices,
                Dimensions::Scalar,
                &[DataType::U8, DataType::U16, DataType::U32],
            )?;
            reader
                .read_indices()
                .ok_or_else(missing)?
                .into_u32()
                .collect()
        }
        None => (0..count as u32).collect(),
    };
    if let Some(place) = indices.iter().position(|&v| v as usize >= count) {
        return Err(ReadReason::IndexOutOfRange {
            triangle: place / 3,
            vertex: indices[place],
            vertices: count,
        });
    }
    part.triangles = match primitive.mode() {
        Mode::Triangles => indices
            .chunks_exact(3)
            .map(|t| [t[0], t[1], t[2]])
            .collect(),
        // Every second triangle of a strip runs the other way round.
        Mode::TriangleStrip => indices
            .windows(3)
            .enumerate()
            .map(|(i, t)| {
                if i % 2 == 0 {
                    [t[0], t[1], t[2]]
                } else {
                    [t[1], t[0], t[2]]
                }
            })
            .collect(),
        Mode::TriangleFan => indices
            .get(1..)
            .unwrap_or_default()
            .windows(2)
            .map(|t| [indices[0], t[0], t[1]])
            .collect(),
        _ => Vec::new(),
    };
    if soup.triangles.len() + part.triangles.len() > MAX_TRIANGLES
        || soup.positions.len() + count > 3 * MAX_TRIANGLES
    {
        return Err(ReadReason::TooManyTriangles);
    }
    if *placed != Affine3A::IDENTITY {
        part = part.transformed(placed);
    }
    let first = soup.positions.len() as u32;
    // Normals are kept only where every part has them.
    if soup.normals.len() == soup.positions.len() {
        soup.normals.extend(part.normals);
    }
    soup.positions.extend(part.positions);
    soup.triangles
        .extend(part.triangles.into_iter().map(|t| t.map(|v| v + first)));
    Ok(())
}

/// Checks what the accessor's iterator takes for granted.
fn sound(
    accessor: &Accessor,
    dimensions: Dimensions,
    types: &[DataType],
) -> Result<(), ReadReason> {
    if accessor.sparse().is_some() {
        return Err(ReadReason::Unsupported("sparse accessors".into()));
    }
    if accessor.dimensions() != dimensions || !types.contains(&accessor.data_type()) {
        return Err(ReadReason::Unsupported(format!(
            "{:?} {:?} for its shape",
            accessor.dimensions(),
            accessor.data_type()
        )));
    }
    let damaged = || ReadReason::Damaged("an accessor does not fit its buffer".into());
    let view = accessor.view().ok_or_else(damaged)?;
    let size = accessor.size();
    let stride = view.stride().unwrap_or(size);
    let end = accessor
        .count()
        .checked_sub(1)
        .and_then(|n| n.checked_mul(stride))
        .and_then(|n| n.checked_add(size))
        .and_then(|n| n.checked_add(accessor.offset()));
    let fits = stride >= size && end.is_some_and(|end| end <= view.length());
    if fits && view.offset().checked_add(view.length()).is_some() {
        Ok(())
    } else {
        Err(damaged())
    }
}

fn buffers(file: &Gltf, folder: Option<&Path>) -> Result<Vec<Vec<u8>>, ReadReason> {
    let mut blob = file.blob.clone();
    file.buffers()
        .map(|buffer| {
            let bytes = match buffer.source() {
                Source::Bin => blob
                    .take()
                    .ok_or_else(|| ReadReason::CutOff("its binary part is missing".into()))?,
                Source::Uri(uri) => match uri.strip_prefix("data:") {
                    Some(data) => inline(data)?,
                    None => beside(uri, folder)?,
                },
            };
            match bytes.len() >= buffer.length() {
                true => Ok(bytes),
                false => Err(ReadReason::CutOff(format!(
                    "a buffer of {} bytes has only {}",
                    buffer.length(),
                    bytes.len()
                ))),
            }
        })
        .collect()
}

/// The content of a data URI.
fn inline(data: &str) -> Result<Vec<u8>, ReadReason> {
    let damaged = || ReadReason::Damaged("a buffer inside it is not base64".into());
    let (_, coded) = data.split_once(";base64,").ok_or_else(damaged)?;
    base64::engine::general_purpose::STANDARD
        .decode(coded.trim())
        .map_err(|_| damaged())
}

/// The content of a file beside the glTF file.
fn beside(uri: &str, folder: Option<&Path>) -> Result<Vec<u8>, ReadReason> {
    let name = line(uri);
    let path = PathBuf::from(
        percent_encoding::percent_decode_str(uri)
            .decode_utf8_lossy()
            .into_owned(),
    );
    let relative = !uri.contains("://")
        && path.components().all(|part| {
            matches!(
                part,
                Component::Normal(_) | Component::CurDir | Component::ParentDir
            )
        });
    let Some(folder) = folder else {
        return Err(ReadReason::Needs(format!(
            "the file {name}, which is not in the archive"
        )));
    };
    if !relative {
        return Err(ReadReason::Needs(format!(
            "{name}, which is not a file beside it"
        )));
    }
    load(&folder.join(path)).map_err(|reason| match reason {
        ReadReason::TooManyBytes => reason,
        _ => ReadReason::Needs(format!("the file {name} beside it, which cannot be read")),
    })
}

fn of_parser(error: gltf::Error) -> ReadReason {
    use gltf::binary::Error as Binary;
    match error {
        gltf::Error::Binary(Binary::Length { .. } | Binary::ChunkLength { .. } | Binary::Io(_)) => {
            ReadReason::CutOff("it ends in the middle of its data".into())
        }
        gltf::Error::Binary(Binary::Version(version)) => {
            ReadReason::Unsupported(format!("glTF version {version}"))
        }
        gltf::Error::Deserialize(error) if error.is_eof() => {
            ReadReason::CutOff("its description ends in the middle".into())
        }
        gltf::Error::Validation(errors) => match errors.first() {
            Some((path, error)) => ReadReason::Damaged(line(format!("{path}: {error}"))),
            None => ReadReason::Damaged("it does not follow the format".into()),
        },
        other => ReadReason::Damaged(line(other)),
    }
}
