//! What a control is bound to: one key or button, several held together, or a stick.

use std::fmt;

use leafwing_input_manager::user_input::{Buttonlike, ButtonlikeChord, GamepadStick};

use super::part::{Device, Part};

/// A stick of the gamepad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stick {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

impl Stick {
    pub(super) fn input(self) -> GamepadStick {
        match self {
            Self::Left => GamepadStick::LEFT,
            Self::Right => GamepadStick::RIGHT,
        }
    }
}

/// One thing a control is bound to.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Binding {
    /// The last goes down while the others are held.
    Chord(Vec<Part>),
    /// A stick.
    Stick(Stick),
}

/// Why a binding cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BindingFault {
    /// There is no such key or button.
    #[error(
        "there is no key \"{0}\"; keys are called A, 1, F1, Enter, Ctrl+Z, Mouse Left, Pad A, Pad LB+X"
    )]
    Unknown(String),
    /// Nothing between the quotes.
    #[error("a key is missing between the quotes; write for instance \"Ctrl+Z\" or \"Pad A\"")]
    Empty,
    /// A stick where a button is needed, or the other way about.
    #[error(
        "\"{0}\" does not fit: sticks are \"Pad Left stick\" and \"Pad Right stick\", everything else takes keys and buttons"
    )]
    Kind(String),
}

impl Binding {
    /// Reads `Ctrl+Z`, `Mouse Left`, `Pad LB+X`, `Pad Left stick`.
    ///
    /// # Errors
    ///
    /// A name is unknown, or nothing is there.
    pub fn parse(text: &str) -> Result<Self, BindingFault> {
        let text = text.trim();
        if text.is_empty() {
            return Err(BindingFault::Empty);
        }
        let unknown = || BindingFault::Unknown(text.to_owned());
        let prefixed = text.get(..4).filter(|p| p.eq_ignore_ascii_case("pad "));
        let parts: Option<Vec<Part>> = match prefixed.and(text.get(4..)) {
            Some(rest) => match rest.trim().to_ascii_lowercase().as_str() {
                "left stick" => return Ok(Self::Stick(Stick::Left)),
                "right stick" => return Ok(Self::Stick(Stick::Right)),
                _ => rest.split('+').map(|n| Part::of_pad(n.trim())).collect(),
            },
            None => text.split('+').map(|n| Part::of_keys(n.trim())).collect(),
        };
        let parts = parts.ok_or_else(unknown)?;
        let repeated = (1..parts.len()).any(|i| parts[..i].contains(&parts[i]));
        if repeated {
            Err(unknown())
        } else {
            Ok(Self::Chord(parts))
        }
    }

    /// What it belongs to.
    pub fn device(&self) -> Device {
        match self {
            Self::Chord(parts) => parts.last().map_or(Device::Keys, |p| p.device()),
            Self::Stick(_) => Device::Pad,
        }
    }

    /// What a hint calls it.
    pub fn label(&self) -> String {
        match self {
            Self::Chord(parts) => {
                let labels: Vec<_> = parts.iter().map(|p| p.label()).collect();
                labels.join("+")
            }
            Self::Stick(Stick::Left) => "left stick".to_owned(),
            Self::Stick(Stick::Right) => "right stick".to_owned(),
        }
    }

    /// The parts of a chord.
    pub(super) fn parts(&self) -> &[Part] {
        match self {
            Self::Chord(parts) => parts,
            Self::Stick(_) => &[],
        }
    }

    /// As leafwing reads it; `None` for a stick.
    pub(super) fn input(&self) -> Option<Box<dyn Buttonlike>> {
        match self.parts() {
            [] => None,
            [only] => Some(only.input()),
            parts => {
                let chord = parts
                    .iter()
                    .fold(ButtonlikeChord::default(), |c, part| match *part {
                        Part::Modifier(m) => c.with(m),
                        Part::Key(k) => c.with(k),
                        Part::Mouse(m) => c.with(m),
                        Part::Pad(b) => c.with(b),
                    });
                Some(Box::new(chord))
            }
        }
    }
}

impl fmt::Display for Binding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Chord(parts) => {
                let names: Vec<_> = parts.iter().map(|p| p.name()).collect();
                let pad = if self.device() == Device::Pad {
                    "Pad "
                } else {
                    ""
                };
                write!(f, "{pad}{}", names.join("+"))
            }
            Self::Stick(Stick::Left) => f.write_str("Pad Left stick"),
            Self::Stick(Stick::Right) => f.write_str("Pad Right stick"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        for text in [
            "Z",
            "Ctrl+Shift+Z",
            "Mouse Left",
            "Shift+Mouse Middle",
            "Pad A",
            "Pad LB+X",
            "Pad Left stick",
            "Num Enter",
        ] {
            assert_eq!(Binding::parse(text).unwrap().to_string(), text);
        }
    }

    #[test]
    fn what_is_no_key_is_refused() {
        for text in [
            "",
            "  ",
            "Ctrl+",
            "Foo",
            "Pad",
            "Pad Z",
            "Ctrl+Ctrl",
            "+",
            "é",
            "Pad +",
        ] {
            assert!(Binding::parse(text).is_err(), "{text:?}");
        }
    }
}
