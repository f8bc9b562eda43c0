use serde::{Deserialize, Serialize};

/// Which snaps pull at what a hand moves. All are off in a session until it switches them on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SnapSettings {
    /// To the lines of the work plane.
    pub grid: GridSnap,
    /// To whole steps of a turn.
    pub angle: AngleSnap,
    /// Onto the surface or the ground below.
    pub surface: SurfaceSnap,
}

impl SnapSettings {
    /// What a person finds who has set nothing yet.
    pub fn of_a_person() -> Self {
        Self {
            surface: SurfaceSnap { on: true },
            ..Self::default()
        }
    }
}

/// Snaps to the lines of the work plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct GridSnap {
    /// Its switch.
    pub on: bool,
    /// Metres from line to line.
    pub step: f32,
}

impl Default for GridSnap {
    fn default() -> Self {
        Self {
            on: false,
            step: 0.05,
        }
    }
}

/// Snaps to whole steps of a turn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct AngleSnap {
    /// Its switch.
    pub on: bool,
    /// Degrees.
    pub step: f32,
}

impl Default for AngleSnap {
    fn default() -> Self {
        Self {
            on: false,
            step: 15.0,
        }
    }
}

/// Sets the underside onto what is below it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SurfaceSnap {
    /// Its switch.
    pub on: bool,
}
