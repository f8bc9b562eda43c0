//! From steps to frames: pure, no world, the same on every run.

use std::{sync::Arc, time::Duration};

use bevy::math::{Quat, Vec2};
use midair_studio::{
    command::Command,
    evaluate::Job,
    hands::{Action, HOLD, HandsInput, Pose, Side},
};

use crate::{
    Goal, Session, Step, Turn,
    frames::Unpacker,
    motion::{between, calm_seconds, ease},
};

/// How long a click is down, and how long the hand then rests, in seconds.
const CLICK: (f64, f64) = (0.1, 0.05);
/// The same for each click of a double one: three of these are shorter than a double press.
const QUICK: f64 = 0.08;
/// How much longer than a hold a button is held.
const BEYOND_HOLD: f64 = 0.1;

/// One thing a session does.
#[derive(Clone, Debug, PartialEq)]
// Nearly every beat is a frame: a box would be one allocation each.
#[expect(clippy::large_enum_variant)]
pub enum Beat {
    /// One frame.
    Frame(FrameBeat),
    /// The step with this index checks what there is.
    Check(usize),
}

/// One frame of a session.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameBeat {
    /// The index of its step.
    pub step: usize,
    /// Time since the frame before.
    pub dt: Duration,
    /// Both hands.
    pub input: HandsInput,
    /// What is asked for, in order.
    pub commands: Vec<Command>,
    /// Which results arrive, in order; means something in recordings only.
    pub ready: Vec<Job>,
}

/// Goes through a session, beat by beat. Holds one step's work at a time, whatever the length.
#[derive(Clone)]
pub struct Cursor {
    session: Arc<Session>,
    step: usize,
    now: Now,
    /// What is left of the current step.
    legs: std::vec::IntoIter<Leg>,
    leg: Option<(Leg, u64, Now)>,
    run: Option<Unpacker>,
    commands: Vec<Command>,
    ready: Vec<Job>,
}

impl Cursor {
    pub(crate) fn new(session: Arc<Session>) -> Self {
        Self {
            now: Now::new(session.start()),
            session,
            step: 0,
            legs: Vec::new().into_iter(),
            leg: None,
            run: None,
            commands: Vec::new(),
            ready: Vec::new(),
        }
    }

    /// The hands as they were last.
    pub fn now(&self) -> &HandsInput {
        &self.now.input
    }

    fn frame(&mut self, step: usize, dt: Duration) -> Beat {
        Beat::Frame(FrameBeat {
            step,
            dt,
            input: self.now.input,
            commands: std::mem::take(&mut self.commands),
            ready: std::mem::take(&mut self.ready),
        })
    }
}

impl Iterator for Cursor {
    type Item = Beat;

    fn next(&mut self) -> Option<Beat> {
        loop {
            if let Some((leg, done, from)) = &mut self.leg {
                *done += 1;
                let (frame, last) = (*done, *done >= leg.frames);
                leg.at(frame, from, &mut self.now);
                if frame == 1
                    && let Change::Ask(command) = &leg.change
                {
                    self.commands.push(Command::clone(command));
                }
                if last {
                    self.leg = None;
                }
                return Some(self.frame(self.step - 1, self.session.dt));
            }
            if let Some(leg) = self.legs.next() {
                if leg.frames > 0 {
                    self.leg = Some((leg, 0, self.now));
                }
                continue;
            }
            let session = self.session.clone();
            if let Some(run) = &mut self.run
                && let Some(Step::Frames(frames)) = session.steps.get(self.step - 1)
            {
                if let Some(frame) = run.next(frames) {
                    self.now.take(frame.input);
                    return Some(self.frame(self.step - 1, frame.dt));
                }
                self.run = None;
            }
            let index = self.step;
            let Some(step) = session.steps.get(index) else {
                // What was asked for last wants a frame too, unless its frame was cut off.
                let pending = !(self.commands.is_empty() && self.ready.is_empty());
                if pending && !session.truncated {
                    return Some(self.frame(index.saturating_sub(1), session.dt));
                }
                return None;
            };
            self.step += 1;
            match step {
                Step::Expect(_) => return Some(Beat::Check(index)),
                Step::Asked(commands) => self.commands.extend(commands.iter().cloned()),
                Step::Ready(jobs) => self.ready.extend(jobs),
                Step::Frames(_) => self.run = Some(Unpacker::default()),
                _ => self.legs = plan(step, &self.now, session.dt).into_iter(),
            }
        }
    }
}

/// The hands, and where each was last somewhere sound: a hand that was lost goes on from there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Now {
    input: HandsInput,
    last: [Pose; 2],
}

impl Now {
    pub fn new(input: HandsInput) -> Self {
        let mut now = Self {
            input,
            last: [Pose::default(); 2],
        };
        now.take(input);
        now
    }

    pub fn take(&mut self, input: HandsInput) {
        self.input = input;
        for (last, frame) in self.last.iter_mut().zip(&input.frames) {
            *last = frame.pose.filter(Pose::is_sound).unwrap_or(*last);
        }
    }
}

/// A part of a step: one change, spread over some frames.
#[derive(Clone, Debug)]
pub(crate) struct Leg {
    pub frames: u64,
    change: Change,
}

#[derive(Clone, Debug)]
enum Change {
    Still,
    Button(Side, Action, bool),
    Go([Option<Pose>; 2]),
    Lost(Side),
    Pad(Side, Option<Vec2>),
    Slide(Side, Vec2),
    Ask(Box<Command>),
}

impl Leg {
    /// The hands in frame `n` of it, counted from 1, having been `from` before it.
    fn at(&self, n: u64, from: &Now, now: &mut Now) {
        let u = if n >= self.frames {
            1.0
        } else {
            n as f64 / self.frames as f64
        };
        let mut input = now.input;
        match &self.change {
            Change::Still | Change::Ask(_) => {}
            Change::Button(side, action, down) => input.side(*side).down.set(*action, *down),
            Change::Go(ends) => {
                for side in Side::BOTH {
                    if let Some(end) = &ends[side as usize] {
                        let start = from.last[side as usize];
                        input.side(side).pose = Some(between(&start, end, u));
                    }
                }
            }
            Change::Lost(side) => input.side(*side).pose = None,
            Change::Pad(side, at) => input.side(*side).swipe = *at,
            Change::Slide(side, to) => {
                let start = from.input.frames[*side as usize].swipe.unwrap_or(*to);
                input.side(*side).swipe = Some(if u >= 1.0 {
                    *to
                } else {
                    start.lerp(*to, ease(u) as f32)
                });
            }
        }
        now.take(input);
    }

    /// The hands after it.
    pub fn finish(&self, now: &mut Now) {
        if self.frames > 0 {
            let from = *now;
            self.at(self.frames, &from, now);
        }
    }
}

/// How many frames of `dt` are nearest to `seconds`.
fn frames_in(seconds: f64, dt: Duration) -> u64 {
    (seconds / dt.as_secs_f64()).round() as u64
}

/// What a step does, from where the hands are; empty for the steps that are no motion.
pub(crate) fn plan(step: &Step, now: &Now, dt: Duration) -> Vec<Leg> {
    let leg = |seconds: f64, change| Leg {
        frames: frames_in(seconds, dt).max(1),
        change,
    };
    let button = |side, action, down, seconds| leg(seconds, Change::Button(side, action, down));
    let place = |side: Side| now.last[side as usize];
    match step {
        Step::Move {
            hand,
            to,
            by,
            turn,
            over,
        } => {
            let goal = Goal {
                to: *to,
                by: *by,
                turn: *turn,
            };
            let mut ends = [None; 2];
            ends[*hand as usize] = Some(end(&place(*hand), &goal));
            vec![leg(seconds(now, &ends, *over), Change::Go(ends))]
        }
        Step::Both { left, right, over } => {
            let ends = [(Side::Left, left), (Side::Right, right)].map(|(side, goal)| {
                let stays = *goal == Goal::default();
                (!stays).then(|| end(&place(side), goal))
            });
            vec![leg(seconds(now, &ends, *over), Change::Go(ends))]
        }
        Step::Jump { hand, to, turn } => {
            let mut ends = [None; 2];
            ends[*hand as usize] = Some(Pose {
                position: *to,
                rotation: turn.map_or(place(*hand).rotation, Turn::raw),
            });
            vec![leg(0.0, Change::Go(ends))]
        }
        Step::Lose(side) => vec![leg(0.0, Change::Lost(*side))],
        Step::Press(s, a) => vec![button(*s, *a, true, 0.0)],
        Step::Release(s, a) => vec![button(*s, *a, false, 0.0)],
        Step::Click(s, a) => vec![
            button(*s, *a, true, CLICK.0),
            button(*s, *a, false, CLICK.1),
        ],
        Step::DoubleClick(s, a) => vec![
            button(*s, *a, true, QUICK),
            button(*s, *a, false, QUICK),
            button(*s, *a, true, QUICK),
            button(*s, *a, false, CLICK.1),
        ],
        Step::Hold(s, a) => vec![
            button(*s, *a, true, f64::from(HOLD) + BEYOND_HOLD),
            button(*s, *a, false, CLICK.1),
        ],
        Step::Touch(s, at) => vec![leg(0.0, Change::Pad(*s, Some(*at)))],
        Step::Untouch(s) => vec![leg(0.0, Change::Pad(*s, None))],
        Step::Slide { hand, to, over } => {
            vec![leg(f64::from(*over), Change::Slide(*hand, *to))]
        }
        Step::Wait(s) => vec![Leg {
            frames: frames_in(f64::from(*s), dt),
            change: Change::Still,
        }],
        Step::Ask(c) => vec![leg(0.0, Change::Ask(Box::new(c.clone())))],
        Step::Expect(_) | Step::Frames(_) | Step::Asked(_) | Step::Ready(_) => Vec::new(),
    }
}

fn end(from: &Pose, goal: &Goal) -> Pose {
    let position = match (goal.to, goal.by) {
        (Some(to), _) => to,
        (None, Some(by)) => from.position + by,
        (None, None) => from.position,
    };
    let rotation = goal.turn.and_then(Turn::rotation).unwrap_or(from.rotation);
    Pose { position, rotation }
}

fn seconds(now: &Now, ends: &[Option<Pose>; 2], over: Option<f32>) -> f64 {
    if let Some(over) = over {
        return f64::from(over);
    }
    let parts = |p: &Pose| -> (_, Quat) { (p.position, p.rotation) };
    ends.iter()
        .zip(&now.last)
        .filter_map(|(end, start)| Some(calm_seconds(parts(start), parts(end.as_ref()?))))
        .fold(0.0, f64::max)
}
