//! Reference images: pictures that stand in the room to work from.
//!
//! They are brought in by [`Command::Reference`](crate::command::Command::Reference), travel in the
//! document, and are objects like others: moved, scaled, hidden, locked, undone. They are no operands and
//! no part of what is exported.

mod read;
mod show;

use bevy::prelude::*;
use midair_document::{ImageHash, Kind, Object, Reference};
use midair_field::Placement;

pub(crate) use read::read;

/// The longer side of a picture that was just brought in, in metres.
const SIDE: f32 = 0.6;

/// Where pictures stand that are brought in without a place: behind the work.
pub(crate) const BEHIND: Vec3 = Vec3::new(0.0, 0.0, -0.5);

/// The object that shows a picture, standing upright on `at`, the ground behind the work where `None`.
pub(crate) fn object(
    name: String,
    image: ImageHash,
    (width, height): (u32, u32),
    at: Option<Vec3>,
) -> Object {
    let per_pixel = SIDE / width.max(height).max(1) as f32;
    let (least, most) = Reference::SIZES;
    let size = [width, height].map(|pixels| (pixels as f32 * per_pixel).clamp(least, most));
    let foot = at.filter(|a| a.is_finite()).unwrap_or(BEHIND);
    let reference = Reference {
        image,
        size,
        opacity: 1.0,
    };
    Object::new(name, Kind::Reference(reference))
        .placed(Placement::at(foot + 0.5 * size[1] * Vec3::Y))
}

pub(crate) fn plugin(app: &mut App) {
    show::plugin(app);
}
