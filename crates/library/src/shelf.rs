use std::collections::HashMap;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, Weak};

use midair_mesh::{MeshHash, TriMesh, from_bytes, to_bytes};

/// No mesh file is larger.
const LARGEST_MESH: u64 = 2 << 30;

/// The meshes of the user's library: a folder of binary PLY files named by the hash of their
/// content. Meshes in use are shared, not read twice. Every method may be called from any thread.
#[derive(Debug)]
pub struct MeshShelf {
    folder: PathBuf,
    in_use: Mutex<HashMap<MeshHash, Weak<TriMesh>>>,
}

impl MeshShelf {
    /// The meshes in `folder`, which need not exist yet.
    pub fn new(folder: PathBuf) -> Self {
        Self {
            folder,
            in_use: Mutex::default(),
        }
    }

    /// The mesh of that name, in metres as it was imported; `None` when its file is gone or holds something else.
    pub fn mesh(&self, hash: &MeshHash) -> Option<Arc<TriMesh>> {
        // A poisoned lock guards a map that is whole after every statement.
        let in_use = || self.in_use.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(mesh) = in_use().get(hash).and_then(Weak::upgrade) {
            return Some(mesh);
        }
        let path = self.path(hash);
        let meta = fs::metadata(&path).ok()?;
        if !meta.is_file() || meta.len() > LARGEST_MESH {
            return None;
        }
        let mesh = from_bytes(&fs::read(&path).ok()?).ok()?;
        if mesh.hash() != *hash {
            return None;
        }
        let mesh = Arc::new(mesh);
        let mut in_use = in_use();
        in_use.retain(|_, m| m.strong_count() > 0);
        in_use.insert(*hash, Arc::downgrade(&mesh));
        Some(mesh)
    }

    /// Whether there is a file of that name; it is not read.
    pub fn has(&self, hash: &MeshHash) -> bool {
        self.path(hash).is_file()
    }

    /// Keeps a mesh, as it is, under the hash of its content.
    ///
    /// # Errors
    /// When the folder cannot be made or written, or the disk is full; nothing is left behind.
    pub fn store(&self, mesh: &TriMesh) -> io::Result<MeshHash> {
        let hash = mesh.hash();
        // What is there but damaged is written again.
        if self.mesh(&hash).is_none() {
            write_whole(&self.path(&hash), &to_bytes(mesh))?;
        }
        Ok(hash)
    }

    fn path(&self, hash: &MeshHash) -> PathBuf {
        self.folder.join(format!("{hash}.ply"))
    }
}

/// Writes a file so that it is there whole or not at all, even when the power fails.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    file.persist(path).map_err(|e| e.error)?;
    Ok(())
}
