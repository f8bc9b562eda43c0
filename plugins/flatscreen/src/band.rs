//! A box drawn with the pointer on empty ground selects what it touches.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, egui};
use bevy_rapier3d::prelude::ReadRapierContext;
use midair_studio::{
    command::Command,
    document::ObjectId,
    evaluate::Evaluations,
    objects::{Ask, How},
    pick::{self, Proxy},
    project::{Project, Selection},
    ruler::selected_box,
    show::{Drafts, form},
    tools::Tools,
};

use crate::bindings::{Control, Controls, Cursor, Device};
use crate::orbit::Orbit;
use crate::panels::Screen;
use crate::pointer::{Pointer, TREMBLE};

/// The mode in which a drag on nothing means nothing else.
const SELECTING: &str = "csg";

/// A box in pixels of the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Band {
    from: Vec2,
    to: Vec2,
    /// What lies in it joins what is selected.
    more: bool,
}

impl Band {
    pub fn new(from: Vec2, more: bool) -> Self {
        Self {
            from,
            to: from,
            more,
        }
    }

    fn is_drawn(&self) -> bool {
        self.from.distance(self.to) > TREMBLE
    }

    fn rect(&self) -> Rect {
        Rect::from_corners(self.from, self.to)
    }
}

/// So many points of each surface are looked at.
const LOOKED_AT: usize = 1024;

/// The command that selects.
pub(crate) fn select(ids: Vec<ObjectId>, how: How) -> Command {
    Command::Objects(Ask::Select { ids, how })
}

pub(crate) fn drag(
    controls: Res<Controls>,
    tools: Res<Tools>,
    cursor: Res<Cursor>,
    camera: Single<(&Camera, &Transform), With<Orbit>>,
    (project, drafts): (Res<Project>, Res<Drafts>),
    evaluations: Res<Evaluations>,
    (context, proxies): (ReadRapierContext, Query<&Proxy>),
    mut pointer: ResMut<Pointer>,
    mut commands: MessageWriter<Command>,
) {
    let Some(mut band) = pointer.band else {
        return;
    };
    let selecting = tools.active().is_some_and(|t| t.id.as_str() == SELECTING);
    if !selecting {
        pointer.band = None;
        return;
    }
    if let Some(at) = cursor.at() {
        band.to = at;
    }
    if controls.pressed_on(Control::Act, Device::Keys) {
        pointer.band = Some(band);
        return;
    }
    pointer.band = None;
    if !band.is_drawn() {
        return;
    }
    let (camera, eye) = camera.into_inner();
    let eye = GlobalTransform::from(*eye);
    let document = project.document();
    let seen = |at: Vec3| camera.world_to_viewport(&eye, at).ok();
    let rect = band.rect();
    // What a ray through the middle of the box meets lies in it, however large its triangles are.
    let ray = camera.viewport_to_world(&eye, rect.center()).ok();
    let middle = context
        .single()
        .ok()
        .zip(ray)
        .and_then(|(c, ray)| pick::cast(&c, &proxies, ray.origin, ray.direction));
    let within = |id: ObjectId| {
        let Some(object) = document.object(id) else {
            return false;
        };
        let standing = drafts.get(id).unwrap_or(&object.placement);
        let Some(form) = form(&project, &evaluations, object) else {
            let only = Selection(vec![id]);
            let whole = selected_box(&project, &only, &drafts);
            return whole
                .and_then(|(low, high)| seen(low.midpoint(high)))
                .is_some_and(|at| rect.contains(at));
        };
        let affine = standing.affine();
        let stride = form.positions.len().div_ceil(LOOKED_AT).max(1);
        let mut points = form.positions.iter().step_by(stride);
        middle.is_some_and(|m| m.object == id)
            || points.any(|&p| seen(affine.transform_point3(p)).is_some_and(|at| rect.contains(at)))
    };
    let ids: Vec<_> = document
        .objects()
        .map(|(id, _)| id)
        .filter(|&id| document.is_visible(id) && !document.is_locked(id) && within(id))
        .collect();
    let how = if band.more { How::Add } else { How::Set };
    commands.write(select(ids, how));
}

pub(crate) fn show(
    mut contexts: EguiContexts,
    screen: Res<Screen>,
    pointer: Res<Pointer>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let (Some(view), Some(band)) = (screen.view(), pointer.band.filter(Band::is_drawn)) else {
        return Ok(());
    };
    let rect = band.rect();
    let rect = egui::Rect::from_min_max(
        egui::pos2(rect.min.x, rect.min.y),
        egui::pos2(rect.max.x, rect.max.y),
    );
    let painter = ctx
        .layer_painter(egui::LayerId::background())
        .with_clip_rect(view);
    let line = ctx.global_style().visuals.selection.stroke.color;
    painter.rect_filled(rect, 2.0, line.gamma_multiply(0.12));
    painter.rect_stroke(
        rect,
        2.0,
        egui::Stroke::new(1.0, line),
        egui::StrokeKind::Inside,
    );
    Ok(())
}
