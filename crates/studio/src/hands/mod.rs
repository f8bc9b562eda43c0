//! What a hand is: a pose, named actions, a swipe, a ray, haptics.
//!
//! Tools read [`Hands`] and know no device. A way in (a window, a headset, a recorded session)
//! writes one [`HandFrame`] per hand into [`HandsInput`] during [`StudioSet::Gather`]; everything
//! else, edges, holds and double presses included, follows from those frames, so that a recorded
//! frame plays back to the same gestures.

mod action;
mod presses;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

pub use action::{Action, ActionSet, Cross};
pub use presses::{COUNTED, DOUBLE_PRESS, HOLD};

use crate::StudioSet;
use presses::Presses;

/// Left or right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Side {
    /// The left hand.
    Left,
    /// The right hand.
    Right,
}

impl Side {
    /// Both, left first.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// The other one.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

/// Where a hand is: the tip of its wand, in world metres. It points along its −Z.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// World metres.
    pub position: Vec3,
    /// A unit quaternion.
    pub rotation: Quat,
}

impl Pose {
    /// Held level at a point.
    pub const fn at(position: Vec3) -> Self {
        Self {
            position,
            rotation: Quat::IDENTITY,
        }
    }

    /// Whether every number is finite and the rotation is one.
    pub fn is_sound(&self) -> bool {
        self.position.is_finite() && self.rotation.is_finite() && self.rotation.is_normalized()
    }

    /// The rigid motion that takes this pose's frame to the world.
    pub fn affine(&self) -> bevy::math::Affine3A {
        bevy::math::Affine3A::from_rotation_translation(self.rotation, self.position)
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self::at(Vec3::ZERO)
    }
}

/// What a device says of one hand in one frame: all that a session records.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HandFrame {
    /// Where it is; `None` while its tracking is lost.
    pub pose: Option<Pose>,
    /// Which actions and physical buttons are down.
    #[serde(default)]
    pub down: ActionSet,
    /// Where its pad or stick is touched, each axis in [−1, 1]; `None` where it is not.
    #[serde(default)]
    pub swipe: Option<Vec2>,
}

/// The frame that the ways in write and [`Hands`] is made from.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct HandsInput {
    /// Left, right.
    pub frames: [HandFrame; 2],
    /// Where the eyes are, if known.
    pub head: Option<Pose>,
    /// Physical metres per metre of world; 1 until the world is scaled.
    pub metres_per_world: f32,
    /// Under how many radians a pixel is seen where hands move over a screen: what they reach is
    /// measured in pixels there. 0 where they are free in space.
    pub pixel: f32,
}

impl Default for HandsInput {
    fn default() -> Self {
        Self {
            frames: [HandFrame::default(); 2],
            head: None,
            metres_per_world: 1.0,
            pixel: 0.0,
        }
    }
}

impl HandsInput {
    /// One hand's frame.
    pub fn side(&mut self, side: Side) -> &mut HandFrame {
        &mut self.frames[side as usize]
    }
}

/// One hand as tools see it.
#[derive(Clone, Debug, Default)]
pub struct Hand {
    /// Its last sound pose: a hand whose tracking is lost stays where it was.
    pub pose: Pose,
    /// Whether the pose is fresh.
    pub tracked: bool,
    /// Where its pad is touched.
    pub swipe: Option<Vec2>,
    down: ActionSet,
    before: ActionSet,
    presses: Presses,
}

impl Hand {
    /// Whether `action` went down in this frame.
    pub fn pressed(&self, action: Action) -> bool {
        self.down.has(action) && !self.before.has(action)
    }

    /// Whether `action` is down.
    pub fn held(&self, action: Action) -> bool {
        self.down.has(action)
    }

    /// Whether `action` went up in this frame.
    pub fn released(&self, action: Action) -> bool {
        !self.down.has(action) && self.before.has(action)
    }

    /// Which arm of the cross was clicked in this frame.
    pub fn cross(&self) -> Option<Cross> {
        Cross::ALL
            .into_iter()
            .find(|&c| self.pressed(Action::from(c)))
    }

    /// The wand: where it starts and the unit direction it points in.
    pub fn ray(&self) -> (Vec3, Dir3) {
        let direction = Dir3::new(self.pose.rotation * Vec3::NEG_Z).unwrap_or(Dir3::NEG_Z);
        (self.pose.position, direction)
    }

    fn advance(&mut self, frame: &HandFrame, dt: f32) {
        match frame.pose.filter(Pose::is_sound) {
            Some(pose) => {
                self.pose = pose;
                self.tracked = true;
            }
            None => self.tracked = false,
        }
        self.swipe = frame.swipe.filter(|s| s.is_finite());
        self.before = self.down;
        self.down = frame.down | self.presses.recognise(frame.down, dt);
    }
}

/// A pulse to feel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Haptic {
    /// Something was touched, snapped or pressed.
    Tick,
    /// Something was done.
    Done,
    /// Something cannot be done.
    Refused,
}

impl Haptic {
    /// What is felt when something was done, or refused.
    pub fn of(done: bool) -> Self {
        if done { Self::Done } else { Self::Refused }
    }
}

/// Both hands, the eyes, and the scale of the world.
#[derive(Resource, Clone, Debug)]
pub struct Hands {
    hands: [Hand; 2],
    /// Where the eyes are, if known.
    pub head: Option<Pose>,
    /// Physical metres per metre of world: thresholds of the hand divide by it.
    pub metres_per_world: f32,
    /// Under how many radians a pixel is seen on a screen; 0 where hands are free in space.
    pub pixel: f32,
    /// Pulses asked for since the way in last took them.
    pub haptics: Vec<(Side, Haptic)>,
}

impl Default for Hands {
    fn default() -> Self {
        Self {
            hands: Default::default(),
            head: None,
            metres_per_world: 1.0,
            pixel: 0.0,
            haptics: Vec::new(),
        }
    }
}

impl Hands {
    /// One hand.
    pub fn get(&self, side: Side) -> &Hand {
        &self.hands[side as usize]
    }

    /// Both, with their sides, left first.
    pub fn both(&self) -> [(Side, &Hand); 2] {
        Side::BOTH.map(|s| (s, self.get(s)))
    }

    /// Whether either hand pressed `action` in this frame.
    pub fn pressed(&self, action: Action) -> Option<Side> {
        Side::BOTH
            .into_iter()
            .find(|&s| self.get(s).pressed(action))
    }

    /// Asks for a pulse.
    pub fn pulse(&mut self, side: Side, haptic: Haptic) {
        // No device may be listening: a short memory is enough.
        if self.haptics.len() < 16 {
            self.haptics.push((side, haptic));
        }
    }

    /// Metres of world that count as `physical` metres for the tip of a hand; on a screen, where a
    /// hand is as exact as a pointer, as `pixels` at its depth.
    pub fn reach(&self, side: Side, physical: f64, pixels: f64) -> f64 {
        match self.head.filter(|_| self.pixel > 0.0) {
            Some(head) => {
                let depth = head.position.distance(self.get(side).pose.position);
                f64::from(depth * self.pixel) * pixels
            }
            None => physical / f64::from(self.metres_per_world),
        }
    }

    /// Takes in one frame, `dt` seconds after the last.
    pub fn advance(&mut self, input: &HandsInput, dt: f32) {
        for (hand, frame) in self.hands.iter_mut().zip(&input.frames) {
            hand.advance(frame, dt);
        }
        self.head = input.head.filter(Pose::is_sound);
        if input.metres_per_world.is_finite() && input.metres_per_world > 0.0 {
            self.metres_per_world = input.metres_per_world;
        }
        if input.pixel.is_finite() && input.pixel >= 0.0 {
            self.pixel = input.pixel;
        }
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<HandsInput>()
        .init_resource::<Hands>()
        .configure_sets(
            Update,
            (WriteHands, FilterHands, AdvanceHands)
                .chain()
                .in_set(StudioSet::Gather),
        )
        // Last in the set: the ways in have written their frames by then.
        .add_systems(Update, advance.in_set(AdvanceHands));
}

/// Ways in write [`HandsInput`].
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct WriteHands;

/// What is in front of the scene takes what is its own out of [`HandsInput`]: a press on a panel is no press for the
/// tool, and none in a recording.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct FilterHands;

/// The step that turns [`HandsInput`] into [`Hands`]; ways in run before it.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct AdvanceHands;

fn advance(input: Res<HandsInput>, time: Res<Time>, mut hands: ResMut<Hands>) {
    hands.advance(&input, time.delta_secs());
}
