//! The controllers that are known, and what they have.

use midair_studio::hands::Side;
use openxr::ExtensionSet;

/// A controller as OpenXR knows it.
#[derive(Debug)]
pub struct Profile {
    /// Below `/interaction_profiles/`.
    pub id: &'static str,
    /// What people call it.
    pub name: &'static str,
    /// Whether the runtime's extensions include it; those of the core are always there.
    pub(crate) offered: fn(&ExtensionSet) -> bool,
    both: &'static [&'static str],
    left: &'static [&'static str],
    right: &'static [&'static str],
}

impl Profile {
    /// What it has on one hand, below `input`.
    pub fn components(&self, side: Side) -> impl Iterator<Item = &'static str> {
        let own = match side {
            Side::Left => self.left,
            Side::Right => self.right,
        };
        self.both.iter().chain(own).copied()
    }

    /// Whether it has `component` on one hand.
    pub fn has(&self, side: Side, component: &str) -> bool {
        self.components(side).any(|c| c == component)
    }

    /// The one of that id.
    pub fn named(id: &str) -> Option<&'static Self> {
        PROFILES.iter().find(|p| p.id == id)
    }
}

fn always(_: &ExtensionSet) -> bool {
    true
}

/// Every one. What the runtime reserves (system buttons) is left out.
pub const PROFILES: &[Profile] = &[
    Profile {
        id: "htc/vive_controller",
        name: "HTC Vive",
        offered: always,
        both: &[
            "squeeze/click",
            "menu/click",
            "trigger/click",
            "trigger/value",
            "trackpad",
            "trackpad/click",
            "trackpad/touch",
        ],
        left: &[],
        right: &[],
    },
    Profile {
        id: "valve/index_controller",
        name: "Valve Index",
        offered: always,
        both: &[
            "a/click",
            "a/touch",
            "b/click",
            "b/touch",
            "squeeze/value",
            "squeeze/force",
            "trigger/click",
            "trigger/value",
            "trigger/touch",
            "thumbstick",
            "thumbstick/click",
            "thumbstick/touch",
            "trackpad",
            "trackpad/force",
            "trackpad/touch",
        ],
        left: &[],
        right: &[],
    },
    Profile {
        id: "oculus/touch_controller",
        name: "Oculus Touch",
        offered: always,
        both: &[
            "squeeze/value",
            "trigger/value",
            "trigger/touch",
            "thumbstick",
            "thumbstick/click",
            "thumbstick/touch",
        ],
        left: &["x/click", "x/touch", "y/click", "y/touch", "menu/click"],
        right: &["a/click", "a/touch", "b/click", "b/touch"],
    },
    Profile {
        id: "microsoft/motion_controller",
        name: "Windows Mixed Reality",
        offered: always,
        both: &[
            "menu/click",
            "squeeze/click",
            "trigger/value",
            "thumbstick",
            "thumbstick/click",
            "trackpad",
            "trackpad/click",
            "trackpad/touch",
        ],
        left: &[],
        right: &[],
    },
    Profile {
        id: "hp/mixed_reality_controller",
        name: "HP Reverb",
        offered: |e| e.ext_hp_mixed_reality_controller,
        both: &[
            "menu/click",
            "squeeze/value",
            "trigger/value",
            "thumbstick",
            "thumbstick/click",
        ],
        left: &["x/click", "y/click"],
        right: &["a/click", "b/click"],
    },
    Profile {
        id: "bytedance/pico4_controller",
        name: "Pico 4",
        offered: |e| e.bd_controller_interaction,
        both: &[
            "trigger/click",
            "trigger/value",
            "trigger/touch",
            "thumbstick",
            "thumbstick/click",
            "thumbstick/touch",
            "squeeze/click",
            "squeeze/value",
        ],
        left: &["x/click", "x/touch", "y/click", "y/touch", "menu/click"],
        right: &["a/click", "a/touch", "b/click", "b/touch"],
    },
    Profile {
        id: "bytedance/pico_neo3_controller",
        name: "Pico Neo 3",
        offered: |e| e.bd_controller_interaction,
        both: &[
            "menu/click",
            "trigger/click",
            "trigger/value",
            "trigger/touch",
            "thumbstick",
            "thumbstick/click",
            "thumbstick/touch",
            "squeeze/click",
            "squeeze/value",
        ],
        left: &["x/click", "x/touch", "y/click", "y/touch"],
        right: &["a/click", "a/touch", "b/click", "b/touch"],
    },
    Profile {
        id: "khr/simple_controller",
        name: "a simple controller",
        offered: always,
        both: &["select/click", "menu/click"],
        left: &[],
        right: &[],
    },
];
