use serde::{Deserialize, Serialize};

/// What a trigger draws in Scaffold (ScaffoldSketch §3.2).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Draws {
    /// A straight construction line.
    #[default]
    Line,
    /// A free shape stroke.
    Stroke,
}

/// How construction lines are seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum LinesShown {
    /// In full.
    #[default]
    Shown,
    /// Faintly; they pull as before.
    Dimmed,
    /// Not at all; what is not seen does not pull.
    Hidden,
}

/// How Scaffold reads what hands draw. The thresholds are those of ScaffoldSketch §4; on a screen lengths of the
/// hand are pixels, 16 to 5 cm and 10 to 3 cm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ScaffoldSettings {
    /// What the trigger draws.
    pub draws: Draws,
    /// Whether what is drawn is corrected.
    pub auto: bool,
    /// All thresholds of correction are multiplied by this, 0.1 to 3.
    pub strength: f64,
    /// Physical metres between an end and a keypoint or line.
    pub distance: f64,
    /// Degrees off square or parallel.
    pub angle: f64,
    /// Off equal length, as a share.
    pub length: f64,
    /// Whether the vertical is a direction to be square or parallel to.
    pub vertical: bool,
    /// Whether a third, a sixth, an eighth of a turn to a line that is met is meant.
    pub part_turns: bool,
    /// Physical metres within which a stroke goes through a keypoint.
    pub stroke_distance: f64,
    /// Degrees within which a stroke follows a line.
    pub stroke_angle: f64,
    /// Metres from side to side of a stroke.
    pub width: f64,
    /// Metres from face to face of a plate.
    pub plate: f64,
    /// How construction lines are seen.
    pub lines: LinesShown,
}

impl Default for ScaffoldSettings {
    fn default() -> Self {
        Self {
            draws: Draws::Line,
            auto: true,
            strength: 1.0,
            distance: 0.05,
            angle: 10.0,
            length: 0.25,
            vertical: true,
            part_turns: true,
            stroke_distance: 0.03,
            stroke_angle: 25.0,
            width: 0.008,
            plate: 0.01,
            lines: LinesShown::Shown,
        }
    }
}

impl ScaffoldSettings {
    /// The same with every number within what makes sense, whatever a file or a session says.
    #[must_use]
    pub fn sound(&self) -> Self {
        let within = |value: f64, low: f64, high: f64, usual: f64| {
            if value.is_finite() {
                value.clamp(low, high)
            } else {
                usual
            }
        };
        let usual = Self::default();
        Self {
            strength: within(self.strength, 0.1, 3.0, usual.strength),
            distance: within(self.distance, 0.002, 0.2, usual.distance),
            angle: within(self.angle, 0.5, 30.0, usual.angle),
            length: within(self.length, 0.01, 0.6, usual.length),
            stroke_distance: within(self.stroke_distance, 0.002, 0.2, usual.stroke_distance),
            stroke_angle: within(self.stroke_angle, 1.0, 60.0, usual.stroke_angle),
            width: within(self.width, 0.0005, 0.2, usual.width),
            plate: within(self.plate, 0.001, 0.5, usual.plate),
            ..self.clone()
        }
    }
}
