//! Where boards stand: before the eyes and beside the work, on a wrist, below what is typed into.

use bevy::prelude::*;
use midair_studio::hands::{Action, Hands, Pose, Side};
use midair_studio::panel::{Dock, Host};
use midair_studio::settings::Settings;
use midair_studio::world::WorldView;

use super::{AWAY, Anchor, Board, Boards};
use crate::room::{Stance, facing};

/// Metres that boards stand below the eyes.
const BELOW: f32 = 0.04;
/// Metres from a hand to the middle of its board, outwards, up and back, as the hand is held level.
pub(crate) const WRIST: Vec3 = Vec3::new(0.23, 0.0, 0.06);
/// How much of a wrist must be turned to the eyes to show its board, and to go on showing it.
const TURNED: [f32; 2] = [0.45, 0.25];
/// Seconds in which a board opens.
const OPENS: f64 = 0.12;

/// A free place before the eyes for a board of that size in metres, on the side where its dock is.
pub(super) fn spot(
    dock: Dock,
    off: Side,
    size: Vec2,
    stance: &Stance,
    taken: &[(Vec3, f32)],
) -> Pose {
    // Degrees to the side of the hand that does not lead.
    let (angles, lower): (&[f32], f32) = match dock {
        Dock::Left => (&[34.0, 70.0, -36.0, -72.0], 0.0),
        Dock::Right => (&[-36.0, -72.0, 36.0, 72.0], 0.0),
        // Over the work, where it can be read and nothing is covered.
        Dock::Corner => (&[0.0, -34.0, 34.0], -0.14),
        Dock::Window => (&[0.0, 36.0, -36.0, 72.0, -72.0], 0.06),
        Dock::Modal => (&[0.0], 0.08),
    };
    let outwards = match off {
        Side::Left => 1.0,
        Side::Right => -1.0,
    };
    let ahead = stance.ahead();
    let eyes = stance.head.position;
    let at = |angle: &f32| {
        let turn = Quat::from_rotation_y((angle * outwards).to_radians());
        eyes + turn * ahead * AWAY - (BELOW + lower) * Vec3::Y
    };
    let radius = 0.5 * size.x;
    let free = |place: &Vec3| {
        // Side by side; boards may overlap by an edge.
        taken
            .iter()
            .all(|(other, r)| other.distance(*place) > 0.95 * (r + radius))
    };
    let place = angles.iter().map(at).find(free);
    let position = place.unwrap_or_else(|| {
        // Nowhere is free: in front of the others.
        let first = angles.first().copied().unwrap_or_default();
        eyes.lerp(at(&first), 0.85)
    });
    Pose {
        position,
        rotation: facing(position, eyes),
    }
}

/// Before the body, below the work: what would hang on a wrist that is not there.
pub(super) fn low(stance: &Stance) -> Pose {
    let eyes = stance.head.position;
    let position = eyes + 0.45 * stance.ahead() - 0.42 * Vec3::Y;
    Pose {
        position,
        rotation: facing(position, eyes),
    }
}

/// Around a hand.
pub(super) fn at_hand(hand: Vec3, stance: &Stance) -> Pose {
    let eyes = stance.head.position;
    // A little behind it, seen from the eyes, so that the hand is before it.
    let position = hand + 0.05 * (hand - eyes).normalize_or(Vec3::NEG_Z);
    Pose {
        position,
        rotation: facing(position, eyes),
    }
}

/// Moves what goes along with something, and shows each where it stands.
pub(crate) fn place(
    mut boards: ResMut<Boards>,
    stance: Res<Stance>,
    (hands, host, view): (Res<Hands>, Res<Host>, Res<WorldView>),
    (settings, time): (Res<Settings>, Res<Time>),
    mut sheets: Query<(&mut Transform, &mut Visibility)>,
) {
    if *host != Host::Room {
        return;
    }
    let boards = boards.bypass_change_detection();
    let eyes = stance.head.position;
    let ids: Vec<_> = boards.all.keys().copied().collect();
    for id in ids {
        let below = boards.all.get(&id).and_then(|b| match b.anchor {
            Anchor::Below(other) => boards.all.get(&other).map(|o| (o.pose, o.metres())),
            _ => None,
        });
        let Some(board) = boards.all.get_mut(&id) else {
            continue;
        };
        match board.anchor {
            Anchor::Room => board.shown = board.open,
            Anchor::Hand(side) => wrist(board, side, &stance, &hands, &view, &settings),
            Anchor::Below(_) => {
                board.shown = board.open;
                if let Some((other, size)) = below {
                    let half = 0.5 * board.metres().y;
                    let down = other.rotation * Vec3::NEG_Y;
                    let foot = other.position + (0.5 * size.y + 0.02) * down;
                    // Nearer and flatter, as keys lie.
                    let position = foot + half * down + 0.10 * (eyes - foot).normalize_or(Vec3::Z);
                    board.pose = Pose {
                        position,
                        rotation: facing(position, eyes),
                    };
                }
            }
        }
        let Some((mut transform, mut visibility)) =
            board.picture.quad.and_then(|q| sheets.get_mut(q).ok())
        else {
            continue;
        };
        let seen = if board.open && board.shown {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        };
        visibility.set_if_neq(seen);
        let since = (time.elapsed_secs_f64() - board.opened) / OPENS;
        let grown = if settings.look.motion && since < 1.0 {
            let left = 1.0 - since.max(0.0) as f32;
            1.0 - 0.15 * left * left
        } else {
            1.0
        };
        transform.set_if_neq(Transform {
            translation: board.pose.position,
            rotation: board.pose.rotation,
            scale: Vec3::splat(grown),
        });
    }
}

/// Beside the hand, turned to the eyes; seen while the back of the hand is, and the hand does nothing else.
fn wrist(
    board: &mut Board,
    side: Side,
    stance: &Stance,
    hands: &Hands,
    view: &WorldView,
    settings: &Settings,
) {
    let hand = stance.hand(side);
    let eyes = stance.head.position;
    let outwards = match side {
        Side::Left => -1.0,
        Side::Right => 1.0,
    };
    // Away from the other hand, whichever way the wrist is bent.
    let across = (stance.head.rotation * Vec3::X)
        .with_y(0.0)
        .normalize_or(Vec3::X);
    let back = (eyes - hand.position).with_y(0.0).normalize_or(Vec3::Z);
    let offset = across * WRIST.x * outwards + Vec3::Y * WRIST.y + back * WRIST.z;
    let wanted = hand.position + offset;
    // A hand at rest carries a board at rest: what trembles less than a millimetre stays.
    let moved = wanted.distance(board.pose.position);
    let position = board
        .pose
        .position
        .lerp(wanted, (moved / 0.02).clamp(0.05, 1.0));
    board.pose = Pose {
        position,
        rotation: facing(position, eyes),
    };
    let turned = (hand.rotation * Vec3::Y).dot((eyes - hand.position).normalize_or(Vec3::Y));
    let enough = TURNED[usize::from(board.shown)];
    let holds = [Action::Act, Action::Grab]
        .iter()
        .any(|&a| hands.get(side).held(a));
    let pointed = board.pointer.is_some();
    board.shown = board.open
        && settings.comfort.wrist
        && stance.tracked[side as usize]
        && (pointed || turned > enough && !holds && !view.is_held());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boards_find_places_beside_each_other_within_reach() {
        let stance = Stance::default();
        let size = Vec2::new(0.34, 0.43);
        let mut taken = Vec::new();
        for dock in [Dock::Left, Dock::Right, Dock::Window, Dock::Left] {
            let pose = spot(dock, Side::Left, size, &stance, &taken);
            let far = pose.position.distance(stance.head.position);
            assert!((0.5..=0.7).contains(&far), "{dock:?} is {far} m away");
            for (other, _) in &taken {
                assert!(pose.position.distance(*other) > 0.2, "{dock:?}");
            }
            taken.push((pose.position, 0.5 * size.x));
        }
        // The library stands at the side of the hand that does not lead.
        assert!(taken[0].0.x < stance.head.position.x);
        let right = spot(Dock::Left, Side::Right, size, &stance, &[]);
        assert!(right.position.x > stance.head.position.x);
    }
}
