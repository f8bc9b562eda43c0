//! Killed at any moment, the program loses nothing it had committed.

mod support;

use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use midair_document::{Document, Edit, History, Journal, MeshStore, Object, ObjectId, Recovery};
use midair_field::Placement;

const FOLDER: &str = "MIDAIR_CRASH_TEST_FOLDER";

/// Not a test by itself: what the other test starts and kills. Commits for ever, and says after
/// each commit how many there were.
#[test]
fn worker() {
    let Some(folder) = std::env::var_os(FOLDER) else {
        return;
    };
    let folder = Path::new(&folder);
    let mut history = match Recovery::find(folder).pop() {
        Some(found) => found.recover().unwrap().history,
        None => {
            let mut history = History::new(Document::new(), MeshStore::new());
            let (document, meshes) = (history.document(), history.meshes());
            let journal = Journal::start(folder, document, meshes, None).unwrap();
            history.attach(journal);
            history
        }
    };
    let mut out = std::io::stdout().lock();
    loop {
        let n = count(history.document()) + 1;
        let object = match n % 50 {
            0 => support::foreign(history.meshes(), n as f32),
            _ => Object::solid("Ball", support::ball(0.1)),
        };
        history.begin("Work").unwrap();
        // The number of commits is written into the document itself.
        if history.document().is_empty() {
            history.add(Object::solid("0", support::ball(0.1))).unwrap();
        }
        let id = history.add(object).unwrap();
        let placement = Placement::at([n as f32, 0.0, 0.0].into());
        history.apply(Edit::SetPlacement { id, placement }).unwrap();
        if n > 20 {
            history
                .apply(Edit::Remove {
                    id: ObjectId(id.0 - 8),
                })
                .unwrap();
        }
        let (id, name) = (ObjectId(1), n.to_string());
        history.apply(Edit::Rename { id, name }).unwrap();
        assert!(history.commit());
        if u64::is_multiple_of(n, 7) {
            history.undo().unwrap();
            history.redo().unwrap();
        }
        assert!(history.take_warnings().is_empty());
        writeln!(out, "committed {n}").unwrap();
        out.flush().unwrap();
    }
}

fn count(document: &Document) -> u64 {
    document
        .object(ObjectId(1))
        .map_or(0, |o| o.name.parse().unwrap())
}

fn start(folder: &Path) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "worker", "--nocapture", "--test-threads=1"])
        .env(FOLDER, folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::inherit())
        .spawn()
        .unwrap()
}

#[test]
fn killed_fifty_times_it_loses_nothing() {
    if std::env::var_os(FOLDER).is_some() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut seed = u64::from(std::process::id()) | 1;
    let mut printed = 0;
    for round in 0..50 {
        let mut child = start(folder.path());
        let mut out = child.stdout.take().unwrap();
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1);
        std::thread::sleep(Duration::from_micros(seed >> 33 & 0xffff));
        child.kill().unwrap();
        child.wait().unwrap();
        let mut text = String::new();
        out.read_to_string(&mut text).unwrap();
        // A line that was cut off was not said.
        let said = text.split_inclusive('\n').filter(|l| l.ends_with('\n'));
        let mut said = said.filter_map(|l| l.trim_end().strip_prefix("committed ")?.parse().ok());
        let last: Option<u64> = said.next_back();
        printed = last.unwrap_or(0).max(printed);

        let mut found = Recovery::find(folder.path());
        assert!(found.len() <= 1, "round {round}");
        let Some(found) = found.pop() else {
            assert_eq!(printed, 0, "round {round}");
            continue;
        };
        let recovered = found.recover().unwrap();
        assert_eq!(recovered.warnings, Vec::<String>::new());
        let document = recovered.history.document();
        assert!(count(document) >= printed, "round {round}");
        assert_eq!(document.check(), Vec::<String>::new());
        let meshes = recovered.history.meshes();
        assert_eq!(document.check_meshes(meshes), Vec::<String>::new());
    }
    println!("{printed} commits survived fifty kills");
    assert!(printed > 50);
}
