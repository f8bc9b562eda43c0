//! Where a picked component appears: on the ground where one looks, beside what is there.

use bevy::prelude::*;
use midair_studio::{document::Kind, project::Project};

/// Metres left between neighbours.
const GAP: f32 = 0.05;
/// How many steps to each side are tried.
const STEPS: i32 = 6;

/// A box in world metres.
pub(crate) type Corners = (Vec3, Vec3);

/// The place nearest to where `towards` meets the ground at which a thing from `low` to `high` about its
/// origin stands in nothing else's way: first to the sides, then nearer and farther.
pub(crate) fn free_spot(
    project: &Project,
    (low, high): Corners,
    eye: &Transform,
    towards: Ray3d,
) -> Vec3 {
    let reach = towards
        .intersect_plane(Vec3::ZERO, InfinitePlane3d::new(Vec3::Y))
        .filter(|&d| d > 0.0 && d < 12.0)
        .unwrap_or(1.5);
    // On the lines of the ground, and beside each other along them.
    let middle = ((towards.get_point(reach) / GAP).round() * GAP).with_y(-low.y);
    let right = axis(*eye.right());
    let ahead = Vec3::Y.cross(right);
    let size = high - low;
    let step = ((0.25 * (size.x.max(size.z) + GAP)) / GAP).ceil() * GAP;
    let taken = taken(project);
    let mut tries: Vec<(i32, i32)> = (-STEPS..=STEPS)
        .flat_map(|z| (-2 * STEPS..=2 * STEPS).map(move |x| (x, z)))
        .collect();
    // Sideways counts less than nearer or farther: a row is easier to see than a file.
    tries.sort_by_key(|&(x, z)| (x * x + 3 * z * z, -x, z));
    tries
        .into_iter()
        .map(|(x, z)| middle + step * (x as f32 * right + z as f32 * ahead))
        .find(|&spot| {
            let (a, b) = (spot + low - 0.5 * GAP, spot + high + 0.5 * GAP);
            !taken
                .iter()
                .any(|(c, d)| a.cmplt(*d).all() && b.cmpgt(*c).all())
        })
        .unwrap_or(middle)
}

/// The level axis of the world that is nearest to a direction.
fn axis(direction: Vec3) -> Vec3 {
    if direction.x.abs() >= direction.z.abs() {
        Vec3::X * direction.x.signum()
    } else {
        Vec3::Z * direction.z.signum()
    }
}

/// The boxes of everything that is there.
fn taken(project: &Project) -> Vec<Corners> {
    let document = project.document();
    document
        .objects()
        .filter_map(|(_, object)| {
            let (low, high) = match &object.kind {
                Kind::Solid(recipe) => (recipe.bounds().min, recipe.bounds().max),
                Kind::Foreign { mesh, .. } => {
                    let bounds = project.mesh(mesh)?.bounds();
                    (bounds.min, bounds.max)
                }
            };
            if !low.cmple(high).all() {
                return None;
            }
            let affine = object.placement.affine();
            let centre = affine.transform_point3(low.midpoint(high));
            let half = 0.5 * (high - low);
            let turned = affine.matrix3;
            let reach = Vec3::from(
                turned.x_axis.abs() * half.x
                    + turned.y_axis.abs() * half.y
                    + turned.z_axis.abs() * half.z,
            );
            Some((centre - reach, centre + reach))
        })
        .collect()
}
