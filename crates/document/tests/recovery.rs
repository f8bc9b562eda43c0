//! The journal's folder and the autosaves, seen from outside.

mod support;

use std::fs;
use std::path::Path;
use std::time::Duration;

use midair_document::{
    Autosave, Document, Edit, History, Journal, MeshStore, Object, ObjectId, Recovery, open, save,
};
use support::{ball, foreign};

fn journalled(folder: &Path, document: Document, meshes: MeshStore) -> History {
    let journal = Journal::start(folder, &document, &meshes, None).unwrap();
    let mut history = History::new(document, meshes);
    history.attach(journal);
    history
}

#[test]
fn what_a_crash_left_is_offered_with_its_undo_list() {
    let folder = tempfile::tempdir().unwrap();
    let mut history = journalled(folder.path(), Document::new(), MeshStore::new());
    history.add(Object::solid("A", ball(0.1))).unwrap();
    let vase = foreign(history.meshes(), 0.2);
    history.add(vase).unwrap();
    history.apply(Edit::Remove { id: ObjectId(1) }).unwrap();
    history.undo().unwrap();
    let document = history.document().clone();
    // A running session is nobody else's.
    assert!(Recovery::find(folder.path()).is_empty());
    drop(history);
    let mut found = Recovery::find(folder.path());
    assert_eq!((found.len(), found[0].steps), (1, 4));
    // Neither is one that is being offered.
    assert!(Recovery::find(folder.path()).is_empty());
    let recovered = found.pop().unwrap().recover().unwrap();
    assert_eq!(recovered.warnings, Vec::<String>::new());
    let mut history = recovered.history;
    assert!(history.is_unsaved());
    assert_eq!(history.document(), &document);
    assert_eq!(history.meshes().len(), 1);
    assert_eq!((history.undo_len(), history.redo_len()), (2, 1));
    // It goes on in the same journal.
    history.redo().unwrap();
    history.undo().unwrap();
    history.undo().unwrap();
    let document = history.document().clone();
    drop(history);
    let found = Recovery::find(folder.path()).pop().unwrap();
    assert_eq!(found.steps, 7);
    assert_eq!(found.recover().unwrap().history.document(), &document);
}

#[test]
fn nothing_is_offered_where_nothing_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    drop(journalled(folder.path(), Document::new(), MeshStore::new()));
    assert!(Recovery::find(folder.path()).is_empty());
    let mut history = journalled(folder.path(), Document::new(), MeshStore::new());
    history.add(Object::solid("A", ball(0.1))).unwrap();
    let path = folder.path().join("work.midair");
    save(&path, history.document(), history.meshes()).unwrap();
    history.note_saved(&path);
    assert!(!history.is_unsaved());
    drop(history);
    assert!(Recovery::find(folder.path()).is_empty());
    let mut history = journalled(folder.path(), Document::new(), MeshStore::new());
    history.add(Object::solid("A", ball(0.1))).unwrap();
    history.detach().unwrap().close();
    assert!(Recovery::find(folder.path()).is_empty());
    let mut history = journalled(folder.path(), Document::new(), MeshStore::new());
    history.add(Object::solid("A", ball(0.1))).unwrap();
    drop(history);
    Recovery::find(folder.path())
        .pop()
        .unwrap()
        .discard()
        .unwrap();
    assert!(Recovery::find(folder.path()).is_empty());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    assert!(Recovery::find(&folder.path().join("nowhere")).is_empty());
}

#[test]
fn work_on_a_saved_file_knows_where_it_belongs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("work.midair");
    let mut history = journalled(folder.path(), Document::new(), MeshStore::new());
    history.add(Object::solid("A", ball(0.1))).unwrap();
    save(&path, history.document(), history.meshes()).unwrap();
    history.note_saved(&path);
    history.add(Object::solid("B", ball(0.1))).unwrap();
    drop(history);
    let recovered = Recovery::find(folder.path())
        .pop()
        .unwrap()
        .recover()
        .unwrap();
    assert_eq!(recovered.origin.as_deref(), Some(&*path));
    assert_eq!(recovered.history.document().len(), 2);
}

#[test]
fn a_folder_that_cannot_be_written_is_one_clear_line() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let error = Journal::start(
        &file.join("journal"),
        &Document::new(),
        &MeshStore::new(),
        None,
    );
    let line = error.unwrap_err().to_string();
    assert_eq!(line.lines().count(), 1);
    assert!(
        line.contains("A crash would cost what is not saved"),
        "{line}"
    );
}

#[test]
fn five_autosaves_take_turns() {
    let folder = tempfile::tempdir().unwrap();
    let mut history = History::new(Document::new(), MeshStore::new());
    let mut autosave = Autosave::new(folder.path(), &history);
    let mut now = Duration::from_secs(10);
    for n in 1..=7 {
        history.add(Object::solid("A", ball(0.1))).unwrap();
        assert_eq!(autosave.tick(now, &history), None);
        assert_eq!(autosave.tick(now + Duration::from_secs(2), &history), None);
        assert_eq!(autosave.finish(), None);
        assert_eq!(Autosave::list(folder.path()).len(), (n - 1).min(5));
        now += Duration::from_secs(4);
        assert_eq!(autosave.tick(now, &history), None);
        assert_eq!(autosave.finish(), None);
        let newest = &Autosave::list(folder.path())[0];
        assert_eq!(&open(newest).unwrap().document, history.document());
        // The clock of the disk may be coarse.
        std::thread::sleep(Duration::from_millis(15));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 5);
}

#[test]
fn an_autosave_that_fails_is_said_once() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let mut history = History::new(Document::new(), MeshStore::new());
    let mut autosave = Autosave::new(file.join("autosave"), &history);
    let mut lines = Vec::new();
    for n in 0..3 {
        history.add(Object::solid("A", ball(0.1))).unwrap();
        for pause in [0, 4] {
            let now = Duration::from_secs(10 * n + pause);
            lines.extend(autosave.tick(now, &history));
        }
        lines.extend(autosave.finish());
    }
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert!(lines[0].contains("could not be saved"), "{lines:?}");
}
