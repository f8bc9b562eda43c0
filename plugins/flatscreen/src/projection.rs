//! With perspective or without.

use bevy::camera::ScalingMode;
use bevy::prelude::*;
use midair_studio::settings::Settings;

use crate::orbit::{FIELD_OF_VIEW, Orbit};

/// Without perspective the camera stands nowhere in particular: what lies this far behind it, in metres,
/// is seen as well.
const BEHIND: f32 = 5.0;

/// What lies at the focus has the same size in both, so that a switch moves nothing.
pub(crate) fn follow(settings: Res<Settings>, camera: Single<(&Orbit, &mut Projection)>) {
    let (orbit, mut projection) = camera.into_inner();
    let height = 2.0 * orbit.distance * (0.5 * FIELD_OF_VIEW).tan();
    match (&*projection, settings.look.orthographic) {
        (Projection::Perspective(_), false) => {}
        (Projection::Orthographic(now), true) if matches!(now.scaling_mode, ScalingMode::FixedVertical { viewport_height: h } if h == height) =>
            {}
        (_, true) => {
            *projection = Projection::Orthographic(OrthographicProjection {
                scaling_mode: ScalingMode::FixedVertical {
                    viewport_height: height,
                },
                near: -BEHIND,
                far: 100.0,
                ..OrthographicProjection::default_3d()
            });
        }
        (_, false) => {
            *projection = Projection::Perspective(PerspectiveProjection {
                fov: FIELD_OF_VIEW,
                near: 0.02,
                ..default()
            });
        }
    }
}
