//! The window on the desktop while somebody wears a headset: what they see, steadied, or a spectator's own view.

use bevy::prelude::*;
use midair_studio::hands::{Hands, Pose};
use midair_studio::panel::Host;
use midair_studio::settings::{Desktop, Settings};
use midair_studio::show::{Eye, FIELD_OF_VIEW};
use midair_studio::world::WorldView;

/// Seconds in which the window follows the head most of the way.
const STEADY: f32 = 0.12;

/// Of the height of a mirror's view, in radians: hands and what is beside them are in it.
const WIDE: f32 = 1.2;

/// Where the window's camera stood before it followed the head, and where it is, in metres of the room.
#[derive(Default)]
pub(crate) struct Followed {
    before: Option<Transform>,
    at: Option<Pose>,
}

pub(crate) fn mirror(
    host: Res<Host>,
    (settings, view): (Res<Settings>, Res<WorldView>),
    (hands, time): (Res<Hands>, Res<Time>),
    mut eyes: Query<(&Eye, &mut Transform, &mut Projection)>,
    mut followed: Local<Followed>,
) {
    let head = hands
        .head
        .filter(|_| *host == Host::Room && settings.comfort.desktop == Desktop::Mirror);
    for (eye, mut transform, mut projection) in &mut eyes {
        if *eye != Eye::Working {
            continue;
        }
        let wanted = if head.is_some() { WIDE } else { FIELD_OF_VIEW };
        if (head.is_some() || followed.before.is_some())
            && matches!(&*projection, Projection::Perspective(p) if p.fov != wanted)
            && let Projection::Perspective(perspective) = &mut *projection
        {
            perspective.fov = wanted;
        }
        let Some(head) = head else {
            if let Some(before) = followed.before.take() {
                *transform = before;
            }
            followed.at = None;
            continue;
        };
        followed.before.get_or_insert(*transform);
        let head = view.room_from_world.pose(&head);
        let at = match followed.at {
            Some(last) => {
                let part = 1.0 - (-time.delta_secs() / STEADY).exp();
                Pose {
                    position: last.position.lerp(head.position, part),
                    rotation: last.rotation.slerp(head.rotation, part),
                }
            }
            None => head,
        };
        followed.at = Some(at);
        let at = view.world_from_room().pose(&at);
        transform.set_if_neq(Transform {
            translation: at.position,
            rotation: at.rotation,
            scale: Vec3::ONE,
        });
    }
}
