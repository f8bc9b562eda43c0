//! Work that is not saved is never thrown away silently; files by command.

use std::time::{Duration, Instant};

use bevy::prelude::*;
use midair_studio::command::Command;
use midair_studio::evaluate::Evaluations;
use midair_studio::objects::{Ask, How};
use midair_studio::panel::{Panels, triangles};
use midair_studio::project::{Answer, Leaving, Project, Then};
use midair_studio::settings::Settings;

use crate::studio::Studio;

fn asked(s: &Studio) -> bool {
    let open = s.world().resource::<Panels>().is_open("leave");
    assert_eq!(open, s.world().resource::<Leaving>().then().is_some());
    open
}

fn unsaved() -> Studio {
    let mut s = Studio::new();
    s.place("solid/cube", Vec3::Y);
    assert!(s.world().resource::<Project>().history().is_unsaved());
    s
}

#[test]
fn a_new_document_asks_first_and_cancel_stays() {
    let mut s = unsaved();
    s.ask(Command::Leave(Then::New));
    assert!(asked(&s));
    s.ask(Command::Answer(Answer::Stay));
    s.frames(4);
    assert!(!asked(&s));
    assert_eq!(s.document().len(), 1);
    // Put away by its corner, it is as if nothing had been asked.
    s.ask(Command::Leave(Then::New));
    s.ask(Command::Panel {
        id: "leave".into(),
        open: false,
    });
    assert!(!asked(&s));
    assert_eq!(s.document().len(), 1);
}

#[test]
fn what_is_given_up_is_gone_and_what_is_saved_is_there() {
    let mut s = unsaved();
    s.ask(Command::Leave(Then::New));
    s.ask(Command::Answer(Answer::Discard));
    s.frames(4);
    assert!(s.document().is_empty());
    s.place("solid/cube", Vec3::Y);
    s.ask(Command::Leave(Then::New));
    s.ask(Command::Answer(Answer::Save));
    s.settle();
    s.frames(4);
    assert!(s.document().is_empty(), "saved, then a new one");
    let recent = s.world().resource::<Settings>().files.recent.clone();
    assert_eq!(recent.len(), 1);
    s.ask(Command::Leave(Then::Open(recent[0].clone())));
    assert!(!asked(&s), "an untouched document needs no question");
    s.settle();
    assert_eq!(s.document().len(), 1);
}

#[test]
fn a_save_that_fails_keeps_the_work() {
    let mut s = unsaved();
    // Where the work folder should be, there is a file.
    let work = s.world().resource::<Project>().work_folder().to_owned();
    std::fs::create_dir_all(work.parent().unwrap()).unwrap();
    std::fs::write(&work, "in the way").unwrap();
    s.ask(Command::Leave(Then::Quit));
    s.ask(Command::Answer(Answer::Save));
    let since = Instant::now();
    while s.world().resource::<Leaving>().then().is_some() {
        s.frame();
        assert!(since.elapsed() < Duration::from_secs(20), "never said");
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(s.document().len(), 1);
    assert!(s.world().resource::<Messages<AppExit>>().is_empty());
    assert!(
        s.warnings().iter().any(|w| w.contains("stays open")),
        "{:?}",
        s.warnings()
    );
}

#[test]
fn the_number_of_triangles_is_known_beforehand() {
    let mut s = Studio::new();
    let ball = s.place("solid/sphere", Vec3::Y);
    let cone = s.place("solid/cone", Vec3::new(1.0, 1.0, 0.0));
    s.settle();
    for step in [0.012, 0.006] {
        let told = {
            let world = s.world();
            let evaluations = world.resource::<Evaluations>();
            triangles(evaluations, s.document(), &[ball, cone], step).unwrap()
        };
        let real = s.mesh(ball, step).triangles.len() + s.mesh(cone, step).triangles.len();
        let off = told as f64 / real as f64;
        assert!((0.8..1.2).contains(&off), "{told} for {real} at {step}");
    }
}

#[test]
fn one_object_alone_is_exported() {
    let mut s = Studio::new();
    let ball = s.place("solid/sphere", Vec3::Y);
    s.place("solid/cube", Vec3::new(2.0, 1.0, 0.0));
    s.ask(Command::Objects(Ask::Select {
        ids: vec![ball],
        how: How::Set,
    }));
    let path = s.home.path().join("ball.stl");
    s.ask(Command::Export {
        up: None,
        path: path.clone(),
        step: Some(0.02),
        unit: None,
        only: Some(ball),
    });
    s.settle();
    let mesh = midair_mesh::read(&path).unwrap().mesh;
    // An STL is read as it was written: in millimetres, one metre up.
    let bounds = mesh.bounds();
    assert!(bounds.max.x < 1.5, "{bounds:?}");
}
