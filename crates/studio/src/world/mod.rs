//! The world as it stands in the room: moved, turned and scaled by both hands.
//!
//! Hands and documents are in metres of world. A way in multiplies by [`WorldView::world_from_room`] what its devices
//! say in metres of the room; nothing else of the studio knows that the world was scaled, but for
//! [`Hands::metres_per_world`].

mod pull;
mod similarity;

use std::ops::RangeInclusive;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

pub use pull::WorldPull;
pub use similarity::Similarity;

use crate::StudioSet;
use crate::command::Command;
use crate::hands::{Action, Hands, Haptic, Side};
use crate::hold::Reserved;
use crate::pick::Touch;
use crate::settings::Settings;
use crate::show::{Drafts, Readouts};

/// How small and how large the world may be.
pub const RANGE: RangeInclusive<f32> = 0.1..=10.0;
/// Seconds for which the scale is shown once it has changed.
const SHOWN: f32 = 1.5;

/// How the world stands in the room.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct WorldView {
    /// From metres of world to metres of the room.
    pub room_from_world: Similarity,
    /// What poses in the world are to be carried by that stay where they are in the room, since the
    /// world was moved in the frame before.
    pub carry: Option<Similarity>,
    pull: Option<WorldPull>,
}

impl Default for WorldView {
    fn default() -> Self {
        Self {
            room_from_world: Similarity::IDENTITY,
            carry: None,
            pull: None,
        }
    }
}

impl WorldView {
    /// From metres of the room to metres of world.
    pub fn world_from_room(&self) -> Similarity {
        self.room_from_world.inverse()
    }

    /// How large the world is shown.
    pub fn scale(&self) -> f32 {
        self.room_from_world.scale
    }

    /// Whether both hands hold it.
    pub fn is_held(&self) -> bool {
        self.pull.is_some()
    }

    fn stand(&mut self, next: Similarity) {
        if next.is_sound() && next != self.room_from_world {
            let carry = next.inverse().after(&self.room_from_world);
            self.carry = Some(match &self.carry {
                Some(before) => carry.after(before),
                None => carry,
            });
            self.room_from_world = next;
        }
    }
}

/// What can be asked of the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum WorldAsk {
    /// As it was at first: upright, at its own size, where it was.
    Reset,
    /// So many times its own size, about a point of the world.
    Scale {
        /// The factor; it stays between 0.1 and 10.
        factor: f32,
        /// What stays where it is, in world metres.
        about: Vec3,
    },
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<WorldView>()
        .add_systems(Update, ask.in_set(StudioSet::Ask))
        // After the tool: what it takes in hand is no grip on the world.
        .add_systems(Update, pull.in_set(StudioSet::Commit))
        .add_systems(Update, say.in_set(StudioSet::Cue));
}

fn ask(mut commands: MessageReader<Command>, mut view: ResMut<WorldView>) {
    // The ways in have taken it.
    if view.carry.is_some() {
        view.carry = None;
    }
    for command in commands.read() {
        let Command::World(ask) = command else {
            continue;
        };
        match *ask {
            WorldAsk::Reset => view.stand(Similarity::IDENTITY),
            WorldAsk::Scale { factor, about } => {
                let now = view.room_from_world;
                let scale = factor.clamp(*RANGE.start(), *RANGE.end());
                let mut next = Similarity { scale, ..now };
                next.translation += now.point(about) - next.point(about);
                view.stand(next);
            }
        }
    }
}

/// Both grips on nothing hold the world.
fn pull(
    mut hands: ResMut<Hands>,
    (touch, reserved): (Res<Touch>, Res<Reserved>),
    drafts: Res<Drafts>,
    settings: Res<Settings>,
    mut view: ResMut<WorldView>,
) {
    let both = Side::BOTH.map(|s| hands.get(s));
    let held = both.iter().all(|h| h.held(Action::Grab) && h.tracked);
    let cancelled = both.iter().any(|h| h.pressed(Action::Cancel));
    if !held || cancelled {
        if view.pull.is_some() {
            view.pull = None;
        }
        return;
    }
    let room = view.room_from_world;
    let [left, right] = both.map(|h| room.point(h.pose.position));
    match view.pull {
        None => {
            let begins = both.iter().any(|h| h.pressed(Action::Grab));
            let empty = Side::BOTH
                .iter()
                .all(|&s| touch.get(s).is_none() && !reserved.has(s, Action::Grab));
            if begins && empty && drafts.is_empty() {
                view.pull = Some(WorldPull::new(room, left, right));
                for side in Side::BOTH {
                    hands.pulse(side, Haptic::Tick);
                }
            }
        }
        Some(pull) => view.stand(pull.world(left, right, settings.world.tilt)),
    }
}

/// How large the world is, while that changes.
fn say(
    hands: Res<Hands>,
    view: Res<WorldView>,
    time: Res<Time>,
    mut readouts: ResMut<Readouts>,
    mut last: Local<(f32, f32)>,
) {
    let (scale, left) = &mut *last;
    if (view.scale() - *scale).abs() > 1e-4 {
        // The first frame shows nothing new.
        if *scale != 0.0 {
            *left = SHOWN;
        }
        *scale = view.scale();
    }
    *left -= time.delta_secs();
    if *left <= 0.0 && !view.is_held() {
        return;
    }
    let [a, b] = Side::BOTH.map(|s| hands.get(s).pose.position);
    let at = match hands.head {
        Some(head) if !view.is_held() => {
            head.position + head.rotation * Vec3::NEG_Z / hands.metres_per_world
        }
        _ => a.midpoint(b),
    };
    readouts.say(at, format!("{:.1}x", view.scale()));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hand_that_stays_in_the_room_is_carried_through_the_world() {
        let mut view = WorldView::default();
        let room = Vec3::new(0.3, 1.0, -0.4);
        let before = view.world_from_room().point(room);
        view.stand(Similarity {
            scale: 2.0,
            rotation: Quat::from_rotation_y(0.7),
            translation: Vec3::new(0.1, 0.0, 0.4),
        });
        let carried = view.carry.unwrap().point(before);
        assert!(carried.distance(view.world_from_room().point(room)) < 1e-5);
    }
}
