//! A whole piece of work by mouse and keyboard alone, recorded and played back.

use bevy::input::keyboard::{Key, NativeKey};
use bevy::prelude::*;
use midair_document::ObjectId;
use midair_studio::hands::Side;
use midair_studio::project::Project;
use midair_studio::snap::own_box;

use crate::desk::Desk;

const PLAIN: Key = Key::Unidentified(NativeKey::Unidentified);

impl Desk {
    /// The middles of the field for the search of the library and of the first component below it, in pixels of the
    /// window.
    fn search(&self) -> (Vec2, Option<Vec2>) {
        let regions = self.focus().regions();
        let library = regions.iter().find(|r| r.name == "library");
        let spots = &library.expect("the library is open").spots;
        // The first widget closes the panel; what is done with components stands beside the field.
        let field = &spots[1];
        let first = spots.iter().find(|s| s.rect.min.y > field.rect.max.y);
        let [field, first] = [Some(field), first].map(|spot| {
            let at = spot?.rect.center();
            Some(Vec2::new(at.x, at.y))
        });
        (field.expect("the field"), first)
    }

    /// A component: its name typed into the search of the library, the first that is found dragged
    /// out to a place on the ground.
    fn out(&mut self, name: &str, to: Vec3) -> ObjectId {
        let before = self.document().len();
        if !self.is_open("library") {
            self.strike_one(KeyCode::KeyL);
        }
        self.wait(3);
        let (field, _) = self.search();
        self.glide(field);
        self.click();
        self.strike(&[
            (KeyCode::ControlLeft, Key::Control),
            (KeyCode::KeyA, Key::Character("a".into())),
        ]);
        for letter in name.to_lowercase().chars() {
            let key = Key::Character(letter.to_string().into());
            self.strike(&[(KeyCode::KeyX, key)]);
        }
        self.wait(3);
        let from = self.search().1.expect("something is found");
        let to = self.pixel(to);
        self.drag(MouseButton::Left, from, to);
        self.settle();
        assert_eq!(self.document().len(), before + 1, "{:?}", self.warnings());
        let (id, object) = self.document().objects().last().expect("it is there");
        assert_eq!(object.name, name);
        id
    }

    fn own_box(&self, id: ObjectId) -> (Vec3, Vec3) {
        let project = self.world().resource::<Project>();
        own_box(project, self.document().object(id).unwrap()).unwrap()
    }

    /// Drags it along the ground, then raises it by its handle.
    fn bring(&mut self, id: ObjectId, to: Vec3) {
        // The first hit is where it is held; the drag takes that as far as the thing is to go.
        for _ in 0..2 {
            let apart = (to - self.stands(id)).with_y(0.0);
            if apart.length() < 5e-3 {
                break;
            }
            let from = self.hover(id);
            let hand = self.hand(Side::Right);
            let there = self.pixel(hand + apart);
            self.drag(MouseButton::Left, from, there);
        }
        if (to.y - self.stands(id).y).abs() > 5e-3 {
            self.hover(id);
            self.click();
            assert_eq!(self.selected(), [id]);
            // The scale of the handles on screen changes with the distance: once more for the rest.
            for _ in 0..3 {
                let (low, high) = self.own_box(id);
                let pivot = self.stands(id) + low.midpoint(high);
                let up = (to.y - self.stands(id).y) * Vec3::Y;
                let (grip, there) = (
                    self.handle(pivot, Vec3::Y),
                    self.handle(pivot + up, Vec3::Y),
                );
                if grip.distance(there) > 4.0 {
                    self.drag(MouseButton::Left, grip, there);
                }
            }
        }
        let now = self.stands(id);
        assert!(now.distance(to) < 8e-3, "at {now} and not {to}");
    }
}

#[test]
fn a_chair_by_mouse_and_keyboard_alone_plays_back_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("chair.ron");
    let mut desk = Desk::recorded(&recording, "A chair, by mouse and keyboard");
    // Things go along the ground.
    desk.strike_one(KeyCode::KeyP);
    let feet = [(-0.12, -0.12), (0.12, -0.12), (-0.12, 0.12), (0.12, 0.12)];
    for (x, z) in feet {
        let leg = desk.out("Round leg", Vec3::new(x, 0.0, z));
        desk.bring(leg, Vec3::new(x, 0.2, z));
        desk.hover(leg);
        desk.strike(&[(KeyCode::KeyU, PLAIN)]);
    }
    for (name, at) in [
        ("Panel back", Vec3::new(0.0, 0.62, -0.18)),
        ("Cushion", Vec3::new(0.0, 0.42, 0.0)),
    ] {
        let part = desk.out(name, Vec3::new(0.35, 0.0, 0.1));
        desk.bring(part, at);
        desk.hover(part);
        desk.strike(&[(KeyCode::KeyU, PLAIN)]);
    }
    assert_eq!(desk.document().pending().len(), 6);
    desk.strike_one(KeyCode::Enter);
    desk.settle();
    assert_eq!(desk.document().len(), 1, "{:?}", desk.warnings());
    let seat = desk.pixel(Vec3::new(0.0, 0.46, 0.05));
    desk.glide(seat);
    desk.strike(&[(KeyCode::KeyE, PLAIN)]);
    desk.settle();
    desk.plays_back(&recording, 1);
}
