//! The pointer as a hand.

use bevy::input::mouse::{AccumulatedMouseMotion, AccumulatedMouseScroll};
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;
use bevy_rapier3d::prelude::ReadRapierContext;
use midair_studio::{
    hands::{Action, ActionSet, HandFrame, HandsInput, Pose, Side},
    pick::{self, Proxy},
};

use crate::orbit::Orbit;

/// The leading hand, and the one that stays where it is.
#[derive(Resource, Clone, Debug)]
pub struct Pointer {
    /// Which hand follows the pointer.
    pub leading: Side,
    poses: [Pose; 2],
    /// Which hands hold on although no button is down.
    latched: [bool; 2],
    /// Metres from the camera, along its view, at which a held thing is dragged.
    depth: Option<f32>,
    /// How the wand is turned against the camera.
    turn: Quat,
    over: bool,
}

impl Default for Pointer {
    fn default() -> Self {
        Self {
            leading: Side::Right,
            poses: [
                Pose::at(Vec3::new(-0.25, 0.2, 0.3)),
                Pose::at(Vec3::new(0.25, 0.2, 0.3)),
            ],
            latched: [false; 2],
            depth: None,
            turn: Quat::IDENTITY,
            over: false,
        }
    }
}

impl Pointer {
    /// Whether a hand holds something, so that the wheel is not the camera's.
    pub fn holds(&self) -> bool {
        self.depth.is_some()
    }

    /// Whether the pointer is over a thing and not over a panel.
    pub fn is_over(&self) -> bool {
        self.over
    }

    /// Where a hand is.
    pub fn pose(&self, side: Side) -> Pose {
        self.poses[side as usize]
    }

    pub(crate) fn release_all(&mut self) {
        self.latched = [false; 2];
        self.depth = None;
    }
}

pub(crate) fn point(
    buttons: Res<ButtonInput<MouseButton>>,
    keys: Res<ButtonInput<KeyCode>>,
    motion: Res<AccumulatedMouseMotion>,
    scroll: Res<AccumulatedMouseScroll>,
    wants: Res<EguiWantsInput>,
    windows: Query<&Window>,
    camera: Single<(&Camera, &Transform), With<Orbit>>,
    context: ReadRapierContext,
    proxies: Query<&Proxy>,
    mut pointer: ResMut<Pointer>,
    mut input: ResMut<HandsInput>,
) {
    let (camera, eye) = camera.into_inner();
    let panel = wants.wants_any_pointer_input();
    let typing = wants.wants_any_keyboard_input();
    let alt = keys.any_pressed([KeyCode::AltLeft, KeyCode::AltRight]);
    let left = buttons.pressed(MouseButton::Left) && !alt;
    if keys.just_pressed(KeyCode::Tab) && !typing {
        let side = pointer.leading;
        // What is held while one swaps stays held.
        pointer.latched[side as usize] = left && pointer.depth.is_some();
        pointer.leading = side.other();
        pointer.depth = None;
    }
    let side = pointer.leading;
    let at = eye_ray(&windows, camera, eye);
    let mut down = ActionSet::NONE;
    let turning = keys.pressed(KeyCode::KeyR) && !typing;
    let started = buttons.just_pressed(MouseButton::Left) && !alt && !panel;
    if let Some(ray) = at.filter(|_| !panel || pointer.depth.is_some()) {
        let forward = eye.forward();
        let mut pose = pointer.poses[side as usize];
        if let (Some(depth), true) = (pointer.depth, left) {
            if turning {
                let turn = Quat::from_axis_angle(*eye.up(), motion.delta.x * 0.01)
                    * Quat::from_axis_angle(*eye.right(), motion.delta.y * 0.01);
                pointer.turn = (eye.rotation.inverse() * turn * eye.rotation) * pointer.turn;
            } else {
                let depth = (depth * 1.06_f32.powf(scroll.delta.y)).clamp(0.05, 40.0);
                pointer.depth = Some(depth);
                pose.position = ray.origin + *ray.direction * (depth / ray.direction.dot(*forward));
            }
        } else {
            let hit = context
                .single()
                .ok()
                .and_then(|c| pick::cast(&c, &proxies, ray.origin, ray.direction));
            pointer.over = hit.is_some();
            pointer.turn = Quat::IDENTITY;
            pose.position = hit.map_or_else(|| on_ground(&ray, eye), |h| h.point);
            pointer.depth = (started && hit.is_some())
                .then(|| (pose.position - eye.translation).dot(*forward));
        }
        pose.rotation = (eye.rotation * pointer.turn).normalize();
        pointer.poses[side as usize] = pose;
    }
    if left && (!panel || pointer.depth.is_some()) {
        down.set(Action::Act, true);
        down.set(Action::Grab, pointer.depth.is_some());
    } else {
        pointer.depth = None;
        pointer.latched[side as usize] = false;
    }
    if !typing {
        keyboard(&keys, &mut down);
    }
    for hand in Side::BOTH {
        let pose = Some(pointer.poses[hand as usize]);
        let mut held = ActionSet::NONE;
        held.set(Action::Grab, pointer.latched[hand as usize]);
        *input.side(hand) = HandFrame {
            pose,
            down: if hand == side { down | held } else { held },
            swipe: None,
        };
    }
    // *Save* is the left hand's and *library* the right's: a key lends them the pointer's place.
    if !typing && keys.pressed(KeyCode::KeyE) {
        let pose = Some(pointer.poses[side as usize]);
        let frame = input.side(Side::Left);
        frame.pose = pose;
        frame.down.set(Action::Save, true);
    }
    if !typing && keys.pressed(KeyCode::KeyL) {
        input.side(Side::Right).down.set(Action::Library, true);
    }
    if keys.just_pressed(KeyCode::Escape) {
        for hand in Side::BOTH {
            input.side(hand).down.set(Action::Cancel, true);
        }
        pointer.release_all();
    }
    input.head = Some(Pose {
        position: eye.translation,
        rotation: eye.rotation,
    });
}

fn keyboard(keys: &ButtonInput<KeyCode>, down: &mut ActionSet) {
    for (key, action) in [
        (KeyCode::Enter, Action::Finish),
        (KeyCode::NumpadEnter, Action::Finish),
        (KeyCode::Delete, Action::Delete),
        (KeyCode::ArrowUp, Action::Up),
        (KeyCode::ArrowRight, Action::Right),
        (KeyCode::ArrowDown, Action::Down),
        (KeyCode::ArrowLeft, Action::Left),
    ] {
        if keys.pressed(key) {
            down.set(action, true);
        }
    }
}

fn eye_ray(windows: &Query<&Window>, camera: &Camera, eye: &Transform) -> Option<Ray3d> {
    let cursor = windows.iter().find_map(Window::cursor_position)?;
    camera
        .viewport_to_world(&GlobalTransform::from(*eye), cursor)
        .ok()
}

/// Where nothing is hit: on the ground if that is near, else in the plane through the point that the
/// camera turns about.
fn on_ground(ray: &Ray3d, eye: &Transform) -> Vec3 {
    let ground = InfinitePlane3d::new(Vec3::Y);
    let reach = ray
        .intersect_plane(Vec3::ZERO, ground)
        .filter(|&d| d > 0.0 && d < 6.0)
        .unwrap_or(eye.translation.length().clamp(0.5, 3.0));
    ray.get_point(reach)
}
