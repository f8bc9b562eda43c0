//! Signs beside operands, and the hands.

use bevy::color::ColorToPacked;
use bevy::prelude::*;
use bevy_egui::{EguiContexts, egui};
use midair_studio::{
    hands::{Action, Hands, Side},
    panel::{ACCENT, Palette},
    project::{Project, Shelf},
    show::{Cues, ObjectMap, Readouts},
};

use crate::bindings::{Bindings, Controls};
use crate::gamepad::Pad;
use crate::keys::key_name;
use crate::orbit::Orbit;
use crate::panels::Screen;
use crate::pointer::Pointer;

/// Each operand carries its place and its sign, since colour alone is no cue for everyone.
pub(crate) fn objects(
    mut contexts: EguiContexts,
    cues: Res<Cues>,
    map: Res<ObjectMap>,
    transforms: Query<&GlobalTransform>,
    camera: Single<(&Camera, &GlobalTransform), With<Orbit>>,
    screen: Res<Screen>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let (camera, eye) = *camera;
    let Some(view) = screen.view() else {
        return Ok(());
    };
    let painter = ctx
        .layer_painter(egui::LayerId::background())
        .with_clip_rect(view);
    let palette = Palette::of(&ctx.global_style().visuals);
    for (&id, cue) in &cues.0 {
        let Some(label) = &cue.label else { continue };
        let Some(at) = map.get(id).and_then(|e| transforms.get(e).ok()) else {
            continue;
        };
        let Ok(at) = camera.world_to_viewport(eye, at.translation()) else {
            continue;
        };
        let galley = painter.layout_no_wrap(
            label.clone(),
            egui::FontId::proportional(16.0),
            palette.text,
        );
        let rect =
            egui::Rect::from_center_size(screen.point(at), galley.size() + egui::vec2(16.0, 8.0));
        let [r, g, b, _] = cue.tint.colour().to_srgba().to_u8_array();
        painter.rect_filled(rect, 6.0, backing(&palette));
        painter.rect_stroke(
            rect,
            6.0,
            egui::Stroke::new(1.5, egui::Color32::from_rgb(r, g, b)),
            egui::StrokeKind::Inside,
        );
        painter.galley(rect.center() - 0.5 * galley.size(), galley, palette.text);
    }
    Ok(())
}

/// Behind words over the view: a panel's colour, nearly closed, so that they read in every room.
fn backing(palette: &Palette) -> egui::Color32 {
    palette.panel.gamma_multiply(0.92)
}

/// An empty room says how one begins.
pub(crate) fn empty(
    mut contexts: EguiContexts,
    project: Res<Project>,
    shelf: Res<Shelf>,
    screen: Res<Screen>,
    (controls, bindings): (Res<Controls>, Res<Bindings>),
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let Some(view) = screen
        .view()
        .filter(|_| project.document().objects().next().is_none())
    else {
        return Ok(());
    };
    let painter = ctx
        .layer_painter(egui::LayerId::background())
        .with_clip_rect(view);
    let first = if shelf.open {
        "Pick a shape to begin".to_owned()
    } else {
        let key = key_name(Action::Library, &bindings, controls.device());
        format!("Press {key} for the library")
    };
    let at = egui::pos2(view.center().x, view.top() + 0.3 * view.height());
    let palette = Palette::of(&ctx.global_style().visuals);
    for (text, size, down, colour) in [
        (first.as_str(), 24.0, 0.0, palette.text),
        (
            "or drop a mesh or a document here",
            15.0,
            32.0,
            palette.weak,
        ),
    ] {
        painter.text(
            at + egui::vec2(0.0, down),
            egui::Align2::CENTER_CENTER,
            text,
            egui::FontId::proportional(size),
            colour,
        );
    }
    Ok(())
}

/// A dot at each hand; what lies below it is the studio's to show.
pub(crate) fn hands(
    mut contexts: EguiContexts,
    hands: Res<Hands>,
    (pointer, pad): (Res<Pointer>, Res<Pad>),
    camera: Single<(&Camera, &Transform), With<Orbit>>,
    screen: Res<Screen>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let Some(view) = screen.view() else {
        return Ok(());
    };
    let (camera, eye) = camera.into_inner();
    let eye = GlobalTransform::from(*eye);
    let painter = ctx
        .layer_painter(egui::LayerId::background())
        .with_clip_rect(view);
    for side in Side::BOTH {
        let (leading, latched) = if pad.leads() {
            (pad.leading(), pad.is_latched(side))
        } else {
            (pointer.leading, pointer.is_latched(side))
        };
        let leads = side == leading;
        if !leads && !latched && !pointer.stretching {
            continue;
        }
        let tip = hands.get(side).pose.position;
        let Ok(at) = camera.world_to_viewport(&eye, tip) else {
            continue;
        };
        // A gamepad has no pointer of its own: its hand is easier to find.
        let radius = if pad.leads() { 6.0 } else { 3.5 };
        let fill = if leads {
            ACCENT
        } else {
            egui::Color32::from_gray(0xc8)
        };
        let at = screen.point(at);
        painter.circle_filled(at, radius + 1.5, egui::Color32::from_black_alpha(110));
        painter.circle(
            at,
            radius,
            fill,
            egui::Stroke::new(1.0, egui::Color32::WHITE),
        );
    }
    Ok(())
}

/// Lengths, angles and scales beside what they are about.
pub(crate) fn readouts(
    mut contexts: EguiContexts,
    readouts: Res<Readouts>,
    camera: Single<(&Camera, &Transform), With<Orbit>>,
    screen: Res<Screen>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let (camera, eye) = camera.into_inner();
    let Some(view) = screen.view() else {
        return Ok(());
    };
    let painter = ctx
        .layer_painter(egui::LayerId::background())
        .with_clip_rect(view);
    let palette = Palette::of(&ctx.global_style().visuals);
    let mut taken: Vec<egui::Rect> = Vec::new();
    for readout in &readouts.0 {
        let eye = GlobalTransform::from(*eye);
        let Ok(at) = camera.world_to_viewport(&eye, readout.at) else {
            continue;
        };
        let galley = painter.layout_no_wrap(
            readout.text.clone(),
            egui::FontId::proportional(14.0),
            palette.text,
        );
        let size = galley.size() + egui::vec2(12.0, 6.0);
        let below = screen.point(at) + egui::vec2(0.0, 24.0);
        let mut rect = egui::Rect::from_center_size(below, size);
        // One below the other where they would lie upon each other.
        while let Some(other) = taken.iter().find(|r| r.intersects(rect)) {
            rect = rect.translate(egui::vec2(0.0, other.bottom() - rect.top() + 2.0));
        }
        taken.push(rect);
        painter.rect_filled(rect, 4.0, backing(&palette));
        painter.galley(rect.center() - 0.5 * galley.size(), galley, palette.text);
    }
    Ok(())
}
