//! What Brush says to bad input, and what becomes of it.

use bevy::prelude::*;
use midair_brush::{Ask, BRUSH, called, canvas};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::notice::Notices;
use midair_studio::project::Shelf;
use midair_studio::settings::Settings;

use crate::studio::Studio;

const HERE: Vec3 = Vec3::new(0.2, 1.0, 0.1);

fn painter(skeleton: &str, radius: f32) -> Studio {
    let mut s = Studio::new();
    s.ask(Command::Mode(BRUSH));
    s.ask(Command::Set {
        key: "brush.skeleton".into(),
        value: format!("\"{skeleton}\""),
    });
    s.ask(Settings::command("brush.radius", radius));
    s.frames(2);
    s
}

fn dab(s: &mut Studio, at: Vec3) {
    s.reach(Side::Right, at);
    s.click(Side::Right, Action::Act);
}

/// Everything that was said, warnings or not.
fn said(s: &Studio) -> String {
    let recent = s.world().resource::<Notices>().recent(1e6);
    let lines: Vec<String> = recent.map(|n| format!("{n:?}")).collect();
    lines.join("\n")
}

#[test]
fn a_polygon_out_of_plane_is_brought_into_one_and_one_without_area_is_refused() {
    let mut s = painter("Polygon", 0.03);
    for (x, y, z) in [
        (0.0, 0.0, 0.0),
        (0.3, 0.1, 0.0),
        (0.3, 0.0, 0.3),
        (0.0, 0.1, 0.3),
    ] {
        dab(&mut s, HERE + Vec3::new(x, y, z));
    }
    s.click(Side::Right, Action::Finish);
    assert!(said(&s).contains("50 mm beside one plane"), "{}", said(&s));
    assert_eq!(s.warnings(), [] as [String; 0]);
    s.settle();
    let flat = s.mesh(s.only(), 0.01).bounds().size();
    assert!(flat.y < 0.08, "{flat}");
    s.faultless(s.only(), 0.01);

    let mut s = painter("Polygon", 0.03);
    for x in [0.0, 0.1, 0.2, 0.3] {
        dab(&mut s, HERE + Vec3::X * x);
    }
    s.click(Side::Right, Action::Finish);
    assert!(s.document().is_empty());
    assert!(s.warnings().last().unwrap().contains("enclose nothing"));
}

#[test]
fn a_brush_finer_than_the_step_is_told_with_the_step_that_shows_it() {
    let mut s = painter("Point", 0.004);
    dab(&mut s, HERE);
    assert!(said(&s).contains("set the step to 5.3 mm"), "{}", said(&s));
    assert!(!s.mesh(s.only(), 0.0053).triangles.is_empty());
    s.ask(Command::Undo);
    let before = said(&s).len();
    s.ask(Command::Edit(midair_document::Edit::SetStep {
        step: 0.0053,
    }));
    dab(&mut s, HERE);
    assert_eq!(said(&s).len(), before, "nothing more to say: {}", said(&s));

    // What even the finest step does not show.
    let mut s = painter("Point", 0.001);
    s.ask(Ask::New.command());
    s.ask(Command::Edit(midair_document::Edit::SetStep {
        step: 0.002,
    }));
    dab(&mut s, HERE);
    assert!(said(&s).contains("set the step to 1.3 mm"), "{}", said(&s));
    s.ask(Settings::command("brush.strength", 1.0));
    s.ask(Ask::Resize(0, 0.5).command());
    assert!(said(&s).contains("no step shows it"), "{}", said(&s));
}

#[test]
fn a_mesh_without_volume_is_no_brush() {
    let flat = "v 0 0 0\nv 0.1 0 0\nv 0.1 0 0.1\nv 0 0 0.1\nf 1 2 3 4\n";
    // Two leaves, whose box is not flat and which enclose nothing all the same.
    let bent = format!("{flat}v 0 0.1 0\nv 0.1 0.1 0\nf 1 2 6 5\n");
    for (name, text) in [("flat", flat), ("bent", bent.as_str())] {
        let mut s = painter("Volume", 0.03);
        let path = s.home.path().join(format!("{name}.obj"));
        std::fs::write(&path, text).unwrap();
        s.ask(Command::Import(vec![path]));
        s.settle();
        s.ask(Ask::Volume(format!("own/{name}")).command());
        s.put(Side::Right, Pose::at(HERE));
        s.frames(2);
        s.settle();
        s.click(Side::Right, Action::Act);
        s.settle();
        assert!(s.document().is_empty(), "{name}");
        let line = s.warnings().last().expect(name);
        assert!(line.contains("has no volume"), "{name}: {line}");
    }
}

#[test]
fn a_stroke_with_poses_that_are_none_goes_on_where_the_hand_was() {
    for skeleton in ["Line", "Polygon", "Volume"] {
        let mut s = painter(skeleton, 0.03);
        s.reach(Side::Right, HERE);
        s.frames(2);
        s.settle();
        s.press(Side::Right, Action::Act);
        s.put(Side::Right, Pose::at(Vec3::splat(f32::NAN)));
        s.frames(5);
        s.put(Side::Right, Pose::at(HERE + Vec3::X * 0.1));
        s.frames(2);
        s.let_go(Side::Right, Action::Act);
        if skeleton == "Polygon" {
            for (x, z) in [(0.1, 0.0), (0.1, 0.1), (0.0, 0.1)] {
                dab(&mut s, HERE + Vec3::new(x, 0.0, z));
            }
            s.click(Side::Right, Action::Finish);
        }
        s.settle();
        s.faultless(s.only(), 0.01);
    }
}

#[test]
fn a_stroke_with_a_volume_is_called_as_the_library_calls_it() {
    let mut s = painter("Volume", 0.03);
    s.ask(Ask::Volume("brush/cat".into()).command());
    dab(&mut s, HERE);
    s.ask(Ask::Erase(0, true).command());
    let shelf = s.world().resource::<Shelf>();
    let object = s.object(s.only());
    let strokes = &canvas(object).expect("a painting").strokes;
    assert_eq!(called(&strokes[0], shelf), "Erased cat");
    let painted = midair_field::Stroke {
        erase: false,
        ..strokes[0].clone()
    };
    assert_eq!(called(&painted, shelf), "Cat");
}

#[test]
fn a_mesh_pressed_before_its_ghost_is_there_paints_nothing_and_says_so() {
    let cube = "v 0 0 0\nv 0.1 0 0\nv 0.1 0.1 0\nv 0 0.1 0\nv 0 0 0.1\nv 0.1 0 0.1\nv 0.1 0.1 0.1\nv 0 0.1 0.1\n\
        f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let mut s = painter("Volume", 0.03);
    let path = s.home.path().join("box.obj");
    std::fs::write(&path, cube).unwrap();
    s.ask(Command::Import(vec![path]));
    s.settle();
    s.put(Side::Right, Pose::at(HERE));
    s.frames(1);
    // In the frame in which it is chosen, nothing of it is made.
    let before = s.warnings().len();
    s.send(Ask::Volume("own/box".into()).command());
    s.press(Side::Right, Action::Act);
    s.let_go(Side::Right, Action::Act);
    assert!(s.document().is_empty());
    let told = &s.warnings()[before..];
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].contains("still being made ready"), "{told:?}");
    s.settle();
    s.frames(2);
    s.click(Side::Right, Action::Act);
    s.settle();
    s.faultless(s.only(), 0.01);
}
