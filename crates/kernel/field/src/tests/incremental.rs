use glam::Vec3;
use proptest::prelude::*;

use super::{STEP, compile, leaf, op, placement, recipe, solid};
use crate::{Brick, FuseOptions, Grid, Op, Operand, Placement, Recipe, changed_box, fuse, refuse};

fn sequence() -> impl Strategy<Value = Vec<(Op, Recipe, Placement)>> {
    prop::collection::vec((op(), recipe(), placement()), 1..5)
}

fn of(parts: &[(Op, Recipe, Placement)]) -> Recipe {
    let refs: Vec<_> = parts.iter().map(|(o, r, p)| (*o, r, *p)).collect();
    solid(&refs)
}

/// What a surface and its normals are made from: signs everywhere, values near the surface.
fn same_surface(a: &Grid, b: &Grid) -> Result<(), TestCaseError> {
    let mut coords = a.sorted_coords();
    coords.extend(b.sorted_coords());
    for c in coords {
        for n in crate::grid::cube(c * 8, 8) {
            prop_assert_eq!(a.is_inside(n), b.is_inside(n), "node {}", n);
        }
        if let (Some(Brick::Values { values: v, .. }), Some(Brick::Values { values: w, .. })) =
            (a.brick(c), b.brick(c))
        {
            for (x, y) in v.iter().zip(w.iter()) {
                prop_assert!(x == y || x.abs().min(y.abs()) > 2.0 * STEP, "{} {}", x, y);
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn an_edit_gives_what_a_fresh_start_gives(
        parts in sequence(), which in 0usize..4, kind in 0..4, new in leaf(), at in placement(), how in op(),
    ) {
        let mut edited = parts.clone();
        let i = which % parts.len();
        match kind {
            0 => edited[i].2 = at,
            1 => edited[i].0 = how,
            2 => edited.insert(i, (how, new, at)),
            _ => { edited.remove(i); }
        }
        let (before, after) = (compile(&of(&parts)), compile(&of(&edited)));
        let options = FuseOptions::default();
        let old = fuse(&before, &options).expect("fits");
        let mut grid = old.clone();
        let changed = refuse(&mut grid, &after, &changed_box(&before, &after), &options).expect("fits");
        same_surface(&grid, &fuse(&after, &options).expect("fits"))?;
        let mut all = old.sorted_coords();
        all.extend(grid.sorted_coords());
        for c in all {
            prop_assert_eq!(old.brick(c) != grid.brick(c), changed.contains(&c));
        }
    }
}

#[test]
fn only_the_moved_part_is_done_again() {
    let ball: Recipe = crate::Primitive::Sphere { radius: 0.1 }.into();
    let row = |y: f32| {
        let part = |i: i32| Operand {
            op: Op::Union,
            placement: Placement::at(Vec3::new(0.3 * i as f32, if i == 4 { y } else { 0.0 }, 0.0)),
            recipe: ball.clone(),
            muted: false,
        };
        Recipe::new(crate::Node::Solid((0..20).map(part).collect()))
    };
    let (before, after) = (compile(&row(0.0)), compile(&row(0.05)));
    let dirty = changed_box(&before, &after);
    assert!(dirty.size().x < 0.2 + 10.0 * STEP);
    let options = FuseOptions::default();
    let mut grid = fuse(&before, &options).expect("fits");
    let all = grid.bricks().count();
    let changed = refuse(&mut grid, &after, &dirty, &options).expect("fits");
    assert!(!changed.is_empty() && changed.len() * 5 < all);
    assert!(changed_box(&after, &after).is_empty());
}
