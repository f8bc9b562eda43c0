//! How far into the view a hand reaches at a place of the window.

use bevy::prelude::*;
use midair_studio::{
    hands::{Pose, Side},
    plane::WorkPlane,
};

/// An empty hand hangs behind the eyes, where it touches and hides nothing.
pub(crate) fn rest(eye: &Transform, side: Side) -> Pose {
    let right = match side {
        Side::Left => -0.2,
        Side::Right => 0.2,
    };
    Pose {
        position: eye.transform_point(Vec3::new(right, -0.25, 0.2)),
        rotation: eye.rotation,
    }
}

/// The ray through a place of the window.
pub(crate) fn ray(camera: &Camera, eye: &Transform, cursor: Vec2) -> Option<Ray3d> {
    camera
        .viewport_to_world(&GlobalTransform::from(*eye), cursor)
        .ok()
}

/// The ray through a point of the window; straight ahead where there is none yet.
pub(crate) fn ray_through(camera: &Camera, eye: &Transform, at: Option<Vec2>) -> Ray3d {
    at.and_then(|at| ray(camera, eye, at)).unwrap_or(Ray3d {
        origin: eye.translation,
        direction: eye.forward(),
    })
}

/// Where a ray is so deep in the view.
pub(crate) fn at_depth(ray: &Ray3d, eye: &Transform, far: f32) -> Option<Vec3> {
    let along = ray.direction.dot(*eye.forward());
    // The ray starts at the near plane, and without perspective even behind the eye.
    let ahead = (ray.origin - eye.translation).dot(*eye.forward());
    (along > 0.1).then(|| ray.get_point((far - ahead) / along))
}

/// Where nothing is hit: on the work plane if it is near (the ground, unless it is in use), else as far
/// away as the origin.
pub(crate) fn on_plane(ray: &Ray3d, eye: &Transform, plane: &WorkPlane) -> Vec3 {
    let plane = if plane.shown {
        *plane
    } else {
        WorkPlane::default()
    };
    let ahead = (ray.origin - eye.translation).dot(*ray.direction);
    let far = || ray.get_point(eye.translation.length().clamp(0.5, 10.0) - ahead);
    plane.meet(ray, 30.0).unwrap_or_else(far)
}

/// Which way is up from the plane that things are put on.
pub(crate) fn plane_up(plane: &WorkPlane) -> Vec3 {
    if plane.shown {
        *plane.normal()
    } else {
        Vec3::Y
    }
}
