use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use glam::Vec2;
use midair_document::{Document, Kind, MeshStore, Object, ObjectId, affine};
use midair_field::{MeshSource, Placement};
use midair_mesh::{
    Curve, Format, Named, TriMesh, Unit, Up, WriteError, WriteOptions, write_drawing,
};

use crate::{Materials, SolidError, finish, own_surface, surface_of, tube};

/// Flat sides around a stroke that is written as a tube.
const SIDES: usize = 12;

/// What to write.
#[derive(Clone, Debug, Default)]
pub struct ExportOptions {
    /// Metres between nodes; the document's own step where `None`.
    pub step: Option<f32>,
    /// The unit of the numbers in the file; the format's own where `None`.
    pub unit: Option<Unit>,
    /// The axis that points up in the file; the format's own where `None`: Z in STL and 3MF, Y in the rest.
    pub up: Option<Up>,
    /// Only this object; all visible ones where `None`.
    pub only: Option<ObjectId>,
    /// What objects are made of.
    pub materials: Materials,
}

/// Why a mesh file was not written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// Nothing to see, or every solid came out empty.
    #[error("{} was not written: nothing that can be seen has a surface that this format holds. Show or add a solid, then export again.", file.display())]
    Empty {
        /// Where it was to go.
        file: PathBuf,
    },
    /// The ending names no format, before any work is done.
    #[error("{} was not written: its ending names no format. Use {}.", file.display(), Format::WRITABLE)]
    Format {
        /// Where it was to go.
        file: PathBuf,
    },
    /// One object could not be evaluated.
    #[error("{} was not written: {object} {reason}.", file.display())]
    Solid {
        /// Where it was to go.
        file: PathBuf,
        /// The object's name.
        object: String,
        /// Why.
        reason: SolidError,
    },
    /// A mesh that stands in for an object is gone.
    #[error("{} was not written: the mesh of {object} is missing. Delete the object, or open a whole copy of the document.", file.display())]
    MeshGone {
        /// Where it was to go.
        file: PathBuf,
        /// The object's name.
        object: String,
    },
    /// The file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Whether [`export`] could write a file there, before anything is made for it. Leaves nothing behind.
///
/// # Errors
///
/// [`ExportError`], as [`export`] would; a disk may still be full then.
pub fn may_export(file: &Path) -> Result<(), ExportError> {
    format(file)?;
    Ok(midair_mesh::writable(file)?)
}

fn format(file: &Path) -> Result<Format, ExportError> {
    Format::from_path(file)
        .filter(|f| *f != Format::Gltf)
        .ok_or_else(|| ExportError::Format { file: file.into() })
}

/// Writes the visible objects of a document as a mesh file, each as one named mesh, evaluated where
/// it stands in the world, so that `step` is the step on the printed part. Strokes are polylines in OBJ
/// and tubes elsewhere; construction lines are written where the format has lines. Returns the
/// triangles written.
///
/// # Errors
///
/// [`ExportError`]; the file is then as it was.
pub fn export(
    file: &Path,
    document: &Document,
    store: &MeshStore,
    volumes: &dyn MeshSource,
    options: &ExportOptions,
    cancel: &AtomicBool,
) -> Result<usize, ExportError> {
    let format = format(file)?;
    let up = options.up.unwrap_or(format.up());
    let step = options.step.unwrap_or(document.step());
    let (mut meshes, mut curves) = (Vec::new(), Vec::new());
    for (id, object) in document.objects() {
        let wanted = match options.only {
            Some(only) => id == only,
            None => document.is_visible(id),
        };
        if !wanted {
            continue;
        }
        if let Some(curve) = curve_of(object, format, up) {
            let looks = finish(object, &options.materials);
            curves.push(Named::new(object.name.clone(), curve).finished(Some(looks)));
        } else {
            let Some((mesh, uv)) = object_mesh(file, object, store, volumes, step, cancel)? else {
                continue;
            };
            let looks = finish(object, &options.materials);
            let named = Named::new(object.name.clone(), mesh.standing(up));
            meshes.push(named.finished(Some(looks)).mapped(uv));
        }
    }
    meshes.retain(|m| !m.value.triangles.is_empty());
    if meshes.is_empty() && (curves.is_empty() || !format.has_lines()) {
        return Err(ExportError::Empty { file: file.into() });
    }
    let borrowed: Vec<_> = meshes
        .iter()
        .map(|m| {
            let named = Named::new(m.name.clone(), &m.value);
            named.finished(m.finish).mapped(m.uv.clone())
        })
        .collect();
    let unit = options.unit;
    write_drawing(file, &borrowed, &curves, &WriteOptions { unit })?;
    Ok(meshes.iter().map(|m| m.value.triangles.len()).sum())
}

/// What is written as a line: construction lines, and strokes where they are not tubes.
fn curve_of(object: &Object, format: Format, up: Up) -> Option<Curve> {
    let (points, closed) = match &object.kind {
        Kind::Line(line) => (line.ends().to_vec(), false),
        Kind::Stroke(stroke) if format == Format::Obj => (stroke.points(), stroke.closed),
        _ => return None,
    };
    let there = affine(&object.placement);
    let positions = points
        .iter()
        .map(|&p| there.transform_point3(p).as_vec3())
        .collect();
    // Turned as the meshes beside them are.
    let points = TriMesh {
        positions,
        ..TriMesh::default()
    };
    let points = points.standing(up).positions;
    // The first point of a closed one is its last: the element says so instead.
    let count = points.len() - usize::from(closed && points.len() > 3);
    Some(Curve {
        points: points[..count].to_vec(),
        closed,
    })
}

/// The surface of an object, and where its vertices lie on a picture, where it has such places.
fn object_mesh(
    file: &Path,
    object: &Object,
    store: &MeshStore,
    volumes: &dyn MeshSource,
    step: f32,
    cancel: &AtomicBool,
) -> Result<Option<(TriMesh, Vec<Vec2>)>, ExportError> {
    let bare = |mesh: TriMesh| Some((mesh, Vec::new()));
    match &object.kind {
        Kind::Solid(recipe) | Kind::Sheet(recipe) => {
            // Evaluated about the object's own origin and moved afterwards: far from the world's
            // origin single precision would fray the triangles.
            let about = Placement {
                translation: glam::Vec3::ZERO,
                ..object.placement
            };
            let (mut mesh, uv) = if let Some(own) = own_surface(recipe) {
                (own.mesh.transformed(&about.affine()), own.uv)
            } else {
                let made = surface_of(recipe, &about, step, volumes, cancel);
                let mesh = made.map_err(|reason| ExportError::Solid {
                    file: file.into(),
                    object: object.name.clone(),
                    reason,
                })?;
                (mesh, Vec::new())
            };
            for p in &mut mesh.positions {
                *p += object.placement.translation;
            }
            Ok(Some((mesh, uv)))
        }
        // Lines that the format does not hold.
        Kind::Line(_) => Ok(None),
        Kind::Stroke(stroke) => {
            let radius = 0.5 * stroke.width;
            let tube = tube(&stroke.points(), radius, stroke.closed, SIDES);
            Ok(bare(tube.transformed(&object.placement.affine())))
        }
        Kind::Foreign { mesh, .. } => store
            .get(*mesh)
            .map(|m| bare(m.transformed(&object.placement.affine())))
            .ok_or_else(|| ExportError::MeshGone {
                file: file.into(),
                object: object.name.clone(),
            }),
        // A picture to work from is no part of the work.
        Kind::Reference(_) => Ok(None),
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use midair_document::ConstructionLine;

    use super::*;

    #[test]
    fn lines_are_turned_as_the_meshes_beside_them() {
        let (a, b) = (DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.0, 1.0, 0.0));
        let line = Object::new("line", Kind::Line(ConstructionLine::raw(a, b)));
        let points = |up| curve_of(&line, Format::Obj, up).unwrap().points;
        assert_eq!(points(Up::Y), [a.as_vec3(), b.as_vec3()]);
        assert_eq!(points(Up::Z), [Vec3::new(0.1, -0.3, 0.2), Vec3::Z]);
    }
}
