//! Recorded frames, packed: what changed since the frame before, bit for bit.
//!
//! A run is a string of bytes, written in a session as base64. Each frame is a byte of flags and
//! what they announce; a number that changed is the exclusive-or of its bits with those before, as
//! a LEB128 variable-length integer, so that a still hand costs nothing and a moving one about
//! 22 bytes. The byte 0x80 and a count repeat the frame before. Every run starts from
//! [`FrameBits::START`], so that each is whole in itself.

mod bits;

use std::{fmt, time::Duration};

use base64::{Engine, engine::general_purpose::STANDARD_NO_PAD};
use midair_studio::hands::HandsInput;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

pub(crate) use bits::Unpacker;
use bits::{FrameBits, REPEAT, pack, put};

/// One frame of the hands: how long after the one before, and what the devices said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Time since the frame before.
    pub dt: Duration,
    /// Both hands, the eyes, the scale.
    pub input: HandsInput,
}

/// What is wrong with a run of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FrameRunFault {
    /// Not base64.
    #[error("recorded frames are not base64")]
    NotBase64,
    /// The bytes end inside a frame.
    #[error("recorded frames end inside frame {0}")]
    CutOff(u64),
    /// A flag, count or action that this format does not have.
    #[error("recorded frames make no sense at frame {0}")]
    Senseless(u64),
}

/// A run of recorded frames, packed. Always well formed: it is checked when it is made.
#[derive(Clone, PartialEq, Eq)]
pub struct FrameRun {
    bytes: Box<[u8]>,
    frames: u64,
    nanos: u64,
}

impl FrameRun {
    /// How many frames.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// How long they take together; at most [`u64::MAX`] nanoseconds are counted.
    pub fn duration(&self) -> Duration {
        Duration::from_nanos(self.nanos)
    }

    /// The frames, one at a time.
    pub fn iter(&self) -> impl Iterator<Item = Frame> + '_ {
        let mut unpacker = Unpacker::default();
        std::iter::from_fn(move || unpacker.next(self))
    }

    /// Calls `f` with every frame that is not the same as the one before it.
    pub(crate) fn for_each_change(&self, mut f: impl FnMut(&Frame)) {
        let mut unpacker = Unpacker::default();
        while let Ok(Some(_)) = unpacker.step(&self.bytes, 0) {
            f(&unpacker.state.frame());
        }
    }

    /// Takes packed bytes. Errors: [`FrameRunFault`]; memory stays within the bytes given.
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self, FrameRunFault> {
        let mut run = Self {
            bytes: bytes.into(),
            frames: 0,
            nanos: 0,
        };
        let mut unpacker = Unpacker::default();
        // Repeats are counted, not walked: a hostile count costs no time.
        while let Some(repeat) = unpacker.step(&run.bytes, run.frames)? {
            run.frames = run.frames.saturating_add(repeat);
            run.nanos = run
                .nanos
                .saturating_add(unpacker.state.dt.saturating_mul(repeat));
        }
        Ok(run)
    }

    /// The text of the run in a session.
    pub fn to_base64(&self) -> String {
        STANDARD_NO_PAD.encode(&self.bytes)
    }
}

impl fmt::Debug for FrameRun {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "FrameRun({} frames)", self.frames)
    }
}

impl Serialize for FrameRun {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(&self.to_base64())
    }
}

impl<'de> Deserialize<'de> for FrameRun {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Text;

        impl de::Visitor<'_> for Text {
            type Value = FrameRun;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("recorded frames as a string")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<FrameRun, E> {
                STANDARD_NO_PAD
                    .decode(text)
                    .map_err(|_| FrameRunFault::NotBase64)
                    .and_then(FrameRun::from_bytes)
                    .map_err(E::custom)
            }
        }

        d.deserialize_str(Text)
    }
}

/// Packs frames, one after the other.
#[derive(Clone)]
pub struct FrameRunBuilder {
    bytes: Vec<u8>,
    last: FrameBits,
    /// Frames not yet written that are the same as the last one.
    repeats: u64,
    frames: u64,
    nanos: u64,
}

impl Default for FrameRunBuilder {
    fn default() -> Self {
        Self {
            bytes: Vec::new(),
            last: FrameBits::START,
            repeats: 0,
            frames: 0,
            nanos: 0,
        }
    }
}

impl FrameRunBuilder {
    /// How many frames it holds.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// How long they take together.
    pub fn duration(&self) -> Duration {
        Duration::from_nanos(self.nanos)
    }

    /// Takes one more.
    pub fn push(&mut self, frame: &Frame) {
        let bits = self.last.followed_by(frame);
        self.nanos = self.nanos.saturating_add(bits.dt);
        if self.frames > 0 && bits == self.last {
            self.repeats += 1;
        } else {
            self.write_repeats();
            pack(&mut self.bytes, &self.last, &bits);
            self.last = bits;
        }
        self.frames += 1;
    }

    /// The run; the builder is empty afterwards.
    pub fn take(&mut self) -> FrameRun {
        self.write_repeats();
        let done = std::mem::take(self);
        FrameRun {
            bytes: done.bytes.into(),
            frames: done.frames,
            nanos: done.nanos,
        }
    }

    fn write_repeats(&mut self) {
        if self.repeats > 0 {
            self.bytes.push(REPEAT);
            put(&mut self.bytes, self.repeats);
            self.repeats = 0;
        }
    }
}
