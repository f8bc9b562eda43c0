//! A session, performed by controllers: what is written for hands is done by the runtime's devices.

use std::sync::Arc;
use std::thread::sleep;
use std::time::Duration;

use anyhow::{Result, bail};
use bevy::math::{Quat, Vec2, Vec3};
use midair_playback::{Beat, Expectation, Session, Step};
use midair_studio::hands::{Action, ActionSet, COUNTED, HOLD, HandFrame, HandsInput, Pose, Side};
use serde_json::Value;

use crate::stage::App;
use crate::wire::{Controller, Rig};

/// Metres from where a controller aims from to the tip of its wand.
const WAND: f32 = 0.08;
/// So much of a session is done in one frame of the app: of a stroke, and of a hand on its way to something.
const STROKE: Duration = Duration::from_millis(33);
const REACH: Duration = Duration::from_millis(100);
/// A button is held for so many frames more than it takes when none is late: a late one counts as a short one.
const HELD: u64 = (HOLD / COUNTED) as u64 + 4;
/// What may be between a pose sent and a pose that has arrived, in metres and radians.
const NEAR: (f32, f32) = (1e-3, 5e-3);

/// Both hands and what they told the app so far.
pub struct Performer {
    pub rig: Rig,
    /// What the hands are to be.
    want: [HandFrame; 2],
}

impl Performer {
    /// Takes hold of the devices.
    pub fn new() -> Result<Self> {
        let mut rig = Rig::connect()?;
        rig.send()?;
        // Both are where the rig has them.
        let want = rig.hands.map(|hand| HandFrame {
            pose: Some(Pose {
                position: hand.pose.position + hand.pose.rotation * Vec3::NEG_Z * WAND,
                rotation: hand.pose.rotation,
            }),
            ..HandFrame::default()
        });
        Ok(Self { rig, want })
    }

    /// Performs a whole session. It goes on with the app's frames: one that is late makes it slower and nothing coarser.
    pub fn session(&mut self, app: &mut App, session: &Arc<Session>) -> Result<()> {
        let mut gone = Duration::ZERO;
        let mut waited = None;
        let mut holding = false;
        for beat in session.cursor() {
            match beat {
                Beat::Frame(frame) => {
                    let step = &session.steps()[frame.step];
                    if !frame.commands.is_empty() {
                        self.settle(app)?;
                        for command in &frame.commands {
                            app.ask(command)?;
                        }
                    }
                    if matches!(step, Step::Wait(_)) && waited != Some(frame.step) {
                        // What is waited for in a session is a matter of frames as well.
                        waited = Some(frame.step);
                        self.settle(app)?;
                        self.frames(app, 6)?;
                    }
                    let at = |e: anyhow::Error| e.context(session.place(frame.step).to_string());
                    if self.presses(&frame.input) {
                        self.settle(app).map_err(at)?;
                        // What lies at the hand is found in the frame after it is there.
                        let held = matches!(step, Step::Hold(..));
                        let lets_go = held && std::mem::replace(&mut holding, true);
                        self.frames(app, if lets_go { HELD } else { 2 })?;
                        holding &= !lets_go;
                        self.hold(&frame.input);
                        self.rig.send()?;
                        self.arrived(app, "buttons").map_err(at)?;
                        continue;
                    }
                    self.hold(&frame.input);
                    if !matches!(
                        step,
                        Step::Move { .. } | Step::Both { .. } | Step::Slide { .. }
                    ) {
                        // Holds and double presses are told by time.
                        sleep(frame.dt);
                        continue;
                    }
                    gone += frame.dt;
                    let draws = self.want.iter().any(|hand| hand.down != ActionSet::NONE);
                    if gone >= if draws { STROKE } else { REACH } {
                        gone = Duration::ZERO;
                        self.rig.send()?;
                        self.frames(app, 1)?;
                    }
                }
                Beat::Check(step) => {
                    self.settle(app)?;
                    if let Step::Expect(expected) = &session.steps()[step] {
                        let what = session.place(step).to_string();
                        app.until(&what, |now| met(expected, now))?;
                    }
                }
            }
        }
        self.settle(app)
    }

    /// Hands go where they are to be at once, and have arrived.
    pub fn go(&mut self, app: &mut App, side: Side, to: Pose) -> Result<()> {
        self.want[side as usize].pose = Some(to);
        self.write();
        self.settle(app)
    }

    /// A controller is switched off.
    pub fn off(&mut self, side: Side) -> Result<()> {
        self.want[side as usize].pose = None;
        self.write();
        self.rig.send()
    }

    /// A button goes down or up, and has.
    pub fn press(&mut self, app: &mut App, side: Side, action: Action, down: bool) -> Result<()> {
        self.want[side as usize].down.set(action, down);
        self.write();
        self.rig.send()?;
        self.arrived(app, "a button")
    }

    /// Waits until the app has both hands where they are.
    pub fn settle(&mut self, app: &mut App) -> Result<()> {
        self.rig.send()?;
        self.arrived(app, "hands")
    }

    /// Waits until the app has drawn so many more.
    pub fn frames(&mut self, app: &mut App, count: u64) -> Result<()> {
        let until = app.now["frame"].as_u64().unwrap_or(0) + count;
        app.until("frames go on", |now| {
            now["frame"].as_u64().unwrap_or(0) >= until
        })?;
        Ok(())
    }

    fn arrived(&mut self, app: &mut App, what: &str) -> Result<()> {
        let want = self.want;
        app.until(&format!("{what} arrive"), |now| {
            Side::BOTH
                .iter()
                .all(|&s| is_there(&want[s as usize], &now["hands"][s as usize]))
        })?;
        Ok(())
    }

    /// Whether this frame presses something that was not, or lets go of it.
    fn presses(&self, input: &HandsInput) -> bool {
        (0..2).any(|i| {
            let (a, b) = (&self.want[i], &input.frames[i]);
            physical(a.down) != physical(b.down) || a.swipe.is_some() != b.swipe.is_some()
        })
    }

    fn hold(&mut self, input: &HandsInput) {
        self.want = input.frames;
        self.write();
    }

    fn write(&mut self) {
        for side in Side::BOTH {
            let hand = &mut self.rig.hands[side as usize];
            put(side, &self.want[side as usize], hand);
        }
    }
}

/// What is pressed for what a session names: the library is a press of the menu's button.
fn physical(down: ActionSet) -> ActionSet {
    down.iter()
        .map(|action| match action {
            Action::Library | Action::Modes => Action::Menu,
            other => other,
        })
        .collect()
}

/// One hand of a session as a controller of the Index.
fn put(side: Side, frame: &HandFrame, hand: &mut Controller) {
    let down = physical(frame.down);
    if let Some(tip) = frame.pose {
        hand.active = true;
        hand.pose = Pose {
            position: tip.position - tip.rotation * Vec3::NEG_Z * WAND,
            rotation: tip.rotation,
        };
    } else {
        hand.active = false;
    }
    hand.trigger = if down.has(Action::Act) { 1.0 } else { 0.0 };
    hand.squeeze = if down.has(Action::Grab) { 1.0 } else { 0.0 };
    hand.stick = [
        (Action::Up, Vec2::Y),
        (Action::Right, Vec2::X),
        (Action::Down, Vec2::NEG_Y),
        (Action::Left, Vec2::NEG_X),
    ]
    .into_iter()
    .find(|(action, _)| down.has(*action))
    .map_or(Vec2::ZERO, |(_, at)| at);
    hand.stick_click = down.has(Action::Centre);
    let main = side == Side::Right;
    hand.a = down.has(if main { Action::Finish } else { Action::Undo });
    hand.b = down.has(if main { Action::Menu } else { Action::Redo });
    hand.pad_force = if down.has(Action::Save) { 1.0 } else { 0.0 };
    hand.pad_touch = frame.swipe.is_some();
    hand.pad = frame.swipe.unwrap_or(Vec2::ZERO);
}

/// Whether the app has a hand as it is to be.
fn is_there(want: &HandFrame, is: &Value) -> bool {
    let down: ActionSet = physical(want.down);
    let mut names: Vec<_> = down.iter().map(|a| format!("{a:?}")).collect();
    // A panel that the wand is on has it, or else the tool.
    let mut said: Vec<_> = ["down", "captured"]
        .iter()
        .filter_map(|whose| is[whose].as_array())
        .flatten()
        .filter_map(Value::as_str)
        .collect();
    names.sort_unstable();
    said.sort_unstable();
    if names != said {
        return false;
    }
    let swiped = match (want.swipe, is["swipe"].as_array()) {
        (None, None) => true,
        (Some(at), Some(is)) => {
            let number = |i: usize| is[i].as_f64().unwrap_or(f64::NAN) as f32;
            at.distance(Vec2::new(number(0), number(1))) < 1e-2
        }
        _ => false,
    };
    let Some(pose) = want.pose else {
        return swiped && is["tracked"] == false;
    };
    let number = |i: usize| is["pose"][i].as_f64().unwrap_or(f64::NAN) as f32;
    let at = Vec3::new(number(0), number(1), number(2));
    let turn = Quat::from_xyzw(number(3), number(4), number(5), number(6));
    swiped
        && is["tracked"] == true
        && at.distance(pose.position) < NEAR.0
        && turn.angle_between(pose.rotation) < NEAR.1
}

/// Whether what a session expects is so, as far as the app tells it; the rest is checked by playing the recording.
fn met(expected: &Expectation, now: &Value) -> bool {
    let count = |name: &str, want: Option<usize>| {
        want.is_none_or(|want| now[name].as_u64() == Some(want as u64))
    };
    let warnings = now["warnings"].as_array().map_or(0, Vec::len);
    now["busy"] == 0
        && count("objects", expected.objects)
        && count("edits", expected.edits)
        && count("undo", expected.undo)
        && count("redo", expected.redo)
        && expected.warnings.is_none_or(|w| w == warnings)
}

/// A session from a file; recordings are no performance.
pub fn load(path: &str) -> Result<Arc<Session>> {
    let session = Session::load(std::path::Path::new(path))?;
    if session.is_recorded() {
        bail!("{path} is a recording: write a session with steps of hands");
    }
    Ok(Arc::new(session))
}
