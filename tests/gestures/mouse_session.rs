//! A whole piece of work by mouse and keyboard alone, recorded and played back.

use bevy::input::keyboard::{Key, NativeKey};
use bevy::prelude::*;
use midair::{Stage, probe};
use midair_document::ObjectId;
use midair_mesh::check;
use midair_playback::{PlayOptions, PlayerPlugin, RecorderPlugin, Session, play};
use midair_studio::hands::Side;
use midair_studio::project::{Begin, Places};

use crate::desk::Desk;
use crate::pad_session::saved;

const PLAIN: Key = Key::Unidentified(NativeKey::Unidentified);

impl Desk {
    /// A component by its name: typed into the search of the library, and the first that is found.
    fn search(&mut self, name: &str) -> ObjectId {
        let before = self.document().len();
        if !self.is_open("library") {
            self.strike_one(KeyCode::KeyL);
        }
        self.wait(3);
        self.strike_one(KeyCode::F6);
        for _ in 0..200 {
            if self.focus().is_text() {
                break;
            }
            self.strike_one(KeyCode::Tab);
        }
        assert!(self.focus().is_text(), "on the search field");
        self.strike(&[
            (KeyCode::ControlLeft, Key::Control),
            (KeyCode::KeyA, Key::Character("a".into())),
        ]);
        for letter in name.to_lowercase().chars() {
            let key = Key::Character(letter.to_string().into());
            self.strike(&[(KeyCode::KeyX, key)]);
        }
        for _ in 0..24 {
            if self.focus().label().contains(name) {
                break;
            }
            self.strike_one(KeyCode::Tab);
        }
        assert!(
            self.focus().label().contains(name),
            "{}",
            self.focus().label()
        );
        self.strike_one(KeyCode::Enter);
        self.settle();
        self.strike_one(KeyCode::Escape);
        assert!(!self.focus().is_inside());
        assert_eq!(self.document().len(), before + 1, "{:?}", self.warnings());
        let last = self.document().objects().map(|(id, _)| id).last();
        last.expect("it is there")
    }

    /// Drags it along the ground, then raises it by its handle.
    fn bring(&mut self, id: ObjectId, to: Vec3) {
        // The first hit is where it is held; the drag takes that as far as the thing is to go.
        for _ in 0..2 {
            let from = self.hover(id);
            let hand = self.hand(Side::Right);
            let by = (to - self.stands(id)).with_y(0.0);
            let there = self.pixel(hand + by);
            self.drag(MouseButton::Left, from, there);
        }
        for _ in 0..2 {
            let now = self.stands(id);
            let up = to.y - now.y;
            if up.abs() > 5e-3 {
                let grip = self.handle(now, Vec3::Y);
                let eye = self.orbit().transform().translation;
                let along = 0.6 * 0.12 * now.distance(eye);
                let there = self.pixel(now + (along + up) * Vec3::Y);
                self.drag(MouseButton::Left, grip, there);
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
    let recorder = RecorderPlugin::create(&recording, "A chair, by mouse and keyboard").unwrap();
    let mut desk = Desk::with(move |app| {
        app.add_plugins(recorder);
    });
    // Things go along the ground.
    desk.strike_one(KeyCode::KeyP);
    let feet = [(-0.12, -0.12), (0.12, -0.12), (-0.12, 0.12), (0.12, 0.12)];
    for (x, z) in feet {
        let leg = desk.search("Round leg");
        desk.bring(leg, Vec3::new(x, 0.19, z));
        desk.hover(leg);
        desk.strike(&[(KeyCode::KeyU, PLAIN)]);
    }
    for (name, at) in [
        ("Panel back", Vec3::new(0.0, 0.62, -0.18)),
        ("Cushion", Vec3::new(0.0, 0.42, 0.0)),
    ] {
        let part = desk.search(name);
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
    assert_eq!(desk.warnings(), [] as [String; 0]);
    println!(
        "a chair by mouse and keyboard: {} presses and drags, {:.0} s",
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
