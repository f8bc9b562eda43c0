//! The journal: every committed step in a file, so that a crash costs nothing.
//!
//! Each running program has a folder of its own, held by a lock that the system releases when the
//! program ends, however it ends: `lock`, `journal` (a base, then one frame per step) and
//! `meshes/` (what the steps need, by the hash of their content).

mod frame;
mod record;
mod recovery;
mod spool;
mod sync;
#[cfg(test)]
mod tests;

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

pub(crate) use record::Change;
pub use recovery::{Recoverable, Recovered, Recovery, RecoveryError};
pub use spool::MeshSpool;

use crate::file::reason;
use crate::history::{images_of_edits, meshes_of_edits};
use crate::{Document, Edit, ImageHash, MeshStore};
use record::Record;
use sync::Syncer;

const JOURNAL: &str = "journal";
const LOCK: &str = "lock";
const MESHES: &str = "meshes";

/// A journal that cannot be started. The session goes on without one.
#[derive(Debug, thiserror::Error)]
#[error(
    "{} cannot be written: {reason}. A crash would cost what is not saved; save often, or make room",
    folder.display()
)]
pub struct JournalError {
    /// Where the journal was to lie.
    pub folder: PathBuf,
    /// What the system said.
    pub reason: String,
}

/// The file that every committed step is written to before the call that commits it returns.
///
/// It is handed to the system at once and forced to disk within a second by a thread of its own:
/// a crash of the program costs nothing, one of the machine a second.
#[derive(Debug)]
pub struct Journal {
    folder: PathBuf,
    file: File,
    /// Bytes up to the end of the last whole frame.
    len: u64,
    spool: MeshSpool,
    syncer: Syncer,
    /// The file misses steps: the next write starts from a new base.
    behind: bool,
    /// The user knows.
    told: bool,
    /// Held, never read: the system lets go of it when the program ends.
    _lock: File,
}

impl Journal {
    /// Starts a journal in a new folder within `folder`, from a document as it is now. `origin` is
    /// the file it was opened from or saved to.
    ///
    /// # Errors
    /// [`JournalError`] where the folder cannot be written.
    pub fn start(
        folder: &Path,
        document: &Document,
        meshes: &MeshStore,
        origin: Option<&Path>,
    ) -> Result<Self, JournalError> {
        Self::try_start(folder, document, meshes, origin).map_err(|e| JournalError {
            folder: folder.to_owned(),
            reason: reason(&e),
        })
    }

    fn try_start(
        root: &Path,
        document: &Document,
        meshes: &MeshStore,
        origin: Option<&Path>,
    ) -> io::Result<Self> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        fs::create_dir_all(root)?;
        let folder = loop {
            let n = COUNT.fetch_add(1, Ordering::Relaxed);
            let folder = root.join(format!("session-{}-{n}", std::process::id()));
            match fs::create_dir(&folder) {
                Ok(()) => break folder,
                // Left by an earlier program that had the same process id.
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => continue,
                Err(e) => return Err(e),
            }
        };
        let lock = File::create(folder.join(LOCK))?;
        lock_if_possible(&lock)?;
        let base = Record::Base {
            document: document.clone(),
            origin: origin.map(|p| p.to_string_lossy().into_owned()),
            unsaved: origin.is_none() && !document.is_empty(),
        };
        let mut bytes = frame::HEADER.to_vec();
        frame::push(&mut bytes, &base.to_bytes()?)?;
        // Renamed when whole: a journal that is found always has its base.
        let fresh = folder.join("journal.new");
        fs::write(&fresh, &bytes)?;
        fs::rename(&fresh, folder.join(JOURNAL))?;
        let journal = Self::adopt(folder, lock, bytes.len() as u64)?;
        journal.keep_meshes(document.meshes(), meshes)?;
        journal.keep_images(document.images(), meshes)?;
        Ok(journal)
    }

    /// Goes on with a journal, behind its last whole frame.
    fn adopt(folder: PathBuf, lock: File, len: u64) -> io::Result<Self> {
        let file = OpenOptions::new().append(true).open(folder.join(JOURNAL))?;
        file.set_len(len)?;
        let syncer = Syncer::start(file.try_clone()?)?;
        let spool = MeshSpool::new(folder.join(MESHES), syncer.handle())?;
        Ok(Self {
            folder,
            file,
            len,
            spool,
            syncer,
            behind: false,
            told: false,
            _lock: lock,
        })
    }

    /// The session's own folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Bytes written so far, meshes aside.
    pub fn bytes(&self) -> u64 {
        self.len
    }

    /// Writes meshes and pictures ahead of the steps that use them, on any thread: a step that brings a mesh of
    /// a million triangles then costs its frame nothing.
    pub fn spool(&self) -> MeshSpool {
        self.spool.clone()
    }

    /// Ends the journal and deletes it: the work is safe, or given up.
    pub fn close(self) {
        let folder = self.folder.clone();
        // The thread that flushes must be gone before its files are.
        drop(self);
        // Left behind where it fails; the next start finds it.
        let _ = delete(&folder);
    }

    pub(crate) fn poll(&mut self) -> Option<String> {
        let e = self.syncer.take_error()?;
        self.tell(&e)
    }

    pub(crate) fn change(
        &mut self,
        change: Change,
        name: &str,
        edits: &[Edit],
        document: &Document,
        meshes: &MeshStore,
    ) -> Option<String> {
        let record = Record::change(change, name, edits);
        let kept = self
            .keep_meshes(meshes_of_edits(edits), meshes)
            .and(self.keep_images(images_of_edits(edits), meshes));
        let written = self.write(&record, document, meshes);
        kept.and(written).err().and_then(|e| self.tell(&e))
    }

    pub(crate) fn saved(
        &mut self,
        document: &Document,
        meshes: &MeshStore,
        path: &Path,
    ) -> Option<String> {
        let path = path.to_string_lossy().into_owned();
        self.write(&Record::Saved { path }, document, meshes)
            .err()
            .and_then(|e| self.tell(&e))
    }

    fn keep_meshes(
        &self,
        hashes: impl IntoIterator<Item = midair_mesh::MeshHash>,
        meshes: &MeshStore,
    ) -> io::Result<()> {
        for hash in hashes {
            if let Some(mesh) = meshes.get(hash) {
                self.spool.write_named(hash, &mesh)?;
            }
        }
        Ok(())
    }

    fn keep_images(
        &self,
        hashes: impl IntoIterator<Item = ImageHash>,
        meshes: &MeshStore,
    ) -> io::Result<()> {
        for hash in hashes {
            if let Some(bytes) = meshes.image(hash) {
                self.spool.write_image(hash, &bytes)?;
            }
        }
        Ok(())
    }

    fn write(
        &mut self,
        record: &Record,
        document: &Document,
        meshes: &MeshStore,
    ) -> io::Result<()> {
        let mut bytes = Vec::new();
        if self.behind {
            self.file.set_len(self.len)?;
            self.keep_meshes(document.meshes(), meshes)?;
            self.keep_images(document.images(), meshes)?;
            let base = Record::Base {
                document: document.clone(),
                origin: None,
                unsaved: true,
            };
            frame::push(&mut bytes, &base.to_bytes()?)?;
        }
        let caught_up = self.behind;
        // The new base holds the step already.
        if !caught_up || matches!(record, Record::Saved { .. }) {
            frame::push(&mut bytes, &record.to_bytes()?)?;
        }
        self.behind = true;
        if let Err(e) = self.file.write_all(&bytes) {
            // What got there is torn; if it cannot be cut off now, the next write tries again.
            let _ = self.file.set_len(self.len);
            return Err(e);
        }
        self.behind = false;
        self.told = false;
        self.len += bytes.len() as u64;
        self.syncer.wake();
        Ok(())
    }

    fn tell(&mut self, e: &io::Error) -> Option<String> {
        if std::mem::replace(&mut self.told, true) {
            return None;
        }
        Some(format!(
            "{} cannot be written: {}. The work is kept in memory; make room or save it elsewhere, a crash would cost it",
            self.folder.display(),
            reason(e)
        ))
    }
}

/// The journal goes first: what is left of a deletion that was cut short offers nothing.
fn delete(folder: &Path) -> io::Result<()> {
    match fs::remove_file(folder.join(JOURNAL)) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e),
        _ => fs::remove_dir_all(folder),
    }
}

/// Takes the lock; on a disk that knows no locks, goes on without.
fn lock_if_possible(lock: &File) -> io::Result<()> {
    match lock.try_lock() {
        Ok(()) => Ok(()),
        Err(fs::TryLockError::WouldBlock) => Err(io::ErrorKind::WouldBlock.into()),
        Err(fs::TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => Ok(()),
        Err(fs::TryLockError::Error(e)) => Err(e),
    }
}
