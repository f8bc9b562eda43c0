use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use midair_field::MeshSource;
use midair_field::bake::{BakeCache, BakeError, BakeOptions, Progress, Volume, bake};
use midair_mesh::{MeshHash, TriMesh};

use crate::folders::Folders;
use crate::keeper::Keeper;
use crate::shelf::MeshShelf;

/// Bytes of volumes kept in memory unless said otherwise.
const IN_MEMORY: usize = 512 << 20;
/// How often one who waits for another's bake looks whether it is still wanted itself.
const LOOK: Duration = Duration::from_millis(20);

/// Where meshes come from: a document's own, the library's, a test's.
pub type FindMesh = dyn Fn(&MeshHash) -> Option<Arc<TriMesh>> + Send + Sync;

/// Why there is no volume.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum VolumeError {
    /// No store has the mesh.
    #[error("the mesh {0} is gone")]
    MeshGone(MeshHash),
    /// It could not be baked, or was cancelled.
    #[error(transparent)]
    Bake(#[from] BakeError),
}

/// Baked meshes by (mesh, step): in memory up to a limit, on disk in the user's cache, and else
/// baked when they are asked for. Every method may be called from any thread; two that ask for one volume bake it
/// once. Asking blocks until the volume is there, so it belongs off the frame.
pub struct Volumes {
    keeper: Keeper,
    limit: usize,
    find: Mutex<Vec<Arc<FindMesh>>>,
    state: Mutex<State>,
    done: Condvar,
}

type Key = (MeshHash, u32);

#[derive(Default)]
struct State {
    kept: HashMap<Key, Kept>,
    bytes: usize,
    /// Counts the uses, so that the one longest ago is known.
    now: u64,
    baking: HashMap<Key, Progress>,
    failed: HashMap<MeshHash, VolumeError>,
}

struct Kept {
    volume: Arc<Volume>,
    used: u64,
}

impl Volumes {
    /// The user's cache on disk, the user's meshes, and at most 512 MiB in memory.
    pub fn new(folders: &Folders) -> Self {
        let volumes = Self::with_cache(BakeCache::new(folders.bakes()), IN_MEMORY);
        let shelf = MeshShelf::new(folders.meshes());
        volumes.add_meshes(move |hash| shelf.mesh(hash));
        volumes
    }

    /// A cache of one's own, `limit` bytes in memory, and no meshes yet. A volume that is in use
    /// lives on beyond the limit.
    pub fn with_cache(cache: BakeCache, limit: usize) -> Self {
        Self {
            keeper: Keeper::new(cache),
            limit,
            find: Mutex::default(),
            state: Mutex::default(),
            done: Condvar::new(),
        }
    }

    /// Looks for meshes here too, before the stores added earlier.
    pub fn add_meshes(
        &self,
        find: impl Fn(&MeshHash) -> Option<Arc<TriMesh>> + Send + Sync + 'static,
    ) {
        let mut all = self.find.lock().unwrap_or_else(PoisonError::into_inner);
        all.insert(0, Arc::new(find));
    }

    /// The mesh of that name, from the first store that has it.
    pub fn mesh(&self, hash: &MeshHash) -> Option<Arc<TriMesh>> {
        // Copied out, so that a slow store does not hold up the others.
        let all = self
            .find
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        all.iter().find_map(|find| find(hash))
    }

    /// The volume of a mesh with nodes every `step` metres, from memory, from disk, or baked now.
    ///
    /// # Errors
    /// When no store has the mesh, when it cannot be baked, or when `progress` is cancelled.
    pub fn get(
        &self,
        mesh: &MeshHash,
        step: f32,
        progress: &Progress,
    ) -> Result<Arc<Volume>, VolumeError> {
        self.once((*mesh, step.to_bits()), progress, || {
            self.mesh(mesh).ok_or(VolumeError::MeshGone(*mesh))
        })
    }

    /// As [`Volumes::get`], for a mesh in hand that need not be in any store.
    ///
    /// # Errors
    /// When it cannot be baked, or when `progress` is cancelled.
    pub fn bake(
        &self,
        mesh: &TriMesh,
        step: f32,
        progress: &Progress,
    ) -> Result<Arc<Volume>, VolumeError> {
        self.once((mesh.hash(), step.to_bits()), progress, || Ok(mesh))
    }

    /// The volume of a mesh if it is in memory already; never blocks for long.
    pub fn ready(&self, mesh: &MeshHash, step: f32) -> Option<Arc<Volume>> {
        self.state().take(&(*mesh, step.to_bits()))
    }

    /// What is being baked just now: the meshes, the steps in metres, and their progress, through
    /// which each can be cancelled. Ordered by mesh and step.
    pub fn baking(&self) -> Vec<(MeshHash, f32, Progress)> {
        let of = |(&(mesh, step), p): (&Key, &Progress)| (mesh, f32::from_bits(step), p.clone());
        let mut all: Vec<_> = self.state().baking.iter().map(of).collect();
        all.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        all
    }

    /// Why a mesh could last not be had, if so; a [`MeshSource`] itself can only say that it could not.
    pub fn failure(&self, mesh: &MeshHash) -> Option<VolumeError> {
        self.state().failed.get(mesh).cloned()
    }

    /// One line saying why the disk last kept no volume, if so; each is given once. The volumes
    /// themselves are good, but will be baked again next time.
    pub fn take_warning(&self) -> Option<String> {
        self.keeper.take_warning()
    }

    /// Waits until every volume baked so far is on disk, or could not be written. Dropping does as well.
    pub fn finish_keeping(&self) {
        self.keeper.finish();
    }

    /// These volumes for one evaluation: what it bakes reports to `progress` and ends when that is
    /// cancelled.
    pub fn watched<'a>(&'a self, progress: &'a Progress) -> Watched<'a> {
        Watched {
            volumes: self,
            progress,
        }
    }

    /// Bytes of the volumes kept in memory.
    pub fn bytes(&self) -> usize {
        self.state().bytes
    }

    fn once<M: std::ops::Deref<Target = TriMesh>>(
        &self,
        key: Key,
        progress: &Progress,
        mesh: impl FnOnce() -> Result<M, VolumeError>,
    ) -> Result<Arc<Volume>, VolumeError> {
        let mut state = self.state();
        loop {
            if let Some(volume) = state.take(&key) {
                progress.set_fraction(1.0);
                return Ok(volume);
            }
            if progress.is_cancelled() {
                return Err(BakeError::Cancelled.into());
            }
            match state.baking.get(&key) {
                Some(other) => progress.set_fraction(other.fraction()),
                None => break,
            }
            let waited = self.done.wait_timeout(state, LOOK);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        state.baking.insert(key, progress.clone());
        drop(state);
        // Takes the mark back however the bake ends, so that no one waits for ever.
        let mark = Mark { volumes: self, key };
        let options = BakeOptions::with_step(f32::from_bits(key.1));
        let mut fresh = false;
        let baked = mesh().and_then(|mesh| {
            if let Some(volume) = self.keeper.find(key.0, &options) {
                progress.set_fraction(1.0);
                return Ok(Arc::new(volume));
            }
            fresh = true;
            Ok(Arc::new(bake(&mesh, &options, progress)?))
        });
        let mut state = self.state();
        match &baked {
            Ok(volume) => state.keep(key, volume.clone(), self.limit),
            Err(VolumeError::Bake(BakeError::Cancelled)) => {}
            Err(e) => drop(state.failed.insert(key.0, e.clone())),
        }
        drop(state);
        drop(mark);
        if let (true, Ok(volume)) = (fresh, &baked) {
            self.keeper.keep(key.0, options, volume.clone());
        }
        baked
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl MeshSource for Volumes {
    fn volume(&self, mesh: &MeshHash, local_step: f32) -> Option<Arc<Volume>> {
        self.get(mesh, local_step, &Progress::new()).ok()
    }

    fn baked(
        &self,
        name: &MeshHash,
        local_step: f32,
        make: &dyn Fn() -> TriMesh,
    ) -> Option<Arc<Volume>> {
        self.watched(&Progress::new()).baked(name, local_step, make)
    }
}

/// [`Volumes`] whose bakes are watched and can be cancelled.
#[derive(Clone, Copy, Debug)]
pub struct Watched<'a> {
    volumes: &'a Volumes,
    progress: &'a Progress,
}

impl MeshSource for Watched<'_> {
    fn volume(&self, mesh: &MeshHash, local_step: f32) -> Option<Arc<Volume>> {
        self.volumes.get(mesh, local_step, self.progress).ok()
    }

    fn baked(
        &self,
        name: &MeshHash,
        local_step: f32,
        make: &dyn Fn() -> TriMesh,
    ) -> Option<Arc<Volume>> {
        let key = (*name, local_step.to_bits());
        let made = self
            .volumes
            .once(key, self.progress, || Ok(Arc::new(make())));
        made.ok()
    }
}

impl fmt::Debug for Volumes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let state = self.state();
        f.debug_struct("Volumes")
            .field("kept", &state.kept.len())
            .field("bytes", &state.bytes)
            .field("baking", &state.baking.len())
            .finish_non_exhaustive()
    }
}

impl State {
    fn take(&mut self, key: &Key) -> Option<Arc<Volume>> {
        self.now += 1;
        let kept = self.kept.get_mut(key)?;
        kept.used = self.now;
        Some(kept.volume.clone())
    }

    fn keep(&mut self, key: Key, volume: Arc<Volume>, limit: usize) {
        self.now += 1;
        self.failed.remove(&key.0);
        self.bytes += volume.bytes();
        let used = self.now;
        if let Some(old) = self.kept.insert(key, Kept { volume, used }) {
            self.bytes -= old.volume.bytes();
        }
        // The newest stays, however large: it is about to be used.
        while self.bytes > limit && self.kept.len() > 1 {
            let oldest = self
                .kept
                .iter()
                .min_by_key(|(_, k)| k.used)
                .map(|(&key, _)| key);
            if let Some(gone) = oldest.and_then(|key| self.kept.remove(&key)) {
                self.bytes -= gone.volume.bytes();
            }
        }
    }
}

struct Mark<'a> {
    volumes: &'a Volumes,
    key: Key,
}

impl Drop for Mark<'_> {
    fn drop(&mut self) {
        self.volumes.state().baking.remove(&self.key);
        self.volumes.done.notify_all();
    }
}
