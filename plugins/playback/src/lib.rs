//! Sessions: hands written down or recorded, played back.
//!
//! A [`Session`] is a RON file of [`Step`]s at the level of the hands (`docs/session.md`). A
//! [`Cursor`] expands it, purely, into one [`Beat`] a frame; the [`PlayerPlugin`] writes each beat
//! into the studio's hands, where a device would; [`play`] drives an app through all of them. The
//! [`RecorderPlugin`] writes down what live hands do, so that it plays back bit for bit.
//!
//! What is guaranteed: the same session gives the same hands, times, commands and arrivals of
//! background work, in the same frames, on every run. What is not: that a tool which reads the
//! wall clock, the file system or random numbers does the same with them.

mod arrivals;
mod cursor;
mod expect;
mod frames;
mod hands_only;
mod motion;
mod parse;
mod parts;
mod player;
mod record;
mod recording;
mod report;
mod run;
mod session;
mod sink;
mod step;
mod systems;
mod turn;

pub use arrivals::{Arrivals, OffFrame};
pub use cursor::{Beat, Cursor, FrameBeat};
pub use expect::Expectation;
pub use frames::{Frame, FrameRun, FrameRunBuilder, FrameRunFault};
pub use hands_only::{HandsOnlyFault, MAX_SPEED, SpeedGate, check_hands_only};
pub use parse::SessionError;
pub use parts::{Counted, Parts, PartsPlugin, TIME_SYSTEMS};
pub use player::{Next, Player, PlayerPlugin, prepare};
pub use record::{Recorder, RecorderPlugin};
pub use recording::{RecordError, Recording};
pub use report::{
    DrawnReport, FrameTimes, LineReport, ObjectReport, Report, StrokeReport, UpdateReport,
};
pub use run::{PlayError, PlayOptions, play};
pub use session::{
    DEFAULT_DT, FORMAT, MAX_BYTES, MAX_FRAMES, MAX_SECONDS, Place, Session, StartHands,
};
pub use step::{Goal, Step};
pub use systems::SystemReport;
pub use turn::Turn;
