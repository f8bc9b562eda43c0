use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::record::{self, Change, Record};
use super::{JOURNAL, Journal, LOCK, MESHES, frame, lock_if_possible, spool};
use crate::file::reason;
use crate::history::{images_of_edits, meshes_of_edits};
use crate::{Document, History, MeshStore};

/// Looks for work that a crash left behind.
#[derive(Debug)]
pub struct Recovery;

/// A session that ended without closing its journal, and had work in it that no file holds. While
/// this lives no other program can take it.
#[derive(Debug)]
pub struct Recoverable {
    folder: PathBuf,
    lock: File,
    /// The file the work belongs to; `None` where it was never saved.
    pub origin: Option<PathBuf>,
    /// When the last step was written.
    pub modified: Option<SystemTime>,
    /// How many steps there are, those undone included.
    pub steps: usize,
}

/// What was recovered, ready to go on.
#[derive(Debug)]
pub struct Recovered {
    /// The document with its steps; it goes on writing to the same journal.
    pub history: History,
    /// The file the work belongs to.
    pub origin: Option<PathBuf>,
    /// What could not be brought back, one line each.
    pub warnings: Vec<String>,
}

/// Work that cannot be brought back. The folder stays as it is.
#[derive(Debug, thiserror::Error)]
pub enum RecoveryError {
    /// The journal cannot be read.
    #[error("{} cannot be read: {reason}. Nothing was deleted; try again", path.display())]
    Unreadable {
        /// The journal.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// The journal has no base.
    #[error("{} is damaged from its start ({reason}). Open the newest autosave instead", path.display())]
    Damaged {
        /// The journal.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

impl Recovery {
    /// The sessions within `folder` that have something to offer, the latest first. Running ones
    /// are passed over, those that have nothing are deleted. A folder that is not there has none.
    pub fn find(folder: &Path) -> Vec<Recoverable> {
        let Ok(entries) = fs::read_dir(folder) else {
            return Vec::new();
        };
        let mut found: Vec<Recoverable> = entries
            .flatten()
            .filter(|e| e.file_name().to_string_lossy().starts_with("session-"))
            .filter_map(|e| look(e.path()))
            .collect();
        found.sort_by(|a, b| (b.modified, &b.folder).cmp(&(a.modified, &a.folder)));
        found
    }
}

fn look(folder: PathBuf) -> Option<Recoverable> {
    let path = folder.join(JOURNAL);
    let Ok(found) = fs::metadata(&path) else {
        // One that just starts, or the rest of one that was closed.
        delete_if_stale(&folder);
        return None;
    };
    let modified = found.modified().ok();
    let lock = File::options()
        .write(true)
        .create(true)
        .truncate(false)
        .open(folder.join(LOCK))
        .ok()?;
    lock_if_possible(&lock).ok()?;
    let bytes = fs::read(&path).ok()?;
    let (mut steps, mut unsaved, mut origin) = (0, false, None);
    let mut first = true;
    for (payload, _) in frame::read(&bytes) {
        if std::mem::take(&mut first) || payload.starts_with(b"Base") {
            if let Ok(Record::Base {
                origin: file,
                unsaved: new,
                ..
            }) = Record::from_bytes(payload)
            {
                unsaved |= new;
                origin = file.or(origin);
            } else {
                unsaved = true;
            }
        } else if payload.starts_with(b"Saved") {
            unsaved = false;
            if let Ok(Record::Saved { path }) = Record::from_bytes(payload) {
                origin = Some(path);
            }
        } else {
            steps += 1;
            unsaved = true;
        }
    }
    if !unsaved && !first {
        let _ = super::delete(&folder);
        return None;
    }
    Some(Recoverable {
        folder,
        lock,
        origin: origin.map(PathBuf::from),
        modified,
        steps,
    })
}

fn delete_if_stale(folder: &Path) {
    let age = fs::metadata(folder)
        .and_then(|m| m.modified())
        .map(|at| at.elapsed().unwrap_or_default());
    if age.is_ok_and(|age| age.as_secs() > 3600) {
        let _ = fs::remove_dir_all(folder);
    }
}

impl Recoverable {
    /// Brings the work back, undo list included: every step whose commit had returned.
    ///
    /// # Errors
    /// [`RecoveryError`] where not even the start of the journal can be read.
    pub fn recover(self) -> Result<Recovered, RecoveryError> {
        let path = self.folder.join(JOURNAL);
        let bytes = fs::read(&path).map_err(|e| RecoveryError::Unreadable {
            path: path.clone(),
            reason: reason(&e),
        })?;
        let replay = replay(&bytes, &self.folder.join(MESHES))
            .map_err(|reason| RecoveryError::Damaged { path, reason })?;
        let Replay {
            mut history,
            end,
            unsaved,
            mut warnings,
        } = replay;
        if let Some(origin) = &self.origin {
            meshes_from_file(origin, &history);
        }
        warnings.extend(history.document().check_meshes(history.meshes()));
        if unsaved {
            history.mark_unsaved();
        }
        match Journal::adopt(self.folder.clone(), self.lock, end) {
            Ok(journal) => history.attach(journal),
            Err(e) => warnings.push(format!(
                "{} cannot be written: {}. A crash would cost what is not saved",
                self.folder.display(),
                reason(&e)
            )),
        }
        Ok(Recovered {
            history,
            origin: self.origin,
            warnings,
        })
    }

    /// Gives the work up and deletes it.
    ///
    /// # Errors
    /// What the system says.
    pub fn discard(self) -> io::Result<()> {
        super::delete(&self.folder)
    }
}

/// Meshes and pictures of the file the session was opened from need not have reached the journal's folder.
fn meshes_from_file(origin: &Path, history: &History) {
    let store = history.meshes();
    let (lacking, pictures) = (history.document().meshes(), history.document().images());
    let whole = lacking.iter().all(|&m| store.contains(m))
        && pictures.iter().all(|&i| store.image(i).is_some());
    if whole {
        return;
    }
    if let Ok(opened) = crate::open(origin) {
        for mesh in lacking.iter().filter_map(|&m| opened.meshes.get(m)) {
            store.insert(mesh);
        }
        for bytes in pictures.iter().filter_map(|&i| opened.meshes.image(i)) {
            store.insert_image(bytes);
        }
    }
}

pub(super) struct Replay {
    pub(super) history: History,
    /// Where the last frame that was taken ends.
    pub(super) end: u64,
    pub(super) unsaved: bool,
    pub(super) warnings: Vec<String>,
}

/// Takes every frame in turn, up to the first that is torn.
pub(super) fn replay(bytes: &[u8], meshes: &Path) -> Result<Replay, String> {
    let store = MeshStore::new();
    let mut frames = frame::read(bytes);
    let (payload, mut end) = frames.next().ok_or("it has no whole frame")?;
    let Record::Base {
        document,
        mut unsaved,
        ..
    } = Record::from_bytes(payload)?
    else {
        return Err("it does not start with a document".into());
    };
    let fresh = |document: Document| {
        spool::read(meshes, document.meshes(), &store);
        spool::read_images(meshes, document.images(), &store);
        let mut history = History::new(document, store.clone());
        // Steps are forgotten at the end, so that every step back finds its own.
        history.set_budget(usize::MAX);
        history
    };
    let mut history = fresh(document);
    let mut warnings = Vec::new();
    for (payload, at) in frames {
        let taken = Record::from_bytes(payload).and_then(|record| match record {
            Record::Base {
                document,
                unsaved: new,
                ..
            } => {
                history = fresh(document);
                unsaved |= new;
                Ok(())
            }
            Record::Saved { .. } => {
                unsaved = false;
                Ok(())
            }
            Record::Change {
                change,
                name,
                recipes,
                edits,
            } => {
                let edits = record::edits(recipes, &edits)?;
                spool::read(meshes, meshes_of_edits(&edits), &store);
                spool::read_images(meshes, images_of_edits(&edits), &store);
                unsaved = true;
                take(&mut history, change, name, edits, &fresh)
            }
        });
        if let Err(reason) = taken {
            warnings.push(format!(
                "the last steps could not be brought back ({reason}); the work is as it was before them"
            ));
            break;
        }
        end = at;
    }
    history.set_budget(History::BUDGET);
    Ok(Replay {
        history,
        end,
        unsaved,
        warnings,
    })
}

fn take(
    history: &mut History,
    change: Change,
    name: String,
    edits: Vec<crate::Edit>,
    fresh: &impl Fn(Document) -> History,
) -> Result<(), String> {
    let mut after = history.document().clone();
    for edit in &edits {
        after.apply(edit).map_err(|e| e.to_string())?;
    }
    match change {
        Change::Commit => history.step(name, edits).map_err(|e| e.to_string())?,
        Change::Undo => drop(history.undo()),
        Change::Redo => drop(history.redo()),
    }
    // The step lies before the base: what it led to stands, what it could be reversed by is gone.
    if *history.document() != after {
        *history = fresh(after);
    }
    Ok(())
}
