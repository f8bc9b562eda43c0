//! The camera: around a point one looks at.

use std::f32::consts::FRAC_PI_2;

use bevy::input::mouse::{AccumulatedMouseScroll, MouseScrollUnit};
use bevy::prelude::*;
use bevy_egui::PrimaryEguiContext;
use midair_studio::{
    hands::HandsInput,
    show::{Eye, camera},
    tools::Aim,
    world::Similarity,
};

pub(crate) use midair_studio::show::FIELD_OF_VIEW;

use crate::bindings::{Control, Controls, Cursor};
use crate::panels::Screen;
use crate::pointer::Pointer;

/// Metres to the focus at the start, where the world has its own size in the hands.
const FIRST_DISTANCE: f32 = 2.2;
/// The focus is never nearer or farther, in metres.
const NEAREST: f32 = 0.05;
const FARTHEST: f32 = 40.0;

/// Where the camera is, as one turns it.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// What it looks at, in world metres.
    pub focus: Vec3,
    /// Turn about the vertical, radians.
    pub yaw: f32,
    /// Tilt above the horizon, radians.
    pub pitch: f32,
    /// Metres to the focus.
    pub distance: f32,
    /// How the whole is leaned over, where the world was tilted.
    pub lean: Quat,
}

impl Default for Orbit {
    fn default() -> Self {
        Self {
            focus: Vec3::new(0.0, 0.2, 0.0),
            yaw: 0.55,
            pitch: 0.42,
            distance: FIRST_DISTANCE,
            lean: Quat::IDENTITY,
        }
    }
}

impl Orbit {
    /// Where the camera stands.
    pub fn transform(&self) -> Transform {
        let upright = Quat::from_rotation_y(self.yaw) * Quat::from_rotation_x(-self.pitch);
        let rotation = (self.lean * upright).normalize();
        Transform {
            translation: self.focus + rotation * Vec3::Z * self.distance,
            rotation,
            scale: Vec3::ONE,
        }
    }

    /// Physical metres per metre of world: seen from afar, the world is small in the hands.
    pub fn metres_per_world(&self) -> f32 {
        (FIRST_DISTANCE / self.distance).clamp(0.1, 10.0)
    }

    /// Whether it is a place to look from.
    fn is_sound(&self) -> bool {
        self.focus.is_finite()
            && self.yaw.is_finite()
            && self.pitch.is_finite()
            && self.distance.is_finite()
    }

    /// Goes along with the world that was moved.
    pub(crate) fn carry(&mut self, by: &Similarity) {
        self.focus = by.point(self.focus);
        self.distance = (self.distance * by.scale).clamp(NEAREST, FARTHEST);
        if (by.rotation * Vec3::Y).distance(Vec3::Y) < 1e-4 && self.lean == Quat::IDENTITY {
            let ahead = by.rotation * Vec3::Z;
            self.yaw += ahead.x.atan2(ahead.z);
        } else {
            self.lean = (by.rotation * self.lean).normalize();
            // Put back upright it is as if it had never leaned.
            if self.lean.angle_between(Quat::IDENTITY) < 1e-3 {
                self.lean = Quat::IDENTITY;
            }
        }
    }

    fn drag(&mut self, drag: Drag, travelled: Vec2, height: f32) {
        // Half a turn across the height of the window.
        let turn = std::f32::consts::PI / height;
        match drag {
            Drag::Pan => {
                // What lies at the focus stays under the pointer.
                let metres = 2.0 * self.distance * (0.5 * FIELD_OF_VIEW).tan() / height;
                let across = Vec3::new(-travelled.x, travelled.y, 0.0) * metres;
                self.focus += self.transform().rotation * across;
            }
            Drag::Orbit => self.turn(travelled * turn),
            Drag::Look => {
                // The eye stays where it is.
                let eye = self.transform().translation;
                self.turn(0.5 * travelled * turn);
                self.focus += eye - self.transform().translation;
            }
        }
    }

    fn turn(&mut self, by: Vec2) {
        self.yaw -= by.x;
        self.pitch = (self.pitch + by.y).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// One flies as far in a second as one is away from what one looks at.
    fn fly(&mut self, controls: &Controls, dt: f32) {
        let along =
            |ahead, back| f32::from(controls.pressed(ahead)) - f32::from(controls.pressed(back));
        let way = Vec3::new(
            along(Control::FlyRight, Control::FlyLeft),
            along(Control::FlyUp, Control::FlyDown),
            along(Control::FlyBack, Control::FlyForward),
        );
        let fast = if controls.pressed(Control::FlyFast) {
            4.0
        } else {
            1.0
        };
        let speed = self.distance.clamp(0.3, 5.0) * fast;
        self.focus += self.transform().rotation * way.normalize_or_zero() * (speed * dt);
    }

    /// Nearer or farther; `about` stays where it is on the screen.
    fn zoom(&mut self, factor: f32, about: Vec3) {
        let distance = (self.distance * factor).clamp(NEAREST, FARTHEST);
        let factor = distance / self.distance;
        // A hand at rest behind the eyes is nothing to zoom towards.
        let eye = self.transform();
        let ahead = (about - eye.translation).dot(*eye.forward());
        let about = if ahead > 0.0 && ahead < 4.0 * self.distance {
            about
        } else {
            self.focus
        };
        self.focus = about + (self.focus - about) * factor;
        self.distance = distance;
    }
}

pub(crate) fn spawn(mut commands: Commands) {
    let orbit = Orbit::default();
    commands.spawn((
        Name::new("camera"),
        camera(Eye::Working),
        // Left to itself it would take the first camera there is: an eye of the headset.
        PrimaryEguiContext,
        orbit.transform(),
        orbit,
    ));
}

/// What a drag does with the view.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Drag {
    Orbit,
    Pan,
    Look,
}

impl Drag {
    const ALL: [(Self, Control); 3] = [
        (Self::Pan, Control::Pan),
        (Self::Orbit, Control::Orbit),
        (Self::Look, Control::Look),
    ];

    fn control(self) -> Control {
        match self {
            Self::Orbit => Control::Orbit,
            Self::Pan => Control::Pan,
            Self::Look => Control::Look,
        }
    }
}

pub(crate) fn steer(
    controls: Res<Controls>,
    scroll: Res<AccumulatedMouseScroll>,
    cursor: Res<Cursor>,
    screen: Res<Screen>,
    (pointer, aim): (Res<Pointer>, Res<Aim>),
    time: Res<Time>,
    camera: Single<(&mut Orbit, &mut Transform)>,
    windows: Query<&Window>,
    mut input: ResMut<HandsInput>,
    mut drag: Local<Option<Drag>>,
) {
    let (mut orbit, mut transform) = camera.into_inner();
    let window = windows.iter().next();
    let height = window.map_or(720.0, |w| w.height().max(1.0));
    let travelled = cursor.travelled();
    let panel = screen.covers(cursor.at());
    // What began in the view goes on over the panels, and the other way about.
    let began = Drag::ALL
        .into_iter()
        .find(|&(_, control)| controls.just_pressed(control) && !panel)
        .map(|(drag, _)| drag);
    let mut next = *orbit;
    // What was travelled came before what went down or up in this frame.
    if let Some(drag) = *drag
        && travelled != Vec2::ZERO
    {
        next.drag(drag, travelled, height);
    }
    *drag = began.or(drag.filter(|d| controls.pressed(d.control())));
    if *drag == Some(Drag::Look) {
        next.fly(&controls, time.delta_secs());
    }
    // While something is held the wheel is the hand's.
    let sizing = aim.draws && controls.pressed(Control::SnapOff);
    if scroll.delta.y != 0.0 && !panel && !pointer.has_wheel() && !sizing {
        next.zoom(
            0.88_f32.powf(lines(&scroll)),
            pointer.pose(pointer.leading).position,
        );
    }
    if next.is_sound() && next != *orbit {
        *orbit = next;
    }
    input.metres_per_world = orbit.metres_per_world();
    transform.set_if_neq(orbit.transform());
}

/// Under how many radians a pixel in the middle of the view is seen.
pub(crate) fn pixel(camera: &Camera) -> f32 {
    let height = camera.logical_viewport_size().map_or(720.0, |size| size.y);
    2.0 * (0.5 * FIELD_OF_VIEW).tan() / height.max(1.0)
}

/// How far the wheel was turned, whatever it counts in.
pub(crate) fn lines(scroll: &AccumulatedMouseScroll) -> f32 {
    match scroll.unit {
        MouseScrollUnit::Line => scroll.delta.y,
        MouseScrollUnit::Pixel => scroll.delta.y / 40.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_one_zooms_towards_stays_on_its_place_on_the_screen() {
        let mut orbit = Orbit::default();
        let about = Vec3::new(0.4, 0.1, -0.2);
        let seen = |o: &Orbit| {
            let at = o.transform().to_matrix().inverse().transform_point3(about);
            at.truncate() / at.z
        };
        let before = seen(&orbit);
        for _ in 0..10 {
            orbit.zoom(0.88, about);
        }
        assert!(orbit.distance < 1.0);
        assert!(seen(&orbit).distance(before) < 1e-3);
        for _ in 0..200 {
            orbit.zoom(0.5, about);
        }
        assert!(orbit.is_sound() && orbit.distance >= NEAREST);
    }

    #[test]
    fn looking_around_turns_about_the_eye() {
        let mut orbit = Orbit::default();
        let eye = orbit.transform().translation;
        orbit.drag(Drag::Look, Vec2::new(90.0, -40.0), 720.0);
        assert!(orbit.transform().translation.distance(eye) < 1e-5);
        assert_ne!(orbit.yaw, Orbit::default().yaw);
    }

    #[test]
    fn the_view_goes_along_with_the_world_and_back() {
        let mut orbit = Orbit::default();
        let by = Similarity {
            scale: 2.0,
            rotation: Quat::from_rotation_y(0.6),
            translation: Vec3::new(0.3, 0.0, -1.0),
        };
        let before = orbit.transform();
        orbit.carry(&by);
        let after = orbit.transform();
        assert!(after.translation.distance(by.point(before.translation)) < 1e-4);
        assert!(after.rotation.angle_between(by.rotation * before.rotation) < 1e-3);
        assert!((orbit.metres_per_world() - 0.5).abs() < 1e-4);
        orbit.carry(&by.inverse());
        assert!(orbit.transform().translation.distance(before.translation) < 1e-4);
        let tilt = Similarity {
            rotation: Quat::from_rotation_x(0.5),
            ..Similarity::IDENTITY
        };
        orbit.carry(&tilt);
        orbit.carry(&tilt.inverse());
        assert_eq!(orbit.lean, Quat::IDENTITY);
    }
}
