//! The passes: which source, which entry, which buffers.

use crate::GpuError;
use crate::wait::block_on;

/// A pass. Its sources are put one after the other into one module.
pub(crate) struct Source {
    pub name: &'static str,
    pub files: &'static [&'static str],
}

const COMMON: &str = include_str!("../shaders/common.wgsl");
const SHAPE: &str = include_str!("../shaders/shape.wgsl");
const PAINT: &str = include_str!("../shaders/paint.wgsl");
const FELT: &str = include_str!("../shaders/felt.wgsl");
const TAPE: &str = include_str!("../shaders/tape.wgsl");
const RANGES: &str = include_str!("../shaders/ranges.wgsl");

/// Every module by name.
pub(crate) const SOURCES: [Source; 6] = [
    Source {
        name: "cull.wgsl",
        files: &[
            COMMON,
            SHAPE,
            PAINT,
            FELT,
            TAPE,
            include_str!("../shaders/cull.wgsl"),
        ],
    },
    Source {
        name: "touch.wgsl",
        files: &[COMMON, RANGES, include_str!("../shaders/touch.wgsl")],
    },
    Source {
        name: "fuse.wgsl",
        files: &[
            COMMON,
            SHAPE,
            PAINT,
            FELT,
            TAPE,
            include_str!("../shaders/fuse.wgsl"),
        ],
    },
    Source {
        name: "extract.wgsl",
        files: &[COMMON, RANGES, include_str!("../shaders/extract.wgsl")],
    },
    Source {
        name: "compact.wgsl",
        files: &[COMMON, include_str!("../shaders/compact.wgsl")],
    },
    Source {
        name: "voxels.wgsl",
        files: &[COMMON, include_str!("../shaders/voxels.wgsl")],
    },
];

/// Numbers of buffers in the shaders.
pub(crate) mod binding {
    pub const GLOBALS: u32 = 0;
    pub const STAGE: u32 = 1;
    pub const PROGRAM: u32 = 2;
    pub const VOLUMES: u32 = 3;
    pub const TAPE: u32 = 4;
    pub const BLOCKS: u32 = 5;
    pub const COUNTERS: u32 = 6;
    pub const PAGES: u32 = 7;
    pub const VALUES: u32 = 8;
    pub const BRICKS: u32 = 9;
    pub const WORK: u32 = 10;
    pub const VERTICES: u32 = 11;
    pub const INDICES: u32 = 12;
    pub const INDIRECT: u32 = 13;
    pub const CASES: u32 = 14;
    pub const OFFSETS: u32 = 15;
    pub const TIGHT_VERTICES: u32 = 16;
    pub const TIGHT_INDICES: u32 = 17;
    pub const RENUMBERED: u32 = 18;
    pub const CORNERS: u32 = 19;
    pub const VOXELS: u32 = 20;
}

/// A pass ready to run.
#[derive(Debug)]
pub(crate) struct Kernel {
    pub pipeline: wgpu::ComputePipeline,
    /// The buffers it reads and writes.
    pub bindings: &'static [u32],
}

/// What passes are compiled for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum For {
    /// `f32`, no painting.
    #[default]
    Plain,
    /// 16-bit values.
    Quantised,
    /// Paintings among the leaves.
    Painted,
}

/// All passes of one kind.
#[derive(Debug)]
pub(crate) struct Kernels {
    pub cull: Kernel,
    pub link: Kernel,
    pub args: Kernel,
    pub touch: Kernel,
    pub gather: Kernel,
    pub fuse: Kernel,
    pub classify: Kernel,
    pub count: Kernel,
    pub emit: Kernel,
    pub scan_tiles: Kernel,
    pub scan_sums: Kernel,
    pub compact_vertices: Kernel,
    pub compact_triangles: Kernel,
    pub shell: Kernel,
    pub fill: Kernel,
    pub smoothed: Kernel,
}

impl Kernels {
    /// Compiles all passes; `sources` in the order of [`SOURCES`].
    pub fn compile(
        device: &wgpu::Device,
        sources: &[(String, String)],
        made_for: For,
    ) -> Result<Self, GpuError> {
        use binding::*;
        let mut modules = Vec::with_capacity(sources.len());
        for (name, text) in sources {
            modules.push((name.as_str(), module(device, name, text)?));
        }
        let make = |module: usize, entry: &str, bindings: &'static [u32]| {
            let (name, module) = &modules[module];
            kernel(device, name, module, entry, bindings, made_for)
        };
        Ok(Self {
            cull: make(
                0,
                "cull",
                &[
                    GLOBALS, STAGE, PROGRAM, VOLUMES, TAPE, BLOCKS, COUNTERS, PAGES,
                ],
            )?,
            link: make(0, "link", &[GLOBALS, STAGE, COUNTERS, PAGES])?,
            args: make(0, "args", &[STAGE, COUNTERS, INDIRECT])?,
            touch: make(
                1,
                "touch",
                &[
                    GLOBALS, STAGE, BLOCKS, COUNTERS, PAGES, BRICKS, VERTICES, INDICES,
                ],
            )?,
            gather: make(
                1,
                "gather",
                &[GLOBALS, COUNTERS, PAGES, BRICKS, WORK, VERTICES, INDICES],
            )?,
            fuse: make(
                2,
                "fuse",
                &[
                    GLOBALS, STAGE, PROGRAM, VOLUMES, TAPE, BLOCKS, COUNTERS, PAGES, VALUES, BRICKS,
                ],
            )?,
            classify: make(3, "classify", &[GLOBALS, COUNTERS, VALUES, BRICKS, WORK])?,
            count: make(
                3,
                "count",
                &[
                    GLOBALS, COUNTERS, PAGES, BRICKS, WORK, VERTICES, INDICES, CASES,
                ],
            )?,
            emit: make(
                3,
                "emit",
                &[
                    GLOBALS, COUNTERS, PAGES, VALUES, BRICKS, WORK, VERTICES, INDICES, CASES,
                ],
            )?,
            scan_tiles: make(4, "scan_tiles", &[GLOBALS, COUNTERS, BRICKS, OFFSETS])?,
            scan_sums: make(4, "scan_sums", &[GLOBALS, OFFSETS])?,
            compact_vertices: make(
                4,
                "compact_vertices",
                &[
                    GLOBALS,
                    COUNTERS,
                    BRICKS,
                    VERTICES,
                    OFFSETS,
                    TIGHT_VERTICES,
                    RENUMBERED,
                ],
            )?,
            compact_triangles: make(
                4,
                "compact_triangles",
                &[
                    GLOBALS,
                    COUNTERS,
                    BRICKS,
                    INDICES,
                    OFFSETS,
                    TIGHT_INDICES,
                    RENUMBERED,
                ],
            )?,
            shell: make(5, "shell", &[GLOBALS, CORNERS, VOXELS])?,
            fill: make(5, "fill", &[GLOBALS, VOXELS])?,
            smoothed: make(
                5,
                "smoothed",
                &[GLOBALS, COUNTERS, PAGES, VALUES, BRICKS, VOXELS],
            )?,
        })
    }
}

/// The sources as they are in the tree, by name.
pub(crate) fn sources() -> Vec<(String, String)> {
    let text = |s: &Source| (s.name.to_owned(), s.files.concat());
    SOURCES.iter().map(text).collect()
}

fn module(device: &wgpu::Device, name: &str, text: &str) -> Result<wgpu::ShaderModule, GpuError> {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    match block_on(scope.pop()) {
        Some(error) => Err(refused(name, &error)),
        None => Ok(module),
    }
}

fn kernel(
    device: &wgpu::Device,
    name: &str,
    module: &wgpu::ShaderModule,
    entry: &str,
    bindings: &'static [u32],
    made_for: For,
) -> Result<Kernel, GpuError> {
    let is = |wanted| f64::from(u8::from(made_for == wanted));
    let constants = [
        ("QUANTISED", is(For::Quantised)),
        ("PAINTED", is(For::Painted)),
    ];
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: None,
        module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions {
            constants: &constants,
            // Every pass writes its workgroup's memory before it reads it.
            zero_initialize_workgroup_memory: false,
        },
        cache: None,
    });
    match block_on(scope.pop()) {
        Some(error) => Err(refused(&format!("{name}, {entry}"), &error)),
        None => Ok(Kernel { pipeline, bindings }),
    }
}

fn refused(name: &str, error: &wgpu::Error) -> GpuError {
    let text = error.to_string();
    let lines = text.lines().map(str::trim).filter(|l| !l.is_empty());
    // The first line says only that something is wrong; the next ones what.
    let reason: Vec<&str> = lines.skip(1).take(3).collect();
    GpuError::Shader {
        name: name.to_owned(),
        reason: if reason.is_empty() {
            text
        } else {
            reason.join(" ")
        },
    }
}
