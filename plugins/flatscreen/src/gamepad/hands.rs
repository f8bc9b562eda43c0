//! The buttons and sticks as hands.

use bevy::prelude::*;
use bevy_rapier3d::prelude::ReadRapierContext;
use midair_studio::{
    command::Command,
    hands::{Action, ActionSet, HandFrame, HandsInput, Pose, Side},
    pick::{self, Proxy},
    plane::WorkPlane,
    project::{Project, Shelf},
    settings::Settings,
    tools::Aim,
};

use super::camera::{rest, sticks, swift};
use super::{Pad, Pressed};
use crate::bindings::{Control, Controls, Device};
use crate::focus::Focus;
use crate::orbit::{FIELD_OF_VIEW, Orbit, pixel};
use crate::panels::Screen;
use crate::place;
use crate::ring::Ring;

/// Radians a second at full deflection.
const TURNS: f32 = 1.8;
/// Metres from the camera: a hand is never nearer or farther.
const REACH: std::ops::RangeInclusive<f32> = 0.05..=40.0;
/// An empty hand stays this far within the edges of the view, as a part of its half.
const EDGE: f32 = 0.95;

/// What of the scene a hand meets.
type Scene<'w, 's> = (
    ReadRapierContext<'w, 's>,
    Query<'w, 's, &'static Proxy>,
    Res<'w, Project>,
    Res<'w, Shelf>,
    Res<'w, WorkPlane>,
    Res<'w, Aim>,
);

/// What is asked for, and where it goes.
type Says<'w> = (
    Res<'w, Controls>,
    Res<'w, Settings>,
    Res<'w, Focus>,
    Res<'w, Ring>,
    Res<'w, Time>,
);

pub(crate) fn hands(
    (controls, settings, focus, ring, time): Says,
    screen: Res<Screen>,
    camera: Single<(&Camera, &Transform, &Orbit)>,
    (context, proxies, project, shelf, plane, aim): Scene,
    mut pad: ResMut<Pad>,
    mut input: ResMut<HandsInput>,
    mut commands: MessageWriter<Command>,
) {
    let (camera, eye, orbit) = camera.into_inner();
    let dt = time.delta_secs();
    let pad = &mut *pad;
    let down = pad.leads && controls.pressed_on(Control::SwapHands, Device::Pad);
    let pressed = pad.swap.advance(down, dt);
    if !pad.leads {
        return;
    }
    match pressed {
        Pressed::Tapped => pad.swap(&controls, eye),
        Pressed::Held => pad.frame = true,
        Pressed::Nothing => {}
    }
    let side = pad.leading;
    pad.grips = controls.pressed_on(Control::Grab, Device::Pad)
        && (pad.grips || controls.just_pressed(Control::Grab));
    if controls.pressed(Control::Cancel) {
        pad.grips = false;
        pad.latched = [false; 2];
    }
    let (mut hand, mut view) = sticks(&controls, &settings);
    if focus.is_inside() {
        view = Vec2::ZERO;
    }
    if controls.pressed(Control::Roam) || ring.is_open() {
        hand = Vec2::ZERO;
    }
    // In the frame of the release too it is where it was moved to.
    let gripped = pad.held[side as usize];
    if pad.grips || gripped {
        pad.carry(&controls, eye, hand, view, dt);
    } else {
        let surface = |ray: Ray3d| {
            let context = context.single().ok().filter(|_| aim.surfaces)?;
            pick::cast(&context, &proxies, ray.origin, ray.direction).map(|h| h.point)
        };
        pad.roam(
            (&controls, &aim),
            (camera, eye, orbit),
            (hand, view),
            dt,
            surface,
        );
    }
    pad.second(&controls, &aim, eye, view, dt);
    for other in Side::BOTH {
        let holds = pad.latched[other as usize] || pad.held[other as usize];
        if other != side && !holds && !pad.out {
            pad.poses[other as usize] = Pose {
                position: rest(eye, other),
                rotation: eye.rotation,
            };
        }
    }
    // Where it was picked is a panel: it goes where one looks, and the hand with it.
    if !pad.grips && !gripped && !pad.picked.is_empty() {
        let component = pad.picked.remove(0);
        if let Some(found) = shelf.library.get(&component) {
            let bounds = found.recipe.bounds();
            let middle = screen.centre();
            let towards = middle
                .and_then(|at| {
                    camera
                        .viewport_to_world(&GlobalTransform::from(*eye), at)
                        .ok()
                })
                .unwrap_or(Ray3d {
                    origin: eye.translation,
                    direction: eye.forward(),
                });
            if !bounds.is_empty() {
                let corners = (bounds.min, bounds.max);
                pad.poses[side as usize] =
                    Pose::at(place::free_spot(&project, &plane, corners, eye, towards));
            }
        }
        commands.write(Command::Place { component, side });
    }
    pad.write(&controls, &settings, &aim, &mut input);
    pad.held = pad.latched;
    pad.held[side as usize] = pad.grips;
    input.head = Some(Pose {
        position: eye.translation,
        rotation: eye.rotation,
    });
    input.pixel = pixel(camera);
}

impl Pad {
    /// The other hand leads; what this one holds it goes on holding.
    fn swap(&mut self, controls: &Controls, eye: &Transform) {
        let other = self.leading.other();
        self.latched[self.leading as usize] = self.grips;
        self.leading = other;
        // Taken back with the button down it is held as before, otherwise let go where it is.
        let held = std::mem::take(&mut self.latched[other as usize]);
        let taken = held && controls.pressed_on(Control::Grab, Device::Pad);
        if !held && !self.out {
            // An empty hand begins where the other one is.
            self.poses[other as usize] = self.poses[other.other() as usize];
        }
        if held && self.latched[other.other() as usize] {
            // Both hold: the button keeps the one that leads now.
            self.grips = true;
        } else {
            self.grips = taken;
        }
        self.turn = if self.out {
            // It is turned as it was left.
            (eye.rotation.inverse() * self.poses[other as usize].rotation).normalize()
        } else {
            Quat::IDENTITY
        };
    }

    /// Where both hands are led at once, the other stick moves the one that does not lead.
    fn second(&mut self, controls: &Controls, aim: &Aim, eye: &Transform, view: Vec2, dt: f32) {
        let side = self.leading;
        let other = side.other();
        let holds = self.latched[other as usize] || self.held[other as usize];
        if !aim.both || holds {
            self.out = false;
            return;
        }
        let bare = !controls.pressed(Control::Deep) && !controls.pressed(Control::Roam);
        if !bare || view == Vec2::ZERO {
            return;
        }
        let lead = self.poses[side as usize];
        let pose = &mut self.poses[other as usize];
        if !std::mem::replace(&mut self.out, true) {
            // It comes out beside the leading one, an eighth of the view away.
            let aside = depth(eye, lead.position).max(*REACH.start()) * 0.25;
            let aside = match other {
                Side::Left => -aside,
                Side::Right => aside,
            };
            *pose = Pose {
                position: lead.position + eye.right() * aside,
                rotation: eye.rotation,
            };
        }
        let away = depth(eye, pose.position).clamp(*REACH.start(), *REACH.end());
        let speed = away * (0.5 * FIELD_OF_VIEW).tan() * swift(view) * dt;
        pose.position += (eye.right() * view.x + eye.up() * view.y) * speed;
    }

    /// A hand that holds something moves in the plane of the view, or with LT in depth.
    fn carry(&mut self, controls: &Controls, eye: &Transform, hand: Vec2, view: Vec2, dt: f32) {
        let pose = &mut self.poses[self.leading as usize];
        let depth = depth(eye, pose.position).clamp(*REACH.start(), *REACH.end());
        let speed = depth * (0.5 * FIELD_OF_VIEW).tan() * swift(hand) * dt;
        if controls.pressed(Control::Deep) {
            let away = depth + hand.y * speed;
            let ahead = away.clamp(*REACH.start(), *REACH.end()) - depth;
            pose.position += *eye.forward() * ahead;
            let turn = turned(eye, hand.x, view, dt);
            pose.rotation = (turn * pose.rotation).normalize();
        } else {
            pose.position += (eye.right() * hand.x + eye.up() * hand.y) * speed;
        }
    }

    /// An empty hand moves over what it meets; where there is nothing it keeps its depth.
    fn roam(
        &mut self,
        (controls, aim): (&Controls, &Aim),
        (camera, eye, orbit): (&Camera, &Transform, &Orbit),
        (hand, view): (Vec2, Vec2),
        dt: f32,
        surface: impl Fn(Ray3d) -> Option<Vec3>,
    ) {
        let pose = &mut self.poses[self.leading as usize];
        let mut at = pose.position;
        let mut away = depth(eye, at);
        if !REACH.contains(&away) || !at.is_finite() {
            at = orbit.focus;
            away = depth(eye, at).max(*REACH.start());
        }
        let speed = away * (0.5 * FIELD_OF_VIEW).tan() * swift(hand) * dt;
        if controls.pressed(Control::Deep) {
            let ahead = (away + hand.y * speed).clamp(*REACH.start(), *REACH.end()) - away;
            at += *eye.forward() * ahead;
            let turn = turned(eye, hand.x, view, dt);
            self.turn = (eye.rotation.inverse() * turn * eye.rotation * self.turn).normalize();
        } else {
            at += (eye.right() * hand.x + eye.up() * hand.y) * speed;
            at = within(camera, eye, at);
            // The surface gives the depth, but only to a hand that moves: what appears in front of one
            // that rests does not pull it.
            if hand != Vec2::ZERO
                && let Ok(direction) = Dir3::new(at - eye.translation)
            {
                let ray = Ray3d {
                    origin: eye.translation,
                    direction,
                };
                at = surface(ray).unwrap_or(at);
            }
        }
        *pose = Pose {
            position: at,
            rotation: aim.turned(eye.rotation, Vec3::Y, self.turn),
        };
    }

    /// What both hands do in this frame.
    fn write(&self, controls: &Controls, settings: &Settings, aim: &Aim, input: &mut HandsInput) {
        let side = self.leading;
        let mut actions: ActionSet = [
            (Control::Finish, Action::Finish),
            (Control::Delete, Action::Delete),
            (Control::Centre, Action::Centre),
            (Control::CrossUp, Action::Up),
            (Control::CrossRight, Action::Right),
            (Control::CrossDown, Action::Down),
            (Control::CrossLeft, Action::Left),
        ]
        .into_iter()
        .filter(|&(control, _)| controls.pressed(control))
        .map(|(_, action)| action)
        .collect();
        let alt = controls.pressed(Control::Alt);
        let acts = controls.pressed_on(Control::Act, Device::Pad) || alt && aim.alt_acts;
        actions.set(Action::Act, acts);
        actions.set(Action::Grab, self.grips);
        for hand in Side::BOTH {
            let mut held = ActionSet::NONE;
            held.set(Action::Grab, self.latched[hand as usize]);
            *input.side(hand) = HandFrame {
                pose: Some(self.poses[hand as usize]),
                down: if hand == side { actions } else { held },
                swipe: None,
            };
        }
        let other = side.other();
        input.side(other).down.set(Action::Act, alt);
        let main = settings.hands.main();
        for (control, action) in [
            (Control::Menu, Action::Menu),
            (Control::Library, Action::Library),
            (Control::Modes, Action::Modes),
        ] {
            let down = controls.pressed(control);
            let frame = input.side(main);
            frame.down.set(action, down);
        }
        if controls.pressed(Control::SaveObject) {
            let off = settings.hands.off();
            // Save is the other hand's: the button lends it the leading one's place, unless it holds
            // something.
            let lent = (!self.latched[off as usize]).then_some(self.poses[side as usize]);
            let frame = input.side(off);
            frame.pose = lent.or(frame.pose);
            frame.down.set(Action::Save, true);
        }
        if controls.pressed(Control::Cancel) {
            for hand in Side::BOTH {
                input.side(hand).down.set(Action::Cancel, true);
            }
        }
    }
}

/// Metres in front of the camera.
fn depth(eye: &Transform, at: Vec3) -> f32 {
    (at - eye.translation).dot(*eye.forward())
}

/// The turn that roll, yaw and pitch ask for in this frame.
fn turned(eye: &Transform, roll: f32, view: Vec2, dt: f32) -> Quat {
    let by = TURNS * dt;
    Quat::from_axis_angle(*eye.up(), view.x * by)
        * Quat::from_axis_angle(*eye.right(), -view.y * by)
        * Quat::from_axis_angle(*eye.forward(), roll * by)
}

/// The point of the view nearest to a point, as far away.
fn within(camera: &Camera, eye: &Transform, at: Vec3) -> Vec3 {
    let aspect = camera
        .logical_viewport_size()
        .map_or(16.0 / 9.0, |s| s.x / s.y.max(1.0));
    let away = depth(eye, at);
    let half = EDGE * away * (0.5 * FIELD_OF_VIEW).tan();
    let from = at - eye.translation;
    let (x, y) = (from.dot(*eye.right()), from.dot(*eye.up()));
    let (kept_x, kept_y) = (x.clamp(-half * aspect, half * aspect), y.clamp(-half, half));
    at + eye.right() * (kept_x - x) + eye.up() * (kept_y - y)
}
