use std::collections::HashSet;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use midair_mesh::{MeshHash, TriMesh};

use super::sync::SyncHandle;
use crate::MeshStore;

/// Keeps meshes beside the journal, each once, in a file named by the hash of its content.
#[derive(Clone, Debug)]
pub struct MeshSpool {
    folder: PathBuf,
    written: Arc<Mutex<HashSet<MeshHash>>>,
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

    pub(super) fn write_named(&self, hash: MeshHash, mesh: &TriMesh) -> io::Result<()> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        if self.known().contains(&hash) {
            return Ok(());
        }
        let path = path_of(&self.folder, hash);
        if !path.exists() {
            let n = COUNT.fetch_add(1, Ordering::Relaxed);
            let fresh = self.folder.join(format!("new-{n}"));
            let mut file = File::create(&fresh)?;
            let written = file
                .write_all(&midair_mesh::to_bytes(mesh))
                .and_then(|()| fs::rename(&fresh, &path));
            if let Err(e) = written {
                let _ = fs::remove_file(&fresh);
                return Err(e);
            }
            self.syncer.sync(file);
        }
        self.known().insert(hash);
        Ok(())
    }

    fn known(&self) -> std::sync::MutexGuard<'_, HashSet<MeshHash>> {
        self.written.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn path_of(folder: &Path, hash: MeshHash) -> PathBuf {
    folder.join(format!("{hash}.ply"))
}

/// Reads the meshes of `hashes` that are kept in `folder` and undamaged.
pub(super) fn read(folder: &Path, hashes: impl IntoIterator<Item = MeshHash>, store: &MeshStore) {
    for hash in hashes {
        if store.contains(hash) {
            continue;
        }
        let Ok(bytes) = fs::read(path_of(folder, hash)) else {
            continue;
        };
        if let Ok(mesh) = midair_mesh::from_bytes(&bytes)
            && mesh.hash() == hash
        {
            store.insert(mesh);
        }
    }
}
