//! By gamepad.

use bevy::input::gamepad::GamepadButton as Button;
use bevy::prelude::*;
use midair_document::ObjectId;
use midair_studio::hands::Side;

use super::words::Act;
use super::{KEYS, Newcomer};

/// Where on a thing one points, as parts of its box.
const SPOTS: [Vec3; 8] = [
    Vec3::new(0.5, 0.5, 0.5),
    Vec3::new(0.5, 0.9, 0.5),
    Vec3::new(0.5, 0.2, 0.6),
    Vec3::new(0.3, 0.4, 0.9),
    Vec3::new(0.8, 0.4, 0.9),
    Vec3::new(0.15, 0.8, 0.9),
    Vec3::new(0.85, 0.8, 0.9),
    Vec3::new(0.9, 0.5, 0.5),
];

/// Presses the button of the card that offers the tutorial.
pub fn begin(person: &mut Newcomer) {
    person.desk.plug();
    person.rest(0.5);
    for _ in 0..6 {
        person.tap("L3");
        if person
            .desk
            .focus()
            .region()
            .is_some_and(|r| r.name == "tutorial")
        {
            break;
        }
    }
    person.walk_to("Show me");
    person.tap("A");
}

pub fn act(person: &mut Newcomer, act: &Act) {
    if let Act::Called(name) = act {
        person.settle();
        return person.called(name);
    }
    match act {
        Act::Press(button, count) => {
            for _ in 0..*count {
                person.tap(button);
            }
            person.settle();
        }
        Act::Choose(name) => person.walk_to(name),
        Act::TurnTo(button, category) => {
            for _ in 0..8 {
                let tab = person.desk.button_called(category);
                if tab.is_some_and(|t| t.chosen) {
                    return;
                }
                person.tap(button);
                person.desk.wait(4);
            }
            panic!("{button} does not turn to {category}");
        }
        Act::PointAt(word) => {
            if let Some(of) = word.strip_prefix("left side of the ") {
                let id = person.thing(of);
                person.names.insert("it".to_owned(), id);
                person.over(id, &[Vec3::new(0.15, 0.5, 0.75)]);
            } else if word == "its right side" {
                person.over(person.thing("it"), &[Vec3::new(0.85, 0.5, 0.75)]);
            } else {
                person.over(person.thing(word), &SPOTS);
            }
        }
        Act::Hold(button) => {
            // Pressed anew where it was down for the other hand.
            person.desk.up(button_of(button));
            person.desk.down(button_of(button));
            person.rest(KEYS);
        }
        Act::LetGo => {
            if !person.desk.pad_hands().holds() {
                return;
            }
            for button in [Button::RightTrigger, Button::LeftTrigger2] {
                person.desk.up(button);
            }
            person.rest(KEYS);
            person.settle();
        }
        Act::Push(place) => {
            let id = person.held();
            let by = person.way(id, place, person.nth);
            person.carry(by);
        }
        Act::Lift(height) => {
            let id = person.held();
            let up = person.height(id, height);
            person.carry(up * Vec3::Y);
        }
        Act::Turn(button) => {
            // A quarter turn at full deflection, as one who looks.
            person.desk.down(button_of(button));
            person.desk.presses += 1;
            person.desk.stick(true, Vec2::NEG_Y);
            person.desk.wait(79);
            person.desk.stick(true, Vec2::ZERO);
            person.desk.wait(2);
            person.desk.up(button_of(button));
        }
        Act::PushLeft => {
            person.nearer(0.72);
        }
        Act::GoTo(button, names) if names.is_empty() => {
            for _ in 0..8 {
                if person.desk.focus().is_inside()
                    && person
                        .desk
                        .focus()
                        .region()
                        .is_some_and(|r| r.name == "bar")
                {
                    return;
                }
                person.tap(button);
                person.desk.wait(3);
            }
            panic!("{button} does not go to the bar");
        }
        Act::GoTo(_, names) => {
            for name in names {
                person.walk_to(name);
                person.tap("A");
                person.desk.wait(6);
            }
            person.settle();
        }
        other => panic!("a gamepad does not do {other:?}"),
    }
}

impl Newcomer {
    fn tap(&mut self, button: &str) {
        self.desk.tap(button_of(button));
        self.rest(KEYS - 0.2);
    }

    /// The D-pad to what is called so.
    fn walk_to(&mut self, name: &str) {
        let before = self.desk.presses;
        self.desk.walk_to(name);
        let steps = (self.desk.presses - before) as f32;
        self.rest(steps * (KEYS - 0.2));
    }

    /// The leading hand over a thing, where nothing hides it.
    fn over(&mut self, id: ObjectId, spots: &[Vec3]) {
        let side = self.desk.pad_hands().leading();
        let (low, high) = self.size(id);
        for &t in spots {
            self.desk.point(low + t * (high - low));
            if self.desk.touched(side) == Some(id) {
                return;
            }
        }
        panic!("{id} is nowhere seen");
    }

    fn held(&self) -> ObjectId {
        let side = self.desk.pad_hands().leading();
        self.desk.touched(side).expect("something is held")
    }

    /// The stick to the left, until the hands are so much nearer to each other.
    fn nearer(&mut self, part: f32) {
        let apart = |desk: &crate::desk::Desk| {
            let [left, right] = Side::BOTH.map(|s| desk.hand(s));
            left.distance(right)
        };
        let goal = part * apart(&self.desk);
        self.desk.presses += 1;
        self.desk.stick(false, Vec2::new(-0.6, 0.0));
        for _ in 0..200 {
            if apart(&self.desk) <= goal {
                break;
            }
            self.desk.frame();
        }
        self.desk.stick(false, Vec2::ZERO);
        self.desk.wait(2);
    }

    /// What the hand holds by so much.
    fn carry(&mut self, by: Vec3) {
        let side = self.desk.pad_hands().leading();
        let from = self.desk.hand(side);
        self.desk.aim(from + by);
    }
}

/// A button by what hints call it.
fn button_of(name: &str) -> Button {
    match name {
        "A" => Button::South,
        "B" => Button::East,
        "X" => Button::West,
        "Y" => Button::North,
        "LB" => Button::LeftTrigger,
        "RB" => Button::RightTrigger,
        "LT" => Button::LeftTrigger2,
        "RT" => Button::RightTrigger2,
        "L3" => Button::LeftThumb,
        "R3" => Button::RightThumb,
        "View" => Button::Select,
        "Start" => Button::Start,
        "D-pad ↑" => Button::DPadUp,
        "D-pad →" => Button::DPadRight,
        "D-pad ↓" => Button::DPadDown,
        "D-pad ←" => Button::DPadLeft,
        other => panic!("there is no button {other}"),
    }
}
