//! Live symmetry: what is made on one side appears on the others at once, and undoes with it.
//!
//! The sides are the [`Image`]s of a mirror plane through the origin and of turns about the vertical
//! through it, as [`SymmetrySettings`] say. Nothing in the document links
//! a thing to its image: it is found where the symmetry would have it ([`spread`]), so that what was
//! copied, opened or brought back counts like what has just been made.
//!
//! A mode that makes whole objects commits by [`Project::commit_live`]; one that draws takes
//! [`Project::images`] and adds the images of its strokes to the same step.

mod image;
mod reflect;
mod spread;

use bevy::prelude::*;

pub use image::{Image, images};
pub use spread::spread;

use crate::StudioSet;
use crate::evaluate::Deliver;
use crate::project::Project;
use crate::settings::Settings;
#[cfg(doc)]
use crate::settings::SymmetrySettings;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(First, keep_current).add_systems(
        Update,
        // Before things take their places, and before anyone asks whether hands rest.
        reflect::reflect.in_set(StudioSet::Rebuild).before(Deliver),
    );
    app.init_resource::<reflect::Reflected>();
}

/// The project knows the images of this frame.
fn keep_current(settings: Res<Settings>, mut project: ResMut<Project>) {
    if settings.is_changed() || project.is_changed() {
        let now = images(&settings.symmetry);
        if project.images() != now {
            project.bypass_change_detection().set_images(now);
        }
    }
}
