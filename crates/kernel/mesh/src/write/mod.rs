mod glb;
mod obj;
pub(crate) mod ply;
mod save;
mod stl;
mod threemf;

use std::path::Path;

use glam::{Vec2, Vec3};
use thiserror::Error;

use crate::rescale::rescaled;
use crate::{Finish, Format, TriMesh, Unit};

/// Something with a name: in a file, the name of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Named<T> {
    /// What a user calls it.
    pub name: String,
    /// The thing itself.
    pub value: T,
    /// How it looks, where that is known; GLB keeps it.
    pub finish: Option<Finish>,
    /// Where each vertex of a mesh lies on a picture, or nothing; GLB and OBJ keep it.
    pub uv: Vec<Vec2>,
}

impl<T> Named<T> {
    /// `value` under `name`.
    pub fn new(name: impl Into<String>, value: T) -> Self {
        Self {
            name: name.into(),
            value,
            finish: None,
            uv: Vec::new(),
        }
    }

    /// The same, looking like this.
    #[must_use]
    pub fn finished(self, finish: Option<Finish>) -> Self {
        Self { finish, ..self }
    }

    /// The same, its vertices lying there on a picture.
    #[must_use]
    pub fn mapped(self, uv: Vec<Vec2>) -> Self {
        Self { uv, ..self }
    }
}

/// Points joined by straight lines, in metres. OBJ and GLB hold it, the other formats leave it out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Its points, at least two.
    pub points: Vec<Vec3>,
    /// Whether the last is joined to the first.
    pub closed: bool,
}

/// How a file is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// The unit of length in the file; `None` is the format's own ([`Format::unit`]).
    pub unit: Option<Unit>,
}

/// A file that could not be written: one line with its name, the reason and a way out.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{file} {reason}")]
pub struct WriteError {
    /// The file's name without its folder.
    pub file: String,
    /// What stood in the way.
    pub reason: WriteReason,
}

/// Why a file could not be written; follows the file's name in a sentence.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum WriteReason {
    /// The extension names no format that is written.
    #[error("has no known extension. Name it {}.", Format::WRITABLE)]
    UnknownFormat,
    /// There is nothing to write.
    #[error("was not written: there are no faces. Make or choose a solid first.")]
    NoFaces,
    /// A mesh is not sound: a corner that is no vertex or no number.
    #[error(
        "was not written: a face of {0:?} has a corner without a place. Undo the last step and try again."
    )]
    Unsound(String),
    /// The lengths are beyond what the file can hold.
    #[error("was not written: the model is too large for the unit {0}. Choose a larger unit.")]
    TooLarge(Unit),
    /// More than four thousand million bytes or vertices, which these formats cannot count.
    #[error(
        "was not written: the model has more triangles than the format can hold. Export at a coarser step."
    )]
    TooMany,
    /// The folder is not there.
    #[error("was not written: its folder is not there. Make it, or choose another.")]
    NoFolder,
    /// A folder has this name.
    #[error("was not written: a folder has this name. Choose another name.")]
    Folder,
    /// The disk is full.
    #[error("was not written: the disk is full. Free some space, or choose another disk.")]
    DiskFull,
    /// The disk or folder is read-only.
    #[error("was not written: the folder is read-only. Choose another folder.")]
    ReadOnly,
    /// The system refused otherwise.
    #[error("was not written: {0}. Check the disk and try again.")]
    Io(String),
}

/// Writes meshes to `path` in the format of its extension.
///
/// The file is there whole or not at all: it is written under another name beside `path` and then
/// takes its place. The same meshes give the same bytes. Vertices at different positions stay
/// apart when lengths are scaled, so that a closed mesh stays closed. STL and PLY hold one mesh:
/// several are put together there.
///
/// # Errors
/// One line that names the file, says what stood in the way and what to do.
pub fn write(
    path: &Path,
    meshes: &[Named<&TriMesh>],
    options: &WriteOptions,
) -> Result<(), WriteError> {
    write_drawing(path, meshes, &[], options)
}

/// The same with curves beside the meshes.
///
/// # Errors
/// As [`write()`].
pub fn write_drawing(
    path: &Path,
    meshes: &[Named<&TriMesh>],
    curves: &[Named<Curve>],
    options: &WriteOptions,
) -> Result<(), WriteError> {
    Format::from_path(path)
        .filter(|&format| format != Format::Gltf)
        .ok_or(WriteReason::UnknownFormat)
        .and_then(|format| encode_drawing(format, meshes, curves, options))
        .and_then(|bytes| save::save(path, &bytes))
        .map_err(|reason| refused(path, reason))
}

/// Whether [`write()`] could put a file at `path`, before anything is made for it. Leaves nothing behind.
///
/// # Errors
/// What [`write()`] would say of the name, the folder and the rights; a disk may still be full then.
pub fn writable(path: &Path) -> Result<(), WriteError> {
    Format::from_path(path)
        .filter(|&format| format != Format::Gltf)
        .ok_or(WriteReason::UnknownFormat)
        .and_then(|_| save::begin(path).map(drop))
        .map_err(|reason| refused(path, reason))
}

fn refused(path: &Path, reason: WriteReason) -> WriteError {
    WriteError {
        file: path
            .file_name()
            .unwrap_or(path.as_os_str())
            .to_string_lossy()
            .into_owned(),
        reason,
    }
}

/// The bytes of a file in `format`. [`Format::Gltf`] gives a GLB.
pub fn encode(
    format: Format,
    meshes: &[Named<&TriMesh>],
    options: &WriteOptions,
) -> Result<Vec<u8>, WriteReason> {
    encode_drawing(format, meshes, &[], options)
}

/// The same with curves beside the meshes.
pub fn encode_drawing(
    format: Format,
    meshes: &[Named<&TriMesh>],
    curves: &[Named<Curve>],
    options: &WriteOptions,
) -> Result<Vec<u8>, WriteReason> {
    let unit = options.unit.unwrap_or(format.unit());
    let parts: Vec<Part> = meshes
        .iter()
        .filter(|mesh| !mesh.value.triangles.is_empty())
        .map(|mesh| Part::new(mesh, unit))
        .collect::<Result<_, _>>()?;
    let curves: Vec<Lines> = curves
        .iter()
        .filter(|curve| format.has_lines() && curve.value.points.len() > 1)
        .map(|curve| Lines::new(curve, unit))
        .collect::<Result<_, _>>()?;
    if parts.is_empty() && curves.is_empty() {
        return Err(WriteReason::NoFaces);
    }
    let corners: usize = parts
        .iter()
        .map(|part| 3 * part.mesh.triangles.len() + part.positions.len())
        .chain(curves.iter().map(|curve| 2 * curve.positions.len()))
        .sum();
    // 12 bytes each at most, in formats that count bytes in 32 bits.
    if corners > u32::MAX as usize / 12 {
        return Err(WriteReason::TooMany);
    }
    match format {
        Format::Glb | Format::Gltf => glb::encode(&parts, &curves),
        Format::Obj => Ok(obj::encode(&parts, &curves)),
        Format::Stl => stl::encode(&parts),
        Format::Ply => Ok(ply::encode(
            &parts
                .iter()
                .map(|part| (part.mesh, part.positions.as_slice()))
                .collect::<Vec<_>>(),
        )),
        Format::ThreeMf => threemf::encode(&parts, unit),
    }
}

/// A mesh ready to be written.
struct Part<'a> {
    name: &'a str,
    mesh: &'a TriMesh,
    finish: Option<Finish>,
    /// Positions in the file's unit.
    positions: Vec<Vec3>,
    /// One for each, or none.
    uv: &'a [Vec2],
}

/// A curve ready to be written.
struct Lines<'a> {
    name: &'a str,
    finish: Option<Finish>,
    closed: bool,
    /// Positions in the file's unit.
    positions: Vec<Vec3>,
}

impl<'a> Lines<'a> {
    fn new(named: &'a Named<Curve>, unit: Unit) -> Result<Self, WriteReason> {
        let points = &named.value.points;
        if !points.iter().all(|p| p.is_finite()) {
            return Err(WriteReason::Unsound(named.name.clone()));
        }
        Ok(Self {
            name: &named.name,
            finish: named.finish,
            closed: named.value.closed,
            positions: rescaled(points, unit.per_metre()).ok_or(WriteReason::TooLarge(unit))?,
        })
    }
}

impl<'a> Part<'a> {
    fn new(named: &'a Named<&'a TriMesh>, unit: Unit) -> Result<Self, WriteReason> {
        let mesh = named.value;
        let n = mesh.positions.len();
        let sound = mesh.triangles.iter().flatten().all(|&v| (v as usize) < n)
            && mesh.positions.iter().all(|p| p.is_finite());
        if !sound {
            return Err(WriteReason::Unsound(named.name.clone()));
        }
        let positions =
            rescaled(&mesh.positions, unit.per_metre()).ok_or(WriteReason::TooLarge(unit))?;
        Ok(Self {
            name: &named.name,
            mesh,
            finish: named.finish,
            uv: if named.uv.len() == positions.len() {
                &named.uv
            } else {
                &[]
            },
            positions,
        })
    }

    /// One normal per vertex, where the mesh has them.
    fn normals(&self) -> Option<&[Vec3]> {
        (self.mesh.normals.len() == self.positions.len()).then_some(&self.mesh.normals)
    }
}
