//! Measures fusion on one and two threads: `cargo run --example fuse`.

use std::sync::Arc;
use std::time::Instant;

use glam::{Quat, Vec3};
use midair_field::bake::Volume;
use midair_field::{
    Brick, FuseOptions, MeshSource, Node, Op, Operand, Placement, Primitive, Program, Recipe, fuse,
};
use midair_mesh::{Aabb, MeshHash};

struct Torus(Arc<Volume>);

impl MeshSource for Torus {
    fn volume(&self, _: &MeshHash, _: f32) -> Option<Arc<Volume>> {
        Some(self.0.clone())
    }
}

/// The C library's `rand` after `srand(7)`, so that the transforms are those of the C loop.
struct Rand(Vec<i32>);

impl Rand {
    fn new(seed: i64) -> Self {
        let mut r = vec![seed as i32];
        for i in 1..31 {
            r.push((16807 * i64::from(r[i - 1])).rem_euclid(2_147_483_647) as i32);
        }
        for i in 31..34 {
            r.push(r[i - 31]);
        }
        let mut rand = Self(r);
        for _ in 34..344 {
            rand.next();
        }
        rand
    }

    fn next(&mut self) -> f32 {
        let n = self.0.len();
        self.0.push(self.0[n - 31].wrapping_add(self.0[n - 3]));
        (self.0[n] as u32 >> 1) as f32 / 2_147_483_647u32 as f32
    }
}

fn operand(op: Op, placement: Placement, recipe: impl Into<Recipe>) -> Operand {
    Operand {
        op,
        placement,
        recipe: recipe.into(),
        muted: false,
    }
}

// The C loop's own 6.28, so that the transforms are the same.
#[allow(clippy::approx_constant)]
fn tori(step: f32) -> (Recipe, Torus) {
    let around = Aabb::around(Vec3::ZERO, Vec3::splat(0.5));
    let torus = |p: Vec3| (p.x.hypot(p.y) - 0.28).hypot(p.z) - 0.12;
    let volume = Volume::from_fn(around, 1.0 / 63.0, torus).expect("64³ nodes");
    let mesh = Recipe::new(Node::Mesh {
        mesh: MeshHash([0; 32]),
        bounds: around,
    });
    let mut rand = Rand::new(7);
    let parts = (0..5).map(|_| {
        let angle = rand.next() * 6.28;
        let t = [0; 3].map(|_| (rand.next() - 0.5) * 0.9);
        let placement = Placement {
            translation: Vec3::from(t) + 0.5 * step,
            rotation: Quat::from_rotation_z(-angle),
            scale: Vec3::ONE,
        };
        operand(Op::Union, placement, mesh.clone())
    });
    (
        Recipe::new(Node::Solid(parts.collect())),
        Torus(Arc::new(volume)),
    )
}

fn cuboid(x: f32, y: f32, z: f32) -> Primitive {
    Primitive::Cuboid {
        half: Vec3::new(x, y, z),
        rounding: 0.0,
    }
}

fn tasks() -> [(&'static str, Recipe); 3] {
    let at = |x: f32, y: f32, z: f32| Placement::at(Vec3::new(x, y, z));
    let ball = Primitive::Sphere { radius: 0.2 };
    let cube = operand(Op::Union, at(0.0, 0.0, 0.0), cuboid(0.2, 0.2, 0.2));
    let cut = vec![cube, operand(Op::Subtract, at(0.15, 0.15, 0.15), ball)];
    let mut chair = vec![
        operand(Op::Union, at(0.0, 0.0, 0.0), cuboid(0.2, 0.02, 0.2)),
        operand(Op::Union, at(0.0, 0.2, -0.18), cuboid(0.2, 0.2, 0.02)),
    ];
    for (x, z) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let leg = cuboid(0.02, 0.2, 0.02);
        chair.push(operand(Op::Union, at(0.18 * x, -0.2, 0.18 * z), leg));
    }
    let cylinder = |radius, half_height| Primitive::Cylinder {
        radius,
        half_height,
        rounding: 0.0,
    };
    let ring = Primitive::Torus {
        major: 0.1,
        minor: 0.02,
    };
    let upright = Placement {
        translation: Vec3::new(0.2, 0.0, 0.0),
        rotation: Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
        scale: Vec3::ONE,
    };
    let cup = vec![
        operand(Op::Union, upright, ring),
        operand(Op::Union, at(0.0, 0.0, 0.0), cylinder(0.18, 0.2)),
        operand(Op::Subtract, at(0.0, 0.03, 0.0), cylinder(0.16, 0.2)),
    ];
    [("cube-sphere", cut), ("chair", chair), ("cup", cup)]
        .map(|(name, parts)| (name, Recipe::new(Node::Solid(parts))))
}

fn measure(name: &str, recipe: &Recipe, step: f32, meshes: &dyn MeshSource) {
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("threads");
        let (mut best, mut prepare) = (f64::MAX, f64::MAX);
        let mut counts = (0, 0);
        pool.install(|| {
            for _ in 0..12 {
                let start = Instant::now();
                let program = Program::compile(recipe, &Placement::IDENTITY, step, meshes);
                let program = program.expect("a sound recipe");
                prepare = prepare.min(start.elapsed().as_secs_f64());
                let start = Instant::now();
                let grid = fuse(&program, &FuseOptions::default()).expect("fits");
                best = best.min(start.elapsed().as_secs_f64());
                let values = |b: &Brick| matches!(b, Brick::Values { min, max, .. } if *min < 0.0 && *max > 0.0);
                let near = grid.near_coords().len();
                counts = (near, grid.bricks().filter(|(_, b)| values(b)).count());
            }
        });
        println!(
            "{name} step {step:.4} on {threads}: compile {:.3} ms, fuse {:.3} ms, {} bricks, {} crossed",
            prepare * 1e3,
            best * 1e3,
            counts.0,
            counts.1
        );
    }
}

fn main() {
    let step = 2.0 / 255.0;
    let (recipe, meshes) = tori(step);
    measure("5x64-in-256", &recipe, step, &meshes);
    for (name, recipe) in tasks() {
        measure(name, &recipe, 0.012, &());
        measure(name, &recipe, 0.006, &());
    }
}
