//! Mirror images and turned copies.

use bevy::math::{Quat, Vec3};
use midair_field::Placement;

use super::Axis;

/// The mirror image of a place in the plane through the origin with this normal.
///
/// A mirror image is no rigid motion: M R S = (M R M)(M S), a rotation and a scale that is negative
/// along one axis.
pub fn mirrored(placement: &Placement, axis: Axis) -> Placement {
    let flip = Vec3::ONE - 2.0 * axis.unit();
    let [x, y, z, w] = placement.rotation.to_array();
    // M R M keeps the part of the axis along the normal and turns the others round.
    let v = -Vec3::new(x, y, z) * flip;
    Placement {
        translation: placement.translation * flip,
        rotation: Quat::from_xyzw(v.x, v.y, v.z, w),
        scale: placement.scale * flip,
    }
}

/// A place turned by `angle` radians about the vertical through the origin.
pub fn turned(placement: &Placement, angle: f32) -> Placement {
    let turn = Quat::from_rotation_y(angle);
    Placement {
        translation: turn * placement.translation,
        rotation: (turn * placement.rotation).normalize(),
        scale: placement.scale,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirror_image_is_where_a_mirror_shows_it() {
        let placement = Placement {
            translation: Vec3::new(0.3, -0.2, 0.7),
            rotation: Quat::from_euler(bevy::math::EulerRot::XYZ, 0.4, -1.1, 2.0),
            scale: Vec3::new(1.0, 2.0, 0.5),
        };
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            let flip = Vec3::ONE - 2.0 * axis.unit();
            let image = mirrored(&placement, axis);
            assert!(image.is_sound());
            for p in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.2, -0.4, 0.9)] {
                let seen = placement.affine().transform_point3(p) * flip;
                // The thing itself is mirrored along the same axis of its own.
                assert!(image.affine().transform_point3(p).distance(seen) < 1e-5);
            }
            assert_eq!(mirrored(&image, axis).scale, placement.scale);
        }
    }

    #[test]
    fn a_full_turn_comes_back() {
        let placement = Placement::at(Vec3::new(1.0, 0.5, 0.0));
        let there = turned(&placement, std::f32::consts::TAU);
        assert!(there.translation.distance(placement.translation) < 1e-5);
    }
}
