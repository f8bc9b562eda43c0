//! By mouse and keyboard.

use bevy::input::keyboard::{Key, NativeKey};
use bevy::input::mouse::MouseScrollUnit;
use bevy::prelude::*;
use midair_document::ObjectId;
use midair_studio::hands::Side;
use midair_studio::show::Drafts;

use super::words::Act;
use super::{BUTTONS, HOMES, KEYS, Newcomer, POINTS};

const PLAIN: Key = Key::Unidentified(NativeKey::Unidentified);

/// Presses the button of the card that offers the tutorial.
pub fn begin(person: &mut Newcomer) {
    person.click_button("Show me");
}

pub fn act(person: &mut Newcomer, act: &Act) {
    if let Act::Called(name) = act {
        person.settle();
        return person.called(name);
    }
    if *act == Act::LetGo {
        return;
    }
    match act {
        Act::Press(key, _) if key == "click" => {
            person.homes(false);
            person.click();
        }
        Act::Press(key, count) => (0..*count).for_each(|_| person.key(key)),
        Act::Click(name, count) => {
            for _ in 0..*count {
                person.click_button(name);
                person.settle();
            }
        }
        Act::PointAt(word) => {
            person.point(person.thing(word));
        }
        Act::Select(word) => {
            person.point(person.thing(word));
            person.click();
        }
        Act::LiftByArrow(word, height) => {
            let id = person.thing(word);
            let up = person.height(id, height);
            person.lift(id, up);
        }
        Act::TurnByRing => {
            let id = person.desk.selected()[0];
            person.turn(id);
        }
        Act::Drag(word, place, wheel) => {
            let things = person.things(word);
            // "The hollow" is one, "each leg" are four.
            let things = match word.starts_with("each ") {
                true => things,
                false => vec![person.thing(word)],
            };
            for (nth, id) in things.into_iter().enumerate() {
                let by = person.way(id, place, nth);
                person.drag(id, by, *wheel);
            }
        }
        Act::MoveLeft => {
            person.homes(false);
            let at = person.cursor();
            person.glide(at - Vec2::new(90.0, 0.0));
        }
        other => panic!("a mouse does not do {other:?}"),
    }
    person.settle();
}

impl Newcomer {
    /// The hand goes to the keyboard or back to the mouse.
    fn homes(&mut self, keys: bool) {
        if self.at_keys != keys {
            self.at_keys = keys;
            self.rest(HOMES);
        }
    }

    fn cursor(&mut self) -> Vec2 {
        let world = self.desk.app.world_mut();
        let mut windows = world.query::<&Window>();
        windows.single(world).unwrap().cursor_position().unwrap()
    }

    fn glide(&mut self, to: Vec2) {
        self.homes(false);
        self.desk.glide(to);
        self.rest(POINTS - 0.13);
    }

    fn click(&mut self) {
        self.desk.click();
        self.rest(2.0 * BUTTONS);
    }

    fn click_button(&mut self, name: &str) {
        let seen = self.desk.button_called(name);
        let seen = seen.unwrap_or_else(|| panic!("there is no \"{name}\" on the screen"));
        let at = seen.rect.center();
        self.glide(Vec2::new(at.x, at.y));
        self.click();
    }

    /// Keys as they are written on caps.
    fn key(&mut self, name: &str) {
        // What the left hand reaches it presses while the right one is at the mouse.
        self.homes(matches!(name, "Enter" | "Del"));
        let chord: Vec<_> = name.split('+').map(code).collect();
        self.desk.strike(&chord);
        self.rest(KEYS * chord.len() as f32);
    }

    fn point(&mut self, id: ObjectId) {
        self.homes(false);
        self.desk.hover(id);
        self.rest(POINTS - 0.13);
    }

    /// Up by the green arrow, in one pull, as one who looks how high it is.
    fn lift(&mut self, id: ObjectId, up: f32) {
        let from = self.desk.stands(id);
        let (low, high) = self.size(id);
        let pivot = low.midpoint(high);
        let grip = self.desk.handle(pivot, Vec3::Y);
        self.homes(false);
        self.desk.glide(grip);
        self.desk.presses += 1;
        self.desk.mouse(MouseButton::Left, true);
        self.desk.wait(2);
        let mut at = grip;
        for _ in 0..4 {
            let shown = self.desk.world().resource::<Drafts>();
            let now = shown.get(id).map_or(from, |p| p.translation).y - from.y;
            let seen = [pivot + now * Vec3::Y, pivot + up * Vec3::Y];
            let [is, goal] = seen.map(|p| self.desk.pixel(p));
            at += goal - is;
            self.desk.glide(at);
        }
        self.desk.mouse(MouseButton::Left, false);
        self.desk.wait(3);
        self.rest(2.0 * (POINTS + BUTTONS) - 0.7);
        self.settle();
        let rose = self.desk.stands(id).y - from.y;
        assert!((rose - up).abs() < 0.02, "{rose} and not {up}");
    }

    fn pull(&mut self, from: Vec2, to: Vec2) {
        self.homes(false);
        self.desk.drag(MouseButton::Left, from, to);
        self.rest(2.0 * (POINTS + BUTTONS) - 0.3);
    }

    /// A quarter turn by the red ring.
    fn turn(&mut self, id: ObjectId) {
        let (low, high) = self.size(id);
        let pivot = low.midpoint(high);
        let eye = self.desk.orbit().transform().translation;
        let ring = 0.12 * pivot.distance(eye);
        let at =
            |degrees: f32| pivot + Quat::from_rotation_x(degrees.to_radians()) * Vec3::Z * ring;
        // From in front to above: the part of it that is seen.
        let (from, to) = (self.desk.pixel(at(0.0)), self.desk.pixel(at(-90.0)));
        self.pull(from, to);
    }

    /// Along the ground; the wheel lifts it meanwhile.
    fn drag(&mut self, id: ObjectId, by: Vec3, wheel: bool) {
        let goal = self.desk.stands(id) + by;
        for round in 0..3 {
            let left = (goal - self.desk.stands(id)).with_y(0.0);
            if left.length() < 0.02 && round > 0 {
                return;
            }
            self.homes(false);
            let from = self.desk.hover(id);
            let hand = self.desk.hand(Side::Right);
            let to = self.desk.pixel(hand + left);
            self.desk.presses += 1;
            self.desk.mouse(MouseButton::Left, true);
            self.desk.wait(2);
            // A little at first, so that it is a drag.
            self.desk.glide(from.lerp(to, 0.1));
            if wheel && round == 0 {
                for _ in 0..2 {
                    self.desk.wheel(1.0);
                    self.rest(KEYS);
                }
            }
            self.desk.glide(to);
            self.desk.mouse(MouseButton::Left, false);
            self.desk.wait(3);
            self.rest(2.0 * (POINTS + BUTTONS) - 0.4);
            self.settle();
        }
        let left = (goal - self.desk.stands(id)).with_y(0.0);
        assert!(left.length() < 0.03, "{left} is left");
    }
}

impl crate::desk::Desk {
    /// So many notches of the wheel.
    fn wheel(&mut self, lines: f32) {
        let window = self.window_entity();
        self.app
            .world_mut()
            .write_message(bevy::input::mouse::MouseWheel {
                unit: MouseScrollUnit::Line,
                x: 0.0,
                y: lines,
                window,
                phase: bevy::input::touch::TouchPhase::Moved,
            });
        self.frame();
    }
}

/// A key by the name on its cap.
fn code(name: &str) -> (KeyCode, Key) {
    let code = match name {
        "Ctrl" => return (KeyCode::ControlLeft, Key::Control),
        "Shift" => return (KeyCode::ShiftLeft, Key::Shift),
        "Enter" => return (KeyCode::Enter, Key::Enter),
        "Del" => return (KeyCode::Delete, Key::Delete),
        "G" => KeyCode::KeyG,
        "I" => KeyCode::KeyI,
        "L" => KeyCode::KeyL,
        "M" => KeyCode::KeyM,
        "P" => KeyCode::KeyP,
        "S" => KeyCode::KeyS,
        "T" => KeyCode::KeyT,
        "U" => KeyCode::KeyU,
        "X" => KeyCode::KeyX,
        "Y" => KeyCode::KeyY,
        "Z" => KeyCode::KeyZ,
        other => panic!("there is no key {other}"),
    };
    (code, PLAIN)
}
