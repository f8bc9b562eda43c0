//! A model of more than 110,000 triangles (3DBrushVR Fig. 4): brought in, painted on, edited, exported.

use std::time::Instant;

use bevy::prelude::*;
use midair_brush::{Ask, BRUSH, canvas};
use midair_field::Skeleton;
use midair_mesh::{Format, Named, TriMesh, WriteOptions, check, encode, read};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Side};

use crate::studio::Studio;

const AROUND: u32 = 640;
const ACROSS: u32 = 90;

/// A closed knot (2, 3) on a torus, as a tube.
fn knot() -> TriMesh {
    let angle = |i: u32, n: u32| i as f32 / n as f32 * std::f32::consts::TAU;
    let middle = |t: f32| {
        let out = 2.0 + (3.0 * t).cos();
        Vec3::new(
            out * (2.0 * t).cos(),
            out * (2.0 * t).sin(),
            (3.0 * t).sin(),
        )
    };
    let mut mesh = TriMesh::default();
    for i in 0..AROUND {
        let t = angle(i, AROUND);
        let along = (middle(t + 1e-3) - middle(t - 1e-3)).normalize();
        let flat = Vec3::new((2.0 * t).cos(), (2.0 * t).sin(), 0.0);
        let out = (3.0 * t).cos() * flat + (3.0 * t).sin() * Vec3::Z;
        let x = (out - along * along.dot(out)).normalize();
        let y = along.cross(x);
        for j in 0..ACROSS {
            let a = angle(j, ACROSS);
            mesh.positions
                .push(middle(t) + 0.5 * (a.cos() * x + a.sin() * y));
            let at = |i: u32, j: u32| i % AROUND * ACROSS + j % ACROSS;
            let [p, q, r, s] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.triangles.extend([[p, q, r], [p, r, s]]);
        }
    }
    mesh
}

/// The most memory so far, MiB; nothing where the system does not say.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024)
}

#[test]
fn a_model_of_more_than_110_000_triangles_is_painted_edited_and_exported() {
    let started = Instant::now();
    let note = |what: &str| println!("{what}: {:.1} s", started.elapsed().as_secs_f32());
    let mesh = knot();
    assert!(mesh.triangles.len() > 110_000);
    let mut s = Studio::new();
    let path = s.home.path().join("knot.ply");
    let named = [Named::new("knot", &mesh)];
    let bytes = encode(Format::Ply, &named, &WriteOptions::default()).unwrap();
    std::fs::write(&path, bytes).unwrap();
    s.ask(Command::Bring {
        paths: vec![path],
        at: Vec3::new(0.0, 1.0, 0.0),
    });
    s.settle();
    note("brought in");
    let id = s.only();
    let there = s.mesh(id, 0.01);
    let bounds = there.bounds();

    // It becomes a painting, itself the first stroke.
    s.ask(Command::Mode(BRUSH));
    s.ask(Ask::PaintOn(id.0).command());
    for (key, value) in [("brush.skeleton", "\"Point\""), ("brush.radius", "0.03")] {
        s.ask(Command::Set {
            key: key.into(),
            value: value.into(),
        });
    }
    s.frames(2);
    let strokes = |s: &Studio| canvas(s.object(s.only())).map_or(0, |c| c.strokes.len());

    // A stroke is led from the surface outwards.
    let top = there.positions.iter().copied();
    let top = top.max_by(|a, b| a.y.total_cmp(&b.y)).unwrap();
    s.reach(Side::Right, top);
    s.press(Side::Right, Action::Act);
    s.carry_right(top + Vec3::Y * 0.12);
    s.let_go(Side::Right, Action::Act);
    s.settle();
    assert_eq!(strokes(&s), 2);
    assert!(matches!(
        canvas(s.object(s.only())).unwrap().strokes[0].skeleton,
        Skeleton::Volume(_)
    ));
    note("painted on");
    let height = |s: &Studio| s.mesh(s.only(), 0.01).bounds().max.y;
    let tall = height(&s);
    assert!((tall - (top.y + 0.15)).abs() < 0.01, "{tall} over {top}");

    // It is moved, some of the model is taken away, and that is undone.
    s.ask(Ask::Move(1, (0.0, -0.05, 0.0)).command());
    s.settle();
    assert!((height(&s) - (tall - 0.05)).abs() < 0.01, "{}", height(&s));
    let whole = s.faultless(s.only(), 0.01).volume;
    s.ask(Command::Set {
        key: "brush.erase".into(),
        value: "true".into(),
    });
    let side = there.positions.iter().copied();
    let side = side.max_by(|a, b| a.x.total_cmp(&b.x)).unwrap();
    s.reach(Side::Right, side);
    s.click(Side::Right, Action::Act);
    s.settle();
    assert_eq!(strokes(&s), 3);
    let bitten = s.faultless(s.only(), 0.01).volume;
    assert!(bitten < 0.998 * whole, "{bitten} of {whole}");
    s.ask(Command::Undo);
    s.settle();
    assert_eq!(strokes(&s), 2);
    let again = s.faultless(s.only(), 0.01).volume;
    assert!((again / whole - 1.0).abs() < 1e-6, "{again}, not {whole}");
    s.ask(Command::Redo);
    s.settle();
    note("edited");

    let out = s.home.path().join("painted.stl");
    s.ask(Command::Export {
        path: out.clone(),
        step: Some(0.004),
        unit: None,
        up: None,
        only: None,
    });
    s.settle();
    let read = read(&out).unwrap();
    let report = check(&read.mesh);
    assert!(report.is_faultless(), "{:?}", report.faults());
    assert!((report.volume / bitten - 1.0).abs() < 0.05);
    assert!(bounds.size().max_element() > 0.3);
    note("exported");
    println!(
        "{} triangles in, {} out, at most {:?} MiB",
        mesh.triangles.len(),
        read.mesh.triangles.len(),
        peak()
    );
    assert_eq!(s.warnings(), [] as [String; 0]);
}
