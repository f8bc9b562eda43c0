//! What goes along when a hand moves one object.

use bevy::math::Affine3A;
use midair_document::{Document, ObjectId};
use midair_field::Placement;

use super::picked;

/// The other objects that move with one: its group, and all that is selected where it is selected
/// itself. Locked ones stay.
pub fn companions(document: &Document, selection: &[ObjectId], object: ObjectId) -> Vec<ObjectId> {
    let mut with = picked(document, object);
    if selection.contains(&object) {
        for &id in selection {
            if !with.contains(&id) && document.object(id).is_some() {
                with.push(id);
            }
        }
    }
    with.retain(|&id| id != object && !document.is_locked(id));
    with
}

/// Where a companion stands when what it accompanies went from `before` to `after`: moved and turned
/// with it, its scale its own.
pub fn carried(before: &Placement, after: &Placement, companion: &Placement) -> Placement {
    let rigid = |p: &Placement| Affine3A::from_rotation_translation(p.rotation, p.translation);
    let moved = rigid(after) * rigid(before).inverse() * rigid(companion);
    let (_, rotation, translation) = moved.to_scale_rotation_translation();
    Placement {
        translation,
        // Products drift off the unit sphere.
        rotation: rotation.normalize(),
        scale: companion.scale,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::{Quat, Vec3};

    #[test]
    fn a_companion_keeps_its_place_beside_what_is_moved() {
        let before = Placement::at(Vec3::X);
        let after = Placement {
            rotation: Quat::from_rotation_y(std::f32::consts::FRAC_PI_2),
            ..Placement::at(Vec3::new(1.0, 2.0, 0.0))
        };
        let companion = Placement {
            scale: Vec3::splat(0.5),
            ..Placement::at(Vec3::X * 2.0)
        };
        let there = carried(&before, &after, &companion);
        assert!(there.translation.distance(Vec3::new(1.0, 2.0, -1.0)) < 1e-6);
        assert_eq!(there.scale, companion.scale);
    }
}
