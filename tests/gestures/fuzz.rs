//! Anything may be pressed at any time.

use bevy::input::gamepad::GamepadButton;
use bevy::input::keyboard::{Key, NativeKey};
use bevy::prelude::*;

use crate::desk::Desk;

/// Numbers that look random and are the same in every run.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % sides
    }

    fn push(&mut self) -> f32 {
        self.roll(2001) as f32 / 1000.0 - 1.0
    }
}

const KEYS: [(KeyCode, Key); 24] = [
    (KeyCode::Tab, Key::Tab),
    (KeyCode::Enter, Key::Enter),
    (KeyCode::Escape, Key::Escape),
    (KeyCode::F6, Key::F6),
    (KeyCode::F3, Key::F3),
    (KeyCode::ArrowDown, Key::ArrowDown),
    (KeyCode::ArrowRight, Key::ArrowRight),
    (KeyCode::ArrowUp, Key::ArrowUp),
    (KeyCode::Delete, Key::Delete),
    (KeyCode::ControlLeft, Key::Control),
    (KeyCode::ShiftLeft, Key::Shift),
    (KeyCode::KeyZ, Key::Unidentified(NativeKey::Unidentified)),
    (KeyCode::KeyL, Key::Unidentified(NativeKey::Unidentified)),
    (KeyCode::KeyU, Key::Unidentified(NativeKey::Unidentified)),
    (KeyCode::KeyI, Key::Unidentified(NativeKey::Unidentified)),
    (KeyCode::KeyM, Key::Unidentified(NativeKey::Unidentified)),
    (KeyCode::KeyS, Key::Unidentified(NativeKey::Unidentified)),
    (KeyCode::KeyR, Key::Unidentified(NativeKey::Unidentified)),
    (KeyCode::KeyF, Key::Unidentified(NativeKey::Unidentified)),
    (KeyCode::KeyX, Key::Unidentified(NativeKey::Unidentified)),
    (KeyCode::KeyQ, Key::Unidentified(NativeKey::Unidentified)),
    (KeyCode::KeyE, Key::Unidentified(NativeKey::Unidentified)),
    (KeyCode::Space, Key::Space),
    (KeyCode::Digit1, Key::Unidentified(NativeKey::Unidentified)),
];

fn anything(seed: u64, frames: usize) {
    let mut dice = Dice(seed);
    let mut desk = Desk::new();
    desk.plug();
    let mut connected = true;
    desk.take("Cube");
    let mut held = [false; KEYS.len()];
    for _ in 0..frames {
        match dice.roll(12) {
            0..=3 => {
                let button = GamepadButton::all()[dice.roll(19) as usize];
                let value = dice.roll(2) as f32;
                desk.button(button, value);
            }
            4 | 5 => {
                let to = Vec2::new(dice.push(), dice.push());
                desk.stick(dice.roll(2) == 0, to);
            }
            6 => desk.stick(dice.roll(2) == 0, Vec2::ZERO),
            7 | 8 => {
                let which = dice.roll(KEYS.len() as u64) as usize;
                held[which] = !held[which];
                let (code, key) = KEYS[which].clone();
                desk.key(code, key, held[which]);
            }
            9 => {
                let to = Vec2::new(dice.roll(1280) as f32, dice.roll(720) as f32);
                desk.cursor(to);
                let buttons = [MouseButton::Left, MouseButton::Middle, MouseButton::Right];
                let button = buttons[dice.roll(3) as usize];
                desk.mouse(button, dice.roll(2) == 0);
            }
            10 if dice.roll(40) == 0 => {
                connected = !connected;
                if connected {
                    desk.plug();
                } else {
                    desk.unplug();
                }
            }
            _ => {}
        }
        // Checks the document, too.
        desk.frame();
        for side in midair_studio::hands::Side::BOTH {
            assert!(desk.hand(side).is_finite());
        }
    }
}

#[test]
fn whatever_is_pressed_the_document_stays_sound() {
    for seed in [0x9e37_79b9_7f4a_7c15, 0xdead_beef_cafe_f00d, 7] {
        anything(seed, 2500);
    }
}
