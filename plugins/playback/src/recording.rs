use std::{
    io,
    path::{Path, PathBuf},
    time::Duration,
};

use midair_studio::{command::Command, evaluate::Job};
use serde::Serialize;

use crate::{
    FORMAT, Frame, FrameRunBuilder, MAX_FRAMES, MAX_SECONDS, parse, session::LONGEST_FRAME,
    sink::Sink,
};

/// How much is written at a time; a crash loses no more.
const CHUNK: Duration = Duration::from_secs(1);

/// Why a recording cannot begin or be ended whole.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The file cannot be made.
    #[error("{file}: cannot be recorded to: {reason}")]
    Create {
        /// The file.
        file: String,
        /// What the system says.
        reason: io::Error,
    },
    /// It ended early.
    #[error("{file}: the recording has ended: {reason}; what was written before can be played")]
    Ended {
        /// The file.
        file: String,
        /// Why.
        reason: String,
    },
}

/// A recording under way: what the hands did, as a session.
pub struct Recording {
    path: PathBuf,
    sink: Option<Sink>,
    run: FrameRunBuilder,
    frames: u64,
    time: Duration,
    fault: Option<String>,
}

impl Recording {
    /// Begins a recording in `path`, which is overwritten.
    pub fn create(path: &Path, title: &str) -> Result<Self, RecordError> {
        let head = format!(
            "// A recorded session of Midair.\n(\nformat: {FORMAT},\ntitle: {},\nrecorded: true,\n\
             steps: [\n",
            to_ron(&title).unwrap_or_else(|_| "\"\"".into())
        );
        let sink = Sink::create(path, &head).map_err(|reason| RecordError::Create {
            file: path.display().to_string(),
            reason,
        })?;
        Ok(Self {
            path: path.to_owned(),
            sink: Some(sink),
            run: FrameRunBuilder::default(),
            frames: 0,
            time: Duration::ZERO,
            fault: None,
        })
    }

    /// Adds one frame: what was asked for in it, and which results it took in, both in order.
    /// Nothing happens once the recording has ended.
    pub fn push(&mut self, frame: &Frame, asked: &[Command], ready: &[Job]) {
        if self.sink.is_none() {
            return;
        }
        let frame = Frame {
            dt: frame.dt.min(LONGEST_FRAME),
            ..*frame
        };
        if self.frames + 1 > MAX_FRAMES || self.time + frame.dt > Duration::from_secs(MAX_SECONDS) {
            let hours = MAX_SECONDS / 3600;
            self.end(format!("it reached {hours} hours or {MAX_FRAMES} frames"));
            return;
        }
        if !asked.is_empty() || !ready.is_empty() {
            self.write_run();
        }
        if !asked.is_empty() {
            self.write_step("Asked", asked);
        }
        if !ready.is_empty() {
            self.write_step("Ready", ready);
        }
        self.run.push(&frame);
        self.frames += 1;
        self.time += frame.dt;
        if self.run.duration() >= CHUNK {
            self.write_run();
        }
        if let Some(fault) = self.sink.as_ref().and_then(Sink::fault) {
            let fault = fault.to_owned();
            self.end(fault);
        }
    }

    /// Ends the file and waits until it is written.
    pub fn finish(&mut self) -> Result<(), RecordError> {
        self.write_run();
        if let Some(mut sink) = self.sink.take()
            && let Err(reason) = sink.close()
        {
            self.fault = Some(reason);
        }
        match &self.fault {
            None => Ok(()),
            Some(reason) => Err(RecordError::Ended {
                file: self.path.display().to_string(),
                reason: reason.clone(),
            }),
        }
    }

    /// Frames so far.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Whether it still records.
    pub fn is_open(&self) -> bool {
        self.sink.is_some()
    }

    fn write_run(&mut self) {
        if self.run.frames() > 0 {
            let run = self.run.take();
            self.write_line(format!("Frames(\"{}\"),\n", run.to_base64()));
        }
    }

    fn write_step<T: Serialize>(&mut self, name: &str, what: &[T]) {
        match to_ron(&what) {
            Ok(list) => self.write_line(format!("{name}({list}),\n")),
            Err(e) => self.end(format!("a command cannot be written down: {e}")),
        }
    }

    fn write_line(&mut self, line: String) {
        if let Some(sink) = &self.sink
            && let Err(reason) = sink.send(line)
        {
            self.end(reason);
        }
    }

    fn end(&mut self, reason: String) {
        self.fault.get_or_insert(reason);
        // The writer may hang with its disk: it is left to end by itself.
        if let Some(sink) = self.sink.take() {
            std::thread::spawn(move || drop(sink));
        }
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        // Whoever cares about the outcome has finished it before.
        let _ = self.finish();
    }
}

fn to_ron<T: Serialize + ?Sized>(what: &T) -> Result<String, ron::Error> {
    parse::options().to_string(what)
}
