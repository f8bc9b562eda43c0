//! One suite on both backends: the processor's kernels are the reference.

use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use glam::{Quat, Vec3};
use midair_field::bake::Volume;
use midair_field::{
    Canvas, FuseOptions, Grid, MeshSource, Node, Op, Operand, Placement, Primitive, Program,
    Recipe, Skeleton, Stroke, fuse,
};
use midair_mesh::{Aabb, MeshHash};
use midair_surface::Surface;

use super::canvases::{paintings, volume_brushes};
use super::support::*;
use crate::{GpuSolid, SolidOptions, can_make};

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
    for (name, canvas) in paintings() {
        let recipe = Recipe::new(Node::Canvas(canvas));
        all.push((name.into(), compile(&recipe, 0.01)));
        let cut = vec![
            operand(Op::Union, Vec3::new(0.05, 0.0, 0.0), recipe),
            operand(
                Op::Subtract,
                Vec3::new(0.1, 0.0, 0.05),
                Primitive::Sphere { radius: 0.08 },
            ),
        ];
        let cut = Recipe::new(Node::Solid(cut));
        all.push((format!("{name}, cut"), compile(&cut, 0.008)));
    }
    for (name, canvas) in volume_brushes() {
        let recipe = Recipe::new(Node::Canvas(canvas));
        assert!(can_make(&recipe), "{name}");
        let program = Program::compile(&recipe, &Placement::IDENTITY, 0.0125, &Torus);
        all.push((name.into(), program.expect("sound")));
    }
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
    let mut off = Vec::new();
    for (name, program) in suite() {
        let solid = GpuSolid::make(&gpu, &program).unwrap();
        let (most, signs, compared) =
            difference(&solid.grid().unwrap(), &on_processor(&program), 3.0, 1e-4);
        println!("{name}: {most:.2e} steps off at most over {compared} nodes");
        assert!(compared > 1000, "{name}");
        if most > 1e-4 || signs > 0 {
            off.push((name, most, signs));
        }
    }
    assert!(off.is_empty(), "steps off, and signs: {off:?}");
}

#[test]
fn quantised_fields_agree_to_half_a_quantum() {
    let Some(gpu) = gpu() else { return };
    let options = SolidOptions {
        quantised: true,
        ..SolidOptions::default()
    };
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

/// 16 bits are chosen by the step and by how flat the parts are, and it is moved by no more than was allowed.
#[test]
fn bits_are_chosen_by_how_far_the_surface_may_be_moved() {
    let Some(gpu) = gpu() else { return };
    let within = |metres| SolidOptions {
        within: Some(metres),
        ..SolidOptions::default()
    };
    let squeezed = |y: f32| {
        let torus = Primitive::Torus {
            major: 0.25,
            minor: 0.1,
        };
        let mut part = operand(Op::Union, Vec3::ZERO, torus);
        part.placement.scale = Vec3::new(1.0, y, 1.0);
        compile(&Recipe::new(Node::Solid(vec![part])), 0.02)
    };
    let chair = &table_1()[1].1;
    for (name, program, most, narrow) in [
        ("the chair", compile(chair, 0.01), 1.0e-5, true),
        ("the chair, exactly", compile(chair, 0.01), 1.0e-7, false),
        ("a flat ring", squeezed(0.5), 1.0e-5, true),
        ("a flat ring, finer", squeezed(0.5), 1.5e-6, false),
        ("a leaf of a ring", squeezed(0.1), 1.0e-3, false),
    ] {
        let solid = GpuSolid::make_with(&gpu, &program, within(most)).unwrap();
        assert_eq!(solid.is_quantised(), narrow, "{name}");
        let wide = GpuSolid::make(&gpu, &program).unwrap();
        let (ours, theirs) = (solid.memory(), wide.memory());
        assert_eq!(ours.bricks, theirs.bricks, "{name}");
        if narrow {
            assert_eq!(
                theirs.used - ours.used,
                1024 * u64::from(ours.bricks),
                "{name}"
            );
        }
        let step = program.step();
        let (ours_mesh, theirs_mesh) = (solid.mesh().unwrap(), wide.mesh().unwrap());
        assert_same(&ours_mesh, &theirs_mesh, step, name);
        // Along an edge that grazes the surface a vertex moves further, with the surface.
        let place: HashMap<_, usize> = (0..theirs_mesh.positions.len())
            .map(|i| (edge_of(theirs_mesh.positions[i], step), i))
            .collect();
        let apart = ours_mesh.positions.iter().fold(0.0f32, |most, p| {
            let i = place[&edge_of(*p, step)];
            most.max(
                (*p - theirs_mesh.positions[i])
                    .dot(theirs_mesh.normals[i])
                    .abs(),
            )
        });
        println!(
            "{name}: {apart:.1e} m apart, {} of {} bytes",
            ours.used, theirs.used
        );
        assert!(apart <= most, "{name}: {apart}");
    }
    // An edit that asks for more than 16 bits gets it.
    let mut solid = GpuSolid::make_with(&gpu, &squeezed(0.5), within(1.0e-5)).unwrap();
    assert!(solid.is_quantised());
    solid.update(&squeezed(0.1)).unwrap();
    assert!(!solid.is_quantised());
    assert_sound(&solid.mesh().unwrap(), "a leaf after a flat ring");
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

/// A stroke that is led on, another beside it, one that takes away, and back.
#[test]
fn a_painting_that_goes_on_is_as_one_made_anew() {
    let Some(gpu) = gpu() else { return };
    let led = |n: u32| {
        let point = |i: u32| {
            let t = 0.1 * i as f32;
            Vec3::new(0.03 * i as f32 - 0.3, 0.1 * t.sin(), 0.1 * t.cos()).extend(1.0)
        };
        Stroke::new(Skeleton::Points((0..=n).map(point).collect()), 0.06)
    };
    let line = Stroke::new(
        Skeleton::Line(Vec3::new(0.1, -0.2, 0.0), Vec3::splat(0.2)),
        0.065,
    );
    let bite = Stroke {
        erase: true,
        ..Stroke::point(Vec3::new(-0.1, 0.05, 0.1), 0.07)
    };
    let painted = |strokes: Vec<Stroke>| {
        let canvas = Canvas {
            strokes,
            blend: 2.0,
            ..Canvas::default()
        };
        compile(&Recipe::new(Node::Canvas(canvas)), 0.01)
    };
    let steps = [
        painted(vec![led(40)]),
        painted(vec![led(42)]),
        painted(vec![led(44), line.clone()]),
        painted(vec![led(44), line.clone(), bite]),
        painted(vec![led(44), line]),
    ];
    let mut solid = GpuSolid::make(&gpu, &steps[0]).unwrap();
    let whole = solid.memory().bricks;
    let mut edits = 0;
    for (i, program) in steps.iter().enumerate().skip(1) {
        solid.update(program).unwrap();
        let again = solid.counters[crate::layout::counter::WORK];
        println!("stroke {i}: {again} of {whole} bricks again");
        edits += usize::from(again > 0 && again < whole);
        let name = format!("stroke {i}");
        let (most, signs, _) =
            difference(&solid.grid().unwrap(), &on_processor(program), 3.0, 1e-4);
        assert!(most <= 1e-4, "{name}: {most}");
        assert_eq!(signs, 0, "{name}");
        assert_sound(&solid.mesh().unwrap(), &name);
    }
    // The first may find that there is too little room.
    assert!(edits >= 2, "{edits} changed a part of it");
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
