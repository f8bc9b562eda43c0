use bevy::math::{Affine3A, Mat3A, Quat, Vec3, Vec3A};
use midair_field::Placement;

use crate::objects::{Axis, mirrored, turned};
use crate::settings::{MirrorPlane, SymmetrySettings};

/// The most copies around the vertical, the first included.
pub const MOST: u32 = 64;

/// One copy that symmetry makes: mirrored first, then turned about the vertical, both about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Image {
    mirror: Option<Axis>,
    /// Radians.
    angle: f32,
}

impl Image {
    /// The image of a point, in metres.
    pub fn point(&self, point: Vec3) -> Vec3 {
        let flipped = self.mirror.map_or(point, |axis| point * flip(axis));
        Quat::from_rotation_y(self.angle) * flipped
    }

    /// The image of a direction or a displacement.
    pub fn vector(&self, vector: Vec3) -> Vec3 {
        self.point(vector)
    }

    /// The image of where an object stands; a mirrored one has a negative scale along one axis.
    pub fn placement(&self, placement: &Placement) -> Placement {
        let placement = self
            .mirror
            .map_or(*placement, |axis| mirrored(placement, axis));
        if self.angle == 0.0 {
            placement
        } else {
            turned(&placement, self.angle)
        }
    }

    /// The whole of it as a map of the world onto itself.
    pub fn affine(&self) -> Affine3A {
        let flip = self.mirror.map_or(Vec3::ONE, flip);
        let turn = Mat3A::from_quat(Quat::from_rotation_y(self.angle));
        Affine3A {
            matrix3: turn * Mat3A::from_diagonal(flip),
            translation: Vec3A::ZERO,
        }
    }
}

fn flip(axis: Axis) -> Vec3 {
    Vec3::ONE - 2.0 * axis.unit()
}

/// Every image but the thing itself; none while symmetry is off.
pub fn images(settings: &SymmetrySettings) -> Vec<Image> {
    let mirror = match settings.mirror {
        MirrorPlane::None => None,
        MirrorPlane::X => Some(Axis::X),
        MirrorPlane::Y => Some(Axis::Y),
        MirrorPlane::Z => Some(Axis::Z),
    };
    let count = settings.count.clamp(1, MOST);
    let turns = (0..count).map(|i| std::f32::consts::TAU * i as f32 / count as f32);
    let both = turns.flat_map(|angle| {
        [None, mirror]
            .into_iter()
            .take(1 + usize::from(mirror.is_some()))
            .map(move |mirror| Image { mirror, angle })
    });
    // The first is the thing itself.
    both.skip(1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(mirror: MirrorPlane, count: u32) -> SymmetrySettings {
        SymmetrySettings {
            mirror,
            count,
            ..SymmetrySettings::default()
        }
    }

    #[test]
    fn there_are_as_many_as_the_symmetry_has_and_no_senseless_number_of_them() {
        for (mirror, count, number) in [
            (MirrorPlane::None, 1, 0),
            (MirrorPlane::None, 0, 0),
            (MirrorPlane::X, 1, 1),
            (MirrorPlane::None, 6, 5),
            (MirrorPlane::Z, 4, 7),
            (MirrorPlane::Y, u32::MAX, 127),
        ] {
            let found = images(&settings(mirror, count));
            assert_eq!(found.len(), number, "{mirror:?} {count}");
        }
    }

    #[test]
    fn an_image_of_an_image_is_an_image() {
        let placement = Placement {
            translation: Vec3::new(0.3, 0.1, -0.2),
            rotation: Quat::from_euler(bevy::math::EulerRot::XYZ, 0.4, -1.1, 2.0),
            scale: Vec3::new(1.0, 2.0, 0.5),
        };
        for mirror in [MirrorPlane::X, MirrorPlane::Y, MirrorPlane::Z] {
            let all = images(&settings(mirror, 5));
            let orbit: Vec<_> = std::iter::once(placement)
                .chain(all.iter().map(|i| i.placement(&placement)))
                .collect();
            for image in &all {
                for standing in &orbit {
                    let there = image.placement(standing);
                    let known = orbit.iter().any(|p| {
                        p.translation.distance(there.translation) < 1e-5
                            && p.rotation.angle_between(there.rotation) < 2e-3
                            && p.scale.distance(there.scale) < 1e-5
                    });
                    assert!(known, "{mirror:?}");
                }
            }
        }
    }

    #[test]
    fn a_place_goes_where_its_points_go() {
        let placement = Placement {
            translation: Vec3::new(0.3, 0.1, -0.2),
            rotation: Quat::from_rotation_x(0.7),
            scale: Vec3::new(1.0, 2.0, 0.5),
        };
        for image in images(&settings(MirrorPlane::Y, 3)) {
            let there = image.placement(&placement).affine();
            let map = image.affine();
            for p in [Vec3::X, Vec3::Y, Vec3::new(0.2, -0.4, 0.9)] {
                let seen = image.point(placement.affine().transform_point3(p));
                assert!(there.transform_point3(p).distance(seen) < 1e-5);
                assert!(map.transform_point3(p).distance(image.point(p)) < 1e-5);
            }
        }
    }
}
