//! S: both hands grip what the pointer touches, and moving the pointer moves them apart. Over nothing they
//! grip the world.

use bevy::prelude::*;
use midair_studio::{
    hands::{Action, HandsInput, Pose, Side},
    world::{Similarity, WorldView},
};

use crate::bindings::{Control, Controls, Cursor};
use crate::orbit::Orbit;
use crate::pointer::Pointer;

/// Metres between the hands when they take hold: both within reach of the same spot.
const APART: f32 = 0.01;
/// Pixels of movement that double the distance.
const DOUBLE: f32 = 180.0;

/// A stretch in progress.
pub(crate) struct Stretching {
    middle: Pose,
    along: Vec3,
    /// Metres of world to a metre in the hands.
    unit: f32,
    /// Pixels moved since it began.
    moved: f32,
    swipe: Option<Vec2>,
}

pub(crate) fn stretch(
    mut stretching: Local<Option<Stretching>>,
    controls: Res<Controls>,
    world: Res<WorldView>,
    cursor: Res<Cursor>,
    mut pointer: ResMut<Pointer>,
    eye: Single<&Transform, With<Orbit>>,
    mut input: ResMut<HandsInput>,
) {
    let travelled = cursor.travelled();
    let Some(now) = stretching.as_mut() else {
        if controls.just_pressed(Control::Stretch) && !pointer.holds() {
            let begun = Stretching {
                middle: pointer.pose(pointer.leading),
                along: *eye.right(),
                unit: 1.0,
                moved: 0.0,
                swipe: None,
            };
            begun.write(&mut input, true);
            *stretching = Some(begun);
            pointer.stretching = true;
        }
        return;
    };
    if let Some(by) = &world.carry {
        now.go_along(by);
    }
    let cancelled = controls.just_pressed(Control::Cancel);
    let entered = controls.just_pressed(Control::Finish);
    let done = cancelled
        || entered
        || controls.just_pressed(Control::Stretch)
        || controls.just_pressed(Control::Act)
        // Undo takes the thing out of the hands.
        || controls.just_pressed(Control::Undo)
        || controls.just_pressed(Control::Redo);
    now.moved += travelled.x - travelled.y;
    for (control, swipe) in [
        (Control::AxisX, Vec2::Y),
        (Control::AxisY, Vec2::X),
        (Control::AxisZ, Vec2::NEG_Y),
        (Control::AxisAll, Vec2::NEG_X),
    ] {
        if controls.just_pressed(control) {
            now.swipe = Some(swipe);
        }
    }
    // In the last frame too the hands are where they were pulled to. The frame without a grip ends the
    // gesture; with Escape it is in the frame as cancel.
    now.write(&mut input, !done || cancelled);
    if done {
        *stretching = None;
        pointer.stretching = false;
        pointer.enter_spent = entered;
    }
}

impl Stretching {
    /// The world was moved: the hands stay where they are in the room.
    fn go_along(&mut self, by: &Similarity) {
        self.middle = by.pose(&self.middle);
        self.along = by.rotation * self.along;
        self.unit *= by.scale;
    }

    /// Puts both hands where they pull. Everything but the grip and *cancel* is taken out of them.
    fn write(&self, input: &mut HandsInput, grip: bool) {
        let apart = self.unit * APART * (self.moved / DOUBLE).exp2();
        for (side, sign) in [(Side::Left, -0.5), (Side::Right, 0.5)] {
            let frame = input.side(side);
            frame.pose = Some(Pose {
                position: self.middle.position + self.along * (sign * apart),
                ..self.middle
            });
            let cancel = frame.down.has(Action::Cancel);
            frame.down = [Action::Grab].into_iter().filter(|_| grip).collect();
            frame.down.set(Action::Cancel, cancel);
            frame.swipe = self.swipe.filter(|_| side == Side::Right);
        }
    }
}
