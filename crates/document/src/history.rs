use std::collections::{BTreeSet, HashSet, VecDeque};
use std::mem::size_of;
use std::path::Path;

use midair_mesh::MeshHash;

use crate::document::meshes_of;
use crate::journal::{Change, Journal};
use crate::{Document, Edit, EditError, ImageHash, Kind, MeshStore, Object, ObjectId};

/// The document with what was done to it: transactions, undo and redo, and the journal.
///
/// One gesture is one transaction: [`History::begin`], any number of [`History::apply`], and
/// [`History::commit`] or [`History::abort`]. There is no limit to the number of steps; once their
/// edits take more than the budget, the oldest are forgotten ([`History::dropped`]).
#[derive(Debug)]
pub struct History {
    document: Document,
    meshes: MeshStore,
    undo: VecDeque<Step>,
    redo: Vec<Step>,
    open: Option<Open>,
    budget: usize,
    bytes: usize,
    dropped: u64,
    committed: u64,
    revision: u64,
    saved: u64,
    journal: Option<Journal>,
    warnings: Vec<String>,
}

/// What takes one step back, or forth again.
#[derive(Debug)]
struct Step {
    name: String,
    /// In the order they are applied.
    edits: Vec<Edit>,
    bytes: usize,
}

impl Step {
    fn new(name: String, edits: Vec<Edit>) -> Self {
        let mut seen = HashSet::new();
        let inner: usize = edits.iter().map(|e| e.bytes(&mut seen)).sum();
        let bytes = size_of::<Self>() + name.len() + inner;
        Self { name, edits, bytes }
    }
}

#[derive(Debug)]
struct Open {
    name: String,
    before: Document,
    forward: Vec<Edit>,
    /// One for each of `forward`.
    inverse: Vec<Edit>,
}

/// A gesture is in progress already.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("\"{0}\" is still in progress")]
pub struct InProgress(
    /// What the open transaction is called.
    pub String,
);

/// How far back an edit looks for one that it merges with.
const MERGE_REACH: usize = 64;

impl History {
    /// How much memory the steps may take where nothing else is said: 64 MiB.
    pub const BUDGET: usize = 64 << 20;

    /// Starts at a document with nothing to undo.
    pub fn new(document: Document, meshes: MeshStore) -> Self {
        Self {
            document,
            meshes,
            undo: VecDeque::new(),
            redo: Vec::new(),
            open: None,
            budget: Self::BUDGET,
            bytes: 0,
            dropped: 0,
            committed: 0,
            revision: 0,
            saved: 0,
            journal: None,
            warnings: Vec::new(),
        }
    }

    /// The document as it is now, an open transaction's edits included.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The meshes of the session.
    pub fn meshes(&self) -> &MeshStore {
        &self.meshes
    }

    /// Opens a transaction. `name` is what the undo list calls it: "Move chair".
    ///
    /// # Errors
    /// [`InProgress`] where one is open; that one stays open.
    pub fn begin(&mut self, name: impl Into<String>) -> Result<(), InProgress> {
        if let Some(open) = &self.open {
            return Err(InProgress(open.name.clone()));
        }
        self.open = Some(Open {
            name: name.into(),
            before: self.document.clone(),
            forward: Vec::new(),
            inverse: Vec::new(),
        });
        Ok(())
    }

    /// What the open transaction is called.
    pub fn in_progress(&self) -> Option<&str> {
        self.open.as_ref().map(|open| &*open.name)
    }

    /// Changes the document: within the open transaction, or as one of its own.
    ///
    /// # Errors
    /// [`EditError`]; the document and the transaction are as they were.
    pub fn apply(&mut self, edit: Edit) -> Result<(), EditError> {
        let Some(open) = &mut self.open else {
            let name = edit.describe().to_owned();
            return self.step(name, vec![edit]);
        };
        let inverse = self.document.apply(&edit)?;
        self.revision += 1;
        match open.merges_into(&edit) {
            Some(at) => open.forward[at] = edit,
            None => {
                open.forward.push(edit);
                open.inverse.push(inverse);
            }
        }
        Ok(())
    }

    /// Adds an object as [`History::apply`] does, and returns the id it got.
    ///
    /// # Errors
    /// [`EditError`] for an unsound object.
    pub fn add(&mut self, object: Object) -> Result<ObjectId, EditError> {
        let id = ObjectId(self.document.next_id());
        let object = object.into();
        self.apply(Edit::Add { id, object })?;
        Ok(id)
    }

    /// A whole transaction at once; does nothing where an edit is refused.
    ///
    /// # Errors
    /// [`EditError`] of the first edit refused. Inside an open transaction the edits join it.
    pub fn step(&mut self, name: impl Into<String>, edits: Vec<Edit>) -> Result<(), EditError> {
        let name = name.into();
        if self.open.is_some() {
            return self.apply(Edit::Composite { name, edits });
        }
        // Cannot fail: none is open.
        let _ = self.begin(name);
        for edit in edits {
            if let Err(e) = self.apply(edit) {
                self.abort();
                return Err(e);
            }
        }
        self.commit();
        Ok(())
    }

    /// Ends the open transaction: it becomes one step to undo and is journalled before this
    /// returns. One that left everything as it was vanishes. Returns whether a step was made.
    pub fn commit(&mut self) -> bool {
        let Some(open) = self.open.take() else {
            return false;
        };
        if self.document.looks_like(&open.before) {
            self.document = open.before;
            return false;
        }
        let Open {
            name,
            forward,
            mut inverse,
            ..
        } = open;
        inverse.reverse();
        self.write(Change::Commit, &name, &forward);
        for step in self.redo.drain(..) {
            self.bytes -= step.bytes;
        }
        self.push_undo(Step::new(name, inverse));
        self.committed += 1;
        self.revision += 1;
        true
    }

    /// Ends the open transaction and takes its edits back.
    pub fn abort(&mut self) {
        if let Some(open) = self.open.take() {
            self.document = open.before;
            self.revision += 1;
        }
    }

    /// Takes the latest step back and returns its name. Does nothing while a transaction is open.
    pub fn undo(&mut self) -> Option<String> {
        let step = match self.open {
            None => self.undo.pop_back()?,
            Some(_) => return None,
        };
        self.bytes -= step.bytes;
        let back = self.turn(step, Change::Undo)?;
        let name = back.name.clone();
        self.bytes += back.bytes;
        self.redo.push(back);
        Some(name)
    }

    /// Does the step taken back last once more and returns its name. Does nothing while a
    /// transaction is open.
    pub fn redo(&mut self) -> Option<String> {
        let step = match self.open {
            None => self.redo.pop()?,
            Some(_) => return None,
        };
        self.bytes -= step.bytes;
        let forth = self.turn(step, Change::Redo)?;
        let name = forth.name.clone();
        self.push_undo(forth);
        Some(name)
    }

    /// Applies a step and returns the one that reverses it.
    fn turn(&mut self, step: Step, change: Change) -> Option<Step> {
        let before = self.document.clone();
        let mut reverse = Vec::with_capacity(step.edits.len());
        for edit in &step.edits {
            match self.document.apply(edit) {
                Ok(inverse) => reverse.push(inverse),
                Err(e) => {
                    // Only a fault in an edit's inverse leads here: lose the step, not the work.
                    self.document = before;
                    let name = &step.name;
                    self.warn(format!("\"{name}\" cannot be taken back: {e}"));
                    return None;
                }
            }
        }
        reverse.reverse();
        self.write(change, &step.name, &step.edits);
        self.revision += 1;
        Some(Step::new(step.name, reverse))
    }

    fn push_undo(&mut self, step: Step) {
        self.bytes += step.bytes;
        self.undo.push_back(step);
        self.trim();
    }

    fn trim(&mut self) {
        while self.bytes > self.budget
            && let Some(step) = self.undo.pop_front()
        {
            self.bytes -= step.bytes;
            self.dropped += 1;
        }
    }

    /// How many steps can be taken back.
    pub fn undo_len(&self) -> usize {
        self.undo.len()
    }

    /// How many steps can be done once more.
    pub fn redo_len(&self) -> usize {
        self.redo.len()
    }

    /// The names of the steps that can be taken back, latest first.
    pub fn undo_names(&self) -> impl Iterator<Item = &str> {
        self.undo.iter().rev().map(|s| &*s.name)
    }

    /// The names of the steps that can be done once more, next first.
    pub fn redo_names(&self) -> impl Iterator<Item = &str> {
        self.redo.iter().rev().map(|s| &*s.name)
    }

    /// The document after each step that can be taken back, with the step's name, oldest first; before them
    /// the state they began from, without a name. States share what they have in common.
    pub fn past(&self) -> Vec<(String, Document)> {
        let mut document = self.document.clone();
        let mut past = Vec::with_capacity(self.undo.len() + 1);
        for step in self.undo.iter().rev() {
            past.push((step.name.clone(), document.clone()));
            if !step.edits.iter().all(|e| document.apply(e).is_ok()) {
                // Only a fault in an edit's inverse leads here: what is known up to there is told.
                break;
            }
        }
        if past.len() == self.undo.len() {
            past.push((String::new(), document));
        }
        past.reverse();
        past
    }

    /// How many transactions were committed in this session.
    pub fn committed(&self) -> u64 {
        self.committed
    }

    /// How many of the oldest steps were forgotten to stay within the budget.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Bytes of memory the steps take, at most: parts shared between steps count in each.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Bytes of memory the steps may take.
    pub fn budget(&self) -> usize {
        self.budget
    }

    /// Sets how many bytes of memory the steps may take.
    pub fn set_budget(&mut self, bytes: usize) {
        self.budget = bytes;
        self.trim();
    }

    /// Grows with every change of the document, whoever made it.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Whether there is something that was not saved.
    pub fn is_unsaved(&self) -> bool {
        self.revision != self.saved
    }

    /// Tells the history, and the journal, that the document as it is now is safe in `path`.
    pub fn note_saved(&mut self, path: &Path) {
        self.saved = self.revision;
        if let Some(journal) = &mut self.journal {
            let warning = journal.saved(&self.document, &self.meshes, path);
            self.warnings.extend(warning);
        }
    }

    /// Writes every step from now on to a journal that was started with this document.
    pub fn attach(&mut self, journal: Journal) {
        self.journal = Some(journal);
    }

    /// The journal, where there is one.
    pub fn journal(&self) -> Option<&Journal> {
        self.journal.as_ref()
    }

    /// Takes the journal out: [`Journal::close`] it when the work is safe or given up.
    pub fn detach(&mut self) -> Option<Journal> {
        self.journal.take()
    }

    /// What the user must be told since the last call, one line each: a journal that cannot be
    /// written, a step that cannot be taken back.
    pub fn take_warnings(&mut self) -> Vec<String> {
        if let Some(warning) = self.journal.as_mut().and_then(Journal::poll) {
            self.warnings.push(warning);
        }
        std::mem::take(&mut self.warnings)
    }

    pub(crate) fn warn(&mut self, line: String) {
        self.warnings.push(line);
    }

    /// What is to be saved is not what is on disk, whatever the counters say.
    pub(crate) fn mark_unsaved(&mut self) {
        self.saved = u64::MAX;
    }

    fn write(&mut self, change: Change, name: &str, edits: &[Edit]) {
        if let Some(journal) = &mut self.journal {
            let warning = journal.change(change, name, edits, &self.document, &self.meshes);
            self.warnings.extend(warning);
        }
    }
}

impl Open {
    /// Which earlier edit this one overwrites. Edits between the two have slots of their own, so
    /// their order does not matter.
    fn merges_into(&self, edit: &Edit) -> Option<usize> {
        let slot = edit.slot()?;
        for (at, earlier) in self.forward.iter().enumerate().rev().take(MERGE_REACH) {
            if earlier.slot()? == slot {
                return Some(at);
            }
        }
        None
    }
}

/// The meshes that edits bring in.
pub(crate) fn meshes_of_edits(edits: &[Edit]) -> BTreeSet<MeshHash> {
    let (mut seen, mut meshes) = (HashSet::new(), BTreeSet::new());
    for edit in edits {
        edit.kinds(&mut |kind| meshes_of(kind, &mut seen, &mut meshes));
    }
    meshes
}

/// The pictures that edits bring in.
pub(crate) fn images_of_edits(edits: &[Edit]) -> BTreeSet<ImageHash> {
    let mut images = BTreeSet::new();
    for edit in edits {
        edit.kinds(&mut |kind| {
            if let Kind::Reference(reference) = kind {
                images.insert(reference.image);
            }
        });
    }
    images
}
