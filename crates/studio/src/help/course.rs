//! The course: tasks and their steps, read from `assets/tutorial`.

use bevy::prelude::*;
use serde::Deserialize;

use super::goal::Goal;
use super::keys::{Keys, Way};

/// One model to make.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Task {
    pub title: String,
    pub steps: Vec<Step>,
}

/// One thing to do. Texts name keys as `{library}`: they are spelt as they are bound when shown.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Step {
    /// Its name, never changed.
    pub id: String,
    /// What to do, with tracked hands and wherever there is nothing more exact.
    pub say: String,
    /// With mouse and keyboard.
    #[serde(default)]
    pub mouse: String,
    /// With a gamepad.
    #[serde(default)]
    pub gamepad: String,
    /// The only way in that needs it; with others it is passed over.
    #[serde(default)]
    pub only: Option<Way>,
    /// When it is done.
    pub until: Goal,
    /// What to look at.
    #[serde(default)]
    pub look: Look,
    /// Wrong turns: the first that is met says how to get out of it.
    #[serde(default)]
    pub wrong: Vec<(Goal, String)>,
}

/// What a step points at.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub(crate) enum Look {
    /// Nothing in the room.
    #[default]
    Nothing,
    /// The latest of a part.
    Part(String),
    /// Where something is to go: a point in metres, and how far around it.
    Place(Vec3, f32),
}

impl Step {
    /// Whether there is anything to do with what one has in hand.
    pub fn concerns(&self, way: Way) -> bool {
        self.only.is_none_or(|only| only == way)
    }

    /// What to do with what one has in hand.
    pub fn text(&self, keys: &Keys) -> String {
        let own = match keys.way {
            Way::Hands => "",
            Way::Mouse => &self.mouse,
            Way::Gamepad => &self.gamepad,
        };
        keys.spell(if own.is_empty() { &self.say } else { own })
    }
}

/// The three tasks of EasyVRModeling §6.
pub(crate) const COURSE: [&str; 3] = [
    include_str!("../../../../assets/tutorial/1-cube-sphere.ron"),
    include_str!("../../../../assets/tutorial/2-chair.ron"),
    include_str!("../../../../assets/tutorial/3-cup.ron"),
];

/// Tasks from their texts.
pub(crate) fn read<'a>(texts: impl IntoIterator<Item = &'a str>) -> Vec<Task> {
    texts
        .into_iter()
        .filter_map(|text| match ron::from_str(text) {
            Ok(task) => Some(task),
            Err(fault) => {
                warn!("a task of the tutorial cannot be read: {fault}");
                None
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tasks_are_read_whole_and_name_what_the_library_has() {
        let tasks = read(COURSE);
        assert_eq!(tasks.len(), 3);
        let mut ids = std::collections::BTreeSet::new();
        let library = midair_library::Library::bundled();
        for step in tasks.iter().flat_map(|t| &t.steps) {
            assert!(ids.insert(&step.id), "{} twice", step.id);
            assert!(!step.say.is_empty());
            if let Look::Part(part) = &step.look {
                let mut all = library.components().iter();
                assert!(all.any(|c| c.id.starts_with(part)), "{part}");
            }
        }
    }

    #[test]
    fn every_key_that_is_named_has_a_name_with_hands() {
        let keys = Keys::default();
        let tasks = read(COURSE);
        let steps = tasks.iter().flat_map(|t| &t.steps);
        // A card for another way in is never shown to hands.
        for step in steps.filter(|s| s.concerns(keys.way)) {
            let spelt = keys.spell(&step.say);
            assert!(!spelt.contains("(no key)"), "{spelt}");
        }
    }
}
