use serde::{Deserialize, Serialize};

/// The plane through the origin across which everything is mirrored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum MirrorPlane {
    /// Nothing is mirrored.
    #[default]
    None,
    /// Left and right: the plane's normal is X.
    X,
    /// Above and below: the plane's normal is Y.
    Y,
    /// Front and back: the plane's normal is Z.
    Z,
}

/// Live symmetry: what is made on one side is made on the others too.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct SymmetrySettings {
    /// Across which plane.
    pub mirror: MirrorPlane,
    /// How many there are around the vertical through the origin, the first included; 1 for none.
    pub count: u32,
    /// Whether its planes are seen while it is on.
    pub planes: bool,
}

impl Default for SymmetrySettings {
    fn default() -> Self {
        Self {
            mirror: MirrorPlane::None,
            count: 1,
            planes: true,
        }
    }
}

impl SymmetrySettings {
    /// Whether anything is mirrored or turned.
    pub fn is_on(&self) -> bool {
        self.mirror != MirrorPlane::None || self.count > 1
    }
}
