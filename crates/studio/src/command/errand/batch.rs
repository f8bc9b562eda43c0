//! Meshes on their way into the library: two at a time, one row on the screen, one summary.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use bevy::math::Vec3;
use midair_field::bake::Progress;
use midair_library::{Component, Folders};

use super::name;

/// Imports that are worked on at once. Baking spreads over the cores by itself, and each holds its
/// mesh and its grid in memory.
const WORKERS: usize = 2;

/// One mesh file to bring in.
#[derive(Clone, Debug)]
pub(crate) struct Import {
    pub path: PathBuf,
    /// Where it is to stand in the scene as well, on its foot; else it only joins the library.
    pub at: Option<Vec3>,
}

/// What came of it.
pub(super) struct Brought {
    pub import: Import,
    /// `Err(None)` where it was given up.
    pub result: Result<Component, Option<String>>,
}

/// All that were asked for since nothing was under way.
pub(super) struct Batch {
    shared: Arc<Shared>,
    sender: Sender<Brought>,
    results: Mutex<Receiver<Brought>>,
    /// How many were asked for.
    pub total: usize,
    /// How many were taken in.
    pub done: usize,
    /// How many of those failed.
    pub failed: usize,
    /// How many of those were given up.
    pub given_up: usize,
    /// How far to the right those that stand in the scene reach, in metres from where they were dropped.
    pub taken: Option<f32>,
}

#[derive(Default)]
struct Shared {
    queue: Mutex<Queue>,
    finished: AtomicUsize,
}

#[derive(Default)]
struct Queue {
    waiting: VecDeque<Import>,
    working: Vec<(PathBuf, Progress)>,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Default for Batch {
    fn default() -> Self {
        let (sender, results) = channel();
        Self {
            shared: Arc::default(),
            sender,
            results: Mutex::new(results),
            total: 0,
            done: 0,
            failed: 0,
            given_up: 0,
            taken: None,
        }
    }
}

impl Batch {
    /// How many are not finished.
    pub fn outstanding(&self) -> usize {
        self.total - self.shared.finished.load(Ordering::Acquire)
    }

    /// How many are under way or waiting to be taken in.
    pub fn len(&self) -> usize {
        self.total - self.done
    }

    /// What the screen says, and how far it is from 0 to 1.
    pub fn progress(&self) -> Option<(String, f32)> {
        if self.len() == 0 {
            return None;
        }
        let queue = self.shared.lock();
        let finished = self.shared.finished.load(Ordering::Acquire);
        let parts: f32 = queue.working.iter().map(|(_, p)| p.fraction()).sum();
        let file = queue.working.first().map(|(path, _)| name(path));
        let file = file.unwrap_or_default();
        let what = match self.total {
            1 => format!("Importing {file}"),
            n => format!("Importing {} of {n}: {file}", (finished + 1).min(n)),
        };
        Some((what, (finished as f32 + parts) / self.total as f32))
    }

    /// Gives the rest up.
    pub fn cancel(&self) {
        let mut queue = self.shared.lock();
        for import in std::mem::take(&mut queue.waiting) {
            self.shared.finished.fetch_add(1, Ordering::Release);
            // The other end is this value's own.
            let _ = self.sender.send(Brought {
                import,
                result: Err(None),
            });
        }
        for (_, progress) in &queue.working {
            progress.cancel();
        }
    }

    /// Adds files to what is under way.
    pub fn add(&mut self, imports: impl IntoIterator<Item = Import>, folders: &Folders) {
        let mut queue = self.shared.lock();
        for import in imports {
            queue.waiting.push_back(import);
            self.total += 1;
        }
        while queue.working.len() < WORKERS
            && let Some(import) = queue.waiting.pop_front()
        {
            let progress = Progress::new();
            queue.working.push((import.path.clone(), progress.clone()));
            let (shared, sender, folders) =
                (self.shared.clone(), self.sender.clone(), folders.clone());
            let first = import.clone();
            let spawned = std::thread::Builder::new()
                .name("import".into())
                .spawn(move || work(&shared, &sender, &folders, first, progress));
            if let Err(error) = spawned {
                queue.working.retain(|(path, _)| *path != import.path);
                self.shared.finished.fetch_add(1, Ordering::Release);
                let reason = format!("{} was not imported: {error}.", name(&import.path));
                let _ = self.sender.send(Brought {
                    import,
                    result: Err(Some(reason)),
                });
            }
        }
    }

    /// What is finished and not taken in yet.
    pub fn take(&mut self) -> Vec<Brought> {
        let results = self.results.get_mut();
        let results = results.unwrap_or_else(PoisonError::into_inner);
        let taken: Vec<_> = results.try_iter().collect();
        self.done += taken.len();
        taken
    }
}

/// One worker: one file after the other until none waits.
fn work(
    shared: &Shared,
    sender: &Sender<Brought>,
    folders: &Folders,
    mut import: Import,
    mut progress: Progress,
) {
    loop {
        // A fault in a decoder is one file's, not the batch's.
        let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            midair_library::import(folders, &import.path, None, &progress)
        }));
        let result = match result {
            Ok(Ok(component)) => Ok(component),
            Ok(Err(_)) if progress.is_cancelled() => Err(None),
            Ok(Err(error)) => Err(Some(error.to_string())),
            Err(_) => Err(Some(format!(
                "{} could not be read: it is damaged in a way nobody thought of. Export it again from where it was made.",
                name(&import.path)
            ))),
        };
        let mut queue = shared.lock();
        queue.working.retain(|(path, _)| *path != import.path);
        // Nobody waits any more when the program ends.
        let _ = sender.send(Brought { import, result });
        shared.finished.fetch_add(1, Ordering::Release);
        let Some(next) = queue.waiting.pop_front() else {
            return;
        };
        progress = Progress::new();
        queue.working.push((next.path.clone(), progress.clone()));
        import = next;
    }
}
