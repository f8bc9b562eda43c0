//! Where an operand stands once it is taken out of its solid.

use midair_field::{Node, Op, Operand, Placement, Recipe};

/// The same solid, standing in the world: a recipe and a placement. `outer` is where the whole stands.
///
/// A turned thing within a whole that is scaled unevenly is skewed; no placement can say that, so
/// it keeps its own within a solid of one.
pub(super) fn outside(outer: &Placement, operand: &Operand) -> (Recipe, Placement) {
    let (inner, scale) = (&operand.placement, outer.scale);
    let even = scale.x == scale.y && scale.y == scale.z;
    // Mirrored evenly in all three it is no rotation any more, but still a placement.
    if even {
        let placement = Placement {
            translation: outer.translation + outer.rotation * (scale * inner.translation),
            rotation: (outer.rotation * inner.rotation).normalize(),
            scale: scale * inner.scale,
        };
        return (operand.recipe.clone(), placement);
    }
    let one = Operand {
        op: Op::Union,
        muted: false,
        ..operand.clone()
    };
    (Recipe::new(Node::Solid(vec![one])), *outer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::{Affine3A, Quat, Vec3};
    use midair_field::Primitive;

    fn matrix(recipe: &Recipe, placement: &Placement) -> Affine3A {
        match recipe.node() {
            Node::Solid(one) => placement.affine() * one[0].placement.affine(),
            _ => placement.affine(),
        }
    }

    #[test]
    fn what_is_taken_out_stands_where_it_stood() {
        let inner = Placement {
            translation: Vec3::new(0.1, -0.2, 0.3),
            rotation: Quat::from_rotation_x(0.7),
            scale: Vec3::new(1.0, 2.0, 0.5),
        };
        let operand = Operand {
            op: Op::Subtract,
            placement: inner,
            recipe: Primitive::Sphere { radius: 0.1 }.into(),
            muted: true,
        };
        for scale in [
            Vec3::ONE,
            Vec3::splat(2.0),
            Vec3::splat(-1.0),
            Vec3::new(1.0, 3.0, 1.0),
        ] {
            let outer = Placement {
                translation: Vec3::new(1.0, 1.0, 0.0),
                rotation: Quat::from_rotation_z(0.4),
                scale,
            };
            let (recipe, placement) = outside(&outer, &operand);
            let wanted = outer.affine() * inner.affine();
            assert!(
                matrix(&recipe, &placement).abs_diff_eq(wanted, 1e-5),
                "{scale}"
            );
        }
    }
}
