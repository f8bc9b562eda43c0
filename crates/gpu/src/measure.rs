//! Workloads of the GPU: what `midair bench` and the small program `measure` time.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use glam::{Quat, Vec3};
use midair_field::bake::Volume;
use midair_field::{
    FuseOptions, MeshSource, Node, Op, Operand, Placement, Primitive, Program, Recipe, changed_box,
    fuse, refuse,
};
use midair_mesh::{Aabb, MeshHash};
use midair_surface::Surface;

use crate::{Gpu, GpuError, GpuSolid, SolidOptions};

/// A step of a workload: the solid it comes to.
struct Made {
    before: Option<Program>,
    program: Program,
}

/// A piece of work by name.
#[derive(Clone, Debug)]
pub struct Work {
    /// As `gpu/full-256` or `gpu/chair/0.006`.
    pub name: String,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    /// A recipe at a step.
    Task(&'static str, f32),
    /// Five tori in a lattice of so many nodes, a side of two metres.
    Tori(u32),
    /// The same, baked to 64³ nodes each.
    Baked(u32),
    /// The same, a ball of so many nodes across moved on its surface.
    Dab { nodes: u32, within: u32 },
    /// The chair at so many nodes along its longest side.
    Growth(u32),
}

/// What a workload took, medians in milliseconds.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// Its name.
    pub name: String,
    /// From the call to the counters in main memory; the surface stays on the device.
    pub total_ms: f64,
    /// The shortest and the longest run of it.
    pub range_ms: [f64; 2],
    /// The device's own clock: culling, fusing, extracting. `None` where it has none.
    pub device_ms: Option<[f64; 3]>,
    /// The mesh copied to main memory.
    pub read_ms: f64,
    /// The same work by the processor.
    pub processor_ms: f64,
    /// Triangles.
    pub triangles: u32,
    /// Bricks that hold values.
    pub bricks: u32,
    /// Bytes on the device in use, and reserved.
    pub bytes: [u64; 2],
}

/// The training tasks of EasyVRModeling Fig. 7 as recipes.
const TASKS: [(&str, &str); 3] = [
    (
        "cube-sphere",
        include_str!("../../../benches/cube-sphere.ron"),
    ),
    ("chair", include_str!("../../../benches/chair.ron")),
    ("cup", include_str!("../../../benches/cup.ron")),
];

/// The steps of EasyVRModeling Table 1, metres.
const STEPS: [f32; 4] = [0.012, 0.010, 0.008, 0.006];

/// Where five tori stand, as in `fuse/5x64-in-256`.
const PLACES: [(f32, [f32; 3]); 5] = [
    (3.057_758, [0.331_179_7, 0.083_332, -0.256_761_2]),
    (0.064_222_7, [0.013_336_7, 0.446_353_4, -0.421_260_9]),
    (3.777_83, [-0.400_189_6, 0.024_102, -0.369_563_3]),
    (4.800_663, [0.283_942_7, 0.350_075_2, -0.302_491_2]),
    (1.353_368, [0.258_914_4, 0.259_828, -0.390_018_8]),
];

/// Every workload, Table 1 first.
pub fn all() -> Vec<Work> {
    let mut all = Vec::new();
    for (task, _) in TASKS {
        for step in STEPS {
            all.push(Work {
                name: format!("gpu/{task}/{step:.3}"),
                kind: Kind::Task(task, step),
            });
        }
    }
    let mut add = |name: String, kind| all.push(Work { name, kind });
    add("gpu/full-256".into(), Kind::Tori(256));
    add("gpu/baked-256".into(), Kind::Baked(256));
    let dab = |nodes, within| Kind::Dab { nodes, within };
    add("gpu/dab-32-in-256".into(), dab(32, 256));
    add("gpu/dab-in-512".into(), dab(32, 512));
    for n in [128, 256, 512, 1024] {
        add(format!("gpu/memory/chair-{n}"), Kind::Growth(n));
    }
    all
}

/// The one volume that every torus names.
struct One(Arc<Volume>);

impl MeshSource for One {
    fn volume(&self, _: &MeshHash, _: f32) -> Option<Arc<Volume>> {
        Some(self.0.clone())
    }
}

fn torus() -> Result<One, String> {
    let around = Aabb::around(Vec3::ZERO, Vec3::splat(0.5));
    let torus = |p: Vec3| (p.x.hypot(p.y) - 0.28).hypot(p.z) - 0.12;
    let volume = Volume::from_fn(around, 1.0 / 63.0, torus).map_err(|e| e.to_string())?;
    Ok(One(Arc::new(volume)))
}

/// Where each of the tori has the z axis for its own.
fn tori(
    step: f32,
    one: &Recipe,
    meshes: &dyn MeshSource,
    dab: Option<(f32, Vec3)>,
) -> Result<Program, String> {
    let mut operands: Vec<Operand> = PLACES
        .map(|(angle, place)| Operand {
            op: Op::Union,
            placement: Placement {
                translation: Vec3::from(place) + 0.5 * step,
                rotation: Quat::from_rotation_z(angle),
                scale: Vec3::ONE,
            },
            recipe: one.clone(),
            muted: false,
        })
        .into();
    if let Some((radius, at)) = dab {
        operands.push(Operand {
            op: Op::Union,
            placement: Placement::at(at),
            recipe: Primitive::Sphere { radius }.into(),
            muted: false,
        });
    }
    let recipe = Recipe::new(Node::Solid(operands));
    Program::compile(&recipe, &Placement::IDENTITY, step, meshes).map_err(|e| e.to_string())
}

/// A torus about z.
fn exact() -> Recipe {
    let torus = Primitive::Torus {
        major: 0.28,
        minor: 0.12,
    };
    Recipe::new(Node::Solid(vec![Operand {
        op: Op::Union,
        placement: Placement {
            rotation: Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
            ..Placement::IDENTITY
        },
        recipe: torus.into(),
        muted: false,
    }]))
}

fn task(name: &str) -> Result<Recipe, String> {
    let found = TASKS.iter().find(|(n, _)| *n == name);
    let (_, text) = found.ok_or_else(|| format!("there is no task {name}"))?;
    ron::from_str(text).map_err(|e| e.to_string())
}

/// The two programs of `gpu/dab-32-in-256`.
#[cfg(test)]
pub(crate) fn dab() -> (Program, Program) {
    let work = Work {
        name: String::new(),
        kind: Kind::Dab {
            nodes: 32,
            within: 256,
        },
    };
    let made = work.made().expect("sound");
    (made.before.expect("an edit"), made.program)
}

impl Work {
    fn made(&self) -> Result<Made, String> {
        let whole = |recipe: &Recipe, step| {
            let program = Program::compile(recipe, &Placement::IDENTITY, step, &());
            Ok(Made {
                before: None,
                program: program.map_err(|e| e.to_string())?,
            })
        };
        match self.kind {
            Kind::Task(name, step) => whole(&task(name)?, step),
            Kind::Growth(n) => {
                let chair = task("chair")?;
                let side = chair.bounds().size().max_element();
                whole(&chair, side / (n - 1) as f32)
            }
            Kind::Tori(n) => Ok(Made {
                before: None,
                program: tori(2.0 / (n - 1) as f32, &exact(), &(), None)?,
            }),
            Kind::Baked(n) => {
                let mesh = Recipe::new(Node::Mesh {
                    mesh: MeshHash([0; 32]),
                    bounds: Aabb::around(Vec3::ZERO, Vec3::splat(0.5)),
                });
                Ok(Made {
                    before: None,
                    program: tori(2.0 / (n - 1) as f32, &mesh, &torus()?, None)?,
                })
            }
            Kind::Dab { nodes, within } => {
                let step = 2.0 / (within - 1) as f32;
                // On the surface of the first torus.
                let (angle, place) = PLACES[0];
                let at =
                    Vec3::from(place) + Quat::from_rotation_z(angle) * Vec3::new(0.4, 0.0, 0.0);
                let radius = 0.5 * nodes as f32 * step;
                Ok(Made {
                    before: Some(tori(step, &exact(), &(), None)?),
                    program: tori(step, &exact(), &(), Some((radius, at)))?,
                })
            }
        }
    }

    /// Times it so often after a first run that only warms up; the median counts.
    ///
    /// # Errors
    /// What the device refuses, in one line.
    pub fn run(
        &self,
        gpu: &Arc<Gpu>,
        options: SolidOptions,
        runs: usize,
    ) -> Result<Figures, String> {
        let Made { before, program } = self.made()?;
        let said = |e: GpuError| e.to_string();
        let mut solid =
            GpuSolid::make_with(gpu, before.as_ref().unwrap_or(&program), options).map_err(said)?;
        let (mut total, mut read, mut parts) = (Vec::new(), Vec::new(), Vec::new());
        for run in 0..=runs {
            match &before {
                Some(before) => {
                    if run > 0 {
                        solid.update(before).map_err(said)?;
                    }
                    solid.update(&program).map_err(said)?;
                }
                None => solid.make_again(&program).map_err(said)?,
            }
            let timing = solid.timing();
            let started = Instant::now();
            solid.mesh().map_err(said)?;
            if run > 0 {
                read.push(ms(started.elapsed()));
                total.push(ms(timing.total));
                let device = [timing.cull, timing.fuse, timing.extract];
                parts.push(device.map(|p| p.map_or(f64::NAN, ms)));
            }
        }
        let memory = solid.memory();
        let device = |k: usize| median(parts.iter().map(|p| p[k]).collect());
        Ok(Figures {
            name: self.name.clone(),
            range_ms: [
                total.iter().copied().fold(f64::INFINITY, f64::min),
                total.iter().copied().fold(0.0, f64::max),
            ],
            total_ms: median(total),
            device_ms: gpu.is_timed().then(|| [device(0), device(1), device(2)]),
            read_ms: median(read),
            processor_ms: on_processor(before.as_ref(), &program, runs)?,
            triangles: solid.size().0,
            bricks: memory.bricks,
            bytes: [memory.used, memory.reserved],
        })
    }
}

/// The same by the processor, milliseconds.
fn on_processor(before: Option<&Program>, program: &Program, runs: usize) -> Result<f64, String> {
    let options = FuseOptions::default();
    let said = |e: midair_field::FuseError| e.to_string();
    let mut times = Vec::new();
    for _ in 0..runs.max(1) {
        match before {
            None => {
                let started = Instant::now();
                let grid = fuse(program, &options).map_err(said)?;
                let surface = Surface::extract(&grid);
                times.push(ms(started.elapsed()));
                drop(surface);
            }
            Some(before) => {
                let mut grid = fuse(before, &options).map_err(said)?;
                let mut surface = Surface::extract(&grid);
                let started = Instant::now();
                let dirty = changed_box(before, program);
                let changed = refuse(&mut grid, program, &dirty, &options).map_err(said)?;
                let go = AtomicBool::new(false);
                surface
                    .update_unless(&grid, &changed, &go)
                    .map_err(|e| e.to_string())?;
                times.push(ms(started.elapsed()));
            }
        }
    }
    Ok(median(times))
}

/// The exponent with which bytes in use grow with the nodes along a side, from the first to the last of the
/// figures of `gpu/memory`; 2 is a surface, 3 a box.
pub fn growth(figures: &[Figures]) -> Option<f64> {
    let nodes = |f: &Figures| {
        f.name
            .strip_prefix("gpu/memory/chair-")?
            .parse::<f64>()
            .ok()
    };
    let of: Vec<(f64, f64)> = figures
        .iter()
        .filter_map(|f| Some((nodes(f)?, f.bytes[0] as f64)))
        .collect();
    let (first, last) = (of.first()?, of.last()?);
    (last.0 > first.0).then(|| (last.1 / first.1).ln() / (last.0 / first.0).ln())
}

fn ms(d: Duration) -> f64 {
    d.as_secs_f64() * 1e3
}

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    match all.len() {
        0 => f64::NAN,
        n => 0.5 * (all[(n - 1) / 2] + all[n / 2]),
    }
}
