//! Where a picked component appears: on the work plane where one looks, beside what is there.

use bevy::prelude::*;
use midair_field::Placement;
use midair_studio::{
    plane::WorkPlane,
    project::Project,
    snap::{box_of, own_box},
};

/// Metres left between neighbours.
const GAP: f32 = 0.05;
/// How many steps to each side are tried.
const STEPS: i32 = 6;

/// A box in world metres.
pub(crate) type Corners = (Vec3, Vec3);

/// The place nearest to where `towards` meets the work plane (the ground, unless it is in use) at which a thing from `low` to `high` about its
/// origin stands in nothing else's way: first to the sides, then nearer and farther.
pub(crate) fn free_spot(
    project: &Project,
    plane: &WorkPlane,
    (low, high): Corners,
    eye: &Transform,
    towards: Ray3d,
) -> Vec3 {
    let plane = if plane.shown {
        *plane
    } else {
        WorkPlane::default()
    };
    let met = plane
        .meet(&towards, 12.0)
        .unwrap_or_else(|| towards.get_point(1.5));
    // How far its box reaches below its origin, as the plane sees it.
    let upright = Placement {
        rotation: plane.rotation.inverse(),
        ..Placement::IDENTITY
    };
    let beneath = box_of(&upright, (low, high)).0.y;
    // On the lines of the plane, and beside each other along them.
    let lines = plane.to_local(met);
    let middle = plane.to_world(((lines / GAP).round() * GAP).with_y(-beneath));
    let right = axis(plane.rotation.inverse() * *eye.right());
    let ahead = plane.rotation * Vec3::Y.cross(right);
    let right = plane.rotation * right;
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

/// Where a thing from `low` to `high` about its origin rests on a face, its box touching it at `point`.
pub(crate) fn against((low, high): Corners, point: Vec3, normal: Vec3) -> Vec3 {
    let upright = normal.y > 0.7;
    // On something that faces up it stands on its foot, centred; else its side lies against the face.
    let normal = if upright { Vec3::Y } else { normal };
    let middle = 0.5 * (low + high);
    let reach = (0.5 * (high - low)).dot(normal.abs());
    point + normal * reach - middle
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
    let objects = project.document().objects();
    objects
        .filter_map(|(_, object)| Some(box_of(&object.placement, own_box(project, object)?)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_let_go_over_a_face_rests_on_it() {
        let corners = (Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.4, 0.1));
        let on_top = against(corners, Vec3::new(1.0, 0.5, 0.0), Vec3::new(0.1, 0.99, 0.0));
        assert!(on_top.distance(Vec3::new(1.0, 0.5, 0.0)) < 1e-6, "{on_top}");
        let beside = against(corners, Vec3::ZERO, Vec3::X);
        assert!((beside.x - 0.1).abs() < 1e-6, "{beside}");
    }
}
