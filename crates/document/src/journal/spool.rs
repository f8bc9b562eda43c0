use std::borrow::Cow;
use std::collections::HashSet;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use midair_mesh::{MeshHash, TriMesh};

use super::sync::SyncHandle;
use crate::{ImageHash, MeshStore};

/// Keeps meshes and pictures beside the journal, each once, in a file named by the hash of its content.
#[derive(Clone, Debug)]
pub struct MeshSpool {
    folder: PathBuf,
    /// The names of the files that are whole.
    written: Arc<Mutex<HashSet<String>>>,
    syncer: SyncHandle,
}

impl MeshSpool {
    pub(super) fn new(folder: PathBuf, syncer: SyncHandle) -> io::Result<Self> {
        fs::create_dir_all(&folder)?;
        Ok(Self {
            folder,
            written: Arc::default(),
            syncer,
        })
    }

    /// Keeps a mesh, unless it is kept already.
    ///
    /// # Errors
    /// What the system says of a disk that is full or read-only.
    pub fn write(&self, mesh: &TriMesh) -> io::Result<()> {
        self.write_named(mesh.hash(), mesh)
    }

    /// Keeps a picture's file, unless it is kept already.
    ///
    /// # Errors
    /// What the system says of a disk that is full or read-only.
    pub fn write_image(&self, hash: ImageHash, bytes: &[u8]) -> io::Result<()> {
        self.keep(image_name(hash), || bytes.into())
    }

    pub(super) fn write_named(&self, hash: MeshHash, mesh: &TriMesh) -> io::Result<()> {
        self.keep(mesh_name(hash), || midair_mesh::to_bytes(mesh).into())
    }

    fn keep<'a>(&self, name: String, bytes: impl FnOnce() -> Cow<'a, [u8]>) -> io::Result<()> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        if self.known().contains(&name) {
            return Ok(());
        }
        let path = self.folder.join(&name);
        if !path.exists() {
            let n = COUNT.fetch_add(1, Ordering::Relaxed);
            let fresh = self.folder.join(format!("new-{n}"));
            let mut file = File::create(&fresh)?;
            let written = file
                .write_all(&bytes())
                .and_then(|()| fs::rename(&fresh, &path));
            if let Err(e) = written {
                let _ = fs::remove_file(&fresh);
                return Err(e);
            }
            self.syncer.sync(file);
        }
        self.known().insert(name);
        Ok(())
    }

    fn known(&self) -> std::sync::MutexGuard<'_, HashSet<String>> {
        self.written.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn mesh_name(hash: MeshHash) -> String {
    format!("{hash}.ply")
}

fn image_name(hash: ImageHash) -> String {
    format!("{hash}.image")
}

/// Reads the pictures of `hashes` that are kept in `folder` and undamaged.
pub(super) fn read_images(
    folder: &Path,
    hashes: impl IntoIterator<Item = ImageHash>,
    store: &MeshStore,
) {
    for hash in hashes {
        if store.image(hash).is_none()
            && let Ok(bytes) = fs::read(folder.join(image_name(hash)))
            && ImageHash::of(&bytes) == hash
        {
            store.insert_image(bytes);
        }
    }
}

/// Reads the meshes of `hashes` that are kept in `folder` and undamaged.
pub(super) fn read(folder: &Path, hashes: impl IntoIterator<Item = MeshHash>, store: &MeshStore) {
    for hash in hashes {
        if store.contains(hash) {
            continue;
        }
        let Ok(bytes) = fs::read(folder.join(mesh_name(hash))) else {
            continue;
        };
        if let Ok(mesh) = midair_mesh::from_bytes(&bytes)
            && mesh.hash() == hash
        {
            store.insert(mesh);
        }
    }
}
