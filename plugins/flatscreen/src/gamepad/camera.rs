//! The sticks and the camera.

use bevy::prelude::*;
use midair_studio::{hands::Side, settings::Settings, tools::Aim};

use super::Pad;
use crate::bindings::{Control, Controls};
use crate::focus::Focus;
use crate::orbit::{FIELD_OF_VIEW, Orbit};
use crate::ring::Ring;

/// Radians a second at full deflection.
const TURNS: f32 = 1.8;
/// How many times nearer in a second.
const ZOOMS: f32 = 4.0;

/// A stick is finer near its middle.
pub(super) fn fine(stick: Vec2) -> Vec2 {
    stick * stick.length()
}

/// How much faster the hand goes than half a view's height a second at full deflection: near the middle of the stick not at
/// all, at its edge two and a half times: a way across the view takes less than a second.
pub(super) fn swift(fine: Vec2) -> f32 {
    1.0 + 1.5 * fine.length().min(1.0)
}

/// The stick of the leading hand and that of the view, mirrored for left-handed people.
pub(super) fn sticks(controls: &Controls, settings: &Settings) -> (Vec2, Vec2) {
    let (hand, view) = (
        fine(controls.stick(Control::HandStick)),
        fine(controls.stick(Control::ViewStick)),
    );
    if settings.hands.left_handed {
        (view, hand)
    } else {
        (hand, view)
    }
}

/// Orbits around the leading hand; with LB pans, orbits around the middle, and zooms.
pub(crate) fn camera(
    controls: Res<Controls>,
    settings: Res<Settings>,
    (focus, ring): (Res<Focus>, Res<Ring>),
    time: Res<Time>,
    (pad, aim): (Res<Pad>, Res<Aim>),
    camera: Single<(&mut Orbit, &Transform)>,
) {
    let dt = time.delta_secs();
    let (mut orbit, eye) = camera.into_inner();
    let mut next = *orbit;
    let zoom = f32::from(controls.pressed(Control::ZoomOut))
        - f32::from(controls.pressed(Control::ZoomIn));
    if zoom != 0.0 {
        next.distance = (next.distance * ZOOMS.powf(zoom * dt)).clamp(0.05, 40.0);
    }
    if pad.leads && !ring.is_open() && !controls.pressed(Control::Deep) {
        let (hand, mut view) = sticks(&controls, &settings);
        let roams = controls.pressed(Control::Roam);
        if focus.is_inside() || aim.both && !roams {
            // It slides in the panel, or moves the other hand.
            view = Vec2::ZERO;
        }
        if roams && hand != Vec2::ZERO {
            let speed = next.distance * (0.5 * FIELD_OF_VIEW).tan();
            next.focus += eye.rotation * hand.extend(0.0) * speed * dt;
        }
        if view != Vec2::ZERO {
            let about = if roams {
                next.focus
            } else {
                pad.poses[pad.leading as usize].position
            };
            turn(&mut next, about, view * TURNS * dt);
        }
    }
    if (next.focus, next.yaw, next.pitch, next.distance)
        != (orbit.focus, orbit.yaw, orbit.pitch, orbit.distance)
    {
        *orbit = next;
    }
}

/// Turns the camera about a point, which stays where it is on the screen.
fn turn(orbit: &mut Orbit, about: Vec3, by: Vec2) {
    let before = orbit.transform();
    orbit.yaw -= by.x;
    orbit.pitch = (orbit.pitch - by.y).clamp(-1.5, 1.5);
    let turned = orbit.transform().rotation * before.rotation.inverse();
    orbit.focus = about + turned * (orbit.focus - about);
}

/// An empty hand hangs where it touches and hides nothing.
pub(super) fn rest(eye: &Transform, side: Side) -> Vec3 {
    let right = match side {
        Side::Left => -0.2,
        Side::Right => 0.2,
    };
    eye.transform_point(Vec3::new(right, -0.25, 0.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_one_orbits_about_stays_on_its_place_on_the_screen() {
        let mut orbit = Orbit::default();
        let about = Vec3::new(0.4, 0.1, -0.2);
        let seen = |o: &Orbit| o.transform().to_matrix().inverse().transform_point3(about);
        let before = seen(&orbit);
        for _ in 0..50 {
            turn(&mut orbit, about, Vec2::new(0.03, 0.05));
        }
        assert!(seen(&orbit).distance(before) < 1e-4);
        assert!(orbit.pitch.abs() <= 1.5);
    }
}
