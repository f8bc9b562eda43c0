use serde::{Deserialize, Serialize};

/// How two hands move the world.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct WorldSettings {
    /// Whether it may be tilted; otherwise it stays upright.
    pub tilt: bool,
}
