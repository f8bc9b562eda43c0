use serde::{Deserialize, Serialize};

/// Where solids are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Backend {
    /// By the graphics card where there is a real one, else by the processor.
    #[default]
    Auto,
    /// By the graphics card, be it software.
    Card,
    /// By the processor.
    Processor,
}

/// What the machine is used for.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct ComputeSettings {
    /// Where solids are made.
    pub backend: Backend,
}
