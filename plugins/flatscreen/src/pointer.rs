//! The pointer as a hand.

use bevy::input::mouse::AccumulatedMouseScroll;
use bevy::prelude::*;
use bevy_rapier3d::prelude::ReadRapierContext;
use midair_studio::{
    command::Command,
    document::ObjectId,
    drawing::Drawing,
    hands::{Action, ActionSet, HandFrame, HandsInput, Pose, Side},
    objects::How,
    pick::{self, PICK_RADIUS, Proxy, Touch},
    plane::WorkPlane,
    project::{Project, Shelf},
    ruler::{MeasureAsk, Ruler},
    settings::Settings,
    tools::Aim,
    world::Similarity,
};

use crate::band::{self, Band};
use crate::bindings::{Control, Controls, Cursor, Device};
use crate::gizmo::Gizmo;
use crate::grip::Grip;
use crate::orbit::{Orbit, lines, pixel};
use crate::panels::Screen;
use crate::place;
use crate::reach::{self, at_depth, on_plane, plane_up, rest};

/// A click may tremble this many pixels before it is a drag.
pub(crate) const TREMBLE: f32 = 3.0;
/// A line is pointed at from so many pixels beside it.
const BESIDE: f32 = 6.0;
/// A line may lie so much deeper than a surface and is seen on it, in metres.
const BEHIND: f64 = 0.01;

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
    /// What is under the pointer.
    under: Option<ObjectId>,
    /// The point and the outward normal of the face under the pointer.
    pub(crate) face: Option<(Vec3, Vec3)>,
    /// A box that is drawn to select what lies in it.
    pub(crate) band: Option<Band>,
    /// Both hands pull at one thing.
    pub(crate) stretching: bool,
    /// Enter ended something and is not to finish as well until it is up again.
    pub(crate) enter_spent: bool,
    /// How deep in the view what is being drawn was last, in metres.
    drawn: Option<f32>,
    /// Lines of the wheel that are to be clicks of the cross, and whether one is down.
    wheel: f32,
    clicked: bool,
    /// Components that were picked and not placed yet, and where in the window they were let go.
    picked: Vec<(String, Option<Vec2>)>,
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
            under: None,
            face: None,
            band: None,
            stretching: false,
            enter_spent: false,
            drawn: None,
            wheel: 0.0,
            clicked: false,
            picked: Vec::new(),
        }
    }
}

impl Pointer {
    /// Whether a hand holds something.
    pub fn holds(&self) -> bool {
        self.grip.is_some() || self.stretching
    }

    /// Whether the wheel is the hand's and not the camera's.
    pub(crate) fn has_wheel(&self) -> bool {
        self.holds() || self.drawn.is_some()
    }

    /// Whether the pointer is over a thing and not over a panel.
    pub fn is_over(&self) -> bool {
        self.under.is_some()
    }

    /// The thing under the pointer in this frame.
    pub(crate) fn under(&self) -> Option<ObjectId> {
        self.under
    }

    /// A component was picked from the library: it goes where one looks.
    pub fn pick(&mut self, component: String) {
        self.picked.push((component, None));
    }

    /// A component was dragged from the library to a place in the window.
    pub(crate) fn put(&mut self, component: String, at: Vec2) {
        self.picked.push((component, Some(at)));
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
        self.band = None;
    }

    /// The world was moved: the hands stay where they are in the room.
    pub(crate) fn carry(&mut self, by: &Similarity) {
        self.poses = self.poses.map(|pose| by.pose(&pose));
    }
}

/// What the devices say, and what is under the pointer for others.
type Devices<'w> = (
    Res<'w, Controls>,
    Res<'w, AccumulatedMouseScroll>,
    Res<'w, Cursor>,
);

/// What of the scene the pointer meets.
type Scene<'w, 's> = (
    ReadRapierContext<'w, 's>,
    Query<'w, 's, &'static Proxy>,
    Res<'w, Touch>,
    Res<'w, Project>,
    Res<'w, Shelf>,
    Res<'w, WorkPlane>,
    Res<'w, Aim>,
    Res<'w, Drawing>,
);

pub(crate) fn point(
    (controls, scroll, cursor): Devices,
    (screen, gizmo, settings): (Res<Screen>, Res<Gizmo>, Res<Settings>),
    camera: Single<(&Camera, &Transform), With<Orbit>>,
    (context, proxies, touch, project, shelf, plane, aim, drawn): Scene,
    mut pointer: ResMut<Pointer>,
    mut ruler: ResMut<Ruler>,
    mut input: ResMut<HandsInput>,
    mut commands: MessageWriter<Command>,
) {
    let (camera, eye) = camera.into_inner();
    let pressed = |control| controls.pressed_on(control, Device::Keys);
    let travelled = cursor.travelled();
    let cursor = cursor.at();
    let panel = screen.covers(cursor);
    let offered = pointer.grip.is_some_and(|grip| grip.offered);
    let free = !panel && !pointer.stretching && !gizmo.has_pointer() && !offered;
    let began = |control| controls.just_pressed(control) && pressed(control) && free;
    let clicked = began(Control::Act);
    if controls.just_pressed(Control::SwapHands) && !pointer.stretching {
        let side = pointer.leading;
        // What is held while one swaps stays held.
        pointer.latched[side as usize] = pointer.grip.take().is_some();
        pointer.acting = false;
        pointer.leading = side.other();
    }
    let side = pointer.leading;
    // The ruler and what joins the selection take the click for themselves.
    let taken = ruler.on || pressed(Control::SelectMore);
    let started = clicked && !taken;
    // What acts draws: it takes nothing in hand.
    let grabs = began(Control::Grab) && !taken && !aim.draws;
    pointer.acting |= started;
    // A latched hand that leads again lets go where it is.
    let unlatched = std::mem::take(&mut pointer.latched[side as usize]);
    let ray = cursor.and_then(|c| reach::ray(camera, eye, c));
    let mut pointed = None;
    if let Some(mut grip) = pointer.grip.filter(|_| !offered) {
        // In the frame of the release too: it comes to rest where it was dragged to.
        if controls.was_pressed(Control::Turn) {
            let turn = turn_by(eye, travelled);
            pointer.turn =
                (eye.rotation.inverse() * turn * eye.rotation * pointer.turn).normalize();
            grip.spent += travelled;
            grip.moved |= travelled != Vec2::ZERO;
        } else if scroll.delta.y != 0.0 {
            grip.nearer(lines(&scroll), eye);
        }
        if let Some(at) = cursor.map(|c| c - grip.spent) {
            grip.moved |= at.distance(grip.from) > TREMBLE;
            if grip.moved
                && let Some(ray) = reach::ray(camera, eye, at)
            {
                let rotation = (eye.rotation * pointer.turn).normalize();
                let pose = &mut pointer.poses[side as usize];
                let position = grip.at(&ray, eye).unwrap_or(pose.position);
                *pose = Pose { position, rotation };
            }
        }
        pointer.grip = Some(grip);
    } else if !unlatched && !offered {
        pointer.under = None;
        let turning = aim.draws && controls.was_pressed(Control::Turn);
        if turning {
            let turn = turn_by(eye, travelled);
            pointer.turn =
                (eye.rotation.inverse() * turn * eye.rotation * pointer.turn).normalize();
        } else if !aim.draws {
            pointer.turn = Quat::IDENTITY;
        }
        let sizing = aim.draws && controls.pressed(Control::SnapOff);
        let drawing = aim.draws && pointer.acting;
        // A line that is being drawn goes on under a panel.
        pointer.poses[side as usize] = match ray.filter(|_| drawing || !panel) {
            Some(ray) => {
                let hit = context
                    .single()
                    .ok()
                    .filter(|_| aim.surfaces)
                    .and_then(|c| pick::cast(&c, &proxies, ray.origin, ray.direction));
                let caught = cursor.filter(|_| aim.draws).and_then(|at| {
                    let eye = GlobalTransform::from(*eye);
                    aim.caught(at, |p| camera.world_to_viewport(&eye, p).ok())
                });
                // A line in the air is seen and not met: it is pointed at from beside it, where no surface hides it.
                let on =
                    Some(&ray).filter(|_| aim.drawn && (!drawing || started) && caught.is_none());
                let on = on.and_then(|ray| {
                    let ray = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
                    let near = f64::from(BESIDE * pixel(camera));
                    drawn.met(ray, eye.translation.as_dvec3(), near)
                });
                let hidden = |far: f64| hit.is_some_and(|h| far > f64::from(h.distance) + BEHIND);
                let on = on.filter(|on| !hidden(on.distance));
                let hit = hit.filter(|_| on.is_none());
                let caught = caught.or(on.map(|on| on.point.as_vec3()));
                let position = caught.or(hit.map(|h| h.point)).unwrap_or_else(|| {
                    let last = pointer.drawn.filter(|_| drawing && !plane.shown);
                    last.and_then(|far| at_depth(&ray, eye, far))
                        .unwrap_or_else(|| on_plane(&ray, eye, &plane))
                });
                let mut far = (position - eye.translation).dot(*eye.forward());
                let position = if turning {
                    // It stays where it is while it turns.
                    pointer.poses[side as usize].position
                } else if drawing && caught.is_none() && scroll.delta.y != 0.0 && !sizing {
                    far = (far * 1.05_f32.powf(lines(&scroll))).clamp(0.05, 40.0);
                    at_depth(&ray, eye, far).unwrap_or(position)
                } else {
                    position
                };
                pointer.drawn = drawing.then_some(far);
                // A small thing is touched from a fingertip's breadth away as well, if the pointer is there still.
                let breadth = PICK_RADIUS / input.metres_per_world;
                let touched = touch
                    .get(side)
                    .filter(|t| t.point.distance(position) <= breadth)
                    .map(|t| t.object);
                let object = on.map(|on| on.id).or(hit.map(|h| h.object)).or(touched);
                pointer.under = object;
                pointer.face = hit.map(|h| (h.point, h.normal));
                pointed = Some(position);
                if clicked && ruler.on {
                    commands.write(Command::Measure(MeasureAsk::Point(position)));
                } else if clicked && !started {
                    let ids: Vec<_> = object.into_iter().collect();
                    if !ids.is_empty() {
                        commands.write(band::select(ids, How::Toggle));
                    }
                }
                if grabs && object.is_some() {
                    pointer.grip = cursor.map(|from| Grip {
                        depth: (position - eye.translation).dot(*eye.forward()),
                        plane: plane.shown.then(|| (position, plane.normal())),
                        from,
                        moved: false,
                        spent: Vec2::ZERO,
                        offered: false,
                    });
                }
                let draws = aim.draws && started;
                if clicked && object.is_none() && !ruler.on && !draws {
                    pointer.band = cursor.map(|from| Band::new(from, !started));
                }
                let up = hit.map_or(Vec3::Y, |h| h.normal);
                Pose {
                    position,
                    rotation: aim.turned(eye.rotation, up, pointer.turn),
                }
            }
            None => {
                pointer.face = None;
                pointer.drawn = None;
                rest(eye, side)
            }
        };
    }
    let pointed = pointed.filter(|_| ruler.on);
    if ruler.pointed != pointed {
        ruler.pointed = pointed;
    }
    let other = side.other();
    if !pointer.latched[other as usize] {
        pointer.poses[other as usize] = rest(eye, other);
    }
    pointer.acting &= pressed(Control::Act);
    if offered {
        pointer.grip = None;
    } else if !pressed(Control::Grab) {
        // A mode's button takes what is in the hand: it stays there until the panels were shown once more.
        let over = pointer.grip.filter(|_| panel && cursor.is_some());
        pointer.grip = over.map(|grip| Grip {
            offered: true,
            ..grip
        });
    }
    // Where it was picked there is no room: it goes where one looks.
    if pointer.grip.is_none() && !pointer.picked.is_empty() {
        let (component, at) = pointer.picked.remove(0);
        if let Some(found) = shelf.library.get(&component) {
            let towards = reach::ray_through(camera, eye, at.or(screen.centre()));
            let bounds = found.recipe.bounds();
            let corners = (bounds.min, bounds.max);
            if !bounds.is_empty() {
                let spot = if at.is_some() {
                    let hit = context
                        .single()
                        .ok()
                        .and_then(|c| pick::cast(&c, &proxies, towards.origin, towards.direction));
                    let face = hit.map(|h| (h.point, h.normal));
                    let (point, normal) =
                        face.unwrap_or_else(|| (on_plane(&towards, eye, &plane), plane_up(&plane)));
                    place::against(corners, point, normal)
                } else {
                    place::free_spot(&project, &plane, corners, eye, towards)
                };
                pointer.poses[side as usize] = Pose::at(spot);
            }
        }
        commands.write(Command::Place { component, side });
    }
    let mut actions: ActionSet = [
        (Control::Finish, Action::Finish),
        (Control::Delete, Action::Delete),
        (Control::CrossUp, Action::Up),
        (Control::CrossRight, Action::Right),
        (Control::CrossDown, Action::Down),
        (Control::CrossLeft, Action::Left),
    ]
    .into_iter()
    .filter(|&(control, _)| pressed(control))
    .map(|(_, action)| action)
    .collect();
    actions.set(Action::Act, pointer.acting);
    // With Ctrl the wheel is the cross: a click of it for each line.
    if aim.draws && controls.pressed(Control::SnapOff) && !panel {
        pointer.wheel = (pointer.wheel + lines(&scroll)).clamp(-20.0, 20.0);
    } else {
        pointer.wheel = 0.0;
    }
    let arm = if pointer.wheel > 0.0 {
        Action::Up
    } else {
        Action::Down
    };
    pointer.clicked = pointer.wheel.abs() >= 1.0 && !pointer.clicked;
    if pointer.clicked {
        pointer.wheel -= pointer.wheel.signum();
        actions.set(arm, true);
    }
    actions.set(Action::Grab, pointer.grip.is_some());
    actions.set(Action::Free, controls.pressed(Control::SnapOff));
    pointer.enter_spent &= pressed(Control::Finish);
    if pointer.enter_spent {
        actions.set(Action::Finish, false);
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
    // *Save* is the other hand's and *library* the leading one's: a key lends them the pointer's place.
    if pressed(Control::SaveObject) && !pointer.stretching {
        let frame = input.side(settings.hands.off());
        frame.pose = Some(pointer.poses[side as usize]);
        frame.down.set(Action::Save, true);
    }
    let main = input.side(settings.hands.main());
    main.down.set(Action::Library, pressed(Control::Library));
    main.down.set(Action::Modes, pressed(Control::Modes));
    if pressed(Control::Cancel) {
        for hand in Side::BOTH {
            input.side(hand).down.set(Action::Cancel, true);
        }
        pointer.let_go();
    }
    input.head = Some(Pose {
        position: eye.translation,
        rotation: eye.rotation,
    });
    input.pixel = pixel(camera);
}

/// How the wand turns while the pointer travels.
fn turn_by(eye: &Transform, travelled: Vec2) -> Quat {
    Quat::from_axis_angle(*eye.up(), travelled.x * 0.01)
        * Quat::from_axis_angle(*eye.right(), travelled.y * 0.01)
}
