//! Panels: functions of what they show to the commands they ask for.
//!
//! A screen hosts them in its own windows, a headset on quads in the room; sessions record the
//! commands. None of them changes the document.

mod bar;
mod hints;
mod library;
mod notices;
mod objects;
mod style;

pub use bar::{Bar, bar};
pub use hints::{KeyNames, hints};
pub use library::library;
pub use notices::{STAYS, notices};
pub use objects::operands;
pub use style::{ACCENT, apply_style};

pub use bevy_egui::egui;
