//! Random sweeps, forty-five of them and as many as `MIDAIR_MANY` says, each united with a ball by the way that Assemble goes: the recipe of a
//! boolean, its field, its surface.

use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

use glam::{Quat, Vec3};
use midair_field::bake::{BakeOptions, Progress, Volume, bake};
use midair_field::{
    MeshSource, Node, Op, Operand, Placement, Primitive, Profile, Recipe, Rib, Sweep,
};
use midair_mesh::{MeshHash, TriMesh, check};
use midair_solid::Solid;

/// Metres between the nodes: half of the thinnest wall.
const STEP: f32 = 0.015;
const RADIUS: f32 = 0.08;
const WALL: f32 = 0.03;

/// SplitMix64: the same numbers every time.
struct Dice(u64);

impl Dice {
    /// From −1 to 1.
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }

    fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * size
    }

    fn turn(&mut self, most: f32) -> Quat {
        let axis = self.vector(1.0).normalize_or(Vec3::X);
        Quat::from_axis_angle(axis, self.next() * most)
    }
}

/// Two hands on smooth ways, turning as they go, and what they leave.
fn swept(dice: &mut Dice, kind: usize) -> Sweep {
    let from = [Vec3::X * -0.25, Vec3::X * 0.25].map(|p| p + dice.vector(0.1));
    let to = from.map(|p| p + dice.vector(0.4));
    let bow = [dice.vector(0.1), dice.vector(0.1)];
    let first = [dice.turn(1.0), dice.turn(1.3)];
    let last = first.map(|q| dice.turn(0.5) * q);
    let ribs = (0..=24).map(|i| {
        let t = i as f32 / 24.0;
        let hand = |k: usize| from[k].lerp(to[k], t) + bow[k] * (4.0 * t * (1.0 - t));
        let points = [hand(0), hand(1)];
        let length = points[0].distance(points[1]);
        let along = |k: usize| first[k].slerp(last[k], t) * Vec3::X * length;
        Rib {
            points,
            tangents: [along(0), along(1)],
            slopes: [1.0; 2],
            start: first[0].slerp(last[0], t).normalize(),
            twist: 0.0,
        }
    });
    let (profile, thickness, caps) = match kind % 3 {
        0 => (Profile::Sheet, WALL, false),
        1 => (Profile::Tube, 0.0, true),
        _ => (Profile::Tube, WALL, false),
    };
    Sweep {
        ribs: ribs.collect(),
        count: 24,
        profile,
        thickness,
        caps,
    }
}

/// What was baked last: a sweep is one mesh in all that is made of it.
#[derive(Default)]
struct Last(Mutex<Option<(MeshHash, Arc<Volume>)>>);

impl MeshSource for Last {
    fn volume(&self, _: &MeshHash, _: f32) -> Option<Arc<Volume>> {
        None
    }

    fn baked(&self, name: &MeshHash, step: f32, make: &dyn Fn() -> TriMesh) -> Option<Arc<Volume>> {
        let mut last = self.0.lock().unwrap();
        if let Some((_, volume)) = last.as_ref().filter(|(n, _)| n == name) {
            return Some(volume.clone());
        }
        let made = bake(&make(), &BakeOptions::with_step(step), &Progress::new()).unwrap();
        *last = Some((*name, Arc::new(made)));
        last.as_ref().map(|(_, v)| v.clone())
    }
}

/// Each with the ball: united and intersected, both without a fault, and together as much as the two are
/// apart.
#[test]
fn random_sweeps_unite_with_a_ball() {
    let many = std::env::var("MIDAIR_MANY").ok();
    let many: usize = many.and_then(|n| n.parse().ok()).unwrap_or(45);
    let started = std::time::Instant::now();
    let mut dice = Dice(7);
    let (mut united, mut flat, mut worst) = (0, 0, 0.0f64);
    let ball = Recipe::from(Primitive::Sphere { radius: RADIUS });
    let alone = 4.0 / 3.0 * PI * f64::from(RADIUS).powi(3);
    let go = AtomicBool::new(false);
    while united < many {
        let sweep = swept(&mut dice, united);
        // Turned anyhow a tube may lie flat at once: that is no solid to begin with.
        if sweep.solid().is_err() {
            flat += 1;
            continue;
        }
        let end = sweep.ribs[12].points[1];
        let recipe = Recipe::checked(Node::Sweep(sweep)).unwrap();
        let source = Last::default();
        let volume = |op: Option<Op>| {
            let mut operands = vec![Operand {
                op: Op::Union,
                placement: Placement::IDENTITY,
                recipe: recipe.clone(),
                muted: false,
            }];
            operands.extend(op.map(|op| Operand {
                op,
                placement: Placement::at(end),
                recipe: ball.clone(),
                muted: false,
            }));
            let both = Recipe::new(Node::Solid(operands));
            let made = Solid::make(&both, &Placement::IDENTITY, STEP, &source, &go).unwrap();
            let mesh = made.mesh();
            // Where a sweep ends in an edge there may be less of it within the ball than a step shows.
            if op == Some(Op::Intersect) && mesh.triangles.is_empty() {
                return 0.0;
            }
            let report = check(&mesh);
            let faults = report.faults();
            assert!(report.is_faultless(), "{united} {op:?}: {faults:?}");
            report.volume
        };
        let (own, with, within) = (
            volume(None),
            volume(Some(Op::Union)),
            volume(Some(Op::Intersect)),
        );
        assert!(
            with > own && with > 0.97 * alone,
            "{united}: {with} of {own}"
        );
        assert!(within < alone && within < own, "{united}: {within}");
        let off = (with + within - own - alone).abs() / (own + alone);
        assert!(off < 0.03, "{united}: {with} + {within} of {own} + {alone}");
        worst = worst.max(off);
        united += 1;
    }
    println!(
        "{united} random sweeps united with a ball and intersected with it in {:.0} s, none with a fault; volumes add up to {:.2} %; {flat} more enclosed nothing",
        started.elapsed().as_secs_f64(),
        worst * 100.0
    );
}

/// Hands tilted the same way: the tube's profile is a figure of eight, and its field is full in both loops.
#[test]
fn a_tube_that_crosses_itself_is_full_in_both_loops() {
    let turn = Quat::from_rotation_z(1.0);
    let ribs = (0..=20).map(|j| {
        let z = 0.01 * j as f32 - 0.1;
        Rib {
            points: [Vec3::new(-0.1, 0.0, z), Vec3::new(0.1, 0.0, z)],
            tangents: [turn * Vec3::X * 0.5; 2],
            slopes: [1.0; 2],
            start: turn,
            twist: 0.0,
        }
    });
    let sweep = Sweep {
        ribs: ribs.collect(),
        count: 64,
        profile: Profile::Tube,
        thickness: 0.0,
        caps: true,
    };
    let solid = sweep.solid().unwrap();
    assert!(solid.crossed.is_some());
    // Between the curve and its mirror image: four times the integral of its height over its half.
    let m = (turn * Vec3::X * 0.5).as_dvec3();
    let height = |u: f64| m.y * (2.0 * u.powi(3) - 3.0 * u * u + u);
    let across = |u: f64| 0.2 * (6.0 * u - 6.0 * u * u);
    let steps = 1000;
    let half: f64 = (0..steps)
        .map(|i| (f64::from(i) + 0.5) / f64::from(steps) * 0.5)
        .map(|u| height(u) * across(u) * 0.5 / f64::from(steps))
        .sum();
    let exact = 4.0 * half * 0.2;
    let recipe = Recipe::checked(Node::Sweep(sweep)).unwrap();
    let go = AtomicBool::new(false);
    let made = Solid::make(&recipe, &Placement::IDENTITY, 0.002, &(), &go).unwrap();
    let report = check(&made.mesh());
    assert!(report.is_faultless(), "{:?}", report.faults());
    let off = (report.volume / exact - 1.0).abs();
    assert!(off < 0.03, "{} of {exact}", report.volume);
    let shown = midair_solid::own_mesh(&recipe);
    assert!(shown.is_none(), "it is drawn from its field");
}
