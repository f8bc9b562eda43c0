//! Handles on what is selected: it is moved, turned and scaled by them, several things as one.
//!
//! While a handle is dragged the things are drafts; letting go is one step, cancel puts them back.

mod draw;
mod handles;

use bevy::prelude::*;
use midair_field::Placement;
use midair_mesh::Unit;
use midair_studio::{
    command::Command,
    document::ObjectId,
    hands::HandsInput,
    objects::Ask,
    project::{Project, Selection},
    settings::{Settings, SnapSettings},
    show::{Drafts, Readouts},
    snap::{Snapper, box_of, own_box},
    tools::{Aim, ToolChanged},
    units::length,
};

pub(crate) use draw::draw;
pub use handles::Mode;
use handles::{Change, Frame, Handle};

use crate::bindings::{Control, Controls, Cursor, Device};
use crate::gamepad::Pad;
use crate::orbit::Orbit;
use crate::panels::Screen;
use crate::pointer::Pointer;
use crate::reach;

/// The handles and what is dragged by them.
#[derive(Resource, Clone, Debug)]
pub struct Gizmo {
    /// What they do; `None` while they are put away.
    pub mode: Option<Mode>,
    /// They were asked for since this mode was taken: where a press draws they would be in the way.
    asked: bool,
    frame: Option<Frame>,
    hovered: Option<Handle>,
    drag: Option<Drag>,
}

/// A drag in progress.
#[derive(Clone, Debug)]
struct Drag {
    mode: Mode,
    handle: Handle,
    frame: Frame,
    /// Where the handles are seen: they go along with what they move.
    shown: Frame,
    /// What the handle read when it was taken.
    from: f32,
    before: Vec<(ObjectId, Placement)>,
}

impl Default for Gizmo {
    fn default() -> Self {
        Self {
            mode: Some(Mode::Move),
            asked: false,
            frame: None,
            hovered: None,
            drag: None,
        }
    }
}

impl Gizmo {
    /// Whether the pointer is on a handle or drags one: it is nobody else's then.
    pub fn has_pointer(&self) -> bool {
        self.hovered.is_some() || self.drag.is_some()
    }

    /// What the handles that are to be seen do: where a press draws, only those that were asked for.
    fn shown(&self, draws: bool) -> Option<Mode> {
        self.mode.filter(|_| self.asked || !draws)
    }

    /// Whether a handle is dragged.
    pub fn is_dragged(&self) -> bool {
        self.drag.is_some()
    }
}

/// What the handles read: the document, the selection, what is in the hands.
type Scene<'w> = (
    Res<'w, Project>,
    Res<'w, Selection>,
    Res<'w, Settings>,
    Res<'w, Aim>,
);

/// Another mode was taken: what was asked for in the one before may be in its way.
pub(crate) fn put_away(_: On<ToolChanged>, mut gizmo: ResMut<Gizmo>) {
    gizmo.asked = false;
}

pub(crate) fn steer(
    controls: Res<Controls>,
    (screen, pointer, pad): (Res<Screen>, Res<Pointer>, Res<Pad>),
    cursor: Res<Cursor>,
    camera: Single<(&Camera, &Transform), With<Orbit>>,
    (project, selection, settings, aim): Scene,
    input: Res<HandsInput>,
    mut gizmo: ResMut<Gizmo>,
    mut drafts: ResMut<Drafts>,
    mut snapper: Snapper,
    mut readouts: ResMut<Readouts>,
    mut commands: MessageWriter<Command>,
) {
    let (camera, eye) = camera.into_inner();
    for (control, mode) in [
        (Control::GizmoMove, Mode::Move),
        (Control::GizmoTurn, Mode::Turn),
        (Control::GizmoScale, Mode::Scale),
    ] {
        // Once more puts the handles away.
        if controls.just_pressed(control) && gizmo.drag.is_none() {
            gizmo.mode = (gizmo.shown(aim.draws) != Some(mode)).then_some(mode);
            gizmo.asked = true;
        }
    }
    let cursor = cursor.at();
    let ray = cursor.and_then(|at| reach::ray(camera, eye, at));
    if let Some(mut drag) = gizmo.drag.take() {
        let lead = drag.before[0].0;
        // Undo, another tool or another document have taken it out of the pointer's hands.
        let taken = drafts.get(lead).is_none();
        if taken || controls.pressed(Control::Cancel) {
            for (id, _) in &drag.before {
                drafts.take(*id);
            }
            return;
        }
        let free = controls.pressed(Control::SnapOff);
        if let Some(to) = ray.and_then(|r| drag.frame.reading(drag.mode, drag.handle, r, *eye.up()))
        {
            let mut change = drag.change(to, &settings.snap, free);
            if let Change::Move(by) = &mut change {
                // It snaps along the handle and nowhere else.
                let axis = drag.frame.axis(drag.handle);
                let wanted = Change::Move(*by).apply(&drag.frame, &drag.before[0].1);
                let others: Vec<_> = drag.before.iter().map(|b| b.0).collect();
                let rests = snapper.rest(lead, &others, wanted, free, input.metres_per_world);
                *by += axis * (rests.translation - wanted.translation).dot(axis);
            }
            for (id, before) in &drag.before {
                drafts.set(*id, change.apply(&drag.frame, before));
            }
            if let Change::Move(by) = change {
                drag.shown.pivot = drag.frame.pivot + by;
            }
            readouts.say(drag.shown.pivot, drag.words(&change, settings.units.length));
        }
        if controls.pressed_on(Control::Act, Device::Keys) {
            gizmo.drag = Some(drag);
            return;
        }
        let moved: Vec<_> = drag
            .before
            .iter()
            .filter_map(|(id, before)| {
                let placement = drafts.take(*id)?;
                (placement != *before).then_some((*id, placement))
            })
            .collect();
        if !moved.is_empty() {
            commands.write(Command::Objects(Ask::Place(moved)));
        }
    }
    let document = project.document();
    let before: Vec<_> = selection
        .0
        .iter()
        .filter(|&&id| document.is_visible(id) && !document.is_locked(id))
        .filter_map(|&id| Some((id, document.object(id)?.placement)))
        .collect();
    let away = pad.leads() || pointer.stretching || pointer.holds() || !drafts.is_empty();
    let mode = gizmo.shown(aim.draws);
    let frame = mode
        .filter(|_| !before.is_empty() && !away)
        .map(|mode| stand(&project, mode, &before, eye.translation));
    let free = !screen.covers(cursor);
    let hovered = match (mode, frame, cursor.filter(|_| free)) {
        (Some(mode), Some(frame), Some(at)) => {
            frame.hit(mode, at, camera, &GlobalTransform::from(*eye))
        }
        _ => None,
    };
    let taken =
        controls.just_pressed(Control::Act) && controls.pressed_on(Control::Act, Device::Keys);
    if let (Some(mode), Some(frame), Some(handle), Some(ray)) = (mode, frame, hovered, ray)
        && taken
        && let Some(from) = frame.reading(mode, handle, ray, *eye.up())
    {
        for (id, placement) in &before {
            drafts.set(*id, *placement);
        }
        gizmo.drag = Some(Drag {
            mode,
            handle,
            frame,
            shown: frame,
            from,
            before,
        });
    }
    if gizmo.frame != frame || gizmo.hovered != hovered {
        gizmo.frame = frame;
        gizmo.hovered = hovered;
    }
}

/// A thing whose origin is farther from it than this, in metres, is taken by its middle.
const NEAR: f32 = 0.05;

/// Where the handles of these things stand: in the middle of the box around them.
fn stand(project: &Project, mode: Mode, things: &[(ObjectId, Placement)], eye: Vec3) -> Frame {
    let document = project.document();
    let boxes = things.iter().filter_map(|(id, placement)| {
        Some(box_of(placement, own_box(project, document.object(*id)?)?))
    });
    let whole = boxes.reduce(|(low, high), (l, h)| (low.min(l), high.max(h)));
    let pivot = match (things, whole) {
        // What is drawn may lie far from its own origin: then its middle is meant.
        ([(_, only)], Some((low, high)))
            if only.translation.clamp(low, high).distance(only.translation) < NEAR =>
        {
            only.translation
        }
        (_, Some((low, high))) => low.midpoint(high),
        _ => things[0].1.translation,
    };
    let basis = match things {
        // A thing is scaled along its own axes.
        [(_, only)] if mode == Mode::Scale => only.rotation,
        _ => Quat::IDENTITY,
    };
    Frame::new(pivot, basis, eye)
}

impl Drag {
    fn change(&self, to: f32, snaps: &SnapSettings, free: bool) -> Change {
        let axis = self.frame.axis(self.handle);
        match self.mode {
            Mode::Move => Change::Move(axis * (to - self.from)),
            Mode::Turn => {
                let mut angle = to - self.from;
                let step = snaps.angle.step.to_radians();
                if snaps.angle.on && !free && step.is_finite() && step > 0.0 {
                    angle = (angle / step).round() * step;
                }
                Change::Turn(Quat::from_axis_angle(axis, angle))
            }
            Mode::Scale => {
                let ratio = if self.from.abs() > 1e-6 {
                    to / self.from
                } else {
                    1.0
                };
                let mut factor = ratio.clamp(0.05, 20.0);
                if snaps.grid.on && !free {
                    factor = ((factor * 10.0).round() / 10.0).max(0.1);
                }
                let along = match self.handle {
                    Handle::All => Vec3::splat(factor),
                    one => Vec3::ONE + one.unit() * (factor - 1.0),
                };
                Change::Scale(along)
            }
        }
    }

    fn words(&self, change: &Change, unit: Unit) -> String {
        match change {
            Change::Move(by) => length(by.dot(self.frame.axis(self.handle)), unit),
            Change::Turn(turn) => {
                let (axis, angle) = turn.to_axis_angle();
                let sign = axis.dot(self.frame.axis(self.handle)).signum();
                let degrees = (sign * angle.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
                format!("{degrees:+.0}°")
            }
            Change::Scale(by) => {
                let factor = match self.handle {
                    Handle::All => by.x,
                    one => by.dot(one.unit()),
                };
                format!("× {factor:.2}")
            }
        }
    }
}
