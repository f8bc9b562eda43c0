//! Sharp edges are put back where the field has them, and nowhere else.

mod common;

use std::sync::atomic::AtomicBool;

use common::{Random, assert_sound};
use glam::{Quat, Vec3};
use midair_field::{FuseOptions, Node, Op, Operand, Placement, Primitive, Program, Recipe, fuse};
use midair_mesh::TriMesh;
use midair_surface::{Cancelled, Surface, crisp, crisp_unless};
use proptest::prelude::*;

const STEP: f32 = 0.01;

fn both(recipe: &Recipe, placement: &Placement, step: f32) -> (TriMesh, TriMesh) {
    let program = Program::compile(recipe, placement, step, &()).unwrap();
    let grid = fuse(&program, &FuseOptions::default()).unwrap();
    let plain = Surface::extract(&grid).mesh();
    (plain.clone(), crisp(plain, &program))
}

fn operand(op: Op, primitive: Primitive, placement: Placement) -> Operand {
    Operand {
        op,
        placement,
        recipe: primitive.into(),
        muted: false,
    }
}

fn cylinder(radius: f32, half_height: f32) -> Primitive {
    Primitive::Cylinder {
        radius,
        half_height,
        rounding: 0.0,
    }
}

/// The cup's body: a cylinder without a narrower one.
fn bored() -> Recipe {
    Recipe::new(Node::Solid(vec![
        operand(Op::Union, cylinder(0.1, 0.12), Placement::IDENTITY),
        operand(
            Op::Subtract,
            cylinder(0.083, 0.12),
            Placement::at(Vec3::new(0.0, 0.0171, 0.0)),
        ),
    ]))
}

/// Vertices that crisping added.
fn added<'m>(plain: &TriMesh, crisped: &'m TriMesh) -> &'m [Vec3] {
    &crisped.positions[plain.positions.len()..]
}

#[test]
fn the_rims_of_a_bore_are_the_circles_they_should_be() {
    let (plain, mesh) = both(&bored(), &Placement::IDENTITY, STEP);
    assert_sound(&mesh);
    let mut rims = [0; 4];
    for p in added(&plain, &mesh) {
        let r = p.x.hypot(p.z);
        let on = [(0.1, 0.12), (0.1, -0.12), (0.083, 0.12), (0.083, -0.1029)]
            .map(|(radius, y): (f32, f32)| (r - radius).abs().max((p.y - y).abs()));
        let nearest = (0..4).min_by(|&a, &b| on[a].total_cmp(&on[b])).unwrap();
        assert!(on[nearest] < 0.01 * STEP, "{p} is {} off", on[nearest]);
        rims[nearest] += 1;
    }
    // As many points to a rim as a circle crosses cells, about.
    assert!(rims.iter().all(|&n| n > 60), "{rims:?}");
    // Nothing of the chamfer is left: as much volume as the solid has but for the facets of its curves.
    let exact = std::f64::consts::PI * (0.01 * 0.24 - 0.083f64.powi(2) * (0.12 + 0.1029));
    let off = |m: &TriMesh| (m.volume() / exact - 1.0).abs();
    assert!(off(&mesh) < 3e-3, "{}", off(&mesh));
    assert!(
        off(&mesh) < 0.2 * off(&plain),
        "{} of {}",
        off(&mesh),
        off(&plain)
    );
}

#[test]
fn a_turned_box_gets_its_edges_and_its_eight_corners() {
    let half = Vec3::new(0.1, 0.07, 0.05);
    let cuboid = Primitive::Cuboid {
        half,
        rounding: 0.0,
    };
    let mut r = Random(11);
    let (mut found, mut worst) = (0, 0.0f64);
    for _ in 0..20 {
        let turn = Quat::from_euler(
            glam::EulerRot::XYZ,
            3.0 * r.signed(),
            3.0 * r.signed(),
            3.0 * r.signed(),
        );
        let placement = Placement {
            rotation: turn,
            ..Placement::at(0.05 * Vec3::new(r.signed(), r.signed(), r.signed()))
        };
        let (plain, mesh) = both(&cuboid.clone().into(), &placement, STEP);
        assert_sound(&mesh);
        let exact = 8.0 * f64::from(half.x * half.y * half.z);
        let off = (mesh.volume() / exact - 1.0).abs();
        let corners = (0..8).filter(|i| {
            let sign = Vec3::new(
                if i & 1 == 0 { 1.0 } else { -1.0 },
                if i & 2 == 0 { 1.0 } else { -1.0 },
                if i & 4 == 0 { 1.0 } else { -1.0 },
            );
            let corner = turn * (sign * half) + placement.translation;
            added(&plain, &mesh)
                .iter()
                .any(|p| p.distance(corner) < 0.05 * STEP)
        });
        found += corners.count();
        worst = worst.max(off);
    }
    assert!(worst < 5e-4, "{worst}");
    // Nearly all: where a lattice cuts a corner so that two of its sides have no vertex in common, it stays blunt.
    assert!(found > 144, "{found} corners of 160");
}

#[test]
fn what_is_round_stays_as_it_was() {
    for primitive in [
        Primitive::Sphere { radius: 0.1 },
        Primitive::Torus {
            major: 0.1,
            minor: 0.03,
        },
        Primitive::Capsule {
            radius: 0.04,
            half_height: 0.1,
        },
    ] {
        let (plain, mesh) = both(&primitive.into(), &Placement::IDENTITY, STEP);
        assert_eq!(plain, mesh);
    }
}

fn any_solid(r: &mut Random, many: usize) -> Recipe {
    let mut at = |size: f32| Vec3::new(r.signed(), r.signed(), r.signed()) * size;
    let mut operands = Vec::new();
    for i in 0..many {
        let s = 0.03 + 0.05 * at(1.0).abs();
        let primitive = match (at(1.0).x * 3.0 + 3.0) as u32 {
            0 | 1 => Primitive::Cuboid {
                half: s,
                rounding: 0.0,
            },
            2 | 3 => cylinder(s.x, s.y),
            4 => Primitive::Frustum {
                bottom: s.x,
                top: 0.0,
                half_height: s.y,
            },
            _ => Primitive::Sphere { radius: s.x },
        };
        let op = match (i, (at(1.0).x * 1.5 + 1.5) as u32) {
            (0, _) | (_, 0) => Op::Union,
            (_, 1) => Op::Subtract,
            _ => Op::Intersect,
        };
        let turn = at(3.0);
        let placement = Placement {
            rotation: Quat::from_euler(glam::EulerRot::XYZ, turn.x, turn.y, turn.z),
            ..Placement::at(at(0.05))
        };
        operands.push(operand(op, primitive, placement));
    }
    Recipe::new(Node::Solid(operands))
}

#[test]
fn a_set_flag_gives_it_up_and_what_has_no_edges_is_left_alone() {
    let flag = |set| AtomicBool::new(set);
    let make = |recipe: &Recipe| {
        let program = Program::compile(recipe, &Placement::IDENTITY, STEP, &()).unwrap();
        let grid = fuse(&program, &FuseOptions::default()).unwrap();
        (Surface::extract(&grid).mesh(), program)
    };
    let (plain, program) = make(&bored());
    assert_eq!(crisp_unless(&plain, &program, &flag(true)), Err(Cancelled));
    let sharp = crisp_unless(&plain, &program, &flag(false)).unwrap();
    assert_eq!(sharp, Some(crisp(plain, &program)));
    let (ball, program) = make(&Primitive::Sphere { radius: 0.1 }.into());
    assert_eq!(crisp_unless(&ball, &program, &flag(false)), Ok(None));
}

#[test]
fn it_is_the_same_on_any_number_of_threads() {
    let mut r = Random(5);
    for many in [2, 4, 6] {
        let recipe = any_solid(&mut r, many);
        let [one, three] = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| both(&recipe, &Placement::IDENTITY, STEP).1)
        });
        assert_eq!(one, three);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Whatever is fused, the surface stays closed, manifold, and free of triangles without area.
    #[test]
    fn any_solid_stays_sound(seed: u64, many in 1usize..5) {
        let recipe = any_solid(&mut Random(seed), many);
        let (plain, mesh) = both(&recipe, &Placement::IDENTITY, STEP);
        assert_sound(&mesh);
        if !mesh.triangles.is_empty() {
            let report = midair_mesh::check(&mesh);
            prop_assert!(report.is_faultless(), "{:?}", report.faults());
        }
        prop_assert!(mesh.positions.len() >= plain.positions.len());
        prop_assert!((mesh.volume() - plain.volume()).abs() <= 0.5 * f64::from(STEP) * plain.area());
    }
}
