//! The work plane that every tool shares: where things go that are drawn, placed or dragged on nothing.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{StudioSet, command::Command};

/// The work plane. The ground until somebody sets it otherwise.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct WorkPlane {
    /// A point of it, in world metres, before it is shifted.
    pub origin: Vec3,
    /// How it lies: its own +Y is its normal, x and z are the directions of its lines.
    pub rotation: Quat,
    /// Metres it is shifted along its normal.
    pub offset: f32,
    /// Whether it is seen and things are dragged along it.
    pub shown: bool,
}

impl Default for WorkPlane {
    fn default() -> Self {
        Self {
            origin: Vec3::ZERO,
            rotation: Quat::IDENTITY,
            offset: 0.0,
            shown: false,
        }
    }
}

impl WorkPlane {
    /// Its unit normal.
    pub fn normal(&self) -> Dir3 {
        Dir3::new(self.rotation * Vec3::Y).unwrap_or(Dir3::Y)
    }

    /// The point that its lines are counted from.
    pub fn middle(&self) -> Vec3 {
        self.origin + self.offset * self.normal().as_vec3()
    }

    /// Where a ray meets it, within `reach` metres.
    pub fn meet(&self, ray: &Ray3d, reach: f32) -> Option<Vec3> {
        let far = ray.intersect_plane(self.middle(), InfinitePlane3d::new(*self.normal()))?;
        (far > 0.0 && far < reach).then(|| ray.get_point(far))
    }

    /// A point of the world in the plane's own frame: y is its height above it.
    pub fn to_local(&self, point: Vec3) -> Vec3 {
        self.rotation.inverse() * (point - self.middle())
    }

    /// The other way.
    pub fn to_world(&self, point: Vec3) -> Vec3 {
        self.middle() + self.rotation * point
    }

    fn carry_out(&mut self, ask: &PlaneAsk) {
        let laid = match *ask {
            PlaneAsk::Ground => Some((Vec3::ZERO, Quat::IDENTITY)),
            PlaneAsk::Front => Some((
                Vec3::ZERO,
                Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
            )),
            PlaneAsk::Side => Some((
                Vec3::ZERO,
                Quat::from_rotation_z(-std::f32::consts::FRAC_PI_2),
            )),
            PlaneAsk::Facing { point, normal } => {
                let Ok(normal) = Dir3::new(normal) else {
                    return;
                };
                if !point.is_finite() {
                    return;
                }
                Some((point, Quat::from_rotation_arc(Vec3::Y, *normal)))
            }
            PlaneAsk::Offset(offset) => {
                if offset.is_finite() {
                    self.offset = offset.clamp(-20.0, 20.0);
                }
                None
            }
            PlaneAsk::Show(shown) => {
                self.shown = shown;
                None
            }
            PlaneAsk::Reset => {
                *self = Self::default();
                None
            }
        };
        if let Some((origin, rotation)) = laid {
            *self = Self {
                origin,
                rotation,
                offset: 0.0,
                shown: true,
            };
        }
    }
}

/// What can be asked of the work plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum PlaneAsk {
    /// It is the ground: x and z.
    Ground,
    /// It stands upright before the eyes: x and y.
    Front,
    /// It stands upright at the side: y and z.
    Side,
    /// It lies against a face, or faces the eyes.
    Facing {
        /// A point of it, in world metres.
        point: Vec3,
        /// Its normal, of any length.
        normal: Vec3,
    },
    /// It is shifted along its normal, by metres.
    Offset(f32),
    /// It is shown, and things are dragged along it; or not.
    Show(bool),
    /// The ground again, and out of sight.
    Reset,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<WorkPlane>()
        .add_systems(Update, ask.in_set(StudioSet::Ask));
}

fn ask(mut commands: MessageReader<Command>, mut plane: ResMut<WorkPlane>) {
    for command in commands.read() {
        match command {
            Command::Plane(ask) => {
                let mut next = *plane;
                next.carry_out(ask);
                plane.set_if_neq(next);
            }
            // Another document begins where a new one does.
            Command::New | Command::Open(_) => {
                plane.set_if_neq(WorkPlane::default());
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(asks: &[PlaneAsk]) -> WorkPlane {
        let mut plane = WorkPlane::default();
        for ask in asks {
            plane.carry_out(ask);
        }
        plane
    }

    #[test]
    fn the_named_planes_face_where_they_are_to() {
        for (ask, normal) in [
            (PlaneAsk::Ground, Vec3::Y),
            (PlaneAsk::Front, Vec3::Z),
            (PlaneAsk::Side, Vec3::X),
        ] {
            let plane = asked(&[ask]);
            assert!(plane.normal().distance(normal) < 1e-6, "{ask:?}");
            assert!(plane.shown);
        }
    }

    #[test]
    fn a_face_sets_it_and_the_offset_shifts_it_along_its_normal() {
        let point = Vec3::new(0.0, 0.4, 0.1);
        let plane = asked(&[
            PlaneAsk::Facing {
                point,
                normal: Vec3::new(0.0, 0.0, 3.0),
            },
            PlaneAsk::Offset(0.2),
        ]);
        assert!(plane.middle().distance(Vec3::new(0.0, 0.4, 0.3)) < 1e-6);
        let ray = Ray3d::new(Vec3::new(0.5, 0.5, 2.0), Dir3::NEG_Z);
        assert!(
            plane
                .meet(&ray, 30.0)
                .unwrap()
                .distance(Vec3::new(0.5, 0.5, 0.3))
                < 1e-5
        );
        assert_eq!(
            asked(&[PlaneAsk::Front, PlaneAsk::Reset]),
            WorkPlane::default()
        );
    }

    #[test]
    fn what_is_no_plane_changes_nothing() {
        for ask in [
            PlaneAsk::Facing {
                point: Vec3::NAN,
                normal: Vec3::Y,
            },
            PlaneAsk::Facing {
                point: Vec3::ZERO,
                normal: Vec3::ZERO,
            },
            PlaneAsk::Offset(f32::NAN),
        ] {
            assert_eq!(asked(&[ask]), WorkPlane::default(), "{ask:?}");
        }
    }
}
