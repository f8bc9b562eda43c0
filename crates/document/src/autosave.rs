use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, SystemTime};

use crate::{Document, History, MeshStore, save};

/// How many autosaves there are before the oldest is overwritten.
const SLOTS: usize = 5;

/// Saves a copy whenever the user pauses, to `autosave-1.midair` … `autosave-5.midair` in turn,
/// off the frame.
#[derive(Debug)]
pub struct Autosave {
    folder: PathBuf,
    /// The revision seen last, and when it was first seen.
    seen: (u64, Duration),
    /// When the first change that is not in an autosave was seen.
    waiting: Option<Duration>,
    running: Option<Receiver<Option<String>>>,
    told: bool,
}

impl Autosave {
    /// The pause after which a copy is saved.
    pub const PAUSE: Duration = Duration::from_secs(3);

    /// After so long one is saved without a pause.
    pub const LATEST: Duration = Duration::from_secs(60);

    /// Autosaves of `history` go to `folder`. What it holds now counts as saved.
    pub fn new(folder: impl Into<PathBuf>, history: &History) -> Self {
        Self {
            folder: folder.into(),
            seen: (history.revision(), Duration::ZERO),
            waiting: None,
            running: None,
            told: false,
        }
    }

    /// Call once a frame with the time since the program started. Starts a copy where one is due,
    /// and returns a line when the user must be told that copies cannot be written.
    pub fn tick(&mut self, now: Duration, history: &History) -> Option<String> {
        let warning = self.finished().and_then(|line| self.tell(line));
        if history.revision() != self.seen.0 {
            self.seen = (history.revision(), now);
            self.waiting.get_or_insert(now);
        }
        let paused = now.saturating_sub(self.seen.1) >= Self::PAUSE;
        let late = |since: Duration| now.saturating_sub(since) >= Self::LATEST;
        // A draft is not worth a copy, and a gesture does not pause for one.
        let due = history.in_progress().is_none()
            && self.running.is_none()
            && self.waiting.is_some_and(|since| paused || late(since));
        if due {
            self.waiting = None;
            self.start(history.document().clone(), history.meshes().clone());
        }
        warning
    }

    /// Waits for a copy that is being written.
    pub fn finish(&mut self) -> Option<String> {
        let line = self.running.take()?.recv().ok().flatten();
        line.and_then(|line| self.tell(line))
    }

    fn start(&mut self, document: Document, meshes: MeshStore) {
        let (done, running) = channel();
        let folder = self.folder.clone();
        let spawned = std::thread::Builder::new()
            .name("autosave".into())
            .spawn(move || {
                let result = write(&folder, &document, &meshes);
                // Nobody waits any more when the program ends.
                let _ = done.send(result.err());
            });
        if spawned.is_ok() {
            self.running = Some(running);
        }
    }

    /// The outcome of a copy that has just been written: a line where it failed.
    fn finished(&mut self) -> Option<String> {
        let result = match self.running.as_ref()?.try_recv() {
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => None,
            Ok(result) => result,
        };
        self.running = None;
        self.told &= result.is_some();
        result
    }

    fn tell(&mut self, line: String) -> Option<String> {
        (!std::mem::replace(&mut self.told, true)).then_some(line)
    }

    /// The autosaves in a folder, latest first.
    pub fn list(folder: &Path) -> Vec<PathBuf> {
        let mut found: Vec<(SystemTime, PathBuf)> = slots(folder)
            .filter_map(|path| Some((age(&path)?, path)))
            .collect();
        found.sort();
        found.into_iter().rev().map(|(_, path)| path).collect()
    }
}

fn slots(folder: &Path) -> impl Iterator<Item = PathBuf> {
    (1..=SLOTS).map(move |n| folder.join(format!("autosave-{n}.midair")))
}

fn age(path: &Path) -> Option<SystemTime> {
    fs::metadata(path).and_then(|m| m.modified()).ok()
}

fn write(folder: &Path, document: &Document, meshes: &MeshStore) -> Result<(), String> {
    // Fails again below, with a better word.
    let _ = fs::create_dir_all(folder);
    // One that is not there is older than any; of equals the first.
    let Some(slot) = slots(folder).min_by_key(|path| age(path)) else {
        return Ok(());
    };
    save(&slot, document, meshes)
        .map(drop)
        .map_err(|e| e.to_string())
}
