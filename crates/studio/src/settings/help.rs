use serde::{Deserialize, Serialize};

/// How far one is with learning.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct HelpSettings {
    /// The tutorial.
    pub tutorial: Progress,
}

/// How far one is in the tutorial.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Progress {
    /// Whether it is going on.
    pub state: Lesson,
    /// The step one is at, counted through all its tasks.
    pub step: usize,
    /// Seconds it has taken up to this step.
    pub seconds: f32,
}

/// Whether the tutorial is going on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Lesson {
    /// It has not been asked for yet: it is offered.
    #[default]
    Offered,
    /// It is going on.
    Going,
    /// It was left; it goes on where it was when it is opened again.
    Left,
    /// It is through.
    Done,
}
