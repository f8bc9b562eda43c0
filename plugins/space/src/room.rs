//! The room that a body stands in, and where its hands and eyes are in it.

use bevy::prelude::*;
use midair_studio::hands::{Hands, HandsInput, Pose, Side};
use midair_studio::panel::Host;
use midair_studio::world::WorldView;

/// The one entity that everything of the room hangs on: metres of the room below it, metres of world above.
#[derive(Component)]
pub struct Root;

/// Where somebody's eyes are of whom only the hands are known, from the middle between the hands at the start.
const EYES: Vec3 = Vec3::new(0.0, 0.42, 0.30);
/// How far those look down, in radians.
const DOWN: f32 = 0.35;

/// Hands and eyes in metres of the room, as they were when this frame began.
#[derive(Resource, Clone, Copy, Debug)]
pub struct Stance {
    /// Left, right: the tips of the wands. A hand that is lost stays where it was.
    pub hands: [Pose; 2],
    /// Which of them are seen.
    pub tracked: [bool; 2],
    /// Where the eyes are.
    pub head: Pose,
    /// Whether that is known; otherwise it is where it could be.
    pub head_known: bool,
}

impl Default for Stance {
    fn default() -> Self {
        Self {
            hands: [-0.2, 0.2].map(|x| Pose::at(Vec3::new(x, 1.1, 0.3))),
            tracked: [false; 2],
            head: Pose {
                position: Vec3::new(0.0, 1.1, 0.3) + EYES,
                rotation: Quat::from_rotation_x(-DOWN),
            },
            head_known: false,
        }
    }
}

impl Stance {
    /// One hand.
    pub fn hand(&self, side: Side) -> Pose {
        self.hands[side as usize]
    }

    /// Which way the eyes look along the floor.
    pub fn ahead(&self) -> Vec3 {
        let ahead = self.head.rotation * Vec3::NEG_Z;
        let up = self.head.rotation * Vec3::Y;
        // Who looks straight down has the top of the head in front.
        let level = if ahead.y.abs() < 0.95 {
            ahead
        } else {
            up * -ahead.y.signum()
        };
        level.with_y(0.0).normalize_or(Vec3::NEG_Z)
    }

    /// The turn about the vertical that takes −Z to [`Stance::ahead`].
    pub fn yaw(&self) -> f32 {
        let ahead = self.ahead();
        (-ahead.x).atan2(-ahead.z)
    }
}

pub(crate) fn spawn(mut commands: Commands) {
    commands.spawn((
        Name::new("room"),
        Root,
        Transform::default(),
        Visibility::Hidden,
    ));
}

/// Before anything is filtered: where this frame's hands are.
pub(crate) fn sense(input: Res<HandsInput>, view: Res<WorldView>, mut stance: ResMut<Stance>) {
    let room = view.room_from_world;
    for side in Side::BOTH {
        let i = side as usize;
        let pose = input.frames[i].pose.filter(Pose::is_sound);
        stance.tracked[i] = pose.is_some();
        if let Some(pose) = pose {
            stance.hands[i] = room.pose(&pose);
        }
    }
    if let Some(head) = input.head.filter(Pose::is_sound) {
        stance.head = room.pose(&head);
        stance.head_known = true;
    }
}

/// After the hands have advanced: one that is lost stays where it was in the room, not in the world.
pub(crate) fn settle(hands: Res<Hands>, mut stance: ResMut<Stance>) {
    for (side, hand) in hands.both() {
        stance.tracked[side as usize] = hand.tracked;
    }
}

/// The room goes through the world; without anybody in it nothing of it is seen.
pub(crate) fn follow(
    view: Res<WorldView>,
    host: Res<Host>,
    root: Single<(&mut Transform, &mut Visibility), With<Root>>,
) {
    let (mut transform, mut visibility) = root.into_inner();
    let wanted = if *host == Host::Room {
        Visibility::Visible
    } else {
        Visibility::Hidden
    };
    visibility.set_if_neq(wanted);
    let world = view.world_from_room();
    transform.set_if_neq(Transform {
        translation: world.translation,
        rotation: world.rotation,
        scale: Vec3::splat(world.scale),
    });
}

/// The turn of something at `at` that shows its +Z to `eye`, upright.
pub(crate) fn facing(at: Vec3, eye: Vec3) -> Quat {
    let away = (at - eye).normalize_or(Vec3::NEG_Z);
    Transform::IDENTITY.looking_to(away, Vec3::Y).rotation
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ahead_is_level_whichever_way_one_looks() {
        let mut stance = Stance::default();
        for pitch in [-1.5, -0.5, 0.0, 0.8, 1.5] {
            stance.head.rotation = Quat::from_rotation_y(0.6) * Quat::from_rotation_x(pitch);
            let ahead = Quat::from_rotation_y(0.6) * Vec3::NEG_Z;
            assert!(stance.ahead().distance(ahead) < 1e-3, "{pitch}");
            assert!((stance.yaw() - 0.6).abs() < 1e-3);
        }
    }

    #[test]
    fn what_faces_the_eyes_shows_them_its_front() {
        let (at, eye) = (Vec3::new(0.3, 1.2, -0.5), Vec3::new(0.0, 1.6, 0.1));
        let front = facing(at, eye) * Vec3::Z;
        assert!(front.distance((eye - at).normalize()) < 1e-5);
        assert!((facing(at, eye) * Vec3::X).y.abs() < 1e-5);
    }
}
