//! The camera: around a point one looks at.

use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::input::mouse::{AccumulatedMouseMotion, AccumulatedMouseScroll, MouseScrollUnit};
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;
use midair_studio::{
    project::{Project, Selection},
    show::ObjectMap,
};

use crate::pointer::Pointer;

/// Where the camera is, as one turns it.
#[derive(Component, Clone, Copy, Debug)]
pub struct Orbit {
    /// What it looks at, in world metres.
    pub focus: Vec3,
    /// Turn about the vertical, radians.
    pub yaw: f32,
    /// Tilt above the horizon, radians.
    pub pitch: f32,
    /// Metres to the focus.
    pub distance: f32,
}

impl Default for Orbit {
    fn default() -> Self {
        Self {
            focus: Vec3::new(0.0, 0.2, 0.0),
            yaw: 0.55,
            pitch: 0.42,
            distance: 2.2,
        }
    }
}

impl Orbit {
    /// Where the camera stands.
    pub fn transform(&self) -> Transform {
        let rotation = Quat::from_rotation_y(self.yaw) * Quat::from_rotation_x(-self.pitch);
        Transform {
            translation: self.focus + rotation * Vec3::Z * self.distance,
            rotation,
            scale: Vec3::ONE,
        }
    }
}

pub(crate) fn spawn(mut commands: Commands) {
    let orbit = Orbit::default();
    commands.spawn((
        Name::new("camera"),
        Camera3d::default(),
        Projection::Perspective(PerspectiveProjection {
            fov: 0.75,
            near: 0.02,
            ..default()
        }),
        Tonemapping::AcesFitted,
        Msaa::Sample4,
        orbit.transform(),
        orbit,
    ));
}

pub(crate) fn steer(
    buttons: Res<ButtonInput<MouseButton>>,
    keys: Res<ButtonInput<KeyCode>>,
    motion: Res<AccumulatedMouseMotion>,
    scroll: Res<AccumulatedMouseScroll>,
    wants: Res<EguiWantsInput>,
    pointer: Res<Pointer>,
    camera: Single<(&mut Orbit, &mut Transform)>,
    windows: Query<&Window>,
) {
    let (mut orbit, mut transform) = camera.into_inner();
    let height = windows.iter().next().map_or(720.0, |w| w.height().max(1.0));
    if !wants.wants_any_pointer_input() {
        let shift = keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
        let alt = keys.any_pressed([KeyCode::AltLeft, KeyCode::AltRight]);
        let orbiting = buttons.pressed(MouseButton::Middle)
            || buttons.pressed(MouseButton::Right)
            || alt && buttons.pressed(MouseButton::Left);
        if orbiting && motion.delta != Vec2::ZERO {
            if shift {
                // What lies at the focus stays under the pointer.
                let metres = 2.0 * orbit.distance * (0.5_f32 * 0.75).tan() / height;
                let delta = transform.rotation
                    * Vec3::new(-motion.delta.x, motion.delta.y, 0.0)
                    * metres;
                orbit.focus += delta;
            } else {
                // Half a turn across the height of the window.
                let turn = std::f32::consts::PI / height;
                orbit.yaw -= motion.delta.x * turn;
                orbit.pitch = (orbit.pitch + motion.delta.y * turn).clamp(-1.5, 1.5);
            }
        }
        // While something is held the wheel is the hand's.
        if scroll.delta.y != 0.0 && !pointer.holds() {
            let lines = match scroll.unit {
                MouseScrollUnit::Line => scroll.delta.y,
                MouseScrollUnit::Pixel => scroll.delta.y / 40.0,
            };
            orbit.distance = (orbit.distance * 0.88_f32.powf(lines)).clamp(0.05, 40.0);
        }
    }
    transform.set_if_neq(orbit.transform());
}

/// F shows what is selected, or everything.
pub(crate) fn frame(
    keys: Res<ButtonInput<KeyCode>>,
    wants: Res<EguiWantsInput>,
    project: Res<Project>,
    selection: Res<Selection>,
    map: Res<ObjectMap>,
    transforms: Query<&Transform, Without<Orbit>>,
    mut orbit: Single<&mut Orbit>,
) {
    if !keys.just_pressed(KeyCode::KeyF) || wants.wants_any_keyboard_input() {
        return;
    }
    let document = project.document();
    let all = selection.0.is_empty();
    let mut low = Vec3::INFINITY;
    let mut high = Vec3::NEG_INFINITY;
    for (id, object) in document.objects() {
        if !all && !selection.0.contains(&id) {
            continue;
        }
        let Some(at) = map.get(id).and_then(|e| transforms.get(e).ok()) else {
            continue;
        };
        let radius = object
            .recipe()
            .map(|r| r.bounds())
            .filter(|b| !b.is_empty())
            .map_or(0.2, |b| {
                (b.min.abs().max(b.max.abs()) * at.scale.abs()).length()
            });
        low = low.min(at.translation - radius);
        high = high.max(at.translation + radius);
    }
    if low.cmple(high).all() {
        orbit.focus = low.midpoint(high);
        orbit.distance = (0.5 * (high - low).length() / 0.33).clamp(0.1, 40.0);
    }
}
