use serde::{Deserialize, Serialize};

/// Whether the result of what is marked is shown before it is made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PreviewSettings {
    /// Whether it is.
    pub on: bool,
}

impl Default for PreviewSettings {
    fn default() -> Self {
        Self { on: true }
    }
}
