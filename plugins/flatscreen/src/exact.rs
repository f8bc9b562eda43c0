//! Keys for snaps, the work plane, the ruler and the world.

use bevy::prelude::*;
use midair_studio::{
    command::Command,
    plane::{PlaneAsk, WorkPlane},
    ruler::{MeasureAsk, Ruler},
    settings::{MirrorPlane, Settings, SymmetrySettings},
    world::WorldAsk,
};

use crate::bindings::{Control, Controls};
use crate::orbit::Orbit;
use crate::pointer::Pointer;

pub(crate) fn commands(
    controls: Res<Controls>,
    settings: Res<Settings>,
    (plane, ruler): (Res<WorkPlane>, Res<Ruler>),
    pointer: Res<Pointer>,
    eye: Single<(&Transform, &Orbit)>,
    mut last: Local<Option<SymmetrySettings>>,
    mut commands: MessageWriter<Command>,
) {
    let pressed = |control| controls.just_pressed(control);
    let snaps = &settings.snap;
    for (control, key, on) in [
        (Control::SnapGrid, "snap.grid.on", snaps.grid.on),
        (Control::SnapAngle, "snap.angle.on", snaps.angle.on),
        (Control::SnapSurface, "snap.surface.on", snaps.surface.on),
    ] {
        if pressed(control) {
            commands.write(Settings::command(key, !on));
        }
    }
    if pressed(Control::Symmetry) {
        let now = &settings.symmetry;
        let next = if now.is_on() {
            *last = Some(now.clone());
            SymmetrySettings {
                planes: now.planes,
                ..SymmetrySettings::default()
            }
        } else {
            // As it was before it was put off, else left and right.
            last.clone().unwrap_or_else(|| SymmetrySettings {
                mirror: MirrorPlane::X,
                ..now.clone()
            })
        };
        commands.write(Settings::command("symmetry", next));
    }
    if pressed(Control::Plane) {
        commands.write(Command::Plane(PlaneAsk::Show(!plane.shown)));
    }
    if pressed(Control::PlaneFace) {
        // Over nothing it faces the eyes.
        let (eye, orbit) = *eye;
        let (point, normal) = pointer.face.unwrap_or((orbit.focus, -*eye.forward()));
        commands.write(Command::Plane(PlaneAsk::Facing { point, normal }));
    }
    let step = if snaps.grid.step.is_finite() {
        snaps.grid.step
    } else {
        0.05
    };
    for (control, by) in [(Control::PlaneUp, step), (Control::PlaneDown, -step)] {
        if controls.fired(control) {
            commands.write(Command::Plane(PlaneAsk::Show(true)));
            commands.write(Command::Plane(PlaneAsk::Offset(plane.offset + by)));
        }
    }
    if pressed(Control::Ruler) {
        let ask = if ruler.on {
            MeasureAsk::End
        } else {
            MeasureAsk::Begin
        };
        commands.write(Command::Measure(ask));
    }
    if ruler.on && pressed(Control::Cancel) {
        commands.write(Command::Measure(MeasureAsk::End));
    }
    if pressed(Control::ResetWorld) {
        commands.write(Command::World(WorldAsk::Reset));
    }
}
