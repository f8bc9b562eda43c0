//! S: both hands grip what the pointer touches, and moving the pointer moves them apart.

use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;
use midair_studio::hands::{Action, HandsInput, Pose, Side};

use crate::orbit::Orbit;
use crate::pointer::Pointer;

/// Metres between the hands when they take hold: both within reach of the same spot.
const APART: f32 = 0.02;
/// Pixels of movement that double the distance.
const DOUBLE: f32 = 180.0;

/// A stretch in progress.
pub(crate) struct Stretching {
    middle: Pose,
    along: Vec3,
    /// Pixels moved since it began.
    moved: f32,
    swipe: Option<Vec2>,
}

pub(crate) fn stretch(
    mut stretching: Local<Option<Stretching>>,
    keys: Res<ButtonInput<KeyCode>>,
    buttons: Res<ButtonInput<MouseButton>>,
    motion: Res<AccumulatedMouseMotion>,
    wants: Res<EguiWantsInput>,
    pointer: Res<Pointer>,
    eye: Single<&Transform, With<Orbit>>,
    mut input: ResMut<HandsInput>,
) {
    let ctrl = keys.any_pressed([KeyCode::ControlLeft, KeyCode::ControlRight]);
    if stretching.is_none() {
        let asked = keys.just_pressed(KeyCode::KeyS) && !ctrl && !wants.wants_any_keyboard_input();
        if asked && pointer.is_over() {
            *stretching = Some(Stretching {
                middle: pointer.pose(pointer.leading),
                along: *eye.right(),
                moved: 0.0,
                swipe: None,
            });
        }
    } else if keys.just_pressed(KeyCode::KeyS)
        || keys.just_pressed(KeyCode::Enter)
        || keys.just_pressed(KeyCode::Escape)
        || buttons.just_pressed(MouseButton::Left)
    {
        // The frame without a grip ends the gesture; Escape is in the frame as cancel.
        *stretching = None;
        for side in Side::BOTH {
            let down = &mut input.side(side).down;
            for action in [Action::Act, Action::Grab, Action::Finish] {
                down.set(action, false);
            }
            down.set(Action::Grab, keys.just_pressed(KeyCode::Escape));
        }
        return;
    }
    let Some(now) = stretching.as_mut() else {
        return;
    };
    now.moved += motion.delta.x - motion.delta.y;
    for (key, swipe) in [
        (KeyCode::KeyX, Vec2::Y),
        (KeyCode::KeyY, Vec2::X),
        (KeyCode::KeyZ, Vec2::NEG_Y),
        (KeyCode::KeyA, Vec2::NEG_X),
    ] {
        if keys.just_pressed(key) {
            now.swipe = Some(swipe);
        }
    }
    let apart = APART * (now.moved / DOUBLE).exp2();
    for (side, sign) in [(Side::Left, -0.5), (Side::Right, 0.5)] {
        let frame = input.side(side);
        frame.pose = Some(Pose {
            position: now.middle.position + now.along * (sign * apart),
            ..now.middle
        });
        frame.down.set(Action::Act, false);
        frame.down.set(Action::Grab, true);
        if side == Side::Right {
            frame.swipe = now.swipe;
        }
    }
}
