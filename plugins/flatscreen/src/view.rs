//! Where the view jumps to: what is selected, the sides, the start; and along with the world.

use std::f32::consts::{FRAC_PI_2, PI};

use bevy::prelude::*;
use bevy_egui::egui;
use midair_studio::{
    project::{Project, Selection},
    ruler::selected_box,
    show::Drafts,
    world::WorldView,
};

use crate::bindings::{Control, Controls};
use crate::gamepad::Pad;
use crate::orbit::{FIELD_OF_VIEW, Orbit};
use crate::panels::Screen;
use crate::pointer::Pointer;

/// The world was moved: hands and eyes stay where they are in the room.
pub(crate) fn carry(
    world: Res<WorldView>,
    mut orbit: Single<&mut Orbit>,
    mut pointer: ResMut<Pointer>,
    mut pad: ResMut<Pad>,
) {
    if let Some(by) = &world.carry {
        orbit.carry(by);
        pointer.carry(by);
        pad.go_along(by);
    }
}

/// F shows what is selected, or everything; the others show it from a side.
pub(crate) fn jump(
    controls: Res<Controls>,
    mut pad: ResMut<Pad>,
    (project, selection, drafts): (Res<Project>, Res<Selection>, Res<Drafts>),
    (screen, windows): (Res<Screen>, Query<&Window>),
    mut orbit: Single<&mut Orbit>,
    mut shown: Local<Option<u64>>,
) {
    let asked = std::mem::take(&mut pad.frame) || controls.just_pressed(Control::FrameSelection);
    let everything = controls.just_pressed(Control::FrameAll);
    // What is opened is seen; what is new begins where one stood at first.
    let opened = shown.replace(project.number()) != Some(project.number());
    if opened && project.document().objects().next().is_none() {
        **orbit = Orbit::default();
    } else if asked || everything || opened {
        let all = Selection(project.document().objects().map(|(id, _)| id).collect());
        let selected = selected_box(&project, &selection, &drafts).filter(|_| !everything);
        if let Some((low, high)) = selected.or_else(|| selected_box(&project, &all, &drafts)) {
            orbit.focus = low.midpoint(high);
            let size = windows.iter().next().map(|w| screen.point(w.size()));
            let part = (0.5 * FIELD_OF_VIEW).tan() * free(screen.view(), size);
            orbit.distance = (0.5 * (high - low).length() / part).clamp(0.1, 40.0);
        }
    }
    if controls.just_pressed(Control::ResetView) {
        **orbit = Orbit::default();
    }
    let corner = Orbit::default();
    for (control, yaw, pitch) in [
        (Control::ViewFront, 0.0, 0.0),
        (Control::ViewRight, FRAC_PI_2, 0.0),
        (Control::ViewTop, 0.0, FRAC_PI_2),
        (Control::ViewCorner, corner.yaw, corner.pitch),
    ] {
        if controls.just_pressed(control) {
            orbit.look_from(yaw, pitch);
        }
    }
}

/// How much of half the window's height what stands in its middle may take before a panel hides it.
fn free(view: Option<egui::Rect>, window: Option<egui::Pos2>) -> f32 {
    const MOST: f32 = 0.84;
    let (Some(view), Some(size)) = (view, window) else {
        return MOST;
    };
    let middle = 0.5 * size.to_vec2();
    let across = (middle.x - view.left()).min(view.right() - middle.x);
    let high = (middle.y - view.top()).min(view.bottom() - middle.y);
    (across.min(high) / middle.y).clamp(0.25, MOST)
}

impl Orbit {
    /// From a side; asked for once more, from the opposite one.
    fn look_from(&mut self, yaw: f32, pitch: f32) {
        let there = (self.yaw - yaw).abs() < 1e-3 && (self.pitch - pitch).abs() < 1e-3;
        let below = pitch >= FRAC_PI_2;
        self.lean = Quat::IDENTITY;
        (self.yaw, self.pitch) = match (there, below) {
            (false, _) => (yaw, pitch),
            (true, true) => (yaw, -pitch),
            (true, false) => (yaw + PI, pitch),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_and_opposite_sides() {
        let mut orbit = Orbit::default();
        let ahead = |o: &Orbit| *o.transform().forward();
        for (yaw, pitch, way) in [
            (0.0, 0.0, Vec3::NEG_Z),
            (FRAC_PI_2, 0.0, Vec3::NEG_X),
            (0.0, FRAC_PI_2, Vec3::NEG_Y),
        ] {
            orbit.look_from(yaw, pitch);
            assert!(ahead(&orbit).distance(way) < 1e-5);
            orbit.look_from(yaw, pitch);
            assert!(ahead(&orbit).distance(-way) < 1e-5);
        }
    }
}
