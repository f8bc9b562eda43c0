//! How the handles look: on top of everything, the one under the pointer brighter.

use bevy::prelude::*;

use super::handles::START;
use super::{Gizmo, Handle, Mode};

/// Drawn over everything.
#[derive(Default, Reflect, GizmoConfigGroup)]
pub(crate) struct Overlay;

fn colour(handle: Handle) -> Color {
    match handle {
        Handle::X => Color::srgb(0.93, 0.36, 0.40),
        Handle::Y => Color::srgb(0.52, 0.80, 0.36),
        Handle::Z => Color::srgb(0.38, 0.60, 0.95),
        Handle::All => Color::srgb(0.92, 0.92, 0.94),
    }
}

pub(crate) fn draw(mut gizmos: Gizmos<Overlay>, gizmo: Res<Gizmo>) {
    let dragged = gizmo.drag.as_ref();
    let Some(mode) = dragged.map(|d| d.mode).or(gizmo.mode) else {
        return;
    };
    let Some(frame) = dragged.map(|d| d.shown).or(gizmo.frame) else {
        return;
    };
    let lit = dragged.map(|d| d.handle).or(gizmo.hovered);
    let shade = |handle: Handle| {
        let colour = colour(handle);
        match lit {
            Some(one) if one == handle => Color::WHITE,
            // The others step back.
            Some(_) => colour.with_alpha(0.35),
            None => colour,
        }
    };
    let length = frame.length;
    for handle in Handle::AXES {
        let axis = frame.axis(handle);
        let colour = shade(handle);
        let tip = frame.pivot + axis * length;
        match mode {
            Mode::Move => {
                gizmos
                    .arrow(frame.pivot + axis * (START * length), tip, colour)
                    .with_tip_length(0.16 * length);
            }
            Mode::Turn => {
                let ring = Quat::from_rotation_arc(Vec3::Z, axis);
                gizmos
                    .circle(Isometry3d::new(frame.pivot, ring), length, colour)
                    .resolution(64);
            }
            Mode::Scale => {
                gizmos.line(frame.pivot + axis * (START * length), tip, colour);
                let cube = Transform {
                    translation: tip,
                    rotation: frame.basis,
                    scale: Vec3::splat(0.1 * length),
                };
                gizmos.cube(cube, colour);
            }
        }
    }
    if mode == Mode::Scale {
        let cube = Transform {
            translation: frame.pivot,
            rotation: frame.basis,
            scale: Vec3::splat(0.14 * length),
        };
        gizmos.cube(cube, shade(Handle::All));
    }
}
