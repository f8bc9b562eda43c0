//! Signs beside operands, and the hands.

use bevy::color::ColorToPacked;
use bevy::prelude::*;
use bevy_egui::{EguiContexts, egui};
use midair_studio::{
    hands::{Hands, Side},
    show::{Cues, ObjectMap},
};

use crate::orbit::Orbit;
use crate::pointer::Pointer;

/// Each operand carries its place and its sign, since colour alone is no cue for everyone.
pub(crate) fn objects(
    mut contexts: EguiContexts,
    cues: Res<Cues>,
    map: Res<ObjectMap>,
    transforms: Query<&GlobalTransform>,
    camera: Single<(&Camera, &GlobalTransform), With<Orbit>>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let (camera, eye) = *camera;
    let painter = ctx.layer_painter(egui::LayerId::background());
    for (&id, cue) in &cues.0 {
        let Some(label) = &cue.label else { continue };
        let Some(at) = map.get(id).and_then(|e| transforms.get(e).ok()) else {
            continue;
        };
        let Ok(screen) = camera.world_to_viewport(eye, at.translation()) else {
            continue;
        };
        let galley = painter.layout_no_wrap(
            label.clone(),
            egui::FontId::proportional(16.0),
            egui::Color32::WHITE,
        );
        let rect = egui::Rect::from_center_size(
            egui::pos2(screen.x, screen.y),
            galley.size() + egui::vec2(16.0, 8.0),
        );
        let [r, g, b, _] = cue.tint.colour().to_srgba().to_u8_array();
        painter.rect_filled(rect, 6.0, egui::Color32::from_black_alpha(200));
        painter.rect_stroke(
            rect,
            6.0,
            egui::Stroke::new(1.5, egui::Color32::from_rgb(r, g, b)),
            egui::StrokeKind::Inside,
        );
        painter.galley(rect.center() - 0.5 * galley.size(), galley, egui::Color32::WHITE);
    }
    Ok(())
}

/// A small ball at each hand, and a plumb line to the ground, so that its depth can be read.
pub(crate) fn hands(mut gizmos: Gizmos, hands: Res<Hands>, pointer: Res<Pointer>) {
    for side in Side::BOTH {
        let tip = hands.get(side).pose.position;
        let leads = side == pointer.leading;
        let colour = if leads {
            Color::srgb(0.62, 0.54, 0.95)
        } else {
            Color::srgba(0.6, 0.6, 0.65, 0.5)
        };
        gizmos.sphere(tip, if leads { 0.008 } else { 0.006 }, colour);
        if tip.y.abs() > 0.01 {
            gizmos.line(tip, tip.with_y(0.0), colour.with_alpha(0.35));
        }
        gizmos.circle(
            Isometry3d::new(tip.with_y(0.001), Quat::from_rotation_arc(Vec3::Z, Vec3::Y)),
            0.015,
            colour.with_alpha(0.5),
        );
    }
}
