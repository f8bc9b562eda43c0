//! What the studio has to say: one line each, where the person looks.

use bevy::prelude::*;

/// How much it matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// Something was done.
    Info,
    /// Something could not be done, or was done in part.
    Warning,
}

/// One line.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    /// What happened and what to do.
    pub text: String,
    /// How much it matters.
    pub weight: Weight,
    /// Seconds since the start when it was said.
    pub at: f64,
}

/// The latest lines, newest last, and every warning of this run for the report.
#[derive(Resource, Debug, Default)]
pub struct Notices {
    lines: Vec<Notice>,
    warnings: Vec<String>,
    now: f64,
}

/// Lines kept for the screen; warnings are kept in full.
const KEPT: usize = 50;

impl Notices {
    /// Says that something was done.
    pub fn info(&mut self, text: impl Into<String>) {
        self.push(text.into(), Weight::Info);
    }

    /// Says that something could not be done.
    pub fn warn(&mut self, text: impl Into<String>) {
        let text = text.into();
        warn!("{text}");
        self.warnings.push(text.clone());
        self.push(text, Weight::Warning);
    }

    /// The lines said within the last `seconds`, oldest first.
    pub fn recent(&self, seconds: f64) -> impl Iterator<Item = &Notice> {
        let since = self.now - seconds;
        self.lines.iter().filter(move |n| n.at >= since)
    }

    /// Every warning of this run.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn push(&mut self, text: String, weight: Weight) {
        let at = self.now;
        self.lines.push(Notice { text, weight, at });
        if self.lines.len() > KEPT {
            self.lines.remove(0);
        }
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Notices>().add_systems(
        First,
        |time: Res<Time<Real>>, mut n: ResMut<Notices>| {
            n.bypass_change_detection().now = time.elapsed_secs_f64();
        },
    );
}
