//! A whole piece of work by gamepad alone, recorded and played back.

use std::path::{Path, PathBuf};

use bevy::input::gamepad::GamepadButton as Button;
use bevy::math::Vec3;
use midair::{Stage, probe};
use midair_document::ObjectId;
use midair_mesh::check;
use midair_playback::{PlayOptions, PlayerPlugin, RecorderPlugin, Session, play};
use midair_studio::project::{Begin, Places};

use crate::desk::Desk;

impl Desk {
    /// A component, carried from where it appears to where it is to be.
    fn put(&mut self, name: &str, at: Vec3) -> ObjectId {
        let id = self.take(name);
        self.down(Button::RightTrigger);
        self.aim(at);
        self.up(Button::RightTrigger);
        self.wait(2);
        let now = self.document().object(id).unwrap().placement.translation;
        assert!(now.distance(at) < 5e-3, "{name} is at {now} and not {at}");
        id
    }

    /// The cross, up, on what the hand points at.
    fn unite(&mut self, id: ObjectId, at: Vec3) {
        self.point(at);
        let side = self.pad_hands().leading();
        assert_eq!(self.touched(side), Some(id), "at {at}");
        self.tap(Button::DPadUp);
    }
}

/// The mesh that the button for saving wrote.
pub fn saved(home: &Path) -> PathBuf {
    let work = Places::below(home).work;
    let files = std::fs::read_dir(&work).unwrap().map(|e| e.unwrap().path());
    let mut meshes: Vec<_> = files
        .filter(|p| p.extension().is_some_and(|e| e == "stl"))
        .collect();
    assert_eq!(meshes.len(), 1, "{meshes:?}");
    meshes.remove(0)
}

#[test]
fn a_chair_by_gamepad_alone_plays_back_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("chair.ron");
    let recorder = RecorderPlugin::create(&recording, "A chair, by gamepad").unwrap();
    let mut desk = Desk::with(move |app| {
        app.add_plugins(recorder);
    });
    desk.plug();
    let seat = desk.put("Cushion", Vec3::new(0.0, 0.42, 0.0));
    let feet = [(-0.12, 0.12), (0.12, 0.12), (0.12, -0.12), (-0.12, -0.12)];
    let legs = feet.map(|(x, z)| (desk.put("Round leg", Vec3::new(x, 0.19, z)), x, z));
    let back = desk.put("Panel back", Vec3::new(0.0, 0.62, -0.18));
    // The library has done its work; the cross marks.
    desk.tap(Button::Start);
    assert!(!desk.is_open("library"));
    desk.tap(Button::DPadUp);
    desk.unite(seat, Vec3::new(0.0, 0.46, 0.05));
    for (leg, x, z) in legs {
        desk.unite(leg, Vec3::new(x, 0.08, z));
    }
    desk.unite(back, Vec3::new(0.1, 0.75, -0.165));
    assert_eq!(desk.document().pending().len(), 6);
    desk.tap(Button::South);
    desk.settle();
    assert_eq!(desk.document().len(), 1, "{:?}", desk.warnings());
    desk.point(Vec3::new(0.0, 0.46, 0.05));
    desk.tap(Button::Select);
    desk.settle();
    assert_eq!(desk.warnings(), [] as [String; 0]);
    println!(
        "a chair by gamepad: {} presses and pushes, {:.0} s",
        desk.presses,
        desk.seconds()
    );
    let Desk { app, home, .. } = desk;
    // The recording ends with the app.
    drop(app);
    let mesh = saved(home.path());
    let read = midair_mesh::read(&mesh).unwrap().mesh;
    let report = check(&read);
    assert!(report.is_faultless(), "{:?}", report.faults());

    let again = tempfile::tempdir().unwrap();
    let mut player = midair::app(Stage::Bare, Places::below(again.path()), Begin::default());
    player.add_plugins(PlayerPlugin);
    let options = PlayOptions {
        probe,
        ..PlayOptions::default()
    };
    let report = play(&mut player, Session::load(&recording).unwrap(), options).unwrap();
    assert_eq!(report.objects.len(), 1);
    let [a, b] = [mesh, saved(again.path())].map(|p| std::fs::read(p).unwrap());
    assert!(a == b, "the same bytes");
}
