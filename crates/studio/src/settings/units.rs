use midair_mesh::Unit;
use serde::{Deserialize, Serialize};

/// In what lengths are read and written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct UnitSettings {
    /// Lengths on panels and in the view.
    pub length: Unit,
}

impl Default for UnitSettings {
    fn default() -> Self {
        Self { length: Unit::Mm }
    }
}
