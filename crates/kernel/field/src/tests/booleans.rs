use glam::{IVec3, Vec3};
use proptest::prelude::*;

use super::{STEP, compile, placement, recipe, solid};
use crate::scratch::EXACT;
use crate::{Brick, FuseOptions, Grid, Node, Op, Placement, Primitive, Recipe, fuse};

const HERE: Placement = Placement::IDENTITY;

fn field(recipe: &Recipe) -> Grid {
    fuse(&compile(recipe), &FuseOptions::default()).expect("fits")
}

/// Every node whose sign the two fields disagree on, within the reach of test solids.
fn differs(a: &Grid, b: &Grid) -> Option<IVec3> {
    let mut coords = a.sorted_coords();
    coords.extend(b.sorted_coords());
    let nodes = coords.into_iter().flat_map(|c| crate::grid::cube(c * 8, 8));
    nodes
        .into_iter()
        .find(|&n| a.is_inside(n) != b.is_inside(n))
}

fn everything() -> Recipe {
    Primitive::Cuboid {
        half: Vec3::splat(1.5),
        rounding: 0.0,
    }
    .into()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A ∩ B is the complement of the union of the complements.
    #[test]
    fn de_morgan(a in recipe(), b in recipe(), at in placement()) {
        let not = |r: &Recipe, p| solid(&[(Op::Union, &everything(), HERE), (Op::Subtract, r, p)]);
        let both = solid(&[(Op::Union, &a, HERE), (Op::Intersect, &b, at)]);
        let either = solid(&[(Op::Union, &not(&a, HERE), HERE), (Op::Union, &not(&b, at), HERE)]);
        prop_assert_eq!(differs(&field(&both), &field(&not(&either, HERE))), None);
    }

    #[test]
    fn union_with_itself_is_itself(a in recipe()) {
        let (once, twice) = (field(&a), field(&solid(&[(Op::Union, &a, HERE), (Op::Union, &a, HERE)])));
        prop_assert_eq!(once.sorted_coords(), twice.sorted_coords());
        for (c, brick) in once.bricks() {
            match (brick, twice.brick(c)) {
                (Brick::Values { values: v, .. }, Some(Brick::Values { values: w, .. })) => {
                    // Further away an operand may be left out of one of the two.
                    let mut pairs = v.iter().zip(w.iter());
                    prop_assert!(pairs.all(|(x, y)| x == y || x.min(*y) >= EXACT * STEP));
                }
                (brick, other) => prop_assert_eq!(Some(brick), other),
            }
        }
    }

    /// (A − B) ∪ (A ∩ B) = A.
    #[test]
    fn subtract_then_union(a in recipe(), b in recipe(), at in placement()) {
        let left = solid(&[(Op::Union, &a, HERE), (Op::Subtract, &b, at)]);
        let cut = solid(&[(Op::Union, &a, HERE), (Op::Intersect, &b, at)]);
        let again = field(&solid(&[(Op::Union, &left, HERE), (Op::Union, &cut, HERE)]));
        let whole = field(&a);
        // At |φ| = 0 both parts are lifted to the outside.
        if let Some(n) = differs(&again, &whole) {
            let (p, q) = (compile(&a), compile(&solid(&[(Op::Union, &b, at)])));
            let at = n.as_vec3() * STEP;
            prop_assert!(p.at(at).abs().min(q.at(at).abs()) < 2e-4 * STEP, "at {}", n);
        }
    }

    #[test]
    fn moving_all_moves_the_field(a in recipe(), b in recipe(), op in super::op(), n in [-9i32..9, -9i32..9, -9i32..9]) {
        let by = Placement::at(IVec3::from(n).as_vec3() * 8.0 * STEP);
        let here = field(&solid(&[(Op::Union, &a, HERE), (op, &b, HERE)]));
        let there = field(&solid(&[(Op::Union, &a, by), (op, &b, by)]));
        for (c, brick) in here.bricks() {
            if let (Brick::Values { values: v, .. }, Some(Brick::Values { values: w, .. })) =
                (brick, there.brick(c + IVec3::from(n)))
            {
                for (x, y) in v.iter().zip(w.iter()) {
                    prop_assert!((x - y).abs() < 1e-5);
                }
            }
        }
        prop_assert!(here.bricks().count().abs_diff(there.bricks().count()) <= here.bricks().count() / 50);
    }
}

#[test]
fn nothing_is_nothing() {
    let none = Recipe::new(Node::Solid(Vec::new()));
    let ball: Recipe = Primitive::Sphere { radius: 0.1 }.into();
    let count = |op, a: &Recipe, b: &Recipe| {
        field(&solid(&[(Op::Union, a, HERE), (op, b, HERE)]))
            .bricks()
            .count()
    };
    let whole = field(&ball).bricks().count();
    assert_eq!(count(Op::Union, &none, &ball), whole);
    assert_eq!(count(Op::Union, &ball, &none), whole);
    assert_eq!(count(Op::Subtract, &ball, &none), whole);
    assert_eq!(count(Op::Intersect, &ball, &none), 0);
    assert_eq!(count(Op::Intersect, &none, &ball), 0);
    assert_eq!(count(Op::Subtract, &none, &ball), 0);
    assert!(compile(&none).bounds().is_empty());
    let rest = solid(&[
        (Op::Union, &ball, HERE),
        (Op::Intersect, &none, HERE),
        (Op::Union, &ball, HERE),
    ]);
    assert_eq!(field(&rest).bricks().count(), whole);
}
