//! Frames as bits, and bits as bytes: each frame by what changed since the one before.

use std::time::Duration;

use bevy::math::{Quat, Vec2, Vec3};
use midair_studio::hands::{Action, ActionSet, HandFrame, HandsInput, Pose};

use super::{Frame, FrameRun, FrameRunFault};

pub(super) const REPEAT: u8 = 0x80;
const DT: u8 = 1;
const HAND: [u8; 2] = [2, 4];
const HEAD: u8 = 8;
const HAS_HEAD: u8 = 16;
const SCALE: u8 = 32;
const PIXEL: u8 = 64;

const TRACKED: u8 = 1;
const TOUCHED: u8 = 2;
const POSE: u8 = 4;
const SWIPE: u8 = 8;
const DOWN: u8 = 16;

#[derive(Clone, Copy, PartialEq, Eq)]
struct HandBits {
    tracked: bool,
    /// What it was when it was last tracked.
    pose: [u32; 7],
    touched: bool,
    swipe: [u32; 2],
    down: u32,
}

/// A frame as bits, so that a NaN equals itself and −0 is not 0.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct FrameBits {
    /// Nanoseconds.
    pub dt: u64,
    hands: [HandBits; 2],
    has_head: bool,
    head: [u32; 7],
    scale: u32,
    pixel: u32,
}

impl FrameBits {
    pub const START: Self = {
        let pose = [0, 0, 0, 0, 0, 0, 1.0_f32.to_bits()];
        let hand = HandBits {
            tracked: false,
            pose,
            touched: false,
            swipe: [0; 2],
            down: 0,
        };
        Self {
            dt: 0,
            hands: [hand; 2],
            has_head: false,
            head: pose,
            scale: 1.0_f32.to_bits(),
            pixel: 0.0_f32.to_bits(),
        }
    };

    /// `frame` as bits; what it leaves out stays as it was in `self`.
    pub fn followed_by(mut self, frame: &Frame) -> Self {
        self.dt = u64::try_from(frame.dt.as_nanos()).unwrap_or(u64::MAX);
        for (bits, hand) in self.hands.iter_mut().zip(&frame.input.frames) {
            bits.tracked = hand.pose.is_some();
            bits.pose = hand.pose.map_or(bits.pose, |p| pose_bits(&p));
            bits.touched = hand.swipe.is_some();
            bits.swipe = hand
                .swipe
                .map_or(bits.swipe, |s| s.to_array().map(f32::to_bits));
            bits.down = hand.down.iter().map(action_bit).fold(0, |a, b| a | b);
        }
        self.has_head = frame.input.head.is_some();
        self.head = frame.input.head.map_or(self.head, |p| pose_bits(&p));
        self.scale = frame.input.metres_per_world.to_bits();
        self.pixel = frame.input.pixel.to_bits();
        self
    }

    pub fn frame(&self) -> Frame {
        Frame {
            dt: Duration::from_nanos(self.dt),
            input: HandsInput {
                frames: self.hands.map(|h| HandFrame {
                    pose: h.tracked.then(|| pose_of(h.pose)),
                    down: Action::ALL
                        .into_iter()
                        .filter(|&a| h.down & action_bit(a) != 0)
                        .collect::<ActionSet>(),
                    swipe: h
                        .touched
                        .then(|| Vec2::from_array(h.swipe.map(f32::from_bits))),
                }),
                head: self.has_head.then(|| pose_of(self.head)),
                metres_per_world: f32::from_bits(self.scale),
                pixel: f32::from_bits(self.pixel),
            },
        }
    }
}

fn pose_bits(p: &Pose) -> [u32; 7] {
    let ([x, y, z], [i, j, k, w]) = (p.position.to_array(), p.rotation.to_array());
    [x, y, z, i, j, k, w].map(f32::to_bits)
}

fn pose_of(bits: [u32; 7]) -> Pose {
    let [x, y, z, i, j, k, w] = bits.map(f32::from_bits);
    Pose {
        position: Vec3::new(x, y, z),
        rotation: Quat::from_array([i, j, k, w]),
    }
}

/// Its bit in a file, fixed whatever the order of the enum becomes.
fn action_bit(action: Action) -> u32 {
    1 << match action {
        Action::Act => 0,
        Action::Grab => 1,
        Action::Finish => 2,
        Action::Cancel => 3,
        Action::Undo => 4,
        Action::Redo => 5,
        Action::Library => 6,
        Action::Modes => 7,
        Action::Save => 8,
        Action::Delete => 9,
        Action::Up => 10,
        Action::Right => 11,
        Action::Down => 12,
        Action::Left => 13,
        Action::Centre => 14,
        Action::Menu => 15,
        Action::Free => 16,
    }
}

/// Writes what changed from one frame to the next.
pub(super) fn pack(out: &mut Vec<u8>, last: &FrameBits, next: &FrameBits) {
    let at = out.len();
    out.push(0);
    let mut flags = 0;
    if next.dt != last.dt {
        flags |= DT;
        put(out, next.dt);
    }
    for (side, flag) in HAND.into_iter().enumerate() {
        let (a, b) = (&last.hands[side], &next.hands[side]);
        if a == b {
            continue;
        }
        flags |= flag;
        let at = out.len();
        out.push(0);
        let mut hand = 0;
        if b.tracked {
            hand |= TRACKED;
        }
        if b.touched {
            hand |= TOUCHED;
        }
        if a.pose != b.pose {
            hand |= POSE;
            put_changes(out, &a.pose, &b.pose);
        }
        if a.swipe != b.swipe {
            hand |= SWIPE;
            put_changes(out, &a.swipe, &b.swipe);
        }
        if a.down != b.down {
            hand |= DOWN;
            put(out, u64::from(b.down));
        }
        out[at] = hand;
    }
    if next.has_head {
        flags |= HAS_HEAD;
    }
    if last.head != next.head {
        flags |= HEAD;
        put_changes(out, &last.head, &next.head);
    }
    if last.scale != next.scale {
        flags |= SCALE;
        put(out, u64::from(next.scale));
    }
    if last.pixel != next.pixel {
        flags |= PIXEL;
        put(out, u64::from(next.pixel));
    }
    out[at] = flags;
}

fn put_changes(out: &mut Vec<u8>, a: &[u32], b: &[u32]) {
    for (a, b) in a.iter().zip(b) {
        put(out, u64::from(a ^ b));
    }
}

pub(super) fn put(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

/// Reads a run frame by frame; holds no borrow, so that a cursor can keep it.
#[derive(Clone)]
pub struct Unpacker {
    at: usize,
    /// The frame that was read last.
    pub(super) state: FrameBits,
    repeats: u64,
}

impl Default for Unpacker {
    fn default() -> Self {
        Self {
            at: 0,
            state: FrameBits::START,
            repeats: 0,
        }
    }
}

impl Unpacker {
    /// The next frame of the run that all calls are made with.
    pub fn next(&mut self, run: &FrameRun) -> Option<Frame> {
        if self.repeats == 0 {
            // The run was checked when it was made: a fault here would be its end.
            self.repeats = self.step(&run.bytes, 0).ok().flatten()?;
        }
        self.repeats -= 1;
        Some(self.state.frame())
    }

    /// Reads one entry; how many frames it stands for, `None` at the end.
    pub(super) fn step(&mut self, bytes: &[u8], frame: u64) -> Result<Option<u64>, FrameRunFault> {
        let mut rest = Rest {
            bytes: &bytes[self.at..],
            frame,
        };
        if rest.bytes.is_empty() {
            return Ok(None);
        }
        let flags = rest.byte()?;
        let mut count = 1;
        if flags == REPEAT {
            count = rest.number()?;
            if count == 0 || self.at == 0 {
                return Err(FrameRunFault::Senseless(frame));
            }
        } else if flags > DT | HAND[0] | HAND[1] | HEAD | HAS_HEAD | SCALE | PIXEL {
            return Err(FrameRunFault::Senseless(frame));
        } else {
            self.state = rest.frame(self.state, flags)?;
        }
        self.at = bytes.len() - rest.bytes.len();
        Ok(Some(count))
    }
}

struct Rest<'a> {
    bytes: &'a [u8],
    frame: u64,
}

impl Rest<'_> {
    fn frame(&mut self, mut state: FrameBits, flags: u8) -> Result<FrameBits, FrameRunFault> {
        if flags & DT != 0 {
            state.dt = self.number()?;
        }
        for (side, flag) in HAND.into_iter().enumerate() {
            if flags & flag == 0 {
                continue;
            }
            let hand = &mut state.hands[side];
            let flags = self.byte()?;
            if flags > TRACKED | TOUCHED | POSE | SWIPE | DOWN {
                return Err(FrameRunFault::Senseless(self.frame));
            }
            hand.tracked = flags & TRACKED != 0;
            hand.touched = flags & TOUCHED != 0;
            if flags & POSE != 0 {
                self.changes(&mut hand.pose)?;
            }
            if flags & SWIPE != 0 {
                self.changes(&mut hand.swipe)?;
            }
            if flags & DOWN != 0 {
                hand.down = self.word()?;
                let known = Action::ALL.into_iter().map(action_bit).sum::<u32>();
                if hand.down & !known != 0 {
                    return Err(FrameRunFault::Senseless(self.frame));
                }
            }
        }
        state.has_head = flags & HAS_HEAD != 0;
        if flags & HEAD != 0 {
            self.changes(&mut state.head)?;
        }
        if flags & SCALE != 0 {
            state.scale = self.word()?;
        }
        if flags & PIXEL != 0 {
            state.pixel = self.word()?;
        }
        Ok(state)
    }

    fn changes(&mut self, bits: &mut [u32]) -> Result<(), FrameRunFault> {
        for b in bits {
            *b ^= self.word()?;
        }
        Ok(())
    }

    fn word(&mut self) -> Result<u32, FrameRunFault> {
        u32::try_from(self.number()?).map_err(|_| FrameRunFault::Senseless(self.frame))
    }

    fn number(&mut self) -> Result<u64, FrameRunFault> {
        let mut value = 0_u64;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            let part = u64::from(byte & 0x7f);
            if shift == 63 && part > 1 {
                break;
            }
            value |= part << shift;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
        }
        Err(FrameRunFault::Senseless(self.frame))
    }

    fn byte(&mut self) -> Result<u8, FrameRunFault> {
        let (&first, rest) = self
            .bytes
            .split_first()
            .ok_or(FrameRunFault::CutOff(self.frame))?;
        self.bytes = rest;
        Ok(first)
    }
}
