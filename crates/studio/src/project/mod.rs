//! The work at hand: document, history, journal, where it is saved.

mod begin;
mod keep;
mod leave;
mod shelf;
mod thumbnails;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use bevy::prelude::*;
use midair_document::{Document, Edit, EditError, History, MeshStore, ObjectId};
use midair_library::Folders;
use midair_mesh::{MeshHash, TriMesh};

pub use begin::{Begin, Recoverables};
pub(crate) use begin::{attach, begin, install};
pub use keep::KeepPlugin;
pub(crate) use leave::PANEL as LEAVE_PANEL;
pub use leave::{Answer, Leaving, Then};
pub use shelf::Shelf;
pub use thumbnails::{Picture, Thumbnails};

use crate::links::Follow;
use crate::notice::Notices;
use crate::symmetry::{Image, spread};

/// What is selected, by every mode alike.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Selection(pub Vec<ObjectId>);

/// Where files of the user go.
#[derive(Resource, Clone, Debug)]
pub struct Places {
    /// Library and caches.
    pub library: Folders,
    /// Journals of running and crashed sessions.
    pub journals: PathBuf,
    /// The five latest autosaves.
    pub autosaves: PathBuf,
    /// What *save* and quick exports write.
    pub work: PathBuf,
}

impl Places {
    /// The platform's folders, or everything below `MIDAIR_HOME`.
    ///
    /// # Errors
    ///
    /// No home folder is known.
    pub fn of_user() -> Result<Self, midair_library::NoHome> {
        Folders::of_user().map(Self::in_folders)
    }

    /// Everything below one folder: portable, or for a test.
    pub fn below(home: &Path) -> Self {
        Self::in_folders(Folders::below(home))
    }

    /// What the person has set.
    pub fn settings(&self) -> PathBuf {
        self.library.config().join("settings.ron")
    }

    fn in_folders(library: Folders) -> Self {
        let state = library.state();
        Self {
            journals: state.join("journal"),
            autosaves: state.join("autosave"),
            work: library.work(),
            library,
        }
    }
}

/// So many links one after the other are followed.
const LONGEST_CHAIN: usize = 8;

/// How many there have been in this run.
static PROJECTS: AtomicU64 = AtomicU64::new(0);

/// The work at hand.
#[derive(Resource)]
pub struct Project {
    history: History,
    path: Option<PathBuf>,
    work: PathBuf,
    /// What is not saved was given up by the person: its journal goes with it.
    give_up: bool,
    /// The images of live symmetry.
    images: Vec<Image>,
    number: u64,
    /// How what is linked follows its sources.
    follows: Vec<Follow>,
}

impl Project {
    /// Goes on with a history; `work` is where files without a place go.
    pub fn new(history: History, path: Option<PathBuf>, work: PathBuf) -> Self {
        Self {
            history,
            path,
            work,
            give_up: false,
            images: Vec::new(),
            number: PROJECTS.fetch_add(1, Ordering::Relaxed),
            follows: Vec::new(),
        }
    }

    /// Tells one work from the next in the same run: it changes when a document is opened, restored or begun.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// The document as it stands.
    pub fn document(&self) -> &Document {
        self.history.document()
    }

    /// Steps, undo and redo.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// The meshes the document names.
    pub fn meshes(&self) -> &MeshStore {
        self.history.meshes()
    }

    /// One of them.
    pub fn mesh(&self, hash: &MeshHash) -> Option<Arc<TriMesh>> {
        self.history.meshes().get(*hash)
    }

    /// The file it was opened from or saved to.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// What people call it.
    pub fn title(&self) -> String {
        self.path
            .as_ref()
            .and_then(|p| p.file_stem())
            .map_or("Untitled".into(), |s| s.to_string_lossy().into_owned())
    }

    /// One gesture: one step that can be undone. What is refused changes nothing and says why.
    /// Returns whether the document changed.
    pub fn commit(
        &mut self,
        name: impl Into<String>,
        edits: impl IntoIterator<Item = Edit>,
        notices: &mut Notices,
    ) -> bool {
        let before = self.history.committed();
        let edits = edits.into_iter().collect();
        let linked = !self.follows.is_empty()
            && self.history.in_progress().is_none()
            && self.document().objects().any(|(_, o)| !o.links.is_empty());
        let done = if linked {
            self.step_with_links(name.into(), edits)
        } else {
            self.history.step(name, edits)
        };
        if let Err(reason) = done {
            notices.warn(reason.to_string());
        }
        self.history.committed() != before
    }

    /// A step, and in it what follows from it.
    fn step_with_links(&mut self, name: String, edits: Vec<Edit>) -> Result<(), EditError> {
        let mut was = self.document().clone();
        // Cannot fail: none is open.
        let _ = self.history.begin(name);
        let mut made = edits.into_iter().try_for_each(|e| self.history.apply(e));
        // What follows may be followed: a stroke by the sweep along it, that by what is painted with it.
        for _ in 0..LONGEST_CHAIN {
            let now = self.document();
            let more: Vec<Edit> = self.follows.iter().flat_map(|f| f(&was, now)).collect();
            if made.is_err() || more.is_empty() {
                break;
            }
            was = self.document().clone();
            made = more.into_iter().try_for_each(|e| self.history.apply(e));
        }
        match made {
            Ok(()) => {
                self.history.commit();
            }
            Err(_) => self.history.abort(),
        }
        made
    }

    /// The same under the live symmetry: what happens to objects happens to their images, in the same
    /// step (see [`symmetry`](crate::symmetry)).
    pub fn commit_live(
        &mut self,
        name: impl Into<String>,
        edits: impl IntoIterator<Item = Edit>,
        notices: &mut Notices,
    ) -> bool {
        let edits = edits.into_iter().collect();
        let edits = spread(self.document(), edits, &self.images);
        self.commit(name, edits, notices)
    }

    /// The images that live symmetry makes of everything: none while it is off.
    pub fn images(&self) -> &[Image] {
        &self.images
    }

    pub(crate) fn follows(&self) -> &[Follow] {
        &self.follows
    }

    pub(crate) fn set_follows(&mut self, follows: Vec<Follow>) {
        self.follows = follows;
    }

    pub(crate) fn set_images(&mut self, images: Vec<Image>) {
        self.images = images;
    }

    /// One step back; what it was called.
    pub fn undo(&mut self) -> Option<String> {
        self.history.undo()
    }

    /// One step forward; what it was called.
    pub fn redo(&mut self) -> Option<String> {
        self.history.redo()
    }

    /// What the history has to say since it was last asked.
    pub fn take_warnings(&mut self) -> Vec<String> {
        self.history.take_warnings()
    }

    /// What was to take its place did not come: it is worked on after all.
    pub(crate) fn keep(&mut self) {
        self.give_up = false;
    }

    /// The work is in this file now.
    pub(crate) fn saved(&mut self, path: PathBuf) {
        self.history.note_saved(&path);
        self.path = Some(path);
    }

    /// Another project takes its place: with nothing unsaved its journal is closed, otherwise it
    /// stays on disk.
    pub(crate) fn retire(&mut self) {
        if (self.give_up || !self.history.is_unsaved())
            && let Some(journal) = self.history.detach()
        {
            journal.close();
        }
    }

    /// A file of its own for one object: its name, in the work folder, never one that is there.
    pub fn export_path(&self, object: ObjectId, ending: &str) -> PathBuf {
        let name = self
            .document()
            .object(object)
            .map_or("object", |o| o.name.as_str());
        free_path(&self.work, name, ending)
    }

    /// A file for a document that has none.
    pub fn new_path(&self) -> PathBuf {
        free_path(&self.work, "Untitled", "midair")
    }

    /// Where files without a place go.
    pub fn work_folder(&self) -> &Path {
        &self.work
    }
}

/// `name.ending`, or `name-2.ending` and so on where that is taken.
fn free_path(folder: &Path, name: &str, ending: &str) -> PathBuf {
    let name: String = name
        .chars()
        .map(|c| {
            if c.is_alphanumeric() || " -_".contains(c) {
                c
            } else {
                '-'
            }
        })
        .collect();
    let first = folder.join(format!("{name}.{ending}"));
    if !first.exists() {
        return first;
    }
    (2..)
        .map(|n| folder.join(format!("{name}-{n}.{ending}")))
        .find(|p| !p.exists())
        .unwrap_or(first)
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Selection>()
        .init_resource::<Thumbnails>();
    begin::plugin(app);
    shelf::plugin(app);
    leave::plugin(app);
}
