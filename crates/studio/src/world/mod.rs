//! The world as it stands in the room: moved, turned and scaled by both hands.
//!
//! Hands and documents are in metres of world. A way in multiplies by [`WorldView::world_from_room`] what its devices
//! say in metres of the room; nothing else of the studio knows that the world was scaled, but for
//! [`Hands::metres_per_world`].

mod one_hand;
mod pull;
mod similarity;

use std::ops::RangeInclusive;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

pub use one_hand::OneHandPull;
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
    /// Metres that the floor of the world lies below that of the room, for somebody who sits.
    lowered: f32,
    pull: Option<Pull>,
}

/// What holds the world; without a pull where it was moved otherwise meanwhile, so that it is taken anew.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pull {
    Both(Option<WorldPull>),
    One(Side, Option<OneHandPull>),
}

impl Default for WorldView {
    fn default() -> Self {
        Self {
            room_from_world: Similarity::IDENTITY,
            carry: None,
            lowered: 0.0,
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

    /// Whether hands hold it.
    pub fn is_held(&self) -> bool {
        self.pull.is_some()
    }

    /// As it was at first, at its own size.
    fn home(&self) -> Similarity {
        Similarity {
            translation: Vec3::new(0.0, -self.lowered, 0.0),
            ..Similarity::IDENTITY
        }
    }

    /// The floor is lowered by so much, in metres of the room.
    fn lower(&mut self, by: f32) {
        if by != self.lowered && by.is_finite() {
            let mut next = self.room_from_world;
            next.translation.y += self.lowered - by;
            self.lowered = by;
            self.stand(next);
        }
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
    /// Turned about the vertical of the room.
    Turn {
        /// To the left, seen from above.
        degrees: f32,
        /// What stays where it is, in world metres.
        about: Vec3,
    },
    /// Upright and at its own size, its front before somebody who stands there.
    Recentre {
        /// Where the eyes are, in metres of the room.
        at: Vec3,
        /// Which way they look: radians about the vertical of the room, 0 along −Z.
        yaw: f32,
    },
}

/// Metres before the middle of the world at which somebody stands.
const BEFORE: f32 = 0.6;

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
        match &mut view.bypass_change_detection().pull {
            Some(Pull::Both(pull)) => *pull = None,
            Some(Pull::One(_, pull)) => *pull = None,
            None => {}
        }
        match *ask {
            WorldAsk::Reset => {
                let home = view.home();
                view.stand(home);
            }
            WorldAsk::Scale { factor, about } => {
                let now = view.room_from_world;
                let scale = factor.clamp(*RANGE.start(), *RANGE.end());
                let mut next = Similarity { scale, ..now };
                next.translation += now.point(about) - next.point(about);
                view.stand(next);
            }
            WorldAsk::Turn { degrees, about } => {
                let now = view.room_from_world;
                let turn = Quat::from_rotation_y(degrees.to_radians());
                let mut next = Similarity {
                    rotation: (turn * now.rotation).normalize(),
                    ..now
                };
                next.translation += now.point(about) - next.point(about);
                view.stand(next);
            }
            WorldAsk::Recentre { at, yaw } => {
                let rotation = Quat::from_rotation_y(yaw);
                let home = view.home();
                view.stand(Similarity {
                    rotation,
                    translation: at.with_y(home.translation.y) - rotation * (BEFORE * Vec3::Z),
                    ..home
                });
            }
        }
    }
}

/// Both grips on nothing hold the world; one where a person has only one to spare.
fn pull(
    mut hands: ResMut<Hands>,
    (touch, reserved): (Res<Touch>, Res<Reserved>),
    drafts: Res<Drafts>,
    settings: Res<Settings>,
    mut view: ResMut<WorldView>,
) {
    let wanted = &settings.world;
    let lowered = if wanted.seated { wanted.lowered } else { 0.0 };
    if lowered != view.lowered {
        view.lower(lowered);
    }
    let both = Side::BOTH.map(|s| hands.get(s));
    let grips = both.each_ref().map(|h| h.held(Action::Grab) && h.tracked);
    let cancelled = both.iter().any(|h| h.pressed(Action::Cancel));
    let count = grips.iter().filter(|&&g| g).count();
    let goes_on = match view.pull {
        Some(Pull::Both(_)) => count == 2,
        Some(Pull::One(side, _)) => count == 1 && grips[side as usize],
        None => true,
    };
    if (!goes_on || cancelled) && view.pull.is_some() {
        view.pull = None;
    }
    if cancelled {
        return;
    }
    let room = view.room_from_world;
    let poses = both.map(|h| room.pose(&h.pose));
    let [left, right] = poses.map(|p| p.position);
    match view.pull {
        None => {
            let begins = Side::BOTH
                .into_iter()
                .find(|&s| hands.get(s).pressed(Action::Grab) && grips[s as usize]);
            let empty = Side::BOTH.iter().all(|&s| {
                !grips[s as usize] || touch.get(s).is_none() && !reserved.has(s, Action::Grab)
            });
            let Some(side) = begins.filter(|_| empty && drafts.is_empty()) else {
                return;
            };
            let holds = match count {
                2 => &Side::BOTH[..],
                1 if wanted.one_handed => &[side][..],
                _ => return,
            };
            view.pull = Some(if count == 2 {
                Pull::Both(Some(WorldPull::new(room, left, right)))
            } else {
                Pull::One(side, Some(OneHandPull::new(room, poses[side as usize])))
            });
            for &side in holds {
                hands.pulse(side, Haptic::Tick);
            }
        }
        Some(Pull::Both(Some(pull))) => view.stand(pull.world(left, right, wanted.tilt)),
        Some(Pull::Both(None)) => {
            view.pull = Some(Pull::Both(Some(WorldPull::new(room, left, right))));
        }
        Some(Pull::One(side, Some(pull))) => view.stand(pull.world(poses[side as usize])),
        Some(Pull::One(side, None)) => {
            let pull = OneHandPull::new(room, poses[side as usize]);
            view.pull = Some(Pull::One(side, Some(pull)));
        }
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
    fn somebody_who_sits_has_the_floor_lower_and_it_stays_lower_when_reset() {
        let mut view = WorldView::default();
        view.lower(0.4);
        assert!((view.room_from_world.translation.y + 0.4).abs() < 1e-6);
        assert_eq!(view.home(), view.room_from_world);
        view.lower(0.0);
        assert_eq!(view.room_from_world, Similarity::IDENTITY);
    }

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
