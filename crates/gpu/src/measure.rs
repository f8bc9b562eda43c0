//! Workloads of the GPU: what `midair bench` and the small program `measure` time.

use std::f32::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use glam::{Quat, Vec3};
use midair_field::bake::{BakeOptions, Progress, Volume, bake};
use midair_field::{
    FuseOptions, MeshSource, Node, Op, Operand, Placement, Primitive, Program, Recipe, fuse,
    refuse_from,
};
use midair_mesh::{Aabb, MeshHash, TriMesh};
use midair_surface::Surface;

use crate::{Gpu, GpuError, GpuSolid, SolidOptions, Timing};

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
    /// 4³ tori that fill a lattice of so many nodes, a side of two metres.
    Full(u32),
    /// Five baked tori of 64³ nodes each in such a lattice.
    Baked(u32),
    /// 4³ tori as above, a ball of so many nodes across set on the surface of one.
    Dab { nodes: u32, within: u32 },
    /// A mesh of 25,000 triangles as a volume brush, at so many nodes along its longest side.
    Brush(u32),
    /// The chair at so many nodes along its longest side.
    Growth(u32),
    /// Somebody else's.
    Own(Own),
}

/// Gives what was there before, where it is an edit, and what is to be made.
type Make = dyn Fn() -> Result<(Option<Program>, Program), String> + Send + Sync;

#[derive(Clone)]
struct Own(Arc<Make>);

impl std::fmt::Debug for Own {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Own")
    }
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
    /// How many runs these are of.
    pub runs: usize,
    /// The device's own clock: culling, fusing, extracting; of a brush voxels, smoothing, extracting. `None` where it has none.
    pub device_ms: Option<[f64; 3]>,
    /// The mesh copied to main memory.
    pub read_ms: f64,
    /// The same work by the processor; for a brush, baking it.
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

/// What takes longer than this is not run again, however many runs are asked for.
const PATIENCE: Duration = Duration::from_secs(15);

/// For so long a card is kept busy before a clock looks: one that idles turns at a sixth of its speed and needs that long
/// to notice that it does not, and one that draws the studio ninety times a second does not idle.
const WARM: Duration = Duration::from_millis(400);

/// The surface is read back so often at most: what that takes is not what counts.
const READS: usize = 5;

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
    add("gpu/full-256".into(), Kind::Full(256));
    add("gpu/baked-256".into(), Kind::Baked(256));
    let dab = |nodes, within| Kind::Dab { nodes, within };
    add("gpu/dab-32-in-256".into(), dab(32, 256));
    add("gpu/dab-in-512".into(), dab(32, 512));
    for n in [128, 256] {
        add(format!("gpu/brush-25k/{n}"), Kind::Brush(n));
    }
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

/// Five baked tori.
fn baked(step: f32) -> Result<Program, String> {
    let mesh = Recipe::new(Node::Mesh {
        mesh: MeshHash([0; 32]),
        bounds: Aabb::around(Vec3::ZERO, Vec3::splat(0.5)),
    });
    let operands = PLACES.map(|(angle, place)| Operand {
        op: Op::Union,
        placement: Placement {
            translation: Vec3::from(place) + 0.5 * step,
            rotation: Quat::from_rotation_z(angle),
            scale: Vec3::ONE,
        },
        recipe: mesh.clone(),
        muted: false,
    });
    let recipe = Recipe::new(Node::Solid(operands.to_vec()));
    Program::compile(&recipe, &Placement::IDENTITY, step, &torus()?).map_err(|e| e.to_string())
}

/// 4³ tori, turned this way and that, and perhaps a ball on the surface of the first.
fn full(step: f32, dab: Option<f32>) -> Result<Program, String> {
    let torus = Recipe::from(Primitive::Torus {
        major: 0.15,
        minor: 0.075,
    });
    let mut operands = Vec::new();
    for i in 0..64 {
        let cell = Vec3::new((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32);
        operands.push(Operand {
            op: Op::Union,
            placement: Placement {
                translation: 0.48 * (cell - 1.5),
                rotation: Quat::from_scaled_axis(Vec3::new(0.7, 0.3, 1.1) * i as f32),
                scale: Vec3::ONE,
            },
            recipe: torus.clone(),
            muted: false,
        });
    }
    if let Some(radius) = dab {
        // The first stands unturned, about y.
        let at = 0.48 * Vec3::splat(-1.5) + Vec3::new(0.15, 0.075, 0.0);
        operands.push(Operand {
            op: Op::Union,
            placement: Placement::at(at),
            recipe: Primitive::Sphere { radius }.into(),
            muted: false,
        });
    }
    let recipe = Recipe::new(Node::Solid(operands));
    Program::compile(&recipe, &Placement::IDENTITY, step, &()).map_err(|e| e.to_string())
}

/// A torus of 25,000 triangles about y, 0.5 m across.
fn brush() -> TriMesh {
    let (n, m) = (125u32, 100u32);
    let mut mesh = TriMesh::default();
    for i in 0..n {
        for j in 0..m {
            let (u, v) = (i as f32 / n as f32 * TAU, j as f32 / m as f32 * TAU);
            let r = 0.17 + 0.08 * v.cos();
            mesh.positions
                .push(Vec3::new(r * u.cos(), 0.08 * v.sin(), r * u.sin()));
            let at = |i: u32, j: u32| i % n * m + j % m;
            mesh.triangles.push([at(i, j), at(i, j + 1), at(i + 1, j)]);
            mesh.triangles
                .push([at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)]);
        }
    }
    mesh
}

fn task(name: &str) -> Result<Recipe, String> {
    let found = TASKS.iter().find(|(n, _)| *n == name);
    let (_, text) = found.ok_or_else(|| format!("there is no task {name}"))?;
    ron::from_str(text).map_err(|e| e.to_string())
}

/// A dab of so many nodes in so many: before, after.
#[cfg(test)]
pub(crate) fn dab(nodes: u32, within: u32) -> (Program, Program) {
    let step = 2.0 / (within - 1) as f32;
    let made = |dab| full(step, dab).expect("sound");
    (made(None), made(Some(0.5 * nodes as f32 * step)))
}

impl Work {
    /// Another workload: `make` gives, when its turn comes, what was there before, where it is an edit, and what is to be
    /// made; or one line that says why it cannot.
    pub fn new(
        name: impl Into<String>,
        make: impl Fn() -> Result<(Option<Program>, Program), String> + Send + Sync + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            kind: Kind::Own(Own(Arc::new(make))),
        }
    }

    fn made(&self) -> Result<Made, String> {
        let whole = |recipe: &Recipe, step| {
            let program = Program::compile(recipe, &Placement::IDENTITY, step, &());
            Ok(Made {
                before: None,
                program: program.map_err(|e| e.to_string())?,
            })
        };
        match &self.kind {
            &Kind::Task(name, step) => whole(&task(name)?, step),
            &Kind::Growth(n) => {
                let chair = task("chair")?;
                let side = chair.bounds().size().max_element();
                whole(&chair, side / (n - 1) as f32)
            }
            &Kind::Full(n) => Ok(Made {
                before: None,
                program: full(2.0 / (n - 1) as f32, None)?,
            }),
            &Kind::Baked(n) => Ok(Made {
                before: None,
                program: baked(2.0 / (n - 1) as f32)?,
            }),
            &Kind::Dab { nodes, within } => {
                let step = 2.0 / (within - 1) as f32;
                Ok(Made {
                    before: Some(full(step, None)?),
                    program: full(step, Some(0.5 * nodes as f32 * step))?,
                })
            }
            Kind::Brush(_) => Err("a brush is no recipe".to_owned()),
            Kind::Own(Own(make)) => {
                let (before, program) = make()?;
                Ok(Made { before, program })
            }
        }
    }

    /// Voxels, smoothing and surface of a mesh (3DBrushVR Table 2).
    fn run_brush(&self, gpu: &Arc<Gpu>, n: u32, runs: usize) -> Result<Figures, String> {
        let mesh = brush();
        let step = mesh.bounds().size().max_element() / (n - 1) as f32;
        let said = |e: GpuError| e.to_string();
        let mut solid = GpuSolid::from_mesh(gpu, &mesh, step).map_err(said)?;
        let timed = timed(gpu, runs, || {
            solid.make_again_from(&mesh, step).map_err(said)?;
            Ok(solid.timing())
        })?;
        let mut processor = Vec::new();
        let begun = Instant::now();
        for run in 0..runs.max(1) {
            if run > 0 && begun.elapsed() > PATIENCE {
                break;
            }
            let started = Instant::now();
            let options = BakeOptions::with_step(step);
            bake(&mesh, &options, &Progress::new()).map_err(|e| e.to_string())?;
            processor.push(ms(started.elapsed()));
        }
        self.figures(gpu, &solid, &timed, median(processor))
    }

    fn figures(
        &self,
        gpu: &Gpu,
        solid: &GpuSolid,
        timed: &[Timing],
        processor_ms: f64,
    ) -> Result<Figures, String> {
        let mut read = Vec::new();
        for _ in 0..timed.len().min(READS) {
            let started = Instant::now();
            solid.mesh().map_err(|e| e.to_string())?;
            read.push(ms(started.elapsed()));
        }
        let total: Vec<f64> = timed.iter().map(|t| ms(t.total)).collect();
        let part = |of: fn(&Timing) -> Option<Duration>| {
            median(timed.iter().map(|t| of(t).map_or(f64::NAN, ms)).collect())
        };
        let memory = solid.memory();
        Ok(Figures {
            name: self.name.clone(),
            range_ms: [
                total.iter().copied().fold(f64::INFINITY, f64::min),
                total.iter().copied().fold(0.0, f64::max),
            ],
            runs: total.len(),
            total_ms: median(total),
            device_ms: gpu
                .is_timed()
                .then(|| [part(|t| t.cull), part(|t| t.fuse), part(|t| t.extract)]),
            read_ms: median(read),
            processor_ms,
            triangles: solid.size().0,
            bricks: memory.bricks,
            bytes: [memory.used, memory.reserved],
        })
    }

    /// Times it so often on a card that is warm, one run right after the other, less often what takes very long; the
    /// median counts.
    ///
    /// # Errors
    /// What the device refuses, in one line.
    pub fn run(
        &self,
        gpu: &Arc<Gpu>,
        options: SolidOptions,
        runs: usize,
    ) -> Result<Figures, String> {
        if let Kind::Brush(n) = self.kind {
            return self.run_brush(gpu, n, runs);
        }
        let Made { before, program } = self.made()?;
        let said = |e: GpuError| e.to_string();
        let first = before.as_ref().unwrap_or(&program);
        let mut solid = GpuSolid::make_with(gpu, first, options).map_err(said)?;
        let mut done = false;
        let timed = timed(gpu, runs, || {
            match &before {
                Some(before) => {
                    if std::mem::replace(&mut done, true) {
                        solid.update(before).map_err(said)?;
                    }
                    solid.update(&program).map_err(said)?;
                }
                None => solid.make_again(&program).map_err(said)?,
            }
            Ok(solid.timing())
        })?;
        let processor = on_processor(before.as_ref(), &program, timed.len())?;
        self.figures(gpu, &solid, &timed, processor)
    }
}

/// Runs it so often on a card that is warm and gives what each run took.
fn timed(
    gpu: &Arc<Gpu>,
    runs: usize,
    mut run: impl FnMut() -> Result<Timing, String>,
) -> Result<Vec<Timing>, String> {
    warm(gpu)?;
    let begun = Instant::now();
    // What only this run needs is there after the first.
    run()?;
    let mut all = Vec::new();
    while all.len() < runs && (all.is_empty() || begun.elapsed() < PATIENCE) {
        all.push(run()?);
    }
    Ok(all)
}

/// Keeps a real card busy until it turns as fast as it can.
fn warm(gpu: &Arc<Gpu>) -> Result<(), String> {
    if gpu.adapter().software {
        return Ok(());
    }
    let program = full(2.0 / 255.0, None)?;
    let begun = Instant::now();
    let mut solid = GpuSolid::make(gpu, &program).map_err(|e| e.to_string())?;
    while begun.elapsed() < WARM {
        solid.make_again(&program).map_err(|e| e.to_string())?;
    }
    Ok(())
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
                let changed = refuse_from(&mut grid, before, program, &options).map_err(said)?;
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
