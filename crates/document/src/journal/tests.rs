use std::fs::{self, File};
use std::path::Path;

use midair_field::{Placement, Primitive};

use super::recovery::replay;
use super::{JOURNAL, MESHES};
use crate::{Document, Edit, History, Journal, MeshStore, Object, ObjectId, Recovery};

fn started(folder: &Path) -> History {
    let (document, meshes) = (Document::new(), MeshStore::new());
    let journal = Journal::start(folder, &document, &meshes, None).unwrap();
    let mut history = History::new(document, meshes);
    history.attach(journal);
    history
}

fn ball() -> Object {
    Object::solid("Ball", Primitive::Sphere { radius: 0.1 })
}

#[test]
fn cut_off_at_any_byte_it_gives_back_all_that_was_whole() {
    let folder = tempfile::tempdir().unwrap();
    let mut history = started(folder.path());
    let mut states = vec![history.document().clone()];
    for i in 0..6_u8 {
        let id = history.add(ball()).unwrap();
        states.push(history.document().clone());
        let placement = Placement::at([f32::from(i) + 1.0, 0.0, 0.0].into());
        history.apply(Edit::SetPlacement { id, placement }).unwrap();
        states.push(history.document().clone());
        if i % 2 == 0 {
            history.undo().unwrap();
            states.push(history.document().clone());
            history.redo().unwrap();
            states.push(history.document().clone());
        }
    }
    let bytes = fs::read(history.journal().unwrap().folder().join(JOURNAL)).unwrap();
    let mut reached = None;
    for len in 0..=bytes.len() {
        let Ok(replay) = replay(&bytes[..len], &folder.path().join(MESHES)) else {
            assert_eq!(reached, None, "{len}");
            continue;
        };
        assert!(replay.warnings.is_empty());
        let from = reached.unwrap_or(0);
        let at = states[from..]
            .iter()
            .position(|s| s == replay.history.document())
            .unwrap_or_else(|| panic!("{len}: a state that never was"));
        assert!(at <= 1, "{len}: steps skipped");
        reached = Some(from + at);
    }
    assert_eq!(reached, Some(states.len() - 1));
    // A byte that changed cuts the rest off.
    for at in (0..bytes.len()).step_by(3) {
        let mut bad = bytes.clone();
        bad[at] ^= 0x20;
        if let Ok(replay) = replay(&bad, folder.path()) {
            assert!(states.contains(replay.history.document()));
            assert!(replay.end <= at as u64);
        }
    }
}

#[test]
fn a_torn_end_is_cut_before_the_work_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let mut history = started(folder.path());
    history.add(ball()).unwrap();
    let path = history.journal().unwrap().folder().join(JOURNAL);
    drop(history);
    let mut bytes = fs::read(&path).unwrap();
    bytes.extend(b"\x40\0\0\0torn");
    fs::write(&path, bytes).unwrap();
    let found = Recovery::find(folder.path()).pop().unwrap();
    let mut history = found.recover().unwrap().history;
    history.add(ball()).unwrap();
    drop(history);
    let found = Recovery::find(folder.path()).pop().unwrap();
    assert_eq!(found.recover().unwrap().history.document().len(), 2);
}

#[test]
fn a_full_disk_costs_nothing_and_is_said_once() {
    let Ok(full) = File::options().append(true).open("/dev/full") else {
        println!("skipped: there is no /dev/full here");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut history = started(folder.path());
    history.add(ball()).unwrap();
    let mut journal = history.detach().unwrap();
    let real = std::mem::replace(&mut journal.file, full);
    history.attach(journal);
    let mut warnings = Vec::new();
    for _ in 0..3 {
        history.add(ball()).unwrap();
        warnings.extend(history.take_warnings());
    }
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains("the disk is full"), "{warnings:?}");
    assert_eq!(warnings[0].lines().count(), 1);
    assert_eq!(history.document().len(), 4);
    // Room again: the next step brings the journal up to date, and steps before it can be undone.
    let mut journal = history.detach().unwrap();
    journal.file = real;
    history.attach(journal);
    history.apply(Edit::Remove { id: ObjectId(1) }).unwrap();
    history.undo().unwrap();
    history.undo().unwrap();
    assert_eq!(history.take_warnings(), Vec::<String>::new());
    let document = history.document().clone();
    drop(history);
    let found = Recovery::find(folder.path()).pop().unwrap();
    assert_eq!(found.recover().unwrap().history.document(), &document);
}

#[test]
fn a_journal_damaged_from_its_start_is_offered_and_refused_with_a_line() {
    let folder = tempfile::tempdir().unwrap();
    let mut history = started(folder.path());
    history.add(ball()).unwrap();
    let path = history.journal().unwrap().folder().join(JOURNAL);
    drop(history);
    fs::write(&path, "nonsense").unwrap();
    let found = Recovery::find(folder.path()).pop().unwrap();
    let line = found.recover().unwrap_err().to_string();
    assert!(line.contains("is damaged from its start"), "{line}");
    assert!(path.exists());
}
