//! The tables as they are used: the usual ones, and what a person has changed.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use midair_studio::bound::{LineFault, own_file};
use midair_studio::hands::{Action, Side};
use midair_studio::notice::Notices;
use midair_studio::project::Places;

use super::file::{self, Tables};
use super::{Arm, Control, Kind, PROFILES, Part, Place, Profile, Source};

/// The usual tables, as everybody finds them.
const USUAL: &str = include_str!("../../../../../assets/bindings/headset.ron");

/// What the buttons of each controller do.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Bindings {
    usual: Tables,
    own: Tables,
}

impl Default for Bindings {
    fn default() -> Self {
        Self {
            usual: file::read(USUAL).0,
            own: Tables::new(),
        }
    }
}

/// What the arms of one hand's stick and pad stand for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Arms(Vec<(Source, Arm, Action)>);

impl Arms {
    /// What an arm stands for.
    pub fn of(&self, source: Source, arm: Arm) -> impl Iterator<Item = Action> {
        self.0
            .iter()
            .filter(move |(s, a, _)| (*s, *a) == (source, arm))
            .map(|(_, _, action)| *action)
    }
}

impl Bindings {
    /// The usual ones, with those that a person's file has changed; and what of that file cannot be used.
    pub fn with_file(text: &str) -> (Self, Vec<LineFault>) {
        let (own, faults) = file::read(text);
        let bindings = Self {
            own,
            ..Self::default()
        };
        (bindings, faults)
    }

    /// Where a control is on one controller.
    pub fn of(&self, profile: &Profile, control: Control) -> &[Place] {
        let found = [&self.own, &self.usual]
            .into_iter()
            .find_map(|tables| tables.get(profile.id).and_then(|t| t.get(&control)));
        found.map_or(&[], Vec::as_slice)
    }

    /// What of a controller is bound to a control of its own, for one hand when `main` leads: components below `input`.
    pub fn components(
        &self,
        profile: &'static Profile,
        control: Control,
        side: Side,
        main: Side,
    ) -> Vec<&str> {
        let places = self.of(profile, control).iter();
        places
            .filter(|p| p.who.is(side, main))
            .filter_map(|p| match &p.part {
                Part::Component(name) => Some(name.as_str()),
                _ => None,
            })
            .filter(|name| profile.has(side, name))
            .collect()
    }

    /// What the arms stand for on one hand when `main` leads. A line about one arm is before a line about all.
    pub fn arms(&self, profile: &Profile, side: Side, main: Side) -> Arms {
        let mut arms = Vec::new();
        for control in Control::ALL.iter().copied() {
            let Some(action) = control.action().filter(|_| control.kind() == Kind::Button) else {
                continue;
            };
            for place in self.of(profile, control) {
                if let Part::Arm(source, arm) = place.part
                    && place.who.is(side, main)
                {
                    arms.push((source, arm, action));
                }
            }
        }
        for place in self.of(profile, Control::Cross) {
            let Part::All(source) = place.part else {
                continue;
            };
            if !place.who.is(side, main) {
                continue;
            }
            for (arm, action) in
                Arm::CROSS
                    .into_iter()
                    .zip([Action::Up, Action::Right, Action::Down, Action::Left])
            {
                if !arms.iter().any(|(s, a, _)| (*s, *a) == (source, arm)) {
                    arms.push((source, arm, action));
                }
            }
        }
        Arms(arms)
    }

    /// What the swipe of one hand is read from.
    pub fn swipe(&self, profile: &Profile, side: Side, main: Side) -> Option<Source> {
        self.of(profile, Control::Swipe)
            .iter()
            .filter(|p| p.who.is(side, main))
            .find_map(|p| match p.part {
                Part::All(source) => Some(source),
                _ => None,
            })
    }
}

/// Where a person's own tables are.
fn path(places: &Places) -> PathBuf {
    places.library.config().join("headset.ron")
}

/// Reads a person's own tables at the start.
pub(crate) fn read(
    places: Option<Res<Places>>,
    mut bindings: ResMut<Bindings>,
    mut notices: ResMut<Notices>,
) {
    let Some(path) = places.map(|p| path(&p)) else {
        return;
    };
    let way_out = |_: &Path| "correct the line and start Midair again.".to_owned();
    let read = own_file(&path, "buttons", way_out, Bindings::with_file, &mut notices);
    if let Some(read) = read {
        *bindings = read;
    }
}

/// Every profile that is known.
pub(crate) fn profiles() -> impl Iterator<Item = (usize, &'static Profile)> {
    PROFILES.iter().enumerate()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::bindings::Who;

    #[test]
    fn the_usual_tables_have_no_fault_and_are_there_for_every_controller() {
        let (tables, faults) = file::read(USUAL);
        assert_eq!(faults, []);
        for profile in PROFILES {
            assert!(tables.contains_key(profile.id), "{}", profile.id);
        }
    }

    /// What tools use. A controller with fewer buttons leaves the rest to the panels.
    const NEEDED: [Action; 14] = [
        Action::Act,
        Action::Grab,
        Action::Finish,
        Action::Undo,
        Action::Redo,
        Action::Library,
        Action::Modes,
        Action::Save,
        Action::Delete,
        Action::Up,
        Action::Right,
        Action::Down,
        Action::Left,
        Action::Menu,
    ];

    #[test]
    fn every_controller_but_the_simple_one_has_every_action_for_either_handedness() {
        let bindings = Bindings::default();
        for profile in PROFILES.iter().filter(|p| !p.id.starts_with("khr/")) {
            for main in Side::BOTH {
                let mut had: Vec<Action> = Vec::new();
                for side in Side::BOTH {
                    for control in Control::ALL.iter().copied() {
                        if !bindings.components(profile, control, side, main).is_empty() {
                            had.extend(control.action());
                        }
                    }
                    let arms = bindings.arms(profile, side, main);
                    had.extend(arms.0.iter().map(|(_, _, action)| *action));
                    assert!(
                        bindings.swipe(profile, side, main).is_some(),
                        "{} swipe",
                        profile.id
                    );
                }
                // What a hold or a double press of those makes.
                if had.contains(&Action::Menu) {
                    had.extend([Action::Library, Action::Modes]);
                }
                if had.contains(&Action::Centre) {
                    had.extend([Action::Finish, Action::Delete]);
                }
                for action in NEEDED {
                    assert!(had.contains(&action), "{} {main:?} {action:?}", profile.id);
                }
            }
        }
    }

    #[test]
    fn a_line_about_one_arm_takes_it_from_the_cross() {
        let bindings = Bindings::default();
        let vive = Profile::named("htc/vive_controller").unwrap();
        let off = bindings.arms(vive, Side::Left, Side::Right);
        let of = |arms: &Arms, arm| arms.of(Source::Pad, arm).collect::<Vec<_>>();
        assert_eq!(of(&off, Arm::Left), [Action::Undo]);
        assert_eq!(of(&off, Arm::Up), [Action::Up]);
        let main = bindings.arms(vive, Side::Right, Side::Right);
        assert_eq!(of(&main, Arm::Left), [Action::Left]);
        assert_eq!(of(&main, Arm::Middle), [Action::Centre]);
        // Mirrored for the left-handed.
        assert_eq!(bindings.arms(vive, Side::Right, Side::Left), off);
    }

    #[test]
    fn a_persons_line_takes_the_place_of_the_usual_one_and_of_no_other() {
        let text = "{ \"oculus/touch_controller\": (undo: [\"right a/click\"]) }";
        let (bindings, faults) = Bindings::with_file(text);
        assert_eq!(faults, []);
        let touch = Profile::named("oculus/touch_controller").unwrap();
        assert_eq!(bindings.of(touch, Control::Undo)[0].who, Who::Right);
        assert_eq!(
            bindings.of(touch, Control::Redo),
            Bindings::default().of(touch, Control::Redo)
        );
        let right = bindings.components(touch, Control::Undo, Side::Right, Side::Right);
        assert_eq!(right, ["a/click"]);
        assert!(
            bindings
                .components(touch, Control::Undo, Side::Left, Side::Right)
                .is_empty()
        );
    }
}
