//! Reference images: in the file, in the journal, and sound.

use std::fs;

use midair_document::{
    Document, Edit, EditError, History, ImageHash, Journal, Kind, MeshStore, Object, ObjectId,
    Recovery, Reference, open, save,
};

/// What a document keeps is bytes; whether they are a picture is found where it is brought in.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n and then some";
const JPEG: &[u8] = b"\xff\xd8\xff and then some";

fn reference(image: ImageHash) -> Reference {
    Reference {
        image,
        size: [0.4, 0.3],
        opacity: 0.8,
    }
}

fn two() -> History {
    let mut history = History::new(Document::new(), MeshStore::new());
    for (name, bytes) in [("Front", PNG), ("Side", JPEG)] {
        let image = history.meshes().insert_image(bytes);
        let kind = Kind::Reference(reference(image));
        history.add(Object::new(name, kind)).unwrap();
    }
    history
}

#[test]
fn a_picture_travels_in_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("work.midair");
    let history = two();
    let warnings = save(&path, history.document(), history.meshes()).unwrap();
    assert_eq!(warnings, [] as [String; 0]);
    let first = fs::read(&path).unwrap();
    let opened = open(&path).unwrap();
    assert_eq!(opened.warnings, [] as [String; 0]);
    assert_eq!(opened.document, *history.document());
    for bytes in [PNG, JPEG] {
        let kept = opened.meshes.image(ImageHash::of(bytes)).unwrap();
        assert_eq!(&kept[..], bytes);
    }
    save(&path, &opened.document, &opened.meshes).unwrap();
    assert!(fs::read(&path).unwrap() == first, "the same bytes again");
}

#[test]
fn a_lost_picture_is_one_line_and_its_object_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("work.midair");
    let history = two();
    let warnings = save(&path, history.document(), &MeshStore::new()).unwrap();
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    let opened = open(&path).unwrap();
    assert_eq!(opened.document, *history.document());
    assert_eq!(opened.warnings.len(), 2, "{:?}", opened.warnings);
    for line in &opened.warnings {
        assert!(
            line.contains("picture") && line.lines().count() == 1,
            "{line}"
        );
    }
}

#[test]
fn a_crash_loses_no_picture() {
    let folder = tempfile::tempdir().unwrap();
    let mut history = History::new(Document::new(), MeshStore::new());
    let journal = Journal::start(folder.path(), history.document(), history.meshes(), None);
    history.attach(journal.unwrap());
    let image = history.meshes().insert_image(PNG);
    let kind = Kind::Reference(reference(image));
    history.add(Object::new("Front", kind)).unwrap();
    let before = history.document().clone();
    // As when the program ends without a word.
    drop(history);
    let found = Recovery::find(folder.path()).remove(0);
    let recovered = found.recover().unwrap();
    assert_eq!(recovered.warnings, [] as [String; 0]);
    assert_eq!(*recovered.history.document(), before);
    let kept = recovered.history.meshes().image(image).unwrap();
    assert_eq!(&kept[..], PNG);
}

#[test]
fn impossible_sizes_are_refused_and_a_width_keeps_the_proportion() {
    let mut history = two();
    let image = ImageHash::of(PNG);
    for (size, opacity) in [
        ([0.0, 0.3], 1.0),
        ([f32::NAN, 0.3], 1.0),
        ([0.4, f32::INFINITY], 1.0),
        ([-0.4, 0.3], 1.0),
        ([0.4, 0.3], 1.5),
        ([0.4, 0.3], f32::NAN),
    ] {
        let kind = Kind::Reference(Reference {
            image,
            size,
            opacity,
        });
        let id = ObjectId(1);
        let refused = history.apply(Edit::SetKind { id, kind });
        assert_eq!(refused, Err(EditError::Reference));
    }
    let wide = reference(image).at_width(1.2);
    assert!((wide.size[1] - 0.9).abs() < 1e-6, "{:?}", wide.size);
    for width in [0.0, -1.0, 1e9, f32::NAN, f32::INFINITY] {
        assert!(reference(image).at_width(width).is_sound(), "{width}");
    }
    assert_eq!(
        history.document().object(ObjectId(1)).unwrap().operand(),
        None
    );
}
