//! The volumes of what is exported, against an exact boolean of exact components.
//!
//! Each operand is tessellated from its numbers alone, placed, and joined to those before by a
//! library that knows triangles and no fields. Two tessellations, one twice as fine, give the limit
//! of both (Richardson): the chords of a curve miss it by the square of their length.

use boolmesh::prelude::{Manifold, OpType, compute_boolean};
use midair_field::{Node, Op, Placement, Recipe};

use crate::shapes::Polyhedron;
use crate::training::{midair, run, trained};

/// Grid steps in metres, each half the one before.
const STEPS: [f32; 3] = [0.010, 0.005, 0.0025];
/// Segments to a quarter turn in the coarser tessellation.
const SEGMENTS: usize = 16;

fn placed(mut p: Polyhedron, placement: &Placement) -> Polyhedron {
    let (r, s, t) = (
        placement.rotation.as_dquat().normalize(),
        placement.scale.as_dvec3(),
        placement.translation.as_dvec3(),
    );
    for q in &mut p.positions {
        *q = (r * (s * bevy::math::DVec3::from_array(*q)) + t).to_array();
    }
    p
}

fn manifold(p: &Polyhedron) -> Manifold {
    let indices = p.triangles.concat();
    Manifold::new(&p.positions.concat(), &indices).unwrap()
}

/// The recipe as an exact boolean of tessellated primitives, read left to right.
fn exact(recipe: &Recipe, n: usize) -> Polyhedron {
    match recipe.node() {
        Node::Primitive(primitive) => Polyhedron::of(primitive, n).expect("a known shape"),
        Node::Component { recipe, .. } => exact(recipe, n),
        Node::Solid(operands) => {
            let mut parts = operands
                .iter()
                .map(|o| (o.op, manifold(&placed(exact(&o.recipe, n), &o.placement))));
            let (_, mut all) = parts.next().expect("operands");
            for (op, part) in parts {
                let op = match op {
                    Op::Union => OpType::Add,
                    Op::Intersect => OpType::Intersect,
                    Op::Subtract => OpType::Subtract,
                };
                all = compute_boolean(&all, &part, op).unwrap();
            }
            Polyhedron {
                positions: all.ps.iter().map(|p| p.to_array()).collect(),
                triangles: all
                    .hs
                    .chunks(3)
                    .map(|t| [t[0].tail, t[1].tail, t[2].tail])
                    .collect(),
            }
        }
        other => panic!("no training task uses {other:?}"),
    }
}

/// The limit of ever finer tessellations, and how far it may be off.
fn limit(recipe: &Recipe) -> (f64, f64) {
    let [a, b, c] = [1, 2, 4].map(|k| exact(recipe, k * SEGMENTS).volume());
    let [coarse, fine] = [(4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0];
    (fine, (fine - coarse).abs())
}

/// The slope of log(error) over log(step), by least squares.
fn slope(errors: &[f64; 3]) -> f64 {
    // The steps are in powers of two about the middle one.
    (errors[0].log2() - errors[2].log2()) / 2.0
}

#[test]
fn exported_volumes_come_to_those_of_an_exact_boolean() {
    println!("session      step m   volume m³      exact m³       error %   noise %  slope");
    let mut missed = Vec::new();
    for trained in trained() {
        let document = midair_document::open(&trained.file(".midair"))
            .unwrap()
            .document;
        let (mut truth, mut noise) = (0.0, 0.0);
        for (_, object) in document.objects() {
            assert_eq!(object.placement.scale, bevy::math::Vec3::ONE);
            let (volume, off) = limit(object.recipe().unwrap());
            truth += volume;
            noise += off;
        }
        let noise = noise / truth;
        let errors = STEPS.map(|step| {
            let file = trained.file(&format!("-{step}.stl"));
            let mut export = midair(&trained.folder);
            export.arg("export").arg(trained.file(".midair"));
            run(export
                .arg("--to")
                .arg(&file)
                .arg("--step")
                .arg(step.to_string()));
            let volume = midair_mesh::read(&file).unwrap().mesh.volume();
            let error = (volume / truth - 1.0).abs();
            println!(
                "{:<12} {step:<8} {volume:<14.9} {truth:<14.9} {:<9.4} {:.5}",
                trained.name,
                100.0 * error,
                100.0 * noise
            );
            error
        });
        let slope = slope(&errors);
        println!("{:<12} {:>60.2}", trained.name, slope);
        let name = trained.name;
        assert!(noise < 2e-5, "{name}: the oracle itself is off by {noise}");
        let [coarse, _, fine] = errors;
        for (holds, what) in [
            (coarse < 0.015, format!("off by {coarse} at 0.010")),
            (fine < 0.0015, format!("off by {fine} at 0.0025")),
            // What is sharp is there at any step: where little else is, nothing is left to fall.
            (
                slope > 1.8 || fine < 1e-4,
                format!("the error falls as step^{slope}"),
            ),
        ] {
            if !holds {
                missed.push(format!("{name}: {what}"));
            }
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}
