//! The camera: around a point one looks at.

use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::input::mouse::{AccumulatedMouseScroll, MouseScrollUnit};
use bevy::light::ShadowFilteringMethod;
use bevy::prelude::*;
use bevy::render::renderer::RenderAdapterInfo;
use midair_studio::{
    project::{Project, Selection},
    show::{ObjectMap, is_software},
};

use crate::bindings::{Control, Controls};
use crate::gamepad::Pad;
use crate::panels::Screen;
use crate::pointer::Pointer;

/// Of the height of the window, in radians.
pub(crate) const FIELD_OF_VIEW: f32 = 0.75;

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

pub(crate) fn spawn(mut commands: Commands, adapter: Option<Res<RenderAdapterInfo>>) {
    let orbit = Orbit::default();
    // Without a graphics card a frame in time is worth more than a smooth edge.
    let software = adapter.is_some_and(|a| is_software(&a));
    let (samples, shadows) = if software {
        (Msaa::Off, ShadowFilteringMethod::Hardware2x2)
    } else {
        (Msaa::Sample4, ShadowFilteringMethod::Gaussian)
    };
    commands.spawn((
        Name::new("camera"),
        Camera3d::default(),
        Projection::Perspective(PerspectiveProjection {
            fov: FIELD_OF_VIEW,
            near: 0.02,
            ..default()
        }),
        Tonemapping::AcesFitted,
        samples,
        shadows,
        orbit.transform(),
        orbit,
    ));
}

pub(crate) fn steer(
    (controls, scroll, mut moved): (
        Res<Controls>,
        Res<AccumulatedMouseScroll>,
        MessageReader<CursorMoved>,
    ),
    screen: Res<Screen>,
    pointer: Res<Pointer>,
    camera: Single<(&mut Orbit, &mut Transform)>,
    windows: Query<&Window>,
    mut steering: Local<bool>,
) {
    let (mut orbit, mut transform) = camera.into_inner();
    let window = windows.iter().next();
    let height = window.map_or(720.0, |w| w.height().max(1.0));
    let travelled: Vec2 = moved.read().filter_map(|m| m.delta).sum();
    let panel = screen.covers(window.and_then(Window::cursor_position));
    let pans = controls.pressed(Control::Pan);
    let began = [Control::Orbit, Control::Pan]
        .into_iter()
        .any(|c| controls.just_pressed(c));
    // What began in the view goes on over the panels, and the other way about.
    *steering = (pans || controls.pressed(Control::Orbit)) && (*steering || began && !panel);
    if *steering && travelled != Vec2::ZERO {
        if pans {
            // What lies at the focus stays under the pointer.
            let metres = 2.0 * orbit.distance * (0.5 * FIELD_OF_VIEW).tan() / height;
            let delta = transform.rotation * Vec3::new(-travelled.x, travelled.y, 0.0) * metres;
            orbit.focus += delta;
        } else {
            // Half a turn across the height of the window.
            let turn = std::f32::consts::PI / height;
            orbit.yaw -= travelled.x * turn;
            orbit.pitch = (orbit.pitch + travelled.y * turn).clamp(-1.5, 1.5);
        }
    }
    // While something is held the wheel is the hand's.
    if scroll.delta.y != 0.0 && !panel && !pointer.holds() {
        orbit.distance = (orbit.distance * 0.88_f32.powf(lines(&scroll))).clamp(0.05, 40.0);
    }
    transform.set_if_neq(orbit.transform());
}

/// How far the wheel was turned, whatever it counts in.
pub(crate) fn lines(scroll: &AccumulatedMouseScroll) -> f32 {
    match scroll.unit {
        MouseScrollUnit::Line => scroll.delta.y,
        MouseScrollUnit::Pixel => scroll.delta.y / 40.0,
    }
}

/// F shows what is selected, or everything.
pub(crate) fn frame(
    controls: Res<Controls>,
    mut pad: ResMut<Pad>,
    project: Res<Project>,
    selection: Res<Selection>,
    map: Res<ObjectMap>,
    transforms: Query<&Transform, Without<Orbit>>,
    mut orbit: Single<&mut Orbit>,
) {
    let asked = std::mem::take(&mut pad.frame) || controls.just_pressed(Control::FrameSelection);
    let everything = controls.just_pressed(Control::FrameAll);
    if !asked && !everything {
        return;
    }
    let document = project.document();
    let all = everything || selection.0.is_empty();
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
