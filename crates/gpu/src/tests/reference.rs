//! One suite on both backends: the processor's kernels are the reference.

use std::sync::{Arc, OnceLock};

use glam::{Quat, Vec3};
use midair_field::bake::Volume;
use midair_field::{
    FuseOptions, Grid, MeshSource, Node, Op, Operand, Placement, Primitive, Program, Recipe, fuse,
};
use midair_mesh::{Aabb, MeshHash};
use midair_surface::Surface;

use super::support::*;
use crate::{GpuSolid, SolidOptions};

fn on_processor(program: &Program) -> Grid {
    fuse(program, &FuseOptions::default()).expect("fits")
}

/// All solids of the suite: each primitive alone, nested ones, and the paper's tasks.
fn suite() -> Vec<(String, Program)> {
    let mut all: Vec<(String, Program)> = zoo()
        .into_iter()
        .enumerate()
        .map(|(i, p)| (format!("primitive {i}"), compile(&p.into(), 1.0 / 64.0)))
        .collect();
    all.push(("nested".into(), compile(&nested(), 0.01)));
    all.push(("baked meshes".into(), baked(0.012)));
    for (name, recipe) in table_1() {
        all.push((name.into(), compile(&recipe, 0.01)));
    }
    all
}

/// Meshes that were baked, turned, stretched and cut, beside an exact part.
fn baked(step: f32) -> Program {
    let mesh = Recipe::new(Node::Mesh {
        mesh: MeshHash([0; 32]),
        bounds: Aabb::around(Vec3::ZERO, Vec3::splat(0.5)),
    });
    let placed = |op, at: [f32; 3], turn: f32, scale: f32| Operand {
        op,
        placement: Placement {
            translation: at.into(),
            rotation: Quat::from_rotation_z(turn),
            scale: Vec3::new(scale, 1.0, 0.8),
        },
        recipe: mesh.clone(),
        muted: false,
    };
    let recipe = Recipe::new(Node::Solid(vec![
        placed(Op::Union, [0.0; 3], 0.3, 1.0),
        placed(Op::Union, [0.3, 0.1, 0.2], 2.0, 1.3),
        placed(Op::Subtract, [-0.2, 0.1, 0.0], 1.0, 0.6),
        operand(
            Op::Union,
            Vec3::new(0.0, -0.4, 0.0),
            Primitive::Sphere { radius: 0.15 },
        ),
    ]));
    Program::compile(&recipe, &Placement::IDENTITY, step, &Torus).expect("sound")
}

/// A source that knows one mesh.
struct Torus;

impl MeshSource for Torus {
    fn volume(&self, _: &MeshHash, _: f32) -> Option<Arc<Volume>> {
        static ONE: OnceLock<Arc<Volume>> = OnceLock::new();
        let torus = |p: Vec3| (p.x.hypot(p.y) - 0.28).hypot(p.z) - 0.12;
        let around = Aabb::around(Vec3::ZERO, Vec3::splat(0.5));
        let bake = || Arc::new(Volume::from_fn(around, 1.0 / 63.0, torus).expect("fits"));
        Some(ONE.get_or_init(bake).clone())
    }
}

#[test]
fn fields_agree_with_the_processor() {
    let Some(gpu) = gpu() else { return };
    for (name, program) in suite() {
        let solid = GpuSolid::make(&gpu, &program).unwrap();
        let (most, signs, compared) =
            difference(&solid.grid().unwrap(), &on_processor(&program), 3.0, 1e-4);
        println!("{name}: {most:.2e} steps off at most over {compared} nodes");
        assert!(compared > 1000, "{name}");
        assert!(most <= 1e-4, "{name}: {most} steps off");
        assert_eq!(signs, 0, "{name}: signs");
    }
}

#[test]
fn quantised_fields_agree_to_half_a_quantum() {
    let Some(gpu) = gpu() else { return };
    let options = SolidOptions { quantised: true };
    for (name, program) in suite() {
        let solid = GpuSolid::make_with(&gpu, &program, options).unwrap();
        let reference = on_processor(&program);
        let (most, signs, _) = difference(&solid.grid().unwrap(), &reference, 3.0, 1.5e-4);
        let bound = if solid.is_quantised() { 1.5e-4 } else { 1e-4 };
        assert!(most <= bound, "{name}: {most} steps off");
        assert_eq!(signs, 0, "{name}: signs");
        assert_sound(&solid.mesh().unwrap(), &name);
    }
}

#[test]
fn the_same_bricks_give_the_same_surface() {
    let Some(gpu) = gpu() else { return };
    for (name, program) in suite() {
        let grid = on_processor(&program);
        let solid = GpuSolid::from_grid(&gpu, &grid).unwrap();
        let reference = Surface::extract(&grid).mesh();
        let (apart, turned) = assert_same(&solid.mesh().unwrap(), &reference, grid.step(), &name);
        println!("{name}: {apart:.1e} m apart, normals {turned:.1e}");
        assert!(apart <= 1e-5, "{name}: {apart} m apart");
        assert!(turned <= 1e-3, "{name}: normals {turned}");
    }
}

#[test]
fn surfaces_are_closed_and_manifold() {
    let Some(gpu) = gpu() else { return };
    for (name, program) in suite() {
        let solid = GpuSolid::make(&gpu, &program).unwrap();
        let mesh = solid.mesh().unwrap();
        assert_sound(&mesh, &name);
        let reference = Surface::extract(&on_processor(&program)).mesh();
        let (ours, theirs) = (mesh.volume(), reference.volume());
        assert!(
            (ours - theirs).abs() <= 1e-5 * theirs,
            "{name}: {ours} {theirs}"
        );
    }
}

/// What an edit leaves is what making it anew gives.
#[test]
fn an_update_gives_the_same_as_making() {
    let Some(gpu) = gpu() else { return };
    let with = |n: usize, at: Vec3| {
        let mut parts = vec![operand(
            Op::Union,
            Vec3::ZERO,
            Primitive::Cuboid {
                half: Vec3::splat(0.3),
                rounding: 0.02,
            },
        )];
        let dab = Primitive::Sphere { radius: 0.07 };
        for i in 0..n {
            let op = if i % 2 == 0 { Op::Subtract } else { Op::Union };
            parts.push(operand(op, at + Vec3::Y * (0.11 * i as f32), dab.clone()));
        }
        compile(&Recipe::new(Node::Solid(parts)), 0.01)
    };
    // Into the middle of what is inside, over edges, beyond the box, and back.
    let steps = [
        with(0, Vec3::ZERO),
        with(1, Vec3::new(0.3, 0.0, 0.1)),
        with(1, Vec3::ZERO),
        with(3, Vec3::new(0.0, 0.1, 0.0)),
        with(4, Vec3::new(-0.3, 0.2, 0.3)),
        with(0, Vec3::ZERO),
    ];
    let mut solid = GpuSolid::make(&gpu, &steps[0]).unwrap();
    for (i, program) in steps.iter().enumerate().skip(1) {
        solid.update(program).unwrap();
        let reference = on_processor(program);
        let name = format!("edit {i}");
        let (most, signs, _) = difference(&solid.grid().unwrap(), &reference, 3.0, 1e-4);
        assert!(most <= 1e-4, "{name}: {most}");
        assert_eq!(signs, 0, "{name}");
        let mesh = solid.mesh().unwrap();
        assert_sound(&mesh, &name);
        let whole = GpuSolid::make(&gpu, program).unwrap();
        assert_same(&mesh, &whole.mesh().unwrap(), 0.01, &name);
    }
}

/// Many edits at random places do not use up memory that is given back.
#[test]
fn what_edits_give_back_is_used_again() {
    let Some(gpu) = gpu() else { return };
    let solid_at = |i: u32| {
        let t = i as f32 * 0.7;
        let at = Vec3::new(0.25 * t.cos(), 0.25 * t.sin(), 0.2 * (1.3 * t).sin());
        compile(
            &Recipe::new(Node::Solid(vec![
                operand(Op::Union, Vec3::ZERO, Primitive::Sphere { radius: 0.25 }),
                operand(Op::Subtract, at, Primitive::Sphere { radius: 0.08 }),
            ])),
            0.01,
        )
    };
    let mut solid = GpuSolid::make(&gpu, &solid_at(0)).unwrap();
    solid.update(&solid_at(1)).unwrap();
    for i in 2..12 {
        solid.update(&solid_at(i)).unwrap();
    }
    let early = solid.memory().used;
    for i in 12..40 {
        solid.update(&solid_at(i)).unwrap();
    }
    let late = solid.memory().used;
    assert!((late as f64) < 1.25 * early as f64, "{early} {late}");
    assert_sound(&solid.mesh().unwrap(), "after forty edits");
    let whole = GpuSolid::make(&gpu, &solid_at(39)).unwrap();
    assert_same(
        &solid.mesh().unwrap(),
        &whole.mesh().unwrap(),
        0.01,
        "after forty edits",
    );
}

#[test]
fn nothing_is_nothing() {
    let Some(gpu) = gpu() else { return };
    let none = compile(&Recipe::new(Node::Solid(Vec::new())), 0.01);
    let mut solid = GpuSolid::make(&gpu, &none).unwrap();
    assert!(solid.mesh().unwrap().triangles.is_empty());
    let ball = compile(&Primitive::Sphere { radius: 0.1 }.into(), 0.01);
    solid.update(&ball).unwrap();
    assert_sound(&solid.mesh().unwrap(), "a ball out of nothing");
    solid.update(&none).unwrap();
    assert!(solid.mesh().unwrap().triangles.is_empty());
}
