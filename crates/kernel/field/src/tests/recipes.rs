use glam::{Vec2, Vec3};
use midair_mesh::{Aabb, MeshHash};
use proptest::prelude::*;

use super::{recipe, solid, zoo};
use crate::{
    MAX_DEPTH, Node, Op, Operand, Placement, Primitive, Program, Recipe, RecipeError, local_step,
};

const HERE: Placement = Placement::IDENTITY;

fn ball(radius: f32) -> Recipe {
    Primitive::Sphere { radius }.into()
}

fn nested(depth: u32) -> Recipe {
    (1..depth).fold(ball(0.1), |r, _| solid(&[(Op::Union, &r, HERE)]))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn written_and_read_it_has_the_same_name(r in recipe()) {
        let text = ron::to_string(&r).expect("writes");
        let again: Recipe = ron::from_str(&text).expect("reads");
        prop_assert_eq!(again.hash(), r.hash());
        let hash: crate::RecipeHash = r.hash().to_string().parse().expect("hex");
        prop_assert_eq!(hash, r.hash());
    }
}

#[test]
fn names_tell_recipes_apart() {
    let mut names: Vec<_> = zoo().into_iter().map(|p| Recipe::from(p).hash()).collect();
    for op in [Op::Union, Op::Intersect, Op::Subtract] {
        names.push(solid(&[(Op::Union, &ball(0.1), HERE), (op, &ball(0.2), HERE)]).hash());
    }
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count);
    let first = |op| solid(&[(op, &ball(0.1), HERE)]);
    assert_eq!(first(Op::Subtract), first(Op::Union));
    let zero = |x| solid(&[(Op::Union, &ball(0.1), Placement::at(Vec3::new(x, 0.0, 0.0)))]);
    assert_eq!(zero(0.0), zero(-0.0));
}

#[test]
fn a_component_is_what_it_holds() {
    let component = Recipe::new(Node::Component {
        id: "ball".into(),
        recipe: ball(0.1),
    });
    assert_eq!(component.bounds(), ball(0.1).bounds());
    let program = Program::compile(&component, &HERE, 0.01, &()).expect("sound");
    assert!((program.at(Vec3::X) - 0.9).abs() < 1e-6);
}

#[test]
fn boxes_follow_the_operators() {
    let far = Placement::at(Vec3::new(0.15, 0.0, 0.0));
    let of = |op| solid(&[(Op::Union, &ball(0.1), HERE), (op, &ball(0.1), far)]).bounds();
    assert!((of(Op::Union).max.x - 0.25).abs() < 1e-5);
    assert!((of(Op::Intersect).min.x - 0.05).abs() < 1e-5);
    assert!((of(Op::Subtract).max.x - 0.1).abs() < 1e-5);
    let away = Placement::at(Vec3::new(1.0, 0.0, 0.0));
    let none = solid(&[
        (Op::Union, &ball(0.1), HERE),
        (Op::Intersect, &ball(0.1), away),
    ]);
    assert!(none.bounds().is_empty());
    assert!(of(Op::Union).union(&Aabb::EMPTY) == of(Op::Union));
}

#[test]
fn meshes_are_found_once_each() {
    let mesh = |n: u8| {
        Recipe::new(Node::Foreign {
            tool: "t".into(),
            data: String::new(),
            mesh: MeshHash([n; 32]),
            bounds: Aabb::around(Vec3::ZERO, Vec3::ONE),
        })
    };
    let r = solid(&[
        (Op::Union, &mesh(2), HERE),
        (Op::Union, &mesh(1), HERE),
        (Op::Union, &mesh(2), HERE),
    ]);
    assert_eq!(r.meshes(), vec![MeshHash([1; 32]), MeshHash([2; 32])]);
    assert_eq!(r.leaves(), 3);
    // Doubling 60 times over is 2⁶⁰ leaves, but only 61 different recipes.
    let huge = (0..60).fold(ball(0.1), |r, _| {
        solid(&[(Op::Union, &r, HERE), (Op::Union, &r, HERE)])
    });
    assert!(huge.meshes().is_empty() && huge.validate().is_ok());
    let error = Program::compile(&huge, &HERE, 0.01, &()).expect_err("too many");
    assert!(error.to_string().contains("parts"));
}

#[test]
fn hostile_nesting_is_refused_not_followed() {
    assert!(nested(MAX_DEPTH).validate().is_ok());
    assert_eq!(nested(MAX_DEPTH + 1).validate(), Err(RecipeError::TooDeep));
    let layers = 100_000;
    let mut text = "Solid([(op:Union,recipe:".repeat(layers);
    text.push_str("Primitive(Sphere(radius:0.1))");
    text.push_str(&")])".repeat(layers));
    let options = ron::Options::default().without_recursion_limit();
    let error = options.from_str::<Recipe>(&text).expect_err("too deep");
    assert!(
        error.to_string().contains("nested more than 64 deep"),
        "{error}"
    );
    // The next one read on this thread starts from the surface again.
    let text = ron::to_string(&nested(10)).expect("writes");
    assert!(ron::from_str::<Recipe>(&text).is_ok());
}

#[test]
fn impossible_numbers_are_named() {
    let says = |p: Primitive, what: &str| {
        let error = p
            .validate()
            .err()
            .map(|e| e.to_string())
            .unwrap_or_default();
        assert!(
            error.contains(what) && !error.contains('\n'),
            "{p:?}: {error}"
        );
    };
    says(
        Primitive::Sphere { radius: f32::NAN },
        "sphere radius is NaN",
    );
    says(Primitive::Sphere { radius: -1.0 }, "sphere radius is -1");
    says(
        Primitive::Sphere {
            radius: f32::INFINITY,
        },
        "sphere radius is inf",
    );
    says(
        Primitive::Cuboid {
            half: Vec3::splat(0.1),
            rounding: 0.2,
        },
        "between 0 and 0.1",
    );
    says(
        Primitive::Frustum {
            bottom: 0.0,
            top: 0.0,
            half_height: 1.0,
        },
        "frustum radius",
    );
    says(
        Primitive::Helix {
            major: 0.1,
            minor: 0.01,
            pitch: 0.0,
            turns: 2.0,
        },
        "pitch",
    );
    says(
        Primitive::Revolution {
            contours: vec![vec![Vec2::new(-0.1, 0.0), Vec2::ONE, Vec2::Y]],
            rounding: 0.0,
        },
        "radius -0.1",
    );
    says(
        Primitive::Extrusion {
            contours: vec![vec![Vec2::ZERO, Vec2::ONE]],
            half_height: 0.1,
            rounding: 0.0,
        },
        "2 points",
    );
    let flat = Primitive::Convex {
        points: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y],
    };
    let error = Program::compile(&flat.into(), &HERE, 0.01, &()).expect_err("flat");
    assert!(error.to_string().contains("encloses nothing"));
    let unsound = Operand {
        op: Op::Union,
        placement: Placement {
            scale: Vec3::new(1.0, 0.0, 1.0),
            ..HERE
        },
        recipe: ball(0.1),
        muted: false,
    };
    let text = ron::to_string(&Node::Solid(vec![unsound])).expect("writes");
    let error = ron::from_str::<Recipe>(&text).expect_err("unsound");
    assert!(error.to_string().contains("operand 1"));
}

#[test]
fn local_steps_are_shared() {
    assert_eq!(local_step(0.01, 1.0), 0.01);
    assert_eq!(local_step(0.02, 1.0), 0.01);
    assert_eq!(local_step(0.006, 1.0), 0.005);
    assert_eq!(local_step(0.01, 1.3), local_step(0.01, 1.4));
    assert!((0.005..=0.01 / 1.4).contains(&local_step(0.01, 1.4)));
    assert_eq!(local_step(0.01, 1.5), 0.005);
    assert_eq!(local_step(0.0025, 1.0), 0.0025);
    assert!(local_step(1e-9, 1.0) >= 0.01 / 64.0);
}

#[test]
fn a_muted_operand_leaves_the_solid_without_it() {
    let operand = |op, x: f32, muted| Operand {
        op,
        placement: Placement::at(Vec3::new(x, 0.0, 0.0)),
        recipe: ball(0.1),
        muted,
    };
    let solid = |operands| Recipe::new(Node::Solid(operands));
    let with = solid(vec![
        operand(Op::Union, 3.0, true),
        operand(Op::Subtract, 0.0, false),
        operand(Op::Intersect, 5.0, true),
        operand(Op::Union, 0.1, false),
    ]);
    // What is not muted first is what the others join, whatever its sign.
    let without = solid(vec![
        operand(Op::Union, 0.0, false),
        operand(Op::Union, 0.1, false),
    ]);
    assert_eq!(with.bounds(), without.bounds());
    assert_ne!(with.hash(), without.hash());
    let (a, b) = (super::compile(&with), super::compile(&without));
    for i in -20..20 {
        let p = Vec3::new(0.013 * i as f32, 0.04, -0.02);
        assert_eq!(a.at(p), b.at(p));
    }
    let none = solid(vec![operand(Op::Union, 0.0, true)]);
    assert!(super::compile(&none).bounds().is_empty());
}

#[test]
fn a_recipe_from_before_operands_could_be_muted_is_read_and_written_the_same() {
    let one = Recipe::new(Node::Solid(vec![Operand {
        op: Op::Union,
        placement: Placement::IDENTITY,
        recipe: ball(0.1),
        muted: false,
    }]));
    let text = ron::to_string(&one).expect("writes");
    assert!(!text.contains("muted"), "{text}");
    assert_eq!(ron::from_str::<Recipe>(&text).expect("reads"), one);
}
