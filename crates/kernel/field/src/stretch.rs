use glam::{Vec2, Vec3};

use crate::Primitive;

/// The primitive that is `p` scaled by positive factors along its own axes, where there is one.
pub(crate) fn stretched(p: &Primitive, s: Vec3) -> Option<Primitive> {
    let about_y = (s.x - s.z).abs() <= 1.0e-6 * s.x;
    let plane = |contours: &[Vec<Vec2>], by: Vec2| {
        let ring = |c: &Vec<Vec2>| c.iter().map(|p| p * by).collect();
        contours.iter().map(ring).collect()
    };
    Some(match p {
        Primitive::Sphere { radius } => Primitive::Ellipsoid { half: s * radius },
        Primitive::Ellipsoid { half } => Primitive::Ellipsoid { half: s * half },
        Primitive::Cuboid { half, rounding } if *rounding == 0.0 => Primitive::Cuboid {
            half: s * half,
            rounding: 0.0,
        },
        Primitive::Cylinder {
            radius,
            half_height,
            rounding,
        } if about_y && *rounding == 0.0 => Primitive::Cylinder {
            radius: radius * s.x,
            half_height: half_height * s.y,
            rounding: 0.0,
        },
        Primitive::Frustum {
            bottom,
            top,
            half_height,
        } if about_y => Primitive::Frustum {
            bottom: bottom * s.x,
            top: top * s.x,
            half_height: half_height * s.y,
        },
        Primitive::Extrusion {
            contours,
            half_height,
            rounding,
        } if *rounding == 0.0 => Primitive::Extrusion {
            contours: plane(contours, s.truncate()),
            half_height: half_height * s.z,
            rounding: 0.0,
        },
        Primitive::Revolution { contours, rounding } if about_y && *rounding == 0.0 => {
            Primitive::Revolution {
                contours: plane(contours, s.truncate()),
                rounding: 0.0,
            }
        }
        Primitive::Convex { points } => Primitive::Convex {
            points: points.iter().map(|p| p * s).collect(),
        },
        _ => return None,
    })
}
