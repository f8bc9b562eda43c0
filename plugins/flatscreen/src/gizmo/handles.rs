//! Where the handles are, which one is under the pointer, and what dragging one does. Pure.

use bevy::gizmos::transform_gizmo::{
    intersect_plane, point_to_segment_dist, translation_plane_normal,
};
use bevy::prelude::*;
use midair_field::Placement;

/// What the handles do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Along an axis.
    Move,
    /// About an axis.
    Turn,
    /// Along an axis, or along all.
    Scale,
}

/// One handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handle {
    /// Red.
    X,
    /// Green.
    Y,
    /// Blue.
    Z,
    /// In the middle: all axes.
    All,
}

impl Handle {
    /// The three that have an axis.
    pub const AXES: [Self; 3] = [Self::X, Self::Y, Self::Z];

    fn index(self) -> Option<usize> {
        Self::AXES.iter().position(|&h| h == self)
    }

    /// Its axis before the frame is turned.
    pub fn unit(self) -> Vec3 {
        self.index().map_or(Vec3::ONE, |i| Vec3::AXES[i])
    }
}

/// The handle's length, as a part of its distance from the eye.
const SIZE: f32 = 0.12;
/// Handles begin this far from the middle, as a part of their length: the middle is the thing's own.
pub const START: f32 = 0.25;
/// A handle is hit within this many pixels.
const NEAR: f32 = 9.0;

/// Where the handles stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Their middle, in world metres.
    pub pivot: Vec3,
    /// How they are turned.
    pub basis: Quat,
    /// How long they are, in metres.
    pub length: f32,
}

impl Frame {
    /// The same size on the screen wherever it is.
    pub fn new(pivot: Vec3, basis: Quat, eye: Vec3) -> Self {
        Self {
            pivot,
            basis,
            length: SIZE * pivot.distance(eye),
        }
    }

    /// The direction of a handle in the world.
    pub fn axis(&self, handle: Handle) -> Vec3 {
        self.basis * handle.unit()
    }

    /// Which handle is under the pointer.
    pub fn hit(
        &self,
        mode: Mode,
        at: Vec2,
        camera: &Camera,
        eye: &GlobalTransform,
    ) -> Option<Handle> {
        let screen = |p: Vec3| camera.world_to_viewport(eye, p).ok();
        let middle = screen(self.pivot)?;
        if mode == Mode::Scale && middle.distance(at) < NEAR {
            return Some(Handle::All);
        }
        let mut best: Option<(f32, Handle)> = None;
        for handle in Handle::AXES {
            let axis = self.axis(handle);
            let far = if mode == Mode::Turn {
                self.far_from_ring(axis, at, screen)
            } else {
                let ends = [START, 1.1].map(|t| screen(self.pivot + axis * (t * self.length)));
                let [Some(from), Some(to)] = ends else {
                    continue;
                };
                // Seen from its end there is nothing to pull at.
                if from.distance(to) < 4.0 {
                    continue;
                }
                point_to_segment_dist(at, from, to)
            };
            if far < NEAR && best.is_none_or(|(b, _)| far < b) {
                best = Some((far, handle));
            }
        }
        best.map(|(_, handle)| handle)
    }

    /// Pixels from a point of the screen to the ring about an axis. The engine's own measure passes over
    /// the near and the far side of a ring that lies flat.
    fn far_from_ring(&self, axis: Vec3, at: Vec2, screen: impl Fn(Vec3) -> Option<Vec2>) -> f32 {
        let arm = axis.any_orthonormal_vector() * self.length;
        let seen = |i: u32| {
            let turn = Quat::from_axis_angle(axis, i as f32 * std::f32::consts::TAU / 48.0);
            screen(self.pivot + turn * arm)
        };
        (0..48)
            .filter_map(|i| Some(point_to_segment_dist(at, seen(i)?, seen(i + 1)?)))
            .fold(f32::INFINITY, f32::min)
    }

    /// How far along a handle, or at which angle about it, a ray points.
    pub fn reading(&self, mode: Mode, handle: Handle, ray: Ray3d, up: Vec3) -> Option<f32> {
        let axis = self.axis(handle);
        let read = match (mode, handle) {
            (Mode::Scale, Handle::All) => {
                // Up and to the right of the middle is larger.
                let at = intersect_plane(ray, *ray.direction, self.pivot)?;
                let right = ray.direction.cross(up).normalize_or_zero();
                1.0 + (at - self.pivot).dot(right + up) / self.length
            }
            (Mode::Turn, _) => {
                let at = intersect_plane(ray, axis, self.pivot)?;
                let from = axis.any_orthonormal_vector();
                let arm = at - self.pivot;
                arm.dot(axis.cross(from)).atan2(arm.dot(from))
            }
            _ => {
                let at = intersect_plane(ray, translation_plane_normal(ray, axis), self.pivot)?;
                (at - self.pivot).dot(axis)
            }
        };
        (read.is_finite() && read.abs() < 100.0).then_some(read)
    }
}

/// What dragging a handle does to everything that is selected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// Metres along an axis of the world.
    Move(Vec3),
    /// About the pivot.
    Turn(Quat),
    /// Factors along the axes of the frame, about the pivot.
    Scale(Vec3),
}

impl Change {
    /// Where a thing stands afterwards.
    pub fn apply(&self, frame: &Frame, before: &Placement) -> Placement {
        match *self {
            Self::Move(by) => Placement {
                translation: before.translation + by,
                ..*before
            },
            Self::Turn(turn) => Placement {
                translation: frame.pivot + turn * (before.translation - frame.pivot),
                rotation: (turn * before.rotation).normalize(),
                scale: before.scale,
            },
            Self::Scale(by) => {
                let arm = frame.basis.inverse() * (before.translation - frame.pivot);
                // Each of its own axes grows as the axis of the frame does that it is nearest to.
                let own = (frame.basis.inverse() * before.rotation).normalize();
                let factor = Vec3::AXES.map(|axis| {
                    let seen = (own * axis).abs();
                    by[seen.max_position()]
                });
                Placement {
                    translation: frame.pivot + frame.basis * (arm * by),
                    rotation: before.rotation,
                    scale: before.scale * Vec3::from(factor),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Frame = Frame {
        pivot: Vec3::new(0.5, 0.0, 0.0),
        basis: Quat::IDENTITY,
        length: 0.2,
    };

    fn ray(from: Vec3, to: Vec3) -> Ray3d {
        Ray3d {
            origin: from,
            direction: Dir3::new(to - from).unwrap(),
        }
    }

    #[test]
    fn a_handle_reads_how_far_and_at_which_angle_the_pointer_is() {
        let eye = Vec3::new(0.4, 0.7, 2.0);
        let along = |to| FRAME.reading(Mode::Move, Handle::X, ray(eye, to), Vec3::Y);
        let read = along(Vec3::new(0.8, 0.0, 0.0)).unwrap();
        assert!((read - 0.3).abs() < 1e-4, "{read}");
        let angle = |to| FRAME.reading(Mode::Turn, Handle::Y, ray(eye, to), Vec3::Y);
        let a = angle(Vec3::new(0.8, 0.0, 0.0)).unwrap();
        let b = angle(Vec3::new(0.5, 0.0, -0.3)).unwrap();
        let turned = Quat::from_axis_angle(Vec3::Y, b - a) * Vec3::X;
        assert!(turned.distance(Vec3::NEG_Z) < 1e-4);
        // Along the plane of the ring there is no angle to read.
        let flat = ray(Vec3::new(0.0, 1.0, 0.0), Vec3::new(1.0, 1.0, 0.0));
        assert_eq!(FRAME.reading(Mode::Turn, Handle::Y, flat, Vec3::Y), None);
    }

    #[test]
    fn several_things_turn_and_scale_as_one() {
        let thing = Placement::at(Vec3::new(1.5, 0.0, 0.0));
        let turn = Change::Turn(Quat::from_rotation_y(std::f32::consts::FRAC_PI_2));
        let there = turn.apply(&FRAME, &thing);
        assert!(there.translation.distance(Vec3::new(0.5, 0.0, -1.0)) < 1e-5);
        let scaled = Change::Scale(Vec3::new(2.0, 1.0, 1.0)).apply(&FRAME, &thing);
        assert!(scaled.translation.distance(Vec3::new(2.5, 0.0, 0.0)) < 1e-5);
        assert_eq!(scaled.scale, Vec3::new(2.0, 1.0, 1.0));
        let lying = Placement {
            rotation: Quat::from_rotation_y(std::f32::consts::FRAC_PI_2),
            ..thing
        };
        let scaled = Change::Scale(Vec3::new(2.0, 1.0, 1.0)).apply(&FRAME, &lying);
        assert_eq!(scaled.scale, Vec3::new(1.0, 1.0, 2.0));
    }
}
