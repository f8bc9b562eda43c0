//! Where a control is: `main a/click`, `off pad left`, `either stick`.

use std::fmt;

use midair_studio::hands::Side;

/// On which hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Who {
    /// Both do it.
    Either,
    /// The one that leads.
    Main,
    /// The other one.
    Off,
    /// The left one, whoever leads.
    Left,
    /// The right one, whoever leads.
    Right,
}

impl Who {
    /// Whether it is on `side` when `main` leads.
    pub fn is(self, side: Side, main: Side) -> bool {
        match self {
            Self::Either => true,
            Self::Main => side == main,
            Self::Off => side != main,
            Self::Left => side == Side::Left,
            Self::Right => side == Side::Right,
        }
    }
}

/// Of what an arm is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Source {
    /// A stick that is flicked.
    Stick,
    /// A pad that is pressed.
    Pad,
}

/// A part of a stick or pad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Arm {
    /// ↑
    Up,
    /// →
    Right,
    /// ↓
    Down,
    /// ←
    Left,
    /// Of a pad alone.
    Middle,
}

impl Arm {
    /// The four.
    pub const CROSS: [Self; 4] = [Self::Up, Self::Right, Self::Down, Self::Left];
}

/// What is pressed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// As OpenXR names it below `input`: `a/click`.
    Component(String),
    /// An arm.
    Arm(Source, Arm),
    /// All of a stick or pad.
    All(Source),
}

/// One place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// On which hand.
    pub who: Who,
    /// What.
    pub part: Part,
}

impl Place {
    /// Reads one.
    ///
    /// # Errors
    ///
    /// What it is not, as one line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut words = text.split_whitespace();
        let who = match words.next().unwrap_or_default() {
            "either" => Who::Either,
            "main" => Who::Main,
            "off" => Who::Off,
            "left" => Who::Left,
            "right" => Who::Right,
            _ => {
                return Err(format!(
                    "\"{text}\" does not say on which hand: begin with either, main, off, left or right"
                ));
            }
        };
        let rest: Vec<_> = words.collect();
        let source = |word: &str| match word {
            "stick" => Some(Source::Stick),
            "pad" => Some(Source::Pad),
            _ => None,
        };
        let part = match *rest {
            [word] => match source(word) {
                Some(source) => Part::All(source),
                None => Part::Component(word.to_owned()),
            },
            [of, arm] => {
                let arm = match arm {
                    "up" => Some(Arm::Up),
                    "right" => Some(Arm::Right),
                    "down" => Some(Arm::Down),
                    "left" => Some(Arm::Left),
                    "middle" => Some(Arm::Middle),
                    _ => None,
                };
                match (source(of), arm) {
                    (Some(Source::Stick), Some(Arm::Middle)) => {
                        return Err("a stick has no middle; write thumbstick/click".to_owned());
                    }
                    (Some(source), Some(arm)) => Part::Arm(source, arm),
                    _ => {
                        return Err(format!(
                            "\"{text}\" is no part of a stick or pad: those are up, right, down, left and pad middle"
                        ));
                    }
                }
            }
            _ => {
                return Err(format!(
                    "\"{text}\" does not say what is pressed; write for instance \"main a/click\" or \"off pad left\""
                ));
            }
        };
        Ok(Self { who, part })
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let who = match self.who {
            Who::Either => "either",
            Who::Main => "main",
            Who::Off => "off",
            Who::Left => "left",
            Who::Right => "right",
        };
        let of = |source: &Source| match source {
            Source::Stick => "stick",
            Source::Pad => "pad",
        };
        match &self.part {
            Part::Component(name) => write!(f, "{who} {name}"),
            Part::All(source) => write!(f, "{who} {}", of(source)),
            Part::Arm(source, arm) => {
                let arm = match arm {
                    Arm::Up => "up",
                    Arm::Right => "right",
                    Arm::Down => "down",
                    Arm::Left => "left",
                    Arm::Middle => "middle",
                };
                write!(f, "{who} {} {arm}", of(source))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_read_and_written() {
        for text in [
            "either trigger/value",
            "off pad left",
            "main pad middle",
            "right stick",
            "left menu/click",
        ] {
            assert_eq!(Place::parse(text).unwrap().to_string(), text);
        }
    }

    #[test]
    fn what_is_none_is_one_line() {
        for text in [
            "",
            "a/click",
            "main",
            "main stick middle",
            "off pad north",
            "main a b c",
        ] {
            let fault = Place::parse(text).unwrap_err();
            assert!(!fault.contains('\n'), "{fault}");
        }
    }
}
