//! The mode works, and its document outlives it.

use std::path::Path;

use bevy::prelude::*;
use midair::{Stage, app};
use midair_document::{Kind, open, save};
use midair_studio::hands::{Action, HandsInput, Pose, Side};
use midair_studio::project::{Begin, Places, Project};
use midair_studio::show::ObjectEntity;
use midair_studio::tools::Tools;
use pebbles::{PEBBLES, PebblesPlugin};

fn places(home: &Path) -> Places {
    Places::below(home)
}

fn ready(mut app: App) -> App {
    app.finish();
    app.cleanup();
    app
}

fn frame(app: &mut App, down: bool) {
    let mut input = app.world_mut().resource_mut::<HandsInput>();
    let hand = input.side(Side::Right);
    hand.pose = Some(Pose::at(Vec3::new(0.1, 0.2, 0.3)));
    hand.down.set(Action::Act, down);
    app.update();
}

#[test]
fn a_document_opens_without_the_mode_that_made_it() {
    let home = tempfile::tempdir().unwrap();
    let mut with = app(Stage::Bare, places(home.path()), Begin::default());
    with.add_plugins(PebblesPlugin);
    let mut with = ready(with);
    assert!(
        with.world_mut()
            .resource_mut::<Tools>()
            .activate(PEBBLES.as_str())
    );
    for down in [false, true, true, false, true, false] {
        frame(&mut with, down);
    }
    let first = home.path().join("first.midair");
    let project = with.world().resource::<Project>();
    assert_eq!(project.document().len(), 2, "one pebble for each press");
    save(&first, project.document(), project.meshes()).unwrap();

    let opened = open(&first).unwrap();
    assert!(opened.warnings.is_empty(), "{:?}", opened.warnings);
    let begin = Begin {
        opened: Some((opened.document, opened.meshes, first.clone())),
        journal: false,
    };
    let mut without = ready(app(Stage::Bare, places(home.path()), begin));
    for _ in 0..4 {
        without.update();
    }
    assert!(!without.world().resource::<Tools>().knows(PEBBLES.as_str()));
    let mut drawn = without.world_mut().query::<(&ObjectEntity, &Mesh3d)>();
    assert_eq!(
        drawn.iter(without.world()).count(),
        2,
        "drawn from the baked mesh"
    );
    let project = without.world().resource::<Project>();
    let (_, pebble) = project.document().objects().next().unwrap();
    let Kind::Foreign { data, .. } = &pebble.kind else {
        panic!("a pebble is still a pebble");
    };
    assert_eq!(data, "(radius: 0.03)");
    let second = home.path().join("second.midair");
    save(&second, project.document(), project.meshes()).unwrap();
    assert_eq!(
        std::fs::read(first).unwrap(),
        std::fs::read(second).unwrap()
    );
}
