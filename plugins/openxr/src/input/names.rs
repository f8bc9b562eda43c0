//! What the controllers in hand call their buttons, for instructions: what is read in the headset names no key of the desk.

use std::collections::BTreeMap;

use bevy::prelude::*;
use midair_studio::hands::{Action, Side};
use midair_studio::help::{Keys, Way};
use midair_studio::settings::Settings;

use super::bindings::{Arm, Bindings, Control, Part, Place, Profile, Source, Who};
use super::controllers::Controllers;
use crate::session::Life;

/// While the headset is worn instructions are for the controllers that are held.
pub(super) fn tell(
    (life, controllers): (Res<Life>, Res<Controllers>),
    (bindings, settings): (Res<Bindings>, Res<Settings>),
    mut keys: ResMut<Keys>,
    mut told: Local<Option<(&'static str, Side)>>,
) {
    if !life.is_worn() {
        *told = None;
        return;
    }
    let main = settings.hands.main();
    let held = [main, main.other()].map(|side| controllers.side(side).profile);
    let held = held.into_iter().find(|p| !p.is_empty()).unwrap_or_default();
    if *told == Some((held, main)) && !bindings.is_changed() {
        return;
    }
    *told = Some((held, main));
    let mut next = Keys::default();
    if let Some(profile) = Profile::named(held) {
        // What this one has no button for keeps the name of what stands in for it.
        next.labels.extend(labels(&bindings, profile, main));
    }
    debug_assert_eq!(next.way, Way::Hands);
    keys.set_if_neq(next);
}

/// The names of what instructions speak of.
fn labels(
    bindings: &Bindings,
    profile: &'static Profile,
    main: Side,
) -> BTreeMap<&'static str, String> {
    let mut labels = BTreeMap::new();
    let mut say = |name, label: Option<String>| {
        if let Some(label) = label {
            labels.insert(name, label);
        }
    };
    let of = |control| {
        let places = bindings.of(profile, control).iter();
        places
            .filter_map(|place| spoken(place, profile, main))
            .next()
    };
    let held = |label: String| format!("{label}, held,");
    let twice = |label: String| format!("{label}, twice,");
    say("act", of(Control::Act));
    say("grab", of(Control::Grab));
    say("library", of(Control::Library).or(of(Control::Menu)));
    say("undo", of(Control::Undo));
    say("redo", of(Control::Redo));
    say("save", of(Control::Save));
    say(
        "finish",
        of(Control::Finish).or(of(Control::Centre).map(held)),
    );
    say(
        "delete",
        of(Control::Delete).or(of(Control::Centre).map(twice)),
    );
    let arms = bindings.arms(profile, main, main);
    for (name, action) in [
        ("cross_up", Action::Up),
        ("cross_right", Action::Right),
        ("cross_down", Action::Down),
        ("cross_left", Action::Left),
    ] {
        let found = [Source::Stick, Source::Pad].into_iter().find_map(|source| {
            let mut all = Arm::CROSS.into_iter();
            let arm = all.find(|&arm| arms.of(source, arm).any(|a| a == action))?;
            Some(arm_of(source, arm))
        });
        say(name, found.map(str::to_owned));
    }
    labels
}

fn arm_of(source: Source, arm: Arm) -> &'static str {
    match (source, arm) {
        (Source::Stick, Arm::Up) => "the stick forwards",
        (Source::Stick, Arm::Right) => "the stick to the right",
        (Source::Stick, Arm::Down) => "the stick backwards",
        (Source::Stick, Arm::Left) => "the stick to the left",
        (Source::Pad, Arm::Up) => "the pad's upper arm",
        (Source::Pad, Arm::Right) => "the pad's right arm",
        (Source::Pad, Arm::Down) => "the pad's lower arm",
        (Source::Pad, Arm::Left) => "the pad's left arm",
        (_, Arm::Middle) => "the middle of the pad",
    }
}

/// One place in words, if this controller has it: `the right B`, `the trigger`.
fn spoken(place: &Place, profile: &Profile, main: Side) -> Option<String> {
    let side = match place.who {
        Who::Either => None,
        Who::Main => Some(main),
        Who::Off => Some(main.other()),
        Who::Left => Some(Side::Left),
        Who::Right => Some(Side::Right),
    };
    let what = match &place.part {
        Part::Component(component) => {
            if !profile.has(side.unwrap_or(main), component) {
                return None;
            }
            match component.split('/').next().unwrap_or_default() {
                "trigger" | "select" => "trigger",
                "squeeze" => "grip",
                "menu" => "menu button",
                "a" => "A",
                "b" => "B",
                "x" => "X",
                "y" => "Y",
                "thumbstick" => "stick, pressed",
                "trackpad" => "pad, pressed",
                _ => return None,
            }
            .to_owned()
        }
        Part::Arm(source, arm) => match side {
            None => return Some(arm_of(*source, *arm).to_owned()),
            Some(side) => {
                let words = arm_of(*source, *arm);
                return Some(format!("{words} ({})", hand(side)));
            }
        },
        Part::All(Source::Stick) => "stick".to_owned(),
        Part::All(Source::Pad) => "pad".to_owned(),
    };
    Some(match side {
        None => format!("the {what}"),
        Some(side) => format!("the {} {what}", hand(side)),
    })
}

fn hand(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::bindings::PROFILES;

    fn named(profile: &str, main: Side) -> BTreeMap<&'static str, String> {
        labels(&Bindings::default(), Profile::named(profile).unwrap(), main)
    }

    #[test]
    fn buttons_are_called_as_they_are_on_the_controller_in_hand() {
        let index = named("valve/index_controller", Side::Right);
        assert_eq!(index["act"], "the trigger");
        assert_eq!(index["library"], "the right B");
        assert_eq!(index["finish"], "the right A");
        assert_eq!(index["undo"], "the left A");
        assert_eq!(index["cross_up"], "the stick forwards");
        assert_eq!(index["delete"], "the stick, pressed, twice,");
        let touch = named("oculus/touch_controller", Side::Right);
        assert_eq!(
            (&*touch["undo"], &*touch["finish"]),
            ("the left X", "the right A")
        );
        // Mirrored: the left controller has X and Y in their place.
        let mirrored = named("oculus/touch_controller", Side::Left);
        assert_eq!(
            (&*mirrored["undo"], &*mirrored["finish"]),
            ("the right A", "the left X")
        );
        let vive = named("htc/vive_controller", Side::Right);
        assert_eq!(vive["finish"], "the middle of the pad, held,");
        assert_eq!(vive["undo"], "the pad's left arm (left)");
        assert_eq!(vive["library"], "the right menu button");
    }

    #[test]
    fn every_controller_but_the_simple_one_has_a_name_for_whatever_instructions_speak_of() {
        let wanted: Vec<_> = Keys::default().labels.into_keys().collect();
        for profile in PROFILES.iter().filter(|p| !p.id.starts_with("khr/")) {
            for main in Side::BOTH {
                let labels = named(profile.id, main);
                for name in &wanted {
                    assert!(labels.contains_key(name), "{} has no {name}", profile.id);
                }
            }
        }
    }
}
