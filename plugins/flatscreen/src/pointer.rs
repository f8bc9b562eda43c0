//! The pointer as a hand.

use bevy::input::mouse::AccumulatedMouseScroll;
use bevy::prelude::*;
use bevy_rapier3d::prelude::ReadRapierContext;
use midair_studio::{
    command::Command,
    hands::{Action, ActionSet, HandFrame, HandsInput, Pose, Side},
    pick::{self, Proxy, Touch},
    project::{Project, Shelf},
    settings::Settings,
};

use crate::bindings::{Control, Controls, Device};
use crate::orbit::{Orbit, lines};
use crate::panels::Screen;
use crate::place;

/// A click may tremble this many pixels before it is a drag.
const TREMBLE: f32 = 3.0;

/// The leading hand, and the one that stays where it is.
#[derive(Resource, Clone, Debug)]
pub struct Pointer {
    /// Which hand follows the pointer.
    pub leading: Side,
    poses: [Pose; 2],
    /// Which hands hold on although no button is down.
    latched: [bool; 2],
    grip: Option<Grip>,
    /// Whether the button went down in the view and is still down.
    acting: bool,
    /// How the wand is turned against the camera.
    turn: Quat,
    over: bool,
    /// Both hands pull at one thing.
    pub(crate) stretching: bool,
    /// Enter ended something and is not to finish as well until it is up again.
    pub(crate) enter_spent: bool,
    /// Components that were picked and not placed yet.
    pub(crate) picked: Vec<String>,
}

/// What the leading hand drags.
#[derive(Clone, Copy, Debug)]
struct Grip {
    /// Metres from the camera, along its view.
    depth: f32,
    /// Where the button went down, in pixels.
    from: Vec2,
    /// Whether it was dragged yet; a click that trembles moves nothing.
    moved: bool,
    /// Pixels that went into turning: the thing stays where it is meanwhile.
    spent: Vec2,
}

impl Default for Pointer {
    fn default() -> Self {
        Self {
            leading: Side::Right,
            poses: [Pose::default(); 2],
            latched: [false; 2],
            grip: None,
            acting: false,
            turn: Quat::IDENTITY,
            over: false,
            stretching: false,
            enter_spent: false,
            picked: Vec::new(),
        }
    }
}

impl Pointer {
    /// Whether a hand holds something, so that the wheel is not the camera's.
    pub fn holds(&self) -> bool {
        self.grip.is_some() || self.stretching
    }

    /// Whether the pointer is over a thing and not over a panel.
    pub fn is_over(&self) -> bool {
        self.over
    }

    /// Where a hand is.
    pub fn pose(&self, side: Side) -> Pose {
        self.poses[side as usize]
    }

    /// Whether a hand goes on holding what it held when the pointer left it.
    pub fn is_latched(&self, side: Side) -> bool {
        self.latched[side as usize]
    }

    pub(crate) fn let_go(&mut self) {
        self.latched = [false; 2];
        self.grip = None;
        self.acting = false;
    }
}

pub(crate) fn point(
    (controls, settings, scroll, mut moved): (
        Res<Controls>,
        Res<Settings>,
        Res<AccumulatedMouseScroll>,
        MessageReader<CursorMoved>,
    ),
    screen: Res<Screen>,
    windows: Query<&Window>,
    camera: Single<(&Camera, &Transform), With<Orbit>>,
    context: ReadRapierContext,
    proxies: Query<&Proxy>,
    touch: Res<Touch>,
    (project, shelf): (Res<Project>, Res<Shelf>),
    mut pointer: ResMut<Pointer>,
    mut input: ResMut<HandsInput>,
    mut commands: MessageWriter<Command>,
) {
    let (camera, eye) = camera.into_inner();
    let travelled: Vec2 = moved.read().filter_map(|m| m.delta).sum();
    let cursor = windows.iter().find_map(Window::cursor_position);
    let panel = screen.covers(cursor);
    let down = |control| controls.pressed_on(control, Device::Keys);
    let began = |control| controls.just_pressed(control) && down(control);
    let free = !panel && !pointer.stretching;
    let started = began(Control::Act) && free;
    let grabs = began(Control::Grab) && free;
    if controls.just_pressed(Control::SwapHands) && !pointer.stretching {
        let side = pointer.leading;
        // What is held while one swaps stays held.
        pointer.latched[side as usize] = pointer.grip.take().is_some();
        pointer.acting = false;
        pointer.leading = side.other();
    }
    let side = pointer.leading;
    pointer.acting |= started;
    // A latched hand that leads again lets go where it is.
    let unlatched = std::mem::take(&mut pointer.latched[side as usize]);
    let ray = cursor.and_then(|c| ray(camera, eye, c));
    if let Some(mut grip) = pointer.grip {
        // In the frame of the release too: it comes to rest where it was dragged to.
        if controls.pressed(Control::Turn) {
            let turn = Quat::from_axis_angle(*eye.up(), travelled.x * 0.01)
                * Quat::from_axis_angle(*eye.right(), travelled.y * 0.01);
            pointer.turn =
                (eye.rotation.inverse() * turn * eye.rotation * pointer.turn).normalize();
            grip.spent += travelled;
            grip.moved |= travelled != Vec2::ZERO;
        } else if scroll.delta.y != 0.0 {
            grip.depth = (grip.depth * 1.05_f32.powf(lines(&scroll))).clamp(0.05, 40.0);
            grip.moved = true;
        }
        if let Some(at) = cursor.map(|c| c - grip.spent) {
            grip.moved |= at.distance(grip.from) > TREMBLE;
            if grip.moved
                && let Some(ray) = self::ray(camera, eye, at)
            {
                let along = ray.direction.dot(*eye.forward()).max(0.1);
                pointer.poses[side as usize] = Pose {
                    position: ray.get_point(grip.depth / along),
                    rotation: (eye.rotation * pointer.turn).normalize(),
                };
            }
        }
        pointer.grip = Some(grip);
    } else if !unlatched {
        pointer.over = false;
        pointer.turn = Quat::IDENTITY;
        pointer.poses[side as usize] = match ray.filter(|_| !panel) {
            Some(ray) => {
                let hit = context
                    .single()
                    .ok()
                    .and_then(|c| pick::cast(&c, &proxies, ray.origin, ray.direction));
                let position = hit.map_or_else(|| on_ground(&ray, eye), |h| h.point);
                // A small thing is touched from a fingertip's breadth away as well.
                pointer.over = hit.is_some() || touch.get(side).is_some();
                if grabs && pointer.over {
                    pointer.grip = cursor.map(|from| Grip {
                        depth: (position - eye.translation).dot(*eye.forward()),
                        from,
                        moved: false,
                        spent: Vec2::ZERO,
                    });
                }
                Pose {
                    position,
                    rotation: eye.rotation,
                }
            }
            None => rest(eye, side),
        };
    }
    let other = side.other();
    if !pointer.latched[other as usize] {
        pointer.poses[other as usize] = rest(eye, other);
    }
    pointer.acting &= down(Control::Act);
    if !down(Control::Grab) {
        pointer.grip = None;
    }
    // Where it was picked there is no room: it goes where one looks.
    if pointer.grip.is_none() && !pointer.picked.is_empty() {
        let component = pointer.picked.remove(0);
        if let Some(found) = shelf.library.get(&component) {
            let towards = ray_through(camera, eye, screen.centre());
            let bounds = found.recipe.bounds();
            let corners = (bounds.min, bounds.max);
            if !bounds.is_empty() {
                pointer.poses[side as usize] =
                    Pose::at(place::free_spot(&project, corners, eye, towards));
            }
        }
        commands.write(Command::Place { component, side });
    }
    let mut actions = ActionSet::NONE;
    actions.set(Action::Act, pointer.acting);
    actions.set(Action::Grab, pointer.grip.is_some());
    pointer.enter_spent &= controls.pressed(Control::Finish);
    for (control, action) in [
        (Control::Finish, Action::Finish),
        (Control::Delete, Action::Delete),
        (Control::CrossUp, Action::Up),
        (Control::CrossRight, Action::Right),
        (Control::CrossDown, Action::Down),
        (Control::CrossLeft, Action::Left),
    ] {
        let spent = control == Control::Finish && pointer.enter_spent;
        actions.set(action, controls.pressed(control) && !spent);
    }
    for hand in Side::BOTH {
        let mut held = ActionSet::NONE;
        held.set(Action::Grab, pointer.latched[hand as usize]);
        *input.side(hand) = HandFrame {
            pose: Some(pointer.poses[hand as usize]),
            down: if hand == side { actions | held } else { held },
            swipe: None,
        };
    }
    // *Save* is one hand's and *library* the other's: a key lends them the pointer's place.
    if controls.pressed(Control::SaveObject) && !pointer.stretching {
        let frame = input.side(settings.hands.off());
        frame.pose = Some(pointer.poses[side as usize]);
        frame.down.set(Action::Save, true);
    }
    let main = input.side(settings.hands.main());
    main.down
        .set(Action::Library, controls.pressed(Control::Library));
    main.down
        .set(Action::Modes, controls.pressed(Control::Modes));
    if controls.pressed(Control::Cancel) {
        for hand in Side::BOTH {
            input.side(hand).down.set(Action::Cancel, true);
        }
        pointer.let_go();
    }
    input.head = Some(Pose {
        position: eye.translation,
        rotation: eye.rotation,
    });
}

/// An empty hand hangs behind the eyes, where it touches and hides nothing.
fn rest(eye: &Transform, side: Side) -> Pose {
    let right = match side {
        Side::Left => -0.2,
        Side::Right => 0.2,
    };
    Pose {
        position: eye.transform_point(Vec3::new(right, -0.25, 0.2)),
        rotation: eye.rotation,
    }
}

fn ray(camera: &Camera, eye: &Transform, cursor: Vec2) -> Option<Ray3d> {
    camera
        .viewport_to_world(&GlobalTransform::from(*eye), cursor)
        .ok()
}

/// The ray through a point of the window; straight ahead where there is none yet.
fn ray_through(camera: &Camera, eye: &Transform, at: Option<Vec2>) -> Ray3d {
    at.and_then(|at| ray(camera, eye, at)).unwrap_or(Ray3d {
        origin: eye.translation,
        direction: eye.forward(),
    })
}

/// Where nothing is hit: on the ground if that is near, else as far away as the origin.
fn on_ground(ray: &Ray3d, eye: &Transform) -> Vec3 {
    let ground = InfinitePlane3d::new(Vec3::Y);
    let reach = ray
        .intersect_plane(Vec3::ZERO, ground)
        .filter(|&d| d > 0.0 && d < 30.0)
        .unwrap_or(eye.translation.length().clamp(0.5, 10.0));
    ray.get_point(reach)
}
