//! A whole piece of work by gamepad alone, recorded and played back.

use bevy::input::gamepad::GamepadButton as Button;
use bevy::math::Vec3;
use midair_document::ObjectId;

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

#[test]
fn a_chair_by_gamepad_alone_plays_back_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("chair.ron");
    let mut desk = Desk::recorded(&recording, "A chair, by gamepad");
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
    desk.plays_back(&recording, 1);
}
