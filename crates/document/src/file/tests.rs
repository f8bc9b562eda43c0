use std::fs::File;
use std::io::Write;

use crate::{Document, MeshStore};

/// A device that is always full stands for a disk that is.
#[test]
fn a_full_disk_leaves_the_old_file() {
    let Ok(full) = File::options().write(true).open("/dev/full") else {
        println!("skipped: there is no /dev/full here");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("work.midair");
    crate::save(&path, &Document::new(), &MeshStore::new()).unwrap();
    let before = std::fs::read(&path).unwrap();
    let bytes = super::save::archive(&Document::new(), &MeshStore::new()).unwrap();
    let failed = super::atomic::replace(&path, |_| (&full).write_all(&bytes));
    assert_eq!(super::reason(&failed.unwrap_err()), "the disk is full");
    assert!(std::fs::read(&path).unwrap() == before);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    assert!(crate::open(&path).is_ok());
}
