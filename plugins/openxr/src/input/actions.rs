//! OpenXR's actions: one set for each handedness, of which one is listened to.
//!
//! A thing that is bound to the main hand is on the other one for the left-handed. Each set has its own bindings, so that the
//! switch works at once and the runtime's own menus show either as it is.

use midair_studio::hands::Side;
use openxr::{Action, ActionSet, Binding, Haptic, Path, Posef, Space, Vector2f};

use super::bindings::{Bindings, Control, Kind, PROFILES, Profile, profiles};
use crate::runtime::{Connection, RuntimeFault};
use bevy_mod_openxr::session::OxrSession;

/// A float, a button or a plane.
pub(super) enum Sense {
    Axis(Action<f32>),
    Button(Action<bool>),
    Plane(Action<Vector2f>),
}

/// The actions for one handedness.
pub(super) struct Set {
    pub set: ActionSet,
    pub senses: Vec<(Control, Sense)>,
    pub haptic: Action<Haptic>,
    pub grip: [Space; 2],
    pub aim: [Space; 2],
    grip_action: Action<Posef>,
    aim_action: Action<Posef>,
}

/// What the runtime said of a controller's table.
#[derive(Clone, Debug)]
pub(super) struct Suggested {
    pub profile: &'static Profile,
    pub bindings: usize,
    pub refused: Option<String>,
}

/// Makes both sets, suggests every controller's table, attaches them.
pub(super) fn make(
    connection: &Connection,
    session: &OxrSession,
    bindings: &Bindings,
    hands: [Path; 2],
) -> Result<([Set; 2], Vec<Suggested>), RuntimeFault> {
    let instance = &connection.instance;
    let left = set(connection, session, Side::Left, hands)?;
    let right = set(connection, session, Side::Right, hands)?;
    let sets = [left, right];
    let mut suggested = Vec::new();
    for (_, profile) in profiles() {
        if !(profile.offered)(&connection.extensions) || !is_wanted(profile) {
            continue;
        }
        let path = |text: &str| instance.string_to_path(text);
        let mut table = Vec::new();
        let mut fault = None;
        for (set, main) in sets.iter().zip(Side::BOTH) {
            for (side, hand) in Side::BOTH.into_iter().zip(["left", "right"]) {
                for (name, action) in [
                    ("input/grip/pose", &set.grip_action),
                    ("input/aim/pose", &set.aim_action),
                ] {
                    match path(&format!("/user/hand/{hand}/{name}")) {
                        Ok(at) => table.push(Binding::new(action, at)),
                        Err(code) => fault = Some(code),
                    }
                }
                match path(&format!("/user/hand/{hand}/output/haptic")) {
                    Ok(at) => table.push(Binding::new(&set.haptic, at)),
                    Err(code) => fault = Some(code),
                }
                for (control, sense) in &set.senses {
                    for component in bindings.components(profile, *control, side, main) {
                        match path(&format!("/user/hand/{hand}/input/{component}")) {
                            Ok(at) => table.push(match sense {
                                Sense::Axis(action) => Binding::new(action, at),
                                Sense::Button(action) => Binding::new(action, at),
                                Sense::Plane(action) => Binding::new(action, at),
                            }),
                            Err(code) => fault = Some(code),
                        }
                    }
                }
            }
        }
        let answer = match fault {
            Some(code) => Err(code),
            None => path(&format!("/interaction_profiles/{}", profile.id))
                .and_then(|p| instance.suggest_interaction_profile_bindings(p, &table)),
        };
        suggested.push(Suggested {
            profile,
            bindings: table.len(),
            refused: answer.err().map(|code| format!("{code:?}")),
        });
    }
    session
        .attach_action_sets(&[&sets[0].set, &sets[1].set])
        .map_err(|code| {
            RuntimeFault::refused(&connection.runtime, "xrAttachSessionActionSets", code)
        })?;
    Ok((sets, suggested))
}

fn set(
    connection: &Connection,
    session: &OxrSession,
    main: Side,
    hands: [Path; 2],
) -> Result<Set, RuntimeFault> {
    let refused = |call| move |code| RuntimeFault::refused(&connection.runtime, call, code);
    let (name, title, suffix) = match main {
        Side::Right => ("midair", "Midair", ""),
        Side::Left => ("midair_left", "Midair, left-handed", "_left"),
    };
    let set = connection
        .instance
        .create_action_set(name, title, 0)
        .map_err(refused("xrCreateActionSet"))?;
    let mut senses = Vec::new();
    for control in Control::ALL.iter().copied() {
        let name = format!("{}{suffix}", control.name());
        let title = control.title();
        let sense = match control.kind() {
            Kind::Axis => set.create_action(&name, title, &hands).map(Sense::Axis),
            Kind::Button => set.create_action(&name, title, &hands).map(Sense::Button),
            Kind::Plane => set.create_action(&name, title, &hands).map(Sense::Plane),
            Kind::Choice => continue,
        };
        senses.push((control, sense.map_err(refused("xrCreateAction"))?));
    }
    let pose = |name: &str, title: &str| {
        set.create_action::<Posef>(&format!("{name}{suffix}"), title, &hands)
            .map_err(refused("xrCreateAction"))
    };
    let grip_action = pose("grip_pose", "Where the hand is")?;
    let aim_action = pose("aim_pose", "Where the wand points")?;
    let haptic = set
        .create_action::<Haptic>(&format!("pulse{suffix}"), "Pulse", &hands)
        .map_err(refused("xrCreateAction"))?;
    let spaces = |action: &Action<Posef>| -> Result<[Space; 2], RuntimeFault> {
        let space = |hand| {
            action
                .create_space(session, hand, Posef::IDENTITY)
                .map_err(refused("xrCreateActionSpace"))
        };
        Ok([space(hands[0])?, space(hands[1])?])
    };
    Ok(Set {
        grip: spaces(&grip_action)?,
        aim: spaces(&aim_action)?,
        set,
        senses,
        haptic,
        grip_action,
        aim_action,
    })
}

/// Whether a table is to be suggested: `MIDAIR_XR_ONLY` may name the one controller that a runtime is to see or emulate.
fn is_wanted(profile: &Profile) -> bool {
    let only = std::env::var_os("MIDAIR_XR_ONLY").filter(|v| !v.is_empty());
    only.is_none_or(|only| only == profile.id)
}

/// The profile of a path that the runtime gave.
pub(super) fn profile_of(connection: &Connection, path: Path) -> Option<&'static Profile> {
    if path == Path::NULL {
        return None;
    }
    let text = connection.instance.path_to_string(path).ok()?;
    let id = text.strip_prefix("/interaction_profiles/")?;
    PROFILES.iter().find(|p| p.id == id)
}
