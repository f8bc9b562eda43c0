use serde::{Deserialize, Serialize};

/// What the window on the desktop shows while a headset is worn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Desktop {
    /// What the person in the headset sees, steadied.
    #[default]
    Mirror,
    /// The view that mouse and gamepad steer: a spectator's.
    Spectator,
}

/// What one wants in a headset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ComfortSettings {
    /// Panels, labels and text in the room, as a multiple of their usual size.
    pub interface_scale: f32,
    /// Pixels of each eye's image along an edge, as a multiple of what the headset asks for; taken up when it is entered.
    pub sharpness: f32,
    /// How far a wand points below its controller, in degrees.
    pub pointer_angle: f32,
    /// How strongly controllers pulse, 0 to 1.
    pub haptics: f32,
    /// Degrees of one turn by grip and stick; 0 turns nothing.
    pub snap_turn: f32,
    /// How much of the view is darkened while the world moves, 0 to 1.
    pub vignette: f32,
    /// Whether the panel on the wrist shows by itself.
    pub wrist: bool,
    /// Whether buttons are named when a controller comes near the face.
    pub labels: bool,
    /// Whether the time of a frame is shown on the wrist.
    pub budget: bool,
    /// What the window on the desktop shows meanwhile.
    pub desktop: Desktop,
}

impl Default for ComfortSettings {
    fn default() -> Self {
        Self {
            interface_scale: 1.0,
            sharpness: 1.0,
            pointer_angle: 0.0,
            haptics: 0.7,
            snap_turn: 30.0,
            vignette: 0.5,
            wrist: true,
            labels: true,
            budget: false,
            desktop: Desktop::default(),
        }
    }
}
