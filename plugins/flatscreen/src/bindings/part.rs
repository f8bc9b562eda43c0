//! One key, button or stick, and what it is called.

use bevy::input::gamepad::GamepadButton;
use bevy::prelude::*;
use leafwing_input_manager::user_input::updating::CentralInputStore;
use leafwing_input_manager::user_input::{Buttonlike, ModifierKey};

/// What a key or button belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Device {
    /// Mouse and keyboard.
    Keys,
    /// A gamepad.
    Pad,
}

/// Something that is down or up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// Ctrl, Shift, Alt, Super: left or right.
    Modifier(ModifierKey),
    /// A key, by where it is.
    Key(KeyCode),
    /// A button of the mouse.
    Mouse(MouseButton),
    /// A button of the gamepad.
    Pad(GamepadButton),
}

pub(super) const MODIFIERS: [(ModifierKey, &str); 4] = [
    // Where Command does what Ctrl does elsewhere.
    #[cfg(target_os = "macos")]
    (ModifierKey::Super, "Ctrl"),
    #[cfg(not(target_os = "macos"))]
    (ModifierKey::Control, "Ctrl"),
    (ModifierKey::Shift, "Shift"),
    (ModifierKey::Alt, "Alt"),
    #[cfg(target_os = "macos")]
    (ModifierKey::Control, "Control"),
    #[cfg(not(target_os = "macos"))]
    (ModifierKey::Super, "Super"),
];

const MOUSE: [(MouseButton, &str, &str); 5] = [
    (MouseButton::Left, "Mouse Left", "click"),
    (MouseButton::Middle, "Mouse Middle", "middle drag"),
    (MouseButton::Right, "Mouse Right", "right drag"),
    (MouseButton::Back, "Mouse Back", "mouse back"),
    (MouseButton::Forward, "Mouse Forward", "mouse forward"),
];

const PAD: [(GamepadButton, &str); 17] = [
    (GamepadButton::South, "A"),
    (GamepadButton::East, "B"),
    (GamepadButton::West, "X"),
    (GamepadButton::North, "Y"),
    (GamepadButton::LeftTrigger, "LB"),
    (GamepadButton::RightTrigger, "RB"),
    (GamepadButton::LeftTrigger2, "LT"),
    (GamepadButton::RightTrigger2, "RT"),
    (GamepadButton::Select, "View"),
    (GamepadButton::Start, "Start"),
    (GamepadButton::LeftThumb, "L3"),
    (GamepadButton::RightThumb, "R3"),
    (GamepadButton::DPadUp, "Up"),
    (GamepadButton::DPadRight, "Right"),
    (GamepadButton::DPadDown, "Down"),
    (GamepadButton::DPadLeft, "Left"),
    (GamepadButton::Mode, "Guide"),
];

/// Name in files, key, and what a hint says where that is shorter.
const KEYS: &[(&str, KeyCode, &str)] = &[
    ("Enter", KeyCode::Enter, ""),
    ("Esc", KeyCode::Escape, ""),
    ("Tab", KeyCode::Tab, ""),
    ("Space", KeyCode::Space, ""),
    ("Backspace", KeyCode::Backspace, ""),
    ("Delete", KeyCode::Delete, "Del"),
    ("Insert", KeyCode::Insert, "Ins"),
    ("Home", KeyCode::Home, ""),
    ("End", KeyCode::End, ""),
    ("PageUp", KeyCode::PageUp, "PgUp"),
    ("PageDown", KeyCode::PageDown, "PgDn"),
    ("Up", KeyCode::ArrowUp, "↑"),
    ("Right", KeyCode::ArrowRight, "→"),
    ("Down", KeyCode::ArrowDown, "↓"),
    ("Left", KeyCode::ArrowLeft, "←"),
    ("Minus", KeyCode::Minus, "-"),
    ("Equal", KeyCode::Equal, "="),
    ("Comma", KeyCode::Comma, ","),
    ("Period", KeyCode::Period, "."),
    ("Slash", KeyCode::Slash, "/"),
    ("Backslash", KeyCode::Backslash, "\\"),
    ("Semicolon", KeyCode::Semicolon, ";"),
    ("Quote", KeyCode::Quote, "'"),
    ("Backquote", KeyCode::Backquote, "`"),
    ("BracketLeft", KeyCode::BracketLeft, "["),
    ("BracketRight", KeyCode::BracketRight, "]"),
    ("Pause", KeyCode::Pause, ""),
    ("Menu", KeyCode::ContextMenu, ""),
    ("Num Enter", KeyCode::NumpadEnter, ""),
    ("Num Add", KeyCode::NumpadAdd, "Num +"),
    ("Num Subtract", KeyCode::NumpadSubtract, "Num -"),
    ("Num Multiply", KeyCode::NumpadMultiply, "Num *"),
    ("Num Divide", KeyCode::NumpadDivide, "Num /"),
    ("Num Decimal", KeyCode::NumpadDecimal, "Num ."),
    ("Num 0", KeyCode::Numpad0, ""),
    ("Num 1", KeyCode::Numpad1, ""),
    ("Num 2", KeyCode::Numpad2, ""),
    ("Num 3", KeyCode::Numpad3, ""),
    ("Num 4", KeyCode::Numpad4, ""),
    ("Num 5", KeyCode::Numpad5, ""),
    ("Num 6", KeyCode::Numpad6, ""),
    ("Num 7", KeyCode::Numpad7, ""),
    ("Num 8", KeyCode::Numpad8, ""),
    ("Num 9", KeyCode::Numpad9, ""),
    ("0", KeyCode::Digit0, ""),
    ("1", KeyCode::Digit1, ""),
    ("2", KeyCode::Digit2, ""),
    ("3", KeyCode::Digit3, ""),
    ("4", KeyCode::Digit4, ""),
    ("5", KeyCode::Digit5, ""),
    ("6", KeyCode::Digit6, ""),
    ("7", KeyCode::Digit7, ""),
    ("8", KeyCode::Digit8, ""),
    ("9", KeyCode::Digit9, ""),
    ("A", KeyCode::KeyA, ""),
    ("B", KeyCode::KeyB, ""),
    ("C", KeyCode::KeyC, ""),
    ("D", KeyCode::KeyD, ""),
    ("E", KeyCode::KeyE, ""),
    ("F", KeyCode::KeyF, ""),
    ("G", KeyCode::KeyG, ""),
    ("H", KeyCode::KeyH, ""),
    ("I", KeyCode::KeyI, ""),
    ("J", KeyCode::KeyJ, ""),
    ("K", KeyCode::KeyK, ""),
    ("L", KeyCode::KeyL, ""),
    ("M", KeyCode::KeyM, ""),
    ("N", KeyCode::KeyN, ""),
    ("O", KeyCode::KeyO, ""),
    ("P", KeyCode::KeyP, ""),
    ("Q", KeyCode::KeyQ, ""),
    ("R", KeyCode::KeyR, ""),
    ("S", KeyCode::KeyS, ""),
    ("T", KeyCode::KeyT, ""),
    ("U", KeyCode::KeyU, ""),
    ("V", KeyCode::KeyV, ""),
    ("W", KeyCode::KeyW, ""),
    ("X", KeyCode::KeyX, ""),
    ("Y", KeyCode::KeyY, ""),
    ("Z", KeyCode::KeyZ, ""),
    ("F1", KeyCode::F1, ""),
    ("F2", KeyCode::F2, ""),
    ("F3", KeyCode::F3, ""),
    ("F4", KeyCode::F4, ""),
    ("F5", KeyCode::F5, ""),
    ("F6", KeyCode::F6, ""),
    ("F7", KeyCode::F7, ""),
    ("F8", KeyCode::F8, ""),
    ("F9", KeyCode::F9, ""),
    ("F10", KeyCode::F10, ""),
    ("F11", KeyCode::F11, ""),
    ("F12", KeyCode::F12, ""),
];

impl Part {
    /// Every part of a device that has a name.
    pub(super) fn all(device: Device) -> Vec<Self> {
        match device {
            Device::Keys => KEYS
                .iter()
                .map(|&(_, key, _)| Self::Key(key))
                .chain(MODIFIERS.map(|(m, _)| Self::Modifier(m)))
                .chain(MOUSE.map(|(m, ..)| Self::Mouse(m)))
                .collect(),
            Device::Pad => PAD.iter().map(|&(b, _)| Self::Pad(b)).collect(),
        }
    }

    /// The key, modifier or mouse button of that name.
    pub(super) fn of_keys(name: &str) -> Option<Self> {
        let is = |other: &str| name.eq_ignore_ascii_case(other);
        None.or_else(|| {
            MODIFIERS
                .iter()
                .find(|m| is(m.1))
                .map(|m| Self::Modifier(m.0))
        })
        .or_else(|| MOUSE.iter().find(|m| is(m.1)).map(|m| Self::Mouse(m.0)))
        .or_else(|| KEYS.iter().find(|k| is(k.0)).map(|k| Self::Key(k.1)))
    }

    /// The gamepad's button of that name, without "Pad".
    pub(super) fn of_pad(name: &str) -> Option<Self> {
        let found = PAD.iter().find(|p| name.eq_ignore_ascii_case(p.1));
        found.map(|p| Self::Pad(p.0))
    }

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Modifier(m) => MODIFIERS.iter().find(|e| e.0 == m).map(|e| e.1),
            Self::Key(k) => KEYS.iter().find(|e| e.1 == k).map(|e| e.0),
            Self::Mouse(m) => MOUSE.iter().find(|e| e.0 == m).map(|e| e.1),
            Self::Pad(b) => PAD.iter().find(|e| e.0 == b).map(|e| e.1),
        }
        .unwrap_or("?")
    }

    /// What a hint calls it.
    pub fn label(self) -> &'static str {
        let short = match self {
            Self::Key(k) => KEYS.iter().find(|e| e.1 == k).map(|e| e.2),
            Self::Mouse(m) => MOUSE.iter().find(|e| e.0 == m).map(|e| e.2),
            Self::Pad(GamepadButton::DPadUp) => Some("D-pad ↑"),
            Self::Pad(GamepadButton::DPadRight) => Some("D-pad →"),
            Self::Pad(GamepadButton::DPadDown) => Some("D-pad ↓"),
            Self::Pad(GamepadButton::DPadLeft) => Some("D-pad ←"),
            Self::Pad(_) | Self::Modifier(_) => None,
        };
        short.filter(|s| !s.is_empty()).unwrap_or(self.name())
    }

    /// What it belongs to.
    pub fn device(self) -> Device {
        match self {
            Self::Pad(_) => Device::Pad,
            _ => Device::Keys,
        }
    }

    /// As leafwing reads it.
    pub(super) fn input(self) -> Box<dyn Buttonlike> {
        match self {
            Self::Modifier(m) => Box::new(m),
            Self::Key(k) => Box::new(k),
            Self::Mouse(m) => Box::new(m),
            Self::Pad(b) => Box::new(b),
        }
    }

    /// Whether it is down.
    pub(super) fn is_down(self, store: &CentralInputStore, pad: Entity) -> bool {
        match self {
            Self::Modifier(m) => m.pressed(store, pad),
            Self::Key(k) => k.pressed(store, pad),
            Self::Mouse(m) => m.pressed(store, pad),
            Self::Pad(b) => b.pressed(store, pad),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_read_back() {
        for part in Part::all(Device::Keys) {
            assert_eq!(Part::of_keys(part.name()), Some(part), "{}", part.name());
        }
        for part in Part::all(Device::Pad) {
            assert_eq!(Part::of_pad(part.name()), Some(part), "{}", part.name());
        }
    }
}
