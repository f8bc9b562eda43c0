use serde::{Deserialize, Serialize};

/// How hands move the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WorldSettings {
    /// Whether it may be tilted; otherwise it stays upright.
    pub tilt: bool,
    /// Whether one hand alone moves and turns it; its stick scales it.
    pub one_handed: bool,
    /// Whether one sits in a headset: the floor is lowered, so that work stands as high as to somebody standing.
    pub seated: bool,
    /// By how much then, in metres.
    pub lowered: f32,
}

impl Default for WorldSettings {
    fn default() -> Self {
        Self {
            tilt: false,
            one_handed: false,
            seated: false,
            lowered: 0.4,
        }
    }
}
