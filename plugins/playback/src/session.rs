use std::{fmt, path::Path, sync::Arc, time::Duration};

use bevy::math::Vec3;
use midair_studio::hands::{HandsInput, Pose, Side};
use serde::Deserialize;

use crate::{Cursor, SessionError, Step, parse};

/// The version of the format that is read and written.
pub const FORMAT: u32 = 1;
/// The time step of a session that names none: 1/90 s, to the nanosecond.
pub const DEFAULT_DT: Duration = Duration::from_nanos(11_111_111);
/// The longest session, in seconds of its own time; a longer one is refused before it starts.
pub const MAX_SECONDS: u64 = 4 * 3600;
/// The most frames of a session.
pub const MAX_FRAMES: u64 = 4_000_000;
/// The largest file that is read, in bytes: four hours of recording at 90 Hz take about a
/// sixth.
pub const MAX_BYTES: u64 = 512 << 20;

/// The longest and shortest time step a session may name, in seconds.
pub(crate) const DT: (f64, f64) = (0.001, 0.1);
/// The longest recorded frame: the engine's clock takes no longer ones.
pub(crate) const LONGEST_FRAME: Duration = Duration::from_millis(250);

/// Where the hands are before the first step: level, pointing ahead.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StartHands {
    /// The left one, in world metres.
    pub left: Vec3,
    /// The right one.
    pub right: Vec3,
}

impl Default for StartHands {
    fn default() -> Self {
        Self {
            left: Vec3::new(-0.2, 1.1, 0.3),
            right: Vec3::new(0.2, 1.1, 0.3),
        }
    }
}

/// Where a step stands in its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file, as the user named it.
    pub file: String,
    /// Counted from 1.
    pub line: usize,
    /// Counted from 1, in characters.
    pub column: usize,
    /// Which step, counted from 1, and its name; `None` for the head of the file.
    pub step: Option<(usize, &'static str)>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file, self.line, self.column)?;
        match self.step {
            Some((number, name)) => write!(f, ": step {number}, {name}"),
            None => Ok(()),
        }
    }
}

/// A session, read and checked: every step makes sense by itself, and all of them together stay
/// within [`MAX_SECONDS`] and [`MAX_FRAMES`].
#[derive(Clone, Debug)]
pub struct Session {
    pub(crate) file: String,
    pub(crate) title: String,
    pub(crate) dt: Duration,
    pub(crate) recorded: bool,
    pub(crate) hands: Option<StartHands>,
    pub(crate) steps: Vec<Step>,
    /// Line and column of each step.
    pub(crate) places: Vec<(usize, usize)>,
    pub(crate) truncated: bool,
    pub(crate) frames: u64,
    pub(crate) duration: Duration,
}

impl Session {
    /// Reads a file. Errors: [`SessionError`], one line naming file, line and column.
    pub fn load(path: &Path) -> Result<Self, SessionError> {
        parse::load(path)
    }

    /// Reads text; `file` is the name that errors give it.
    pub fn parse(text: &str, file: &str) -> Result<Self, SessionError> {
        parse::parse(text, file)
    }

    /// What the user named the file.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Its title.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The time step of everything that is not recorded.
    pub fn dt(&self) -> Duration {
        self.dt
    }

    /// Whether it was recorded, so that background work arrives when it did then.
    pub fn is_recorded(&self) -> bool {
        self.recorded
    }

    /// Whether its file ends in the middle of a recording; it plays up to there.
    pub fn is_truncated(&self) -> bool {
        self.truncated
    }

    /// The steps.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// How many frames it has, without those that wait for background work.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// How long it is.
    pub fn duration(&self) -> Duration {
        self.duration
    }

    /// Where a step stands; the head of the file where there is no such step.
    pub fn place(&self, step: usize) -> Place {
        let (line, column) = self.places.get(step).copied().unwrap_or((1, 1));
        Place {
            file: self.file.clone(),
            line,
            column,
            step: self.steps.get(step).map(|s| (step + 1, s.name())),
        }
    }

    /// The hands before the first step.
    pub(crate) fn start(&self) -> HandsInput {
        let mut input = HandsInput::default();
        // A recording says itself when the tracking begins.
        let hands = self.hands.or((!self.recorded).then(StartHands::default));
        if let Some(hands) = hands {
            input.side(Side::Left).pose = Some(Pose::at(hands.left));
            input.side(Side::Right).pose = Some(Pose::at(hands.right));
        }
        input
    }

    /// Its frames, from the first.
    pub fn cursor(self: &Arc<Self>) -> Cursor {
        Cursor::new(self.clone())
    }
}
