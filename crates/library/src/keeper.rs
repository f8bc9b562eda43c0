use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use midair_field::bake::{BakeCache, BakeOptions, Volume};
use midair_mesh::MeshHash;

/// Volumes that may wait to be written: one more, and who baked it writes it.
const WAITING: usize = 4;

/// What is written: the volume of the mesh of that name, baked so.
type Job = (MeshHash, BakeOptions, Arc<Volume>);

/// Writes volumes to the cache while what needs them goes on: to pack and to write one takes about as long as
/// to bake it. Dropped, it waits until the last one is written.
pub(crate) struct Keeper {
    cache: BakeCache,
    writer: Mutex<Option<Writer>>,
    warning: Arc<Mutex<Option<String>>>,
}

struct Writer {
    jobs: SyncSender<Job>,
    thread: JoinHandle<()>,
}

impl Keeper {
    pub fn new(cache: BakeCache) -> Self {
        Self {
            cache,
            writer: Mutex::default(),
            warning: Arc::default(),
        }
    }

    /// The volume of the mesh of that name, where it was kept before.
    pub fn find(&self, mesh: MeshHash, options: &BakeOptions) -> Option<Volume> {
        self.cache.find(mesh, options)
    }

    /// Has a volume written.
    pub fn keep(&self, mesh: MeshHash, options: BakeOptions, volume: Arc<Volume>) {
        let job = (mesh, options, volume);
        let mut writer = lock(&self.writer);
        if writer.is_none() {
            *writer = self.begin();
        }
        let left = match &*writer {
            None => Some(job),
            Some(w) => match w.jobs.try_send(job) {
                Ok(()) => None,
                Err(TrySendError::Full(job) | TrySendError::Disconnected(job)) => Some(job),
            },
        };
        drop(writer);
        if let Some(job) = left {
            write(&self.cache, &job, &self.warning);
        }
    }

    /// One line saying why the disk last kept no volume, if so; each is given once.
    pub fn take_warning(&self) -> Option<String> {
        lock(&self.warning).take()
    }

    /// Waits until everything is written.
    pub fn finish(&self) {
        let writer = lock(&self.writer).take();
        if let Some(Writer { jobs, thread }) = writer {
            drop(jobs);
            // A writer that panicked has kept nothing, and there is nothing more to wait for.
            let _ = thread.join();
        }
    }

    /// A thread that writes; `None` where the system gives no more of them.
    fn begin(&self) -> Option<Writer> {
        let (jobs, todo) = sync_channel::<Job>(WAITING);
        let (cache, warning) = (self.cache.clone(), self.warning.clone());
        let work = move || {
            for job in todo {
                write(&cache, &job, &warning);
            }
        };
        let named = std::thread::Builder::new().name("bakes".into());
        let thread = named.spawn(work).ok()?;
        Some(Writer { jobs, thread })
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        self.finish();
    }
}

fn write(cache: &BakeCache, (mesh, options, volume): &Job, warning: &Mutex<Option<String>>) {
    if let Err(line) = cache.keep(*mesh, options, volume) {
        *lock(warning) = Some(line);
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
