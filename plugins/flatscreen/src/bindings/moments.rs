//! What mouse, keys and gamepads said, a moment at a time.
//!
//! In a frame that takes long a button goes down and up again, twice even, and the pointer goes on
//! meanwhile. Taken as one, a press would count where the pointer is by then, or not at all. So a frame
//! takes in what belongs together, and what came after that waits for the next one.

use std::collections::VecDeque;

use bevy::input::ButtonState;
use bevy::input::gamepad::{GamepadButton, GamepadButtonStateChangedEvent};
use bevy::prelude::*;
use bevy::window::WindowEvent;
use leafwing_input_manager::buttonlike::ButtonValue;
use leafwing_input_manager::user_input::SpecificGamepadButton;
use leafwing_input_manager::user_input::updating::CentralInputStore;

/// Where in the window the pointer is in this frame, for all who ask: they have to agree on it.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct Cursor {
    at: Option<Vec2>,
    travelled: Vec2,
}

impl Cursor {
    /// In pixels of the window: where it was when a button or key went down or up in this frame, else
    /// where it is now. `None` where it is outside.
    pub fn at(&self) -> Option<Vec2> {
        self.at
    }

    /// How far it went since the frame before, in pixels: up to what went down or up in this one.
    pub fn travelled(&self) -> Vec2 {
        self.travelled
    }
}

/// A key or button of one device.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Button {
    Key(KeyCode),
    Mouse(MouseButton),
    Pad(Entity, GamepadButton),
}

/// What was said, in the order in which it was.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Said {
    /// The pointer went there, and by so much.
    Moved(Vec2, Vec2),
    Down(Button),
    Up(Button),
}

/// What this frame takes in, and what waits.
#[derive(Default)]
pub(super) struct Moments {
    waiting: VecDeque<Said>,
    /// What went down (`true`) or up in this frame.
    changed: Vec<(Button, bool)>,
}

impl Moments {
    /// Something happened in the window.
    pub fn hear(&mut self, event: &WindowEvent) {
        let (button, state) = match event {
            WindowEvent::CursorMoved(moved) => {
                let by = moved.delta.filter(|d| d.is_finite()).unwrap_or(Vec2::ZERO);
                self.waiting.push_back(Said::Moved(moved.position, by));
                return;
            }
            WindowEvent::MouseButtonInput(input) => (Button::Mouse(input.button), input.state),
            WindowEvent::KeyboardInput(input) if !input.repeat => {
                (Button::Key(input.key_code), input.state)
            }
            _ => return,
        };
        self.change(button, state);
    }

    /// A button of a gamepad went down or up.
    pub fn hear_pad(&mut self, event: &GamepadButtonStateChangedEvent) {
        self.change(Button::Pad(event.entity, event.button), event.state);
    }

    fn change(&mut self, button: Button, state: ButtonState) {
        self.waiting.push_back(match state {
            ButtonState::Pressed => Said::Down(button),
            ButtonState::Released => Said::Up(button),
        });
    }

    /// Letters go into a field: it has them in its own order, and they hold nothing up.
    pub fn leave_out(&mut self, letter: impl Fn(KeyCode) -> bool) {
        self.waiting.retain(
            |said| !matches!(said, Said::Down(Button::Key(k)) | Said::Up(Button::Key(k)) if letter(*k)),
        );
    }

    /// Takes in what belongs to this frame: how far the pointer went, and then what went down or up
    /// where it was, as long as no button does so twice and none goes up after another went down.
    /// `now`: where the window has the pointer.
    pub fn next(&mut self, now: Option<Vec2>, cursor: &mut Cursor) {
        self.changed.clear();
        cursor.travelled = Vec2::ZERO;
        while let Some(&said) = self.waiting.front() {
            let (button, down) = match said {
                Said::Moved(..) if !self.changed.is_empty() => break,
                Said::Moved(to, by) => {
                    cursor.at = Some(to);
                    cursor.travelled += by;
                    self.waiting.pop_front();
                    continue;
                }
                Said::Down(button) => (button, true),
                Said::Up(button) => (button, false),
            };
            let before = |&(other, went): &(Button, bool)| other == button || (went && !down);
            if self.changed.iter().any(before) {
                break;
            }
            self.changed.push((button, down));
            self.waiting.pop_front();
        }
        // What is remembered may be stale: it counts only where the pointer went on from there.
        if !self.waiting.iter().any(|s| matches!(s, Said::Moved(..))) {
            cursor.at = now;
        }
        cursor.at = cursor.at.filter(|at| at.is_finite());
    }

    /// Tells the store what is down in this frame, where that is not what is down by now.
    pub fn tell(&self, store: &mut CentralInputStore) {
        // Backwards, so that what waits longest has the last word.
        for &said in self.waiting.iter().rev() {
            match said {
                Said::Down(button) => button.tell(store, false),
                Said::Up(button) => button.tell(store, true),
                Said::Moved(..) => {}
            }
        }
        for &(button, down) in &self.changed {
            button.tell(store, down);
        }
    }
}

impl Button {
    fn tell(self, store: &mut CentralInputStore, down: bool) {
        let value = ButtonValue::from_pressed(down);
        match self {
            Self::Key(key) => store.update_buttonlike(key, value),
            Self::Mouse(button) => store.update_buttonlike(button, value),
            Self::Pad(pad, button) => {
                store.update_buttonlike(SpecificGamepadButton::new(pad, button), value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEFT: Button = Button::Mouse(MouseButton::Left);
    const CTRL: Button = Button::Key(KeyCode::ControlLeft);
    const Z: Button = Button::Key(KeyCode::KeyZ);

    fn to(x: f32) -> Said {
        Said::Moved(Vec2::splat(x), Vec2::X)
    }

    /// Frame by frame: what changed, where the pointer is, how far it went.
    fn frames(said: &[Said], now: f32) -> Vec<(Vec<(Button, bool)>, f32, f32)> {
        let mut cursor = Cursor {
            at: Some(Vec2::ZERO),
            travelled: Vec2::ZERO,
        };
        let mut moments = Moments {
            waiting: said.iter().copied().collect(),
            changed: Vec::new(),
        };
        let mut frames = Vec::new();
        while !moments.waiting.is_empty() {
            moments.next(Some(Vec2::splat(now)), &mut cursor);
            let at = cursor.at().unwrap().x;
            frames.push((moments.changed.clone(), at, cursor.travelled().x));
        }
        frames
    }

    #[test]
    fn a_press_is_where_the_cursor_was_if_that_goes_on_in_the_same_frame() {
        use Said::{Down, Up};
        assert_eq!(frames(&[to(1.0), to(2.0)], 2.0), [(vec![], 2.0, 2.0)]);
        let press = vec![(LEFT, true)];
        // What is remembered may be stale.
        assert_eq!(frames(&[Down(LEFT)], 3.0), [(press.clone(), 3.0, 0.0)]);
        assert_eq!(
            frames(&[Down(LEFT), to(1.0)], 1.0),
            [(press.clone(), 0.0, 0.0), (vec![], 1.0, 1.0)]
        );
        assert_eq!(
            frames(&[to(1.0), Down(LEFT), to(2.0), Up(LEFT), to(3.0)], 3.0),
            [
                (press, 1.0, 1.0),
                (vec![(LEFT, false)], 2.0, 1.0),
                (vec![], 3.0, 1.0)
            ]
        );
    }

    #[test]
    fn what_goes_down_twice_does_so_in_a_frame_each_and_what_is_held_for_it_is_held() {
        use Said::{Down, Up};
        let told: Vec<_> = frames(&[Up(LEFT), Down(LEFT), Up(LEFT), Down(LEFT)], 0.0)
            .into_iter()
            .map(|f| f.0)
            .collect();
        let each = [false, true, false, true].map(|down| vec![(LEFT, down)]);
        assert_eq!(told, each);
        let told: Vec<_> = frames(&[Down(CTRL), Down(Z), Up(CTRL), Up(Z)], 0.0)
            .into_iter()
            .map(|f| f.0)
            .collect();
        assert_eq!(
            told,
            [
                vec![(CTRL, true), (Z, true)],
                vec![(CTRL, false), (Z, false)]
            ]
        );
    }
}
