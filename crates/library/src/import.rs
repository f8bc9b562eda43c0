use std::path::{Path, PathBuf};

use midair_field::bake::{BakeError, LONGEST_SIDE, Progress, STEP};
use midair_field::{Node, Recipe};
use midair_mesh::ReadError;

use crate::component::Component;
use crate::folders::Folders;
use crate::save::{self, SaveError};
use crate::shelf::MeshShelf;
use crate::volumes::{VolumeError, Volumes};

/// Why a mesh could not be brought into the library. One line each.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file could not be read as a mesh.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The mesh is no boundary of anything.
    #[error("{}: cannot be made solid: {reason}", path.display())]
    Bake {
        /// The mesh's file.
        path: PathBuf,
        /// What is wrong with it.
        reason: BakeError,
    },
    /// The library could not be written.
    #[error("{}: cannot be kept: {reason}", path.display())]
    Save {
        /// The mesh's file.
        path: PathBuf,
        /// What refused.
        reason: SaveError,
    },
    /// It was cancelled; nothing was kept.
    #[error("{}: the import was cancelled", path.display())]
    Cancelled {
        /// The mesh's file.
        path: PathBuf,
    },
}

/// Brings a mesh into the user's library: read, stood up where its format has Z up, centred and scaled to a longest side of 0.4 m
/// (EasyVRModeling §5.2, 1–3), baked at the default step, so that placing it later does not wait,
/// and kept under `name`, or the name of its file. Importing it again changes nothing.
///
/// Blocks; `progress` tells how far it is and can cancel it.
///
/// # Errors
/// [`ImportError`]; nothing is then listed that was not before.
pub fn import(
    folders: &Folders,
    path: &Path,
    name: Option<&str>,
    progress: &Progress,
) -> Result<Component, ImportError> {
    let cancelled = || ImportError::Cancelled {
        path: path.to_owned(),
    };
    let keep = |reason| ImportError::Save {
        path: path.to_owned(),
        reason,
    };
    if progress.is_cancelled() {
        return Err(cancelled());
    }
    let read = midair_mesh::read(path)?;
    let upright = read.mesh.stood_up(read.format.up());
    let mesh = upright.normalised(LONGEST_SIDE).0;
    // Baked before it is kept: what cannot be made solid leaves nothing behind.
    let volumes = Volumes::new(folders);
    match volumes.bake(&mesh, STEP, progress) {
        Ok(_) => {}
        Err(VolumeError::Bake(BakeError::Cancelled)) => return Err(cancelled()),
        Err(VolumeError::Bake(reason)) => {
            return Err(ImportError::Bake {
                path: path.to_owned(),
                reason,
            });
        }
        // A mesh in hand is never gone.
        Err(VolumeError::MeshGone(hash)) => return Err(keep(SaveError::MeshGone(hash))),
    }
    let shelf = MeshShelf::new(folders.meshes());
    let hash = shelf.store(&mesh).map_err(|reason| {
        let path = folders.meshes();
        keep(SaveError::Unwritable { path, reason })
    })?;
    let recipe = Recipe::new(Node::Mesh {
        mesh: hash,
        bounds: mesh.bounds(),
    });
    let name = name.map_or_else(|| name_of(path), str::to_owned);
    save::write(folders, &name, recipe).map_err(keep)
}

/// Imports several meshes one after the other as they are asked for, each as [`import`] does; one
/// that fails does not keep the others out. A `name` given to several is told apart by numbers.
/// `progress` is that of the mesh at hand; cancelled, it cancels the rest too.
pub fn import_all<'a>(
    folders: &'a Folders,
    paths: &'a [PathBuf],
    name: Option<&'a str>,
    progress: &'a Progress,
) -> impl Iterator<Item = Result<Component, ImportError>> + 'a {
    paths
        .iter()
        .map(move |path| import(folders, path, name, progress))
}

/// What a mesh is called that was given no name: its file's, in words.
fn name_of(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let words = stem.replace(['-', '_'], " ");
    let mut chars = words.trim().chars();
    match chars.next() {
        Some(first) => first.to_uppercase().chain(chars).collect(),
        None => String::new(),
    }
}
