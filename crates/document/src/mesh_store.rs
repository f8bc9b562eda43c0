use std::collections::HashMap;
use std::sync::{Arc, PoisonError, RwLock};

use midair_mesh::{MeshHash, TriMesh};

use crate::ImageHash;

/// The meshes of a session, and the files of its pictures, by the hash of their content. A clone is
/// the same store; they are added and never taken away, so that undo always finds what it needs.
#[derive(Clone, Debug, Default)]
pub struct MeshStore(Arc<RwLock<Meshes>>);

#[derive(Debug, Default)]
struct Meshes {
    sound: HashMap<MeshHash, Arc<TriMesh>>,
    damaged: HashMap<MeshHash, Arc<[u8]>>,
    images: HashMap<ImageHash, Arc<[u8]>>,
}

impl MeshStore {
    /// An empty store.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a mesh in and returns its name.
    pub fn insert(&self, mesh: impl Into<Arc<TriMesh>>) -> MeshHash {
        let mesh = mesh.into();
        let hash = mesh.hash();
        self.write().sound.entry(hash).or_insert(mesh);
        hash
    }

    /// The mesh of that name.
    pub fn get(&self, hash: MeshHash) -> Option<Arc<TriMesh>> {
        self.read().sound.get(&hash).cloned()
    }

    /// Whether the mesh of that name is there.
    pub fn contains(&self, hash: MeshHash) -> bool {
        self.read().sound.contains_key(&hash)
    }

    /// How many meshes there are.
    pub fn len(&self) -> usize {
        self.read().sound.len()
    }

    /// Whether there is no mesh.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Takes a picture file in and returns its name.
    pub fn insert_image(&self, bytes: impl Into<Arc<[u8]>>) -> ImageHash {
        let bytes = bytes.into();
        let hash = ImageHash::of(&bytes);
        self.write().images.entry(hash).or_insert(bytes);
        hash
    }

    /// The picture file of that name.
    pub fn image(&self, hash: ImageHash) -> Option<Arc<[u8]>> {
        self.read().images.get(&hash).cloned()
    }

    /// Keeps bytes that should be a mesh and are not, so that saving writes them again.
    pub(crate) fn keep_damaged(&self, hash: MeshHash, bytes: Vec<u8>) {
        self.write().damaged.insert(hash, bytes.into());
    }

    pub(crate) fn damaged(&self, hash: MeshHash) -> Option<Arc<[u8]>> {
        self.read().damaged.get(&hash).cloned()
    }

    fn read(&self) -> std::sync::RwLockReadGuard<'_, Meshes> {
        self.0.read().unwrap_or_else(PoisonError::into_inner)
    }

    fn write(&self) -> std::sync::RwLockWriteGuard<'_, Meshes> {
        self.0.write().unwrap_or_else(PoisonError::into_inner)
    }
}
