//! Pictures to work from: brought in, moved, sized, hidden, undone, and part of nothing.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use midair_document::{ObjectId, open, save};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Side};
use midair_studio::notice::Notices;
use midair_studio::objects::{Ask, How};
use midair_studio::project::Project;

use crate::desk::Desk;
use crate::studio::{Studio, near};

/// A picture twice as wide as high.
pub fn picture(folder: &Path, name: &str) -> PathBuf {
    let path = folder.join(name);
    let pixel = |x: u32, y: u32| image::Rgb([(x % 256) as u8, (y % 256) as u8, 90]);
    let picture = image::RgbImage::from_fn(200, 100, pixel);
    picture.save(&path).unwrap();
    path
}

fn bring(s: &mut Studio, paths: Vec<PathBuf>, at: Option<Vec3>) {
    s.ask(Command::Reference { paths, at });
    s.settle();
}

fn with_picture() -> (Studio, ObjectId) {
    let mut s = Studio::new();
    let path = picture(s.home.path(), "front view.png");
    bring(&mut s, vec![path], Some(Vec3::new(0.5, 0.0, 0.2)));
    assert!(s.warnings().is_empty(), "{:?}", s.warnings());
    let id = s.only();
    (s, id)
}

#[test]
fn a_picture_stands_upright_where_it_was_put_and_one_step_takes_it_back() {
    let (mut s, id) = with_picture();
    let object = s.object(id);
    assert_eq!(object.name, "front view");
    let [width, height] = object.reference().unwrap().size;
    assert!((width - 0.6).abs() < 1e-6 && (height - 0.3).abs() < 1e-6);
    near(
        object.placement.translation,
        Vec3::new(0.5, 0.15, 0.2),
        1e-6,
    );
    s.ask(Command::Undo);
    assert!(s.document().is_empty());
    s.ask(Command::Redo);
    s.settle();
    assert_eq!(s.only(), id);
    // Several stand beside each other.
    let folder = s.home.path().to_owned();
    let more = vec![picture(&folder, "a.png"), picture(&folder, "b.jpg")];
    bring(&mut s, more, None);
    let mut xs: Vec<_> = s
        .document()
        .objects()
        .skip(1)
        .map(|(_, o)| o.placement.translation.x)
        .collect();
    xs.sort_by(f32::total_cmp);
    assert_eq!(xs.len(), 2);
    assert!(xs[1] - xs[0] > 0.6, "{xs:?}");
}

#[test]
fn a_hand_takes_it_and_a_locked_one_is_passed_through() {
    let (mut s, id) = with_picture();
    let middle = s.placement(id).translation;
    s.reach(Side::Right, middle + Vec3::Z * 0.01);
    assert_eq!(s.touched(Side::Right), Some(id));
    s.press(Side::Right, Action::Grab);
    s.carry_right(middle + Vec3::new(0.3, 0.2, 0.01));
    near(
        s.shown(id).translation,
        middle + Vec3::new(0.3, 0.2, 0.0),
        1e-4,
    );
    let steps = s.undo_len();
    s.let_go(Side::Right, Action::Grab);
    assert_eq!(s.undo_len(), steps + 1);
    let there = s.placement(id).translation;
    let ids = vec![id];
    s.ask(Command::Objects(Ask::Locked { ids, locked: true }));
    s.frames(4);
    s.reach(Side::Left, there);
    assert_eq!(s.touched(Side::Left), None);
}

#[test]
fn its_width_is_set_by_a_number_and_its_opacity_too() {
    let (mut s, id) = with_picture();
    s.ask(Command::Objects(Ask::Picture {
        id,
        width: Some(1.2),
        opacity: None,
    }));
    let size = s.object(id).reference().unwrap().size;
    assert!((size[0] - 1.2).abs() < 1e-6 && (size[1] - 0.6).abs() < 1e-6);
    // It is touched at its new edge.
    s.settle();
    let edge = s.placement(id).translation + Vec3::X * 0.59;
    s.reach(Side::Right, edge);
    assert_eq!(s.touched(Side::Right), Some(id));
    for (opacity, then) in [(0.25, 0.25), (7.0, 1.0), (-1.0, 0.0), (f32::NAN, 0.0)] {
        s.ask(Command::Objects(Ask::Picture {
            id,
            width: None,
            opacity: Some(opacity),
        }));
        assert_eq!(s.object(id).reference().unwrap().opacity, then);
    }
    for width in [f32::NAN, 0.0, -3.0, f32::INFINITY] {
        s.ask(Command::Objects(Ask::Picture {
            id,
            width: Some(width),
            opacity: None,
        }));
        assert!(s.object(id).reference().unwrap().is_sound());
    }
}

#[test]
fn it_is_no_operand_and_no_part_of_what_is_written() {
    let (mut s, id) = with_picture();
    s.reach(Side::Right, Vec3::new(0.0, 4.0, 0.0));
    s.operate();
    let at = s.placement(id).translation;
    s.mark(at, Action::Up);
    assert!(s.marks().is_empty());
    assert_eq!(s.warnings().len(), 1, "{:?}", s.warnings());
    let path = s.home.path().join("out.stl");
    let export = |only| Command::Export {
        path: path.clone(),
        step: None,
        unit: None,
        up: None,
        only,
    };
    s.ask(export(None));
    s.settle();
    s.ask(export(Some(id)));
    s.settle();
    assert!(!path.exists());
    assert_eq!(s.warnings().len(), 3, "{:?}", s.warnings());
    let cube = s.place("solid/cube", Vec3::new(-0.5, 0.5, 0.0));
    s.ask(export(None));
    s.settle();
    let written = midair_mesh::read(&path).unwrap().mesh;
    assert!((written.volume() - s.mesh(cube, 0.02).volume()).abs() < 1e-4);
}

#[test]
fn what_is_no_picture_is_one_line_each() {
    let mut s = Studio::new();
    let folder = s.home.path().to_owned();
    let whole = std::fs::read(picture(&folder, "whole.png")).unwrap();
    let mut paths = vec![folder.join("gone.png")];
    for (name, bytes) in [
        ("cut.png", &whole[..whole.len() / 3]),
        ("text.png", &b"hello"[..]),
        ("empty.jpg", &b""[..]),
    ] {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        paths.push(path);
    }
    bring(&mut s, paths, None);
    assert!(s.document().is_empty());
    assert_eq!(s.warnings().len(), 4, "{:?}", s.warnings());
    for name in ["gone.png", "cut.png", "text.png", "empty.jpg"] {
        let of: Vec<_> = s
            .warnings()
            .iter()
            .filter(|w| w.starts_with(name))
            .collect();
        assert_eq!(of.len(), 1, "{name}: {:?}", s.warnings());
        assert_eq!(of[0].lines().count(), 1);
    }
}

#[test]
fn it_travels_with_the_document_and_is_drawn_again() {
    let (mut s, id) = with_picture();
    let path = s.home.path().join("work.midair");
    let project = s.world().resource::<Project>();
    save(&path, project.document(), project.meshes()).unwrap();
    let before = s.document().clone();
    s.ask(Command::Open(path.clone()));
    s.settle();
    assert_eq!(*s.document(), before);
    let at = s.placement(id).translation;
    s.reach(Side::Right, at);
    assert_eq!(s.touched(Side::Right), Some(id));
    let opened = open(&path).unwrap();
    let image = opened
        .document
        .object(id)
        .unwrap()
        .reference()
        .unwrap()
        .image;
    assert!(opened.meshes.image(image).is_some());
}

#[test]
fn several_things_are_done_with_it_as_with_any_object() {
    let (mut s, id) = with_picture();
    s.ask(Command::Objects(Ask::Select {
        ids: vec![id],
        how: How::Set,
    }));
    s.ask(Command::Objects(Ask::Duplicate));
    assert_eq!(s.document().len(), 2);
    s.ask(Command::Objects(Ask::Visible {
        ids: vec![id],
        visible: false,
    }));
    s.frames(4);
    assert!(!s.document().is_visible(id));
    s.ask(Command::Objects(Ask::Delete));
    assert_eq!(s.document().len(), 1);
}

#[test]
fn dropped_on_the_view_it_stands_there_and_meshes_go_their_own_way() {
    let mut desk = Desk::new();
    let folder = desk.home.path().to_owned();
    let files = [picture(&folder, "side.JPG"), folder.join("note.txt")];
    std::fs::write(&files[1], b"no mesh").unwrap();
    let spot = desk.pixel(Vec3::new(0.2, 0.0, 0.1));
    desk.cursor(spot);
    desk.wait(3);
    desk.drop_files(&files);
    desk.settle();
    let (_, object) = desk.document().objects().next().expect("the picture");
    assert!(object.reference().is_some());
    let foot = object.placement.translation - Vec3::Y * 0.15;
    near(foot, Vec3::new(0.2, 0.0, 0.1), 0.01);
    assert_eq!(desk.document().len(), 1);
    assert_eq!(desk.warnings().len(), 1, "{:?}", desk.warnings());
    let notices = desk.world().resource::<Notices>();
    assert!(notices.recent(1e9).any(|n| n.text.contains("note.txt")));
}
