//! How the handles look: on top of everything, smooth on every renderer, the one under the pointer brighter.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, egui};
use egui::{Color32, Pos2, Shape, Stroke, Vec2 as Points};

use super::handles::START;
use super::{Frame, Gizmo, Handle, Mode};
use crate::orbit::Orbit;
use crate::panels::Screen;

/// Points across a line, an arrow's head and a box at the end of a handle.
const LINE: f32 = 2.5;
const HEAD: Points = egui::vec2(14.0, 5.5);
const BOX: f32 = 9.0;
/// Lines of which a ring is made.
const RING: usize = 72;

fn colour(handle: Handle) -> Color32 {
    match handle {
        Handle::X => Color32::from_rgb(0xed, 0x5c, 0x66),
        Handle::Y => Color32::from_rgb(0x79, 0xc2, 0x54),
        Handle::Z => Color32::from_rgb(0x61, 0x99, 0xf2),
        Handle::All => Color32::from_rgb(0xeb, 0xeb, 0xf0),
    }
}

/// Where points of the world are on the screen.
struct Lens<'a> {
    camera: &'a Camera,
    eye: GlobalTransform,
    screen: &'a Screen,
}

impl Lens<'_> {
    fn see(&self, at: Vec3) -> Option<Pos2> {
        let at = self.camera.world_to_viewport(&self.eye, at).ok()?;
        Some(self.screen.point(at))
    }
}

pub(crate) fn draw(
    mut contexts: EguiContexts,
    gizmo: Res<Gizmo>,
    camera: Single<(&Camera, &Transform), With<Orbit>>,
    screen: Res<Screen>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let dragged = gizmo.drag.as_ref();
    let (Some(mode), Some(frame), Some(view)) = (
        dragged.map(|d| d.mode).or(gizmo.mode),
        dragged.map(|d| d.shown).or(gizmo.frame),
        screen.view(),
    ) else {
        return Ok(());
    };
    let (camera, eye) = camera.into_inner();
    let lens = Lens {
        camera,
        eye: GlobalTransform::from(*eye),
        screen: &screen,
    };
    let painter = ctx
        .layer_painter(egui::LayerId::background())
        .with_clip_rect(view);
    let lit = dragged.map(|d| d.handle).or(gizmo.hovered);
    let shade = |handle: Handle| match lit {
        // White is to be seen in a dark room only.
        Some(one) if one == handle => ctx.global_style().visuals.strong_text_color(),
        // The others step back.
        Some(_) => colour(handle).gamma_multiply(0.35),
        None => colour(handle),
    };
    // What is farther away lies below.
    let mut axes = Handle::AXES;
    let towards = |h: &Handle| frame.axis(*h).dot(*eye.forward());
    axes.sort_by(|a, b| towards(b).total_cmp(&towards(a)));
    for handle in axes {
        let colour = shade(handle);
        match mode {
            Mode::Move | Mode::Scale => arm(&painter, &lens, &frame, handle, mode, colour),
            Mode::Turn => ring(&painter, &lens, &frame, handle, colour),
        }
    }
    if mode == Mode::Scale
        && let Some(at) = lens.see(frame.pivot)
    {
        square(&painter, at, 1.3 * BOX, shade(Handle::All));
    }
    Ok(())
}

/// A dark rim, so that a line is seen on light and dark alike.
fn rim(colour: Color32) -> Color32 {
    Color32::from_black_alpha((0.35 * f32::from(colour.a())) as u8)
}

fn arm(
    painter: &egui::Painter,
    lens: &Lens,
    frame: &Frame,
    handle: Handle,
    mode: Mode,
    colour: Color32,
) {
    let axis = frame.axis(handle);
    let ends = [START, 1.0].map(|t| lens.see(frame.pivot + axis * (t * frame.length)));
    let [Some(from), Some(tip)] = ends else {
        return;
    };
    let long = from.distance(tip);
    // Seen from its end there is nothing to pull at.
    if long < 4.0 {
        return;
    }
    let ahead = (tip - from) / long;
    let aside = ahead.rot90();
    let head = HEAD.min(Points::splat(0.6 * long));
    let neck = if mode == Mode::Move {
        tip - ahead * head.x
    } else {
        tip
    };
    painter.line_segment([from, neck], Stroke::new(LINE + 2.0, rim(colour)));
    painter.line_segment([from, neck], Stroke::new(LINE, colour));
    if mode == Mode::Move {
        let corners = vec![tip, neck + aside * head.y, neck - aside * head.y];
        painter.add(Shape::convex_polygon(
            corners,
            colour,
            Stroke::new(1.0, rim(colour)),
        ));
    } else {
        square(painter, tip, BOX, colour);
    }
}

fn square(painter: &egui::Painter, at: Pos2, size: f32, colour: Color32) {
    let rect = egui::Rect::from_center_size(at, Points::splat(size));
    painter.rect(
        rect,
        2.0,
        colour,
        Stroke::new(1.0, rim(colour)),
        egui::StrokeKind::Outside,
    );
}

/// The half of a ring that faces away is faint.
fn ring(painter: &egui::Painter, lens: &Lens, frame: &Frame, handle: Handle, colour: Color32) {
    let turned = Quat::from_rotation_arc(Vec3::Z, frame.axis(handle));
    let towards = lens.eye.translation() - frame.pivot;
    let at = |i: usize| {
        let (sin, cos) = (std::f32::consts::TAU * i as f32 / RING as f32).sin_cos();
        turned * Vec3::new(cos, sin, 0.0)
    };
    for i in 0..RING {
        let (a, b) = (at(i), at(i + 1));
        let [Some(from), Some(to)] = [a, b].map(|p| lens.see(frame.pivot + p * frame.length))
        else {
            continue;
        };
        let colour = if (a + b).dot(towards) < 0.0 {
            colour.gamma_multiply(0.3)
        } else {
            colour
        };
        painter.line_segment([from, to], Stroke::new(LINE + 1.5, rim(colour)));
        painter.line_segment([from, to], Stroke::new(LINE, colour));
    }
}
