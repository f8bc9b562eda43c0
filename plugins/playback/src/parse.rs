//! From text to a [`Session`], with the line and column of everything that is wrong.

use std::{
    fmt, fs,
    io::{self, Read},
    path::Path,
    time::Duration,
};

use ron::{error::SpannedError, extensions::Extensions, value::RawValue};
use serde::{
    Deserialize, Deserializer,
    de::{self, DeserializeSeed, MapAccess, SeqAccess, Visitor},
};

use crate::{
    Expectation, FORMAT, MAX_BYTES, MAX_FRAMES, MAX_SECONDS, Place, Session, StartHands, Step,
    cursor::{self, Now},
    session::{DEFAULT_DT, DT, LONGEST_FRAME},
};

/// Why a session cannot be played.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// The file cannot be read.
    #[error("{file}: cannot be read: {reason}")]
    Read {
        /// The file.
        file: String,
        /// What the system says.
        reason: io::Error,
    },
    /// More than [`MAX_BYTES`].
    #[error("{file}: is larger than {} MiB, too large for a session", MAX_BYTES >> 20)]
    TooLarge {
        /// The file.
        file: String,
    },
    /// Not text.
    #[error("{file}: is not a session: byte {at} is not UTF-8 text")]
    NotText {
        /// The file.
        file: String,
        /// Where.
        at: usize,
    },
    /// A newer Midair wrote it.
    #[error("{file}: is format {found}; this Midair reads format {FORMAT}: a newer one is needed")]
    Newer {
        /// The file.
        file: String,
        /// Its format.
        found: u64,
    },
    /// It does not parse: an unknown step, field or action among others.
    #[error("{at}: {what}")]
    Syntax {
        /// Where.
        at: Place,
        /// What, and what there is instead.
        what: String,
    },
    /// A step whose numbers make no sense.
    #[error("{at}: {what}")]
    Senseless {
        /// Which.
        at: Place,
        /// Why.
        what: String,
    },
    /// Longer than [`MAX_SECONDS`] or [`MAX_FRAMES`].
    #[error(
        "{at}: the session is longer than {} hours or {} frames with this step; cut it in parts",
        MAX_SECONDS / 3600, MAX_FRAMES
    )]
    TooLong {
        /// The step that makes it so.
        at: Place,
    },
}

pub(crate) fn load(path: &Path) -> Result<Session, SessionError> {
    let file = path.display().to_string();
    let read = |reason| SessionError::Read {
        file: file.clone(),
        reason,
    };
    let mut bytes = Vec::new();
    fs::File::open(path)
        .map_err(read)?
        // A device or pipe has no length beforehand.
        .take(MAX_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(read)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(SessionError::TooLarge { file });
    }
    let text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(e) => {
            let fault = e.utf8_error();
            let at = fault.valid_up_to();
            // Cut off inside a character: the text before it may be a recording's.
            if fault.error_len().is_some() {
                return Err(SessionError::NotText { file, at });
            }
            let mut bytes = e.into_bytes();
            bytes.truncate(at);
            String::from_utf8_lossy(&bytes).into_owned()
        }
    };
    parse(&text, &file)
}

pub(crate) fn parse(text: &str, file: &str) -> Result<Session, SessionError> {
    // A file system may fill what was not written before a crash with zeros.
    let text = text.trim_end_matches('\0');
    let at = |line, column, step| Place {
        file: file.to_owned(),
        line,
        column,
        step,
    };
    let mut head = Head::default();
    let outcome = options().from_str_seed(text, HeadSeed(&mut head));
    if let Some(found) = head.format.filter(|&f| f != u64::from(FORMAT)) {
        return Err(SessionError::Newer {
            file: file.to_owned(),
            found,
        });
    }
    let mut truncated = false;
    if let Err(e) = outcome {
        // A recorder writes one step a line: only its last one can be unfinished.
        let last_line = text.trim_end_matches('\n').lines().count();
        truncated = head.recorded && !head.steps.is_empty() && e.span.end.line >= last_line;
        if !truncated {
            return Err(SessionError::Syntax {
                at: at(e.span.start.line, e.span.start.col, None),
                what: plain(&e),
            });
        }
    }
    let mut steps = Vec::with_capacity(head.steps.len());
    let mut places = Vec::with_capacity(head.steps.len());
    let mut walk = Walk::new(text);
    for raw in &head.steps {
        let raw = skip_blank(raw.get_ron());
        let (line, column) = walk.to(raw);
        let parsed = if ident(raw) == "Expect" {
            options().from_str::<Expectation>(raw).map(Step::Expect)
        } else {
            options().from_str::<Step>(raw)
        };
        let step = parsed.map_err(|e| {
            let start = e.span.start;
            let here = match start.line {
                1 => at(line, column + start.col - 1, None),
                n => at(line + n - 1, start.col, None),
            };
            SessionError::Syntax {
                at: here,
                what: plain(&e),
            }
        })?;
        if let Some(what) = step.fault() {
            return Err(SessionError::Senseless {
                at: at(line, column, Some((steps.len() + 1, step.name()))),
                what,
            });
        }
        steps.push(step);
        places.push((line, column));
    }
    let dt = match head.dt {
        None => DEFAULT_DT,
        Some(s) if s >= DT.0 && s <= DT.1 => Duration::from_nanos((s * 1e9).round() as u64),
        Some(s) => {
            return Err(SessionError::Senseless {
                at: at(1, 1, None),
                what: format!("`dt` is {s}: it must lie in [{}, {}] seconds", DT.0, DT.1),
            });
        }
    };
    if let Some(h) = head.hands
        && !(h.left.is_finite() && h.right.is_finite())
    {
        return Err(SessionError::Senseless {
            at: at(1, 1, None),
            what: "`hands` must start somewhere finite".into(),
        });
    }
    let mut session = Session {
        file: file.to_owned(),
        title: head.title,
        dt,
        recorded: head.recorded,
        hands: head.hands,
        steps,
        places,
        truncated,
        frames: 0,
        duration: Duration::ZERO,
    };
    measure(&mut session)?;
    Ok(session)
}

/// Counts frames and time, and refuses what is too long, without walking the frames.
fn measure(session: &mut Session) -> Result<(), SessionError> {
    let mut now = Now::new(session.start());
    let mut pending = false;
    for index in 0..session.steps.len() {
        let step = &session.steps[index];
        let (frames, duration) = if let Step::Frames(run) = step {
            let mut last = session.start();
            let mut slowest = Duration::ZERO;
            run.for_each_change(|frame| {
                slowest = slowest.max(frame.dt);
                last = frame.input;
            });
            if slowest > LONGEST_FRAME {
                return Err(SessionError::Senseless {
                    at: session.place(index),
                    what: format!("a recorded frame lasts {slowest:?}; the most is 0.25 s"),
                });
            }
            if run.frames() > 0 {
                now.take(last);
            }
            (run.frames(), run.duration())
        } else {
            let mut frames = 0_u64;
            for leg in cursor::plan(step, &now, session.dt) {
                frames = frames.saturating_add(leg.frames);
                leg.finish(&mut now);
            }
            (frames, nanos(session.dt, frames))
        };
        pending = match step {
            Step::Asked(_) | Step::Ready(_) => true,
            _ => pending && frames == 0,
        };
        session.frames = session.frames.saturating_add(frames);
        session.duration = session.duration.saturating_add(duration);
        if session.frames > MAX_FRAMES || session.duration > Duration::from_secs(MAX_SECONDS) {
            return Err(SessionError::TooLong {
                at: session.place(index),
            });
        }
    }
    if pending && !session.truncated {
        session.frames += 1;
        session.duration += session.dt;
    }
    Ok(())
}

fn nanos(dt: Duration, frames: u64) -> Duration {
    // At most 0.1 s by 2⁶⁴ frames: beyond the limit it only has to stay beyond it.
    Duration::from_nanos((dt.as_nanos() as u64).saturating_mul(frames))
}

/// How sessions write RON: `Some(x)` may be written `x`.
pub(crate) fn options() -> ron::Options {
    ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME)
}

/// RON's words for a fault, in one line, with all that could stand there instead.
fn plain(e: &SpannedError) -> String {
    use ron::Error as E;
    let list = |all: &[&str]| all.join(", ");
    let outer = |o: &Option<String>| o.as_ref().map_or_else(String::new, |o| format!(" of {o}"));
    match &e.code {
        E::NoSuchEnumVariant {
            expected,
            found,
            outer: Some(outer),
        } => {
            let what = match outer.as_str() {
                "Step" => "step",
                "Action" => "action",
                "Side" => "hand",
                "Command" => "command",
                other => other,
            };
            format!(
                "there is no {what} `{found}`; there are: {}",
                list(expected)
            )
        }
        E::NoSuchEnumVariant {
            expected, found, ..
        } => format!("there is no `{found}`; there are: {}", list(expected)),
        E::NoSuchStructField {
            expected,
            found,
            outer: o,
        } => format!(
            "there is no field `{found}`{}; there are: {}",
            outer(o),
            list(expected)
        ),
        E::MissingStructField { field, outer: o } => {
            format!("the field `{field}`{} is missing", outer(o))
        }
        E::DuplicateStructField { field, outer: o } => {
            format!("the field `{field}`{} stands twice", outer(o))
        }
        other => {
            let line = other.to_string().replace('\n', " ");
            match line.chars().count() {
                0..300 => line,
                _ => line.chars().take(300).chain("…".chars()).collect(),
            }
        }
    }
}

/// Turns places in a text into lines and columns, going forward once.
struct Walk<'a> {
    text: &'a str,
    at: usize,
    line: usize,
    column: usize,
}

impl<'a> Walk<'a> {
    fn new(text: &'a str) -> Self {
        Self {
            text,
            at: 0,
            line: 1,
            column: 1,
        }
    }

    /// Line and column of the start of `part`, a slice of the text at or after the last one.
    fn to(&mut self, part: &str) -> (usize, usize) {
        let to = (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize);
        let between = self.text.get(self.at..to).unwrap_or_default();
        match between.rfind('\n') {
            Some(last) => {
                self.line += between.matches('\n').count();
                self.column = 1 + between[last + 1..].chars().count();
            }
            None => self.column += between.chars().count(),
        }
        self.at = self.at.max(to);
        (self.line, self.column)
    }
}

/// `text` without the white space and comments in front.
fn skip_blank(mut text: &str) -> &str {
    loop {
        text = text.trim_start();
        if text.starts_with("//") {
            text = text.split_once('\n').map_or("", |(_, rest)| rest);
        } else if text.starts_with("/*") {
            let mut depth = 0_usize;
            let mut at = 0;
            let end = loop {
                let rest = &text.as_bytes()[at..];
                if rest.is_empty() {
                    break at;
                } else if rest.starts_with(b"/*") {
                    depth += 1;
                    at += 2;
                } else if rest.starts_with(b"*/") {
                    depth -= 1;
                    at += 2;
                    if depth == 0 {
                        break at;
                    }
                } else {
                    at += 1;
                }
            };
            text = &text[end..];
        } else {
            return text;
        }
    }
}

fn ident(text: &str) -> &str {
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_');
    &text[..end.unwrap_or(text.len())]
}

/// The file before its steps are understood; filled as it is read, so that what stands before a
/// fault is kept.
#[derive(Default)]
struct Head<'a> {
    format: Option<u64>,
    title: String,
    dt: Option<f64>,
    recorded: bool,
    hands: Option<StartHands>,
    steps: Vec<&'a RawValue>,
}

#[derive(Deserialize)]
#[serde(field_identifier, rename_all = "snake_case")]
enum Field {
    Format,
    Title,
    Dt,
    Recorded,
    Hands,
    Steps,
}

struct HeadSeed<'h, 'a>(&'h mut Head<'a>);

impl<'a> DeserializeSeed<'a> for HeadSeed<'_, 'a> {
    type Value = ();

    fn deserialize<D: Deserializer<'a>>(self, d: D) -> Result<(), D::Error> {
        const FIELDS: &[&str] = &["format", "title", "dt", "recorded", "hands", "steps"];
        d.deserialize_struct("Session", FIELDS, self)
    }
}

impl<'a> Visitor<'a> for HeadSeed<'_, 'a> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a session: (format: 1, title: \"…\", steps: […])")
    }

    fn visit_map<A: MapAccess<'a>>(self, mut map: A) -> Result<(), A::Error> {
        let head = self.0;
        let mut steps = false;
        while let Some(field) = map.next_key()? {
            match field {
                Field::Format => {
                    let format = map.next_value()?;
                    head.format = Some(format);
                    // What follows may be written in another way.
                    if format != u64::from(FORMAT) {
                        return Err(de::Error::custom("another format"));
                    }
                }
                Field::Title => head.title = map.next_value()?,
                Field::Dt => head.dt = map.next_value()?,
                Field::Recorded => head.recorded = map.next_value()?,
                Field::Hands => head.hands = map.next_value()?,
                Field::Steps if steps => return Err(de::Error::duplicate_field("steps")),
                Field::Steps => {
                    steps = true;
                    map.next_value_seed(StepsSeed(&mut head.steps))?;
                }
            }
        }
        if head.format.is_none() {
            return Err(de::Error::missing_field("format"));
        }
        if !steps {
            return Err(de::Error::missing_field("steps"));
        }
        Ok(())
    }
}

struct StepsSeed<'h, 'a>(&'h mut Vec<&'a RawValue>);

impl<'a> DeserializeSeed<'a> for StepsSeed<'_, 'a> {
    type Value = ();

    fn deserialize<D: Deserializer<'a>>(self, d: D) -> Result<(), D::Error> {
        d.deserialize_seq(self)
    }
}

impl<'a> Visitor<'a> for StepsSeed<'_, 'a> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of steps")
    }

    fn visit_seq<A: SeqAccess<'a>>(self, mut seq: A) -> Result<(), A::Error> {
        while let Some(raw) = seq.next_element()? {
            self.0.push(raw);
        }
        Ok(())
    }
}
