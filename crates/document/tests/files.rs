//! `*.midair` files, sound and damaged.

mod support;

use std::fs;
use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};

use midair_document::{
    Document, Edit, History, Kind, MeshStore, Object, ObjectId, OpenError, open, save,
};
use midair_field::{Op, Placement};
use support::{ball, foreign, fuse, mesh_recipe};
use zip::write::SimpleFileOptions;

fn sample() -> History {
    let mut history = History::new(Document::new(), MeshStore::new());
    let meshes = history.meshes().clone();
    history.add(Object::solid("Ball", ball(0.1))).unwrap();
    history.add(foreign(&meshes, 0.3)).unwrap();
    let part = mesh_recipe(&meshes, 0.2);
    let whole = fuse([
        (Op::Union, Placement::IDENTITY, part),
        (
            Op::Subtract,
            Placement::at([0.1, 0.0, -0.0].into()),
            ball(0.05),
        ),
    ]);
    let id = history.add(Object::solid("Fused", whole)).unwrap();
    let op = Some(Op::Subtract);
    history.apply(Edit::SetMark { id, op }).unwrap();
    let edit = history.document().group_edit("Both", &[ObjectId(1), id]);
    history.apply(edit).unwrap();
    history.apply(Edit::SetStep { step: 0.0025 }).unwrap();
    history
}

fn saved(folder: &Path) -> (PathBuf, Vec<u8>) {
    let history = sample();
    let path = folder.join("work.midair");
    let warnings = save(&path, history.document(), history.meshes()).unwrap();
    assert!(warnings.is_empty());
    let bytes = fs::read(&path).unwrap();
    (path, bytes)
}

/// The archive with each entry passed through `change`, which may drop it.
fn rewritten(bytes: &[u8], mut change: impl FnMut(&str, Vec<u8>) -> Option<Vec<u8>>) -> Vec<u8> {
    let mut from = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut to = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for i in 0..from.len() {
        let mut entry = from.by_index(i).unwrap();
        let name = entry.name().unwrap().into_owned();
        let mut content = Vec::new();
        entry.read_to_end(&mut content).unwrap();
        if let Some(content) = change(&name, content) {
            to.start_file(name, SimpleFileOptions::default()).unwrap();
            to.write_all(&content).unwrap();
        }
    }
    to.finish().unwrap().into_inner()
}

fn with_text(bytes: &[u8], change: impl Fn(&str) -> String) -> Vec<u8> {
    rewritten(bytes, |name, content| {
        Some(match name {
            "document.ron" => change(std::str::from_utf8(&content).unwrap()).into_bytes(),
            _ => content,
        })
    })
}

fn line_of(path: &Path) -> String {
    let error = open(path).unwrap_err();
    let line = error.to_string();
    assert_eq!(line.lines().count(), 1, "{line}");
    assert!(line.starts_with(&path.display().to_string()), "{line}");
    assert!(line.len() < 600, "{line}");
    line
}

#[test]
fn saved_opened_and_saved_again_is_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let (path, bytes) = saved(folder.path());
    let opened = open(&path).unwrap();
    assert_eq!(opened.warnings, Vec::<String>::new());
    assert_eq!(&opened.document, sample().document());
    assert_eq!(opened.meshes.len(), 2);
    save(&path, &opened.document, &opened.meshes).unwrap();
    assert!(fs::read(&path).unwrap() == bytes);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn the_text_is_readable_and_says_its_version_first() {
    let text = sample().document().to_ron();
    assert!(text.starts_with("(\n  format: 1,\n"), "{text}");
    assert!(text.contains("radius: 0.1"));
    assert!(text.lines().all(|l| l.len() < 400));
}

#[test]
fn only_meshes_in_use_are_saved() {
    let folder = tempfile::tempdir().unwrap();
    let mut history = sample();
    history.apply(Edit::Remove { id: ObjectId(2) }).unwrap();
    let path = folder.path().join("less.midair");
    save(&path, history.document(), history.meshes()).unwrap();
    assert_eq!(open(&path).unwrap().meshes.len(), 1);
}

#[test]
fn cut_off_anywhere_it_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let (_, bytes) = saved(folder.path());
    let path = folder.path().join("cut.midair");
    for len in (0..bytes.len())
        .step_by(7)
        .chain([1, 2, 3, bytes.len() - 1])
    {
        fs::write(&path, &bytes[..len]).unwrap();
        let line = line_of(&path);
        assert!(line.contains("is cut off or damaged"), "{len}: {line}");
    }
}

#[test]
fn a_changed_byte_anywhere_never_panics() {
    let folder = tempfile::tempdir().unwrap();
    let (_, bytes) = saved(folder.path());
    let path = folder.path().join("changed.midair");
    for at in (0..bytes.len()).step_by(5) {
        let mut bad = bytes.clone();
        bad[at] ^= 0x41;
        fs::write(&path, &bad).unwrap();
        match open(&path) {
            Ok(opened) => assert_eq!(opened.document.check(), Vec::<String>::new()),
            Err(e) => assert_eq!(e.to_string().lines().count(), 1, "{e}"),
        }
    }
}

#[test]
fn bad_files_get_one_clear_line() {
    let folder = tempfile::tempdir().unwrap();
    let (_, bytes) = saved(folder.path());
    let path = folder.path().join("bad.midair");
    let line = |content: Vec<u8>| {
        fs::write(&path, content).unwrap();
        let line = line_of(&path);
        println!("{line}");
        line
    };
    let newer = with_text(&bytes, |t| t.replace("format: 1", "format: 7"));
    assert!(line(newer).contains(
        "was written by a newer Midair (format 7; this one reads up to 1). Update Midair"
    ));
    let strange = with_text(&bytes, |_| "(format: 99, all: <new> syntax!".into());
    assert!(line(strange).contains("(format 99;"));
    assert!(line(b"solid cube\n".to_vec()).contains("it is not a zip archive"));
    assert!(line(Vec::new()).contains("it is empty"));
    let without = rewritten(&bytes, |name, c| (name != "document.ron").then_some(c));
    assert!(line(without).contains("without document.ron"));
    let syntax = with_text(&bytes, |t| t.replace("step: 0.0025", "step: ,"));
    assert!(line(syntax).contains("document.ron: line 3, column "));
    let nan = with_text(&bytes, |t| {
        t.replace("scale: (1.0, 1.0, 1.0)", "scale: (1.0, NaN, 1.0)")
    });
    assert!(line(nan).contains("stands nowhere"));
    let nan = with_text(&bytes, |t| t.replace("radius: 0.1", "radius: NaN"));
    assert!(line(nan).contains("NaN"));
    let step = with_text(&bytes, |t| t.replace("step: 0.0025", "step: -1.0"));
    assert!(line(step).contains("the step -1 m"));
    let id = with_text(&bytes, |t| t.replace("next_id: 5", "next_id: 1"));
    assert!(line(id).contains("was never handed out"));
    let recipe = with_text(&bytes, |t| t.replace("recipe: 0", "recipe: 4000000000"));
    fs::write(&path, recipe).unwrap();
    let _ = open(&path);
    let nested = with_text(&bytes, |t| {
        t.replace(
            "step: 0.0025",
            &format!("step: 0.01, odd: {}", "[".repeat(100_000)),
        )
    });
    assert!(line(nested).contains("nested too deeply"));
    let text = with_text(&bytes, |_| "(".repeat(10));
    line(text);
    fs::remove_file(&path).unwrap();
    assert!(line_of(&path).contains("there is no such file"));
    assert!(line_of(folder.path()).contains("it is a folder"));
}

#[test]
fn an_archive_that_unpacks_without_end_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bomb.midair");
    let mut zip = zip::ZipWriter::new(fs::File::create(&path).unwrap());
    let options = SimpleFileOptions::default();
    zip.start_file("document.ron", options).unwrap();
    zip.write_all(&vec![b' '; 64 << 20]).unwrap();
    zip.finish().unwrap();
    assert!(matches!(open(&path), Err(OpenError::TooLarge { .. })));
    line_of(&path);
}

#[test]
fn a_tower_of_recipes_is_refused() {
    let mut text = String::from(
        "(format: 1, next_id: 1, layers: {0: (name: \"\")}, recipes: [Primitive(Sphere(radius: 1.0)),",
    );
    for i in 0..100_000 {
        text += &format!("Component(id: \"\", recipe: {i}),");
    }
    text += "], objects: {})";
    let error = Document::from_ron(&text).unwrap_err().to_string();
    assert!(error.contains("deep"), "{error}");
}

#[test]
fn objects_whose_mesh_is_gone_stay() {
    let folder = tempfile::tempdir().unwrap();
    let (path, bytes) = saved(folder.path());
    let without = rewritten(&bytes, |name, c| {
        (!name.starts_with("meshes/")).then_some(c)
    });
    fs::write(&path, without).unwrap();
    let opened = open(&path).unwrap();
    assert_eq!(opened.warnings.len(), 2, "{:?}", opened.warnings);
    assert!(opened.warnings[0].contains("it is missing"));
    assert_eq!(&opened.document, sample().document());
    assert_eq!(
        save(&path, &opened.document, &opened.meshes).unwrap().len(),
        2
    );
    assert_eq!(&open(&path).unwrap().document, sample().document());
}

#[test]
fn a_mesh_that_is_not_what_its_name_says_is_kept_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let (path, bytes) = saved(folder.path());
    let other = midair_mesh::to_bytes(&support::tetrahedron(9.0));
    let wrong = |name: &str, content: Vec<u8>| {
        Some(if name.starts_with("meshes/") {
            other.clone()
        } else {
            content
        })
    };
    fs::write(&path, rewritten(&bytes, wrong)).unwrap();
    for _ in 0..2 {
        let opened = open(&path).unwrap();
        assert_eq!(opened.warnings.len(), 2);
        assert!(opened.warnings[0].contains("it is not the mesh its name says"));
        save(&path, &opened.document, &opened.meshes).unwrap();
    }
}

#[test]
fn unknown_fields_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let (path, bytes) = saved(folder.path());
    let more = with_text(&bytes, |t| {
        t.replace("step: 0.0025", "step: 0.0025, weather: \"fine\"")
    });
    fs::write(&path, more).unwrap();
    let opened = open(&path).unwrap();
    assert_eq!(opened.warnings.len(), 1);
    assert!(
        opened.warnings[0].contains("weather"),
        "{:?}",
        opened.warnings
    );
}

#[test]
fn a_file_that_cannot_be_written_keeps_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let (path, bytes) = saved(folder.path());
    let mut permissions = fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&path, permissions).unwrap();
    let empty = (Document::new(), MeshStore::new());
    let error = save(&path, &empty.0, &empty.1).unwrap_err().to_string();
    assert!(error.contains("write-protected"), "{error}");
    assert_eq!(error.lines().count(), 1);
    assert!(fs::read(&path).unwrap() == bytes);
    let nowhere = folder.path().join("missing/work.midair");
    let error = save(&nowhere, &empty.0, &empty.1).unwrap_err().to_string();
    assert!(error.contains("there is no such file or folder"), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn sweeps_sheets_and_rows_of_clones_come_back_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let mut history = History::new(Document::new(), MeshStore::new());
    let (sheet, plate, row) = support::swept();
    let before = history.bytes();
    let id = history
        .add(Object::new("Sheet", Kind::Sheet(sheet.clone())))
        .unwrap();
    history.add(Object::solid("Plate", plate.clone())).unwrap();
    history.add(Object::solid("Row", row)).unwrap();
    let held = history.bytes() - before;
    history
        .apply(Edit::SetKind {
            id,
            kind: Kind::Solid(plate.clone()),
        })
        .unwrap();
    history.undo();
    assert!(held > 0 && history.document().check().is_empty());
    let path = folder.path().join("swept.midair");
    save(&path, history.document(), history.meshes()).unwrap();
    let opened = open(&path).unwrap();
    assert!(opened.warnings.is_empty(), "{:?}", opened.warnings);
    assert_eq!(&opened.document, history.document());
    let object = opened.document.object(id).unwrap();
    assert!(object.sheet().is_some() && object.recipe().is_none() && object.operand().is_none());
    // A surface is no solid, and a solid that is no sweep no surface.
    let open_solid = history.apply(Edit::set_recipe(id, sheet));
    assert!(
        open_solid
            .unwrap_err()
            .to_string()
            .contains("give it a thickness")
    );
    let kind = Kind::Sheet(ball(0.1));
    assert!(history.apply(Edit::SetKind { id, kind }).is_err());
}
