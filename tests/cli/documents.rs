//! Documents that are damaged, from elsewhere, or outlive their library.

use crate::archive::of_one;
use crate::place::{CUBE, Place};

/// Nothing that takes a document takes this one.
fn refused(place: &Place, name: &str, words: &[&str]) {
    let words = [&[name], words].concat();
    place.session("Wait(0.1)");
    place.refused(&["check", name], &words);
    place.refused(&["export", name, "--to", "out.stl"], &words);
    place.refused(&["play", "session.ron", "--open", name], &words);
    assert!(!place.path("out.stl").exists());
}

#[test]
fn documents_that_cannot_be_read_are_named() {
    let place = Place::new();
    place.session(CUBE);
    place.done(&["play", "session.ron", "--save", "whole.midair"]);
    let whole = place.read("whole.midair");
    for part in [0.1, 0.5, 0.9, 0.99] {
        place.write("cut.midair", &whole[..(part * whole.len() as f64) as usize]);
        refused(&place, "cut.midair", &["cut off or damaged"]);
    }
    let mut spoiled = whole.clone();
    for byte in &mut spoiled[60..70] {
        *byte ^= 0x55;
    }
    place.write("spoiled.midair", spoiled);
    refused(&place, "spoiled.midair", &[]);
    place.write("text.midair", "not a zip");
    refused(&place, "text.midair", &["no Midair document"]);
    place.write("empty.midair", "");
    refused(&place, "empty.midair", &[]);
    place.write("other.midair", of_one("readme.txt", b"hello"));
    refused(&place, "other.midair", &[]);
    refused(&place, "none.midair", &["no such file"]);
    std::fs::create_dir(place.path("folder.midair")).unwrap();
    refused(&place, "folder.midair", &["folder"]);
}

#[test]
fn a_document_of_a_newer_midair_is_told_apart() {
    let place = Place::new();
    let newer = b"(format: 99, step: 0.01, wonders: [(new: true)])";
    place.write("newer.midair", of_one("document.ron", newer));
    refused(&place, "newer.midair", &["newer Midair", "Update"]);
    let broken = b"(format: 1, step: 0.01, objects: {";
    place.write("broken.midair", of_one("document.ron", broken));
    refused(&place, "broken.midair", &["document.ron"]);
}

#[test]
fn an_empty_document_exports_nothing_and_says_so() {
    let place = Place::new();
    place.session("Wait(0.1)");
    place.done(&["play", "session.ron", "--save", "empty.midair"]);
    place.done(&["check", "empty.midair"]);
    place.refused(
        &["export", "empty.midair", "--to", "out.stl"],
        &["out.stl", "nothing that can be seen", "add a solid"],
    );
}

#[test]
fn a_document_outlives_its_library() {
    let place = Place::new();
    // A wedge of one's own.
    place.write(
        "wedge.obj",
        "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 3\nv 2 0 3\nv 0 1 3\n\
         f 1 3 2\nf 4 5 6\nf 1 2 5 4\nf 2 3 6 5\nf 3 1 4 6\n",
    );
    let said = place.done(&["import", "wedge.obj"]);
    let id = said.split_whitespace().next().unwrap().to_owned();
    place.session(&format!(
        r#"Click(Right, Library),
        Move(hand: Right, to: (0, 1, 0)),
        Ask(Place(component: "{id}", side: Right)),
        Wait(0.2),
        Move(hand: Right, to: (0.15, 1.05, 0)),
        Ask(Place(component: "solid/sphere", side: Right)),
        Ask(Edit(SetPending(pending: [(1, Union), (2, Subtract)]))),
        Ask(Tool(tool: "csg", ask: "update")),
        Expect(objects: 1, closed: true),"#
    ));
    place.done(&[
        "play",
        "session.ron",
        "--save",
        "a.midair",
        "--export",
        "a.stl",
    ]);
    std::fs::remove_dir_all(place.path("home")).unwrap();
    assert!(!place.done(&["library"]).contains(&id));
    place.done(&["check", "a.midair"]);
    place.done(&["export", "a.midair", "--to", "b.stl"]);
    place.session("Expect(objects: 1, closed: true, warnings: 0)");
    place.done(&[
        "play",
        "session.ron",
        "--open",
        "a.midair",
        "--save",
        "b.midair",
        "--export",
        "c.stl",
    ]);
    assert_eq!(
        place.read("a.midair"),
        place.read("b.midair"),
        "saved again it is the same"
    );
    assert_eq!(place.read("a.stl"), place.read("b.stl"));
    assert_eq!(place.read("a.stl"), place.read("c.stl"));
}
