use serde::{Deserialize, Serialize};

/// The room that one works in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum RoomKind {
    /// Calm and dark.
    #[default]
    Dusk,
    /// Light.
    Day,
    /// White, as in ScaffoldSketch.
    Paper,
}

/// The room and how it is drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LookSettings {
    /// Which room.
    pub room: RoomKind,
    /// Whether edges of triangles are drawn.
    pub wireframe: bool,
    /// Whether what is far is as large as what is near.
    pub orthographic: bool,
    /// Whether what appears and snaps eases in; without it, it is there at once.
    pub motion: bool,
    /// Panels and text, as a multiple of their usual size.
    pub interface_scale: f32,
}

impl Default for LookSettings {
    fn default() -> Self {
        Self {
            room: RoomKind::default(),
            wireframe: false,
            orthographic: false,
            motion: true,
            interface_scale: 1.0,
        }
    }
}
