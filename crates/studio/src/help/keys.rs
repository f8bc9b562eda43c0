//! What the way in that is in use calls its keys and buttons.

use std::collections::BTreeMap;

use bevy::prelude::*;
use serde::Deserialize;

/// With what one works at the moment; instructions differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Way {
    /// Two tracked hands.
    #[default]
    Hands,
    /// Mouse and keyboard.
    Mouse,
    /// A gamepad.
    Gamepad,
}

/// One line of the list of keys.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyLine {
    /// Its name in bindings: `undo`.
    pub name: &'static str,
    /// What belongs together.
    pub group: &'static str,
    /// What it does.
    pub does: &'static str,
    /// The keys, as they are bound now.
    pub keys: Vec<String>,
}

/// The names of keys and buttons. The way in that is in use writes it when they change; tracked
/// hands without a way in have those of a controller.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct Keys {
    /// With what one works.
    pub way: Way,
    /// What hints call each control, by its name in bindings.
    pub labels: BTreeMap<&'static str, String>,
    /// Everything that is bound, for the list.
    pub lines: Vec<KeyLine>,
}

impl Default for Keys {
    fn default() -> Self {
        let labels = [
            ("act", "the trigger"),
            ("grab", "the grip"),
            ("library", "the right menu button"),
            ("finish", "the middle of the pad, held,"),
            ("undo", "the left arm of the left pad"),
            ("redo", "the right arm of the left pad"),
            ("cross_up", "the pad's upper arm"),
            ("cross_right", "the pad's right arm"),
            ("cross_down", "the pad's lower arm"),
            ("delete", "the middle of the pad, twice,"),
            ("save", "Save in the File menu"),
        ];
        Self {
            way: Way::Hands,
            labels: labels.map(|(k, v)| (k, v.to_owned())).into(),
            lines: Vec::new(),
        }
    }
}

impl Keys {
    /// `text` with each `{control}` replaced by what its key is called.
    pub fn spell(&self, text: &str) -> String {
        let mut spelt = String::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once('{') {
            spelt.push_str(before);
            let Some((name, after)) = after.split_once('}') else {
                rest = after;
                break;
            };
            match self.labels.get(name).filter(|l| !l.is_empty()) {
                Some(label) => spelt.push_str(label),
                // Bound to nothing: Controls is where that is changed.
                None => spelt.push_str("(no key)"),
            }
            rest = after;
        }
        spelt.push_str(rest);
        spelt
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_keys_are_put_in_their_places() {
        let mut keys = Keys::default();
        keys.labels.insert("library", "L".to_owned());
        assert_eq!(keys.spell("Press {library} now"), "Press L now");
        assert_eq!(keys.spell("{nowhere}."), "(no key).");
        assert_eq!(keys.spell("No braces"), "No braces");
    }
}
