use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::{IVec3, Vec3};
use midair_field::{BRICK, Program, changed_box};
use midair_mesh::Aabb;

use crate::Gpu;
use crate::error::GpuError;
use crate::flatten::Flat;
use crate::kernels::{For, Kernels};
use crate::layout::{Block, Globals, Stage, counter, overflow};
use crate::memory::{Buffers, Room, TIMES, read_back};
use crate::passes::{Groups, Recorder};

/// How a solid is kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolidOptions {
    /// Values as 16-bit multiples of 1e-4 steps instead of `f32`, at half the memory and up to half of that off,
    /// cut off 3.27 steps from the surface. Where φ is flat (very uneven scaling) they stay `f32`.
    pub quantised: bool,
    /// The same where the surface is moved by no more than this for it, metres: by half a multiple over the least |∇φ|
    /// of the solid's parts.
    pub within: Option<f32>,
}

impl SolidOptions {
    /// Whether a solid of this step is kept in 16 bits, the least |∇φ| of whose parts this is; 0 where it is not known.
    pub(crate) fn quantises(&self, step: f32, flattest: f32) -> bool {
        let moved = 0.5 * QUANTUM * step / flattest;
        flattest >= FLATTEST && (self.quantised || self.within.is_some_and(|most| moved <= most))
    }
}

/// How long the last making or update took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// From the call to the counters back in main memory, the device's own work included.
    pub total: Duration,
    /// On the device, by its own clock: which operands matter where. `None` where it has no clock.
    pub cull: Option<Duration>,
    /// Their fields at the nodes.
    pub fuse: Option<Duration>,
    /// The surface.
    pub extract: Option<Duration>,
}

/// Bytes on the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Bricks that hold values.
    pub bricks: u32,
    /// What bricks, page table and mesh take, gaps in the mesh included.
    pub used: u64,
    /// What the buffers take, room to grow and to work in included.
    pub reserved: u64,
}

/// One solid on the device: its field in bricks and its surface.
pub struct GpuSolid {
    pub(crate) gpu: Arc<Gpu>,
    pub(crate) buffers: Arc<Buffers>,
    pub(crate) room: Room,
    options: SolidOptions,
    pub(crate) made_for: For,
    program: Option<Program>,
    pub(crate) globals: Globals,
    pub(crate) counters: [u32; counter::COUNT],
    /// The meshes that `buffers.volumes` holds.
    meshes: Vec<Arc<midair_field::bake::Volume>>,
    pub(crate) timing: Timing,
}

/// An edit over more chunks than this is a making.
const MOST_CHUNKS: i64 = 4096;
/// An edit of more than this share of the box is a making.
const MUCH: f64 = 0.5;
/// Steps around a crossing where values are there, as the processor has it.
const AROUND: f32 = 2.0;
/// Of 16-bit values, and what is too near to zero to be told from it; in steps.
const QUANTUM: f32 = 1.0e-4;
/// Where |∇φ| may be less than this, 16 bits are not enough.
const FLATTEST: f32 = 0.25;

impl GpuSolid {
    /// Fuses and extracts a program on the device, values as `f32`.
    ///
    /// # Errors
    /// Whatever the device lacks; a painting or a depth that it does not know.
    pub fn make(gpu: &Arc<Gpu>, program: &Program) -> Result<Self, GpuError> {
        Self::make_with(gpu, program, SolidOptions::default())
    }

    /// As [`GpuSolid::make`], told how to keep it.
    ///
    /// # Errors
    /// As [`GpuSolid::make`].
    pub fn make_with(
        gpu: &Arc<Gpu>,
        program: &Program,
        options: SolidOptions,
    ) -> Result<Self, GpuError> {
        gpu.watched(|| {
            let flat = Flat::new(program)?;
            let room = guess(program, &flat, options)?;
            let mut solid = Self::empty(gpu, room, options)?;
            solid.remake(program, &flat)?;
            Ok(solid)
        })
    }

    /// A solid with room but nothing in it.
    pub(crate) fn empty(
        gpu: &Arc<Gpu>,
        room: Room,
        options: SolidOptions,
    ) -> Result<Self, GpuError> {
        Ok(Self {
            buffers: Arc::new(Buffers::new(gpu, &room)?),
            gpu: gpu.clone(),
            room,
            options,
            made_for: For::default(),
            program: None,
            globals: Globals::default(),
            counters: [0; counter::COUNT],
            meshes: Vec::new(),
            timing: Timing::default(),
        })
    }

    /// Brings it up to date: only the bricks in which the two programs can differ run again.
    ///
    /// # Errors
    /// As [`GpuSolid::make`]; the solid then holds nothing that can be relied on and the next update makes it whole.
    pub fn update(&mut self, program: &Program) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        gpu.watched(|| self.brought_up(program))
    }

    fn brought_up(&mut self, program: &Program) -> Result<(), GpuError> {
        let flat = Flat::new(program)?;
        // Taken out, so that an edit that fails half way is made up for as a whole.
        let before = self.program.take();
        let dirty = match &before {
            Some(before) if before.step() == program.step() => changed_box(before, program),
            _ => return self.remake(program, &flat),
        };
        if dirty.is_empty() {
            self.program = Some(program.clone());
            return Ok(());
        }
        let (low, high) = bricks_touching(&dirty, program.step());
        let span: IVec3 = (high >> 3) - (low >> 3) + 1;
        let chunks = span.as_i64vec3().element_product();
        let fits = flat.tape.len() as u32 <= self.room.tape / 4
            && flat.program.len() as u32 <= self.room.program
            && flat.volume_bytes() / 4 <= self.room.volumes.into()
            && (!self.room.quantised || self.options.quantises(program.step(), flat.flattest));
        // Most of it anew is sooner made whole, and leaves nothing of what was there before.
        if share(&dirty, program) > MUCH
            || chunks > MOST_CHUNKS.min(self.room.blocks.into())
            || !fits
            || self.globals.top < 3
        {
            return self.remake(program, &flat);
        }
        let started = Instant::now();
        if self.edit(program, &flat, low, high)? {
            self.timing.total = started.elapsed();
            self.program = Some(program.clone());
            return Ok(());
        }
        // Something ran out: made whole with more room.
        self.remake(program, &flat)
    }

    /// Whether an update would leave most of it as it is.
    pub fn is_near(&self, program: &Program) -> bool {
        let before = self.program.as_ref();
        before
            .filter(|before| before.step() == program.step())
            .is_some_and(|before| share(&changed_box(before, program), program) <= MUCH)
    }

    /// Bricks whose surface the last making or update made.
    pub fn renewed(&self) -> u32 {
        let counted = if self.globals.update == 1 {
            counter::WORK
        } else {
            counter::SLOTS
        };
        self.counters[counted]
    }

    /// Makes it whole on the buffers it has.
    ///
    /// # Errors
    /// As [`GpuSolid::make`].
    pub fn make_again(&mut self, program: &Program) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        gpu.watched(|| self.remake(program, &Flat::new(program)?))
    }

    /// Whether it lives on this device.
    pub fn is_on(&self, gpu: &Arc<Gpu>) -> bool {
        Arc::ptr_eq(&self.gpu, gpu)
    }

    /// Metres between nodes.
    pub fn step(&self) -> f32 {
        self.globals.step
    }

    /// How long the last making or update took.
    pub fn timing(&self) -> Timing {
        self.timing
    }

    /// Triangles and vertices of its surface.
    pub fn size(&self) -> (u32, u32) {
        (
            self.counters[counter::ALL_TRIANGLES],
            self.counters[counter::ALL_VERTICES],
        )
    }

    /// Whether values are kept as 16-bit numbers.
    pub fn is_quantised(&self) -> bool {
        self.room.quantised
    }

    /// Bytes on the device.
    pub fn memory(&self) -> Memory {
        let c = &self.counters;
        let bricks = c[counter::SLOTS] - c[counter::FREE];
        let record = 4 * crate::layout::STRIDE as u64;
        let each = 4 * u64::from(self.room.brick()) + record;
        let pages =
            (4 * 4 + 20) * u64::from(c[counter::CHUNKS]) + 2048 * u64::from(c[counter::TABLES]);
        let mesh = 24 * u64::from(c[counter::VERTICES]) + 12 * u64::from(c[counter::TRIANGLES]);
        Memory {
            bricks,
            used: u64::from(bricks) * each + pages + mesh,
            reserved: self.room.bytes(),
        }
    }

    /// Makes it whole, with more room as often as that is needed.
    fn remake(&mut self, program: &Program, flat: &Flat) -> Result<(), GpuError> {
        self.program = None;
        let wanted = guess(program, flat, self.options)?;
        if !holds(&self.room, &wanted) {
            self.grow(larger(&self.room, &wanted))?;
        }
        let started = Instant::now();
        for _ in 0..12 {
            self.whole(program, flat)?;
            let missing = self.counters[counter::OVERFLOW];
            if missing == 0 {
                self.timing.total = started.elapsed();
                self.program = Some(program.clone());
                return Ok(());
            }
            self.grow(self.room_for(missing))?;
        }
        Err(GpuError::Refused(format!(
            "the solid found no room ({:#x})",
            self.counters[counter::OVERFLOW]
        )))
    }

    /// The room that the counters asked for.
    fn room_for(&self, missing: u32) -> Room {
        let c = &self.counters;
        let mut room = self.room;
        // A quarter more than was asked for: what comes after what ran out may ask for more.
        let more = |now: u32, asked: u32| asked.max(now).saturating_add(asked.max(now) / 4 + 64);
        if missing & overflow::SLOTS != 0 {
            room.slots = more(room.slots, c[counter::SLOTS]);
        }
        if missing & overflow::CHUNKS != 0 {
            room.chunks = more(room.chunks, c[counter::CHUNKS]);
            room.tables = more(room.tables, c[counter::TABLES]);
        }
        if missing & overflow::BLOCKS != 0 {
            let levels = &c[counter::LEVELS..counter::VERTEX_HEADS];
            let most = levels.iter().copied().max().unwrap_or(0);
            room.blocks = more(room.blocks, most);
        }
        if missing & overflow::TAPE != 0 {
            room.tape = more(room.tape, c[counter::TAPE]);
        }
        if missing & overflow::VERTICES != 0 {
            room.vertices = more(room.vertices, c[counter::VERTICES]);
        }
        if missing & overflow::TRIANGLES != 0 {
            room.triangles = more(room.triangles, c[counter::TRIANGLES]);
        }
        room
    }

    fn grow(&mut self, room: Room) -> Result<(), GpuError> {
        room.check(&self.gpu)?;
        self.buffers = Arc::new(Buffers::new(&self.gpu, &room)?);
        self.room = room;
        self.meshes.clear();
        Ok(())
    }

    /// Uniforms, operands and counters for a descent from the `first` blocks.
    fn begin(&mut self, program: &Program, flat: &Flat, first: &[IVec3], level: u32) {
        let step = program.step();
        let b = program.bounds();
        let reach = b.min.abs().max(b.max.abs()).max_element();
        let g = &mut self.globals;
        g.step = step;
        g.slack = 1.0e-3 * step + 4.0e-6 * reach;
        g.around = AROUND * step;
        g.eps = QUANTUM * step;
        g.shapes = flat.shapes;
        self.made_for = match (flat.painted, self.room.quantised) {
            (true, _) => For::Painted,
            (false, true) => For::Quantised,
            (false, false) => For::Plain,
        };
        self.size_globals();
        let queue = &self.gpu.queue;
        queue.write_buffer(
            &self.buffers.program,
            0,
            bytemuck::cast_slice(&flat.program),
        );
        queue.write_buffer(&self.buffers.tape, 0, bytemuck::cast_slice(&flat.tape));
        let same = self.meshes.len() == flat.meshes.len()
            && self
                .meshes
                .iter()
                .zip(&flat.meshes)
                .all(|(a, b)| Arc::ptr_eq(a, b));
        if !same {
            let words = flat.volumes();
            queue.write_buffer(&self.buffers.volumes, 0, bytemuck::cast_slice(&words));
            self.meshes.clone_from(&flat.meshes);
        }
        let blocks: Vec<Block> = first
            .iter()
            .map(|c| Block {
                at: c.to_array(),
                off: 0,
                len: flat.tape.len() as u32,
                table: crate::layout::NONE,
            })
            .collect();
        queue.write_buffer(&self.buffers.blocks, 0, bytemuck::cast_slice(&blocks));
        let c = &mut self.counters;
        c[counter::TAPE] = flat.tape.len() as u32;
        c[counter::WORK] = 0;
        c[counter::OVERFLOW] = 0;
        c[counter::LEVELS..counter::VERTEX_HEADS].fill(0);
        c[counter::LEVELS + level as usize + 1] = blocks.len() as u32;
    }

    /// Numbers that follow from the room there is.
    pub(crate) fn size_globals(&mut self) {
        let (g, r) = (&mut self.globals, &self.room);
        g.slots = r.slots;
        g.hash_mask = r.hash() - 1;
        g.info_base = r.info_base();
        g.table_base = r.table_base();
        g.chunks = r.chunks;
        g.tables = r.tables;
        g.blocks = r.blocks;
        g.tape = r.tape;
        g.vertices = r.vertices;
        g.triangles = r.triangles;
    }

    pub(crate) fn write_numbers(&self) {
        let queue = &self.gpu.queue;
        queue.write_buffer(&self.buffers.globals, 0, bytemuck::bytes_of(&self.globals));
        queue.write_buffer(
            &self.buffers.counters,
            0,
            bytemuck::cast_slice(&self.counters),
        );
    }

    /// Everything, from the largest blocks down.
    fn whole(&mut self, program: &Program, flat: &Flat) -> Result<(), GpuError> {
        let step = program.step();
        let region = program.bounds().grown(step);
        self.counters = [0; counter::COUNT];
        if region.is_empty() {
            self.globals.step = step;
            self.globals.top = 0;
            return Ok(());
        }
        let (low, high) = bricks_touching(&region, step);
        let mut level = 3u32;
        while ((high >> level) - (low >> level)).max_element() >= 4 {
            level += 1;
        }
        let (first, last) = (low >> level, high >> level);
        let first: Vec<IVec3> = corners(first, last).collect();
        self.globals.low = low.to_array();
        self.globals.high = high.to_array();
        self.globals.top = level;
        self.globals.update = 0;
        self.begin(program, flat, &first, level);
        self.write_numbers();
        let (gpu, buffers) = (self.gpu.clone(), self.buffers.clone());
        let k = gpu.kernels(self.made_for)?;
        let times = self.times();
        let mut recorder = Recorder::new(&gpu, &buffers, times.as_ref());
        let hash = 4 * u64::from(self.room.hash());
        recorder.encoder.clear_buffer(&buffers.pages, 0, Some(hash));
        let tables = 4 * u64::from(self.room.table_base());
        recorder.encoder.clear_buffer(&buffers.pages, tables, None);
        let list = descend(
            &mut recorder,
            k,
            &self.room,
            level,
            first.len() as u32,
            None,
        );
        self.finish(recorder, k, list, times.as_ref())
    }

    /// The bricks from `low` to `high` anew; false where something ran out.
    fn edit(
        &mut self,
        program: &Program,
        flat: &Flat,
        low: IVec3,
        high: IVec3,
    ) -> Result<bool, GpuError> {
        let chunks: Vec<IVec3> = corners(low >> 3, high >> 3).collect();
        self.globals.low = low.to_array();
        self.globals.high = high.to_array();
        self.globals.mesh_low = (low - 2).to_array();
        self.globals.mesh_high = (high + 1).to_array();
        self.globals.update = 1;
        self.begin(program, flat, &chunks, 3);
        self.write_numbers();
        let (gpu, buffers) = (self.gpu.clone(), self.buffers.clone());
        let k = gpu.kernels(self.made_for)?;
        let times = self.times();
        let mut recorder = Recorder::new(&gpu, &buffers, times.as_ref());
        let linked = self.counters[counter::CHUNKS];
        let n = chunks.len() as u32;
        let list = descend(&mut recorder, k, &self.room, 3, n, Some(linked));
        self.finish(recorder, k, list, times.as_ref())?;
        Ok(self.counters[counter::OVERFLOW] == 0)
    }

    pub(crate) fn times(&self) -> Option<wgpu::QuerySet> {
        self.gpu.tick.map(|_| {
            self.gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count: TIMES,
            })
        })
    }

    /// Fuses the bricks in list `list`, extracts, and waits for the counters.
    fn finish(
        &mut self,
        mut recorder: Recorder,
        k: &Kernels,
        list: u32,
        times: Option<&wgpu::QuerySet>,
    ) -> Result<(), GpuError> {
        let room = self.room;
        recorder.pass("fuse", |p| {
            let groups = p.find(&k.args, counter::LEVELS, room.blocks, 1, 1);
            let stage = Stage {
                from_block: list * room.blocks,
                count_in: counter::LEVELS as u32,
                ..Stage::default()
            };
            p.run(&k.fuse, stage, groups, &[]);
        });
        let update = self.globals.update == 1;
        let box_size = IVec3::from(self.globals.mesh_high) - IVec3::from(self.globals.mesh_low) + 1;
        recorder.pass("extract", |p| {
            if update {
                let bricks = box_size.as_uvec3().element_product();
                p.run(
                    &k.gather,
                    Stage::default(),
                    Groups::Count(bricks.div_ceil(64)),
                    &[],
                );
            }
            extract(p, k, &room, update);
        });
        self.tell(recorder, times)
    }

    /// Submits, and reads counters and times.
    pub(crate) fn tell(
        &mut self,
        mut recorder: Recorder,
        times: Option<&wgpu::QuerySet>,
    ) -> Result<(), GpuError> {
        let bytes = 4 * counter::COUNT as u64;
        let (from, to) = (&self.buffers.counters, &self.buffers.told);
        recorder
            .encoder
            .copy_buffer_to_buffer(from, 0, to, 0, Some(bytes));
        let mut all = bytes;
        if let Some(set) = times {
            let resolved = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("times"),
                size: 8 * u64::from(TIMES),
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            recorder
                .encoder
                .resolve_query_set(set, 0..TIMES, &resolved, 0);
            recorder.encoder.copy_buffer_to_buffer(
                &resolved,
                0,
                to,
                bytes,
                Some(8 * u64::from(TIMES)),
            );
            all += 8 * u64::from(TIMES);
        }
        let refused = self
            .gpu
            .device
            .push_error_scope(wgpu::ErrorFilter::Validation);
        recorder.submit()?;
        let refused = crate::wait::block_on(refused.pop());
        self.gpu.check()?;
        if let Some(e) = refused {
            return Err(GpuError::refused(&e));
        }
        let words = read_back(&self.gpu, &self.buffers.told, all)?;
        self.counters.copy_from_slice(&words[..counter::COUNT]);
        self.timing = Timing::default();
        if let (Some(tick), Some(_)) = (self.gpu.tick, times) {
            let at = |i: usize| {
                let w = &words[counter::COUNT + 2 * i..];
                u64::from(w[0]) | u64::from(w[1]) << 32
            };
            let between = |i: usize| {
                let ticks = at(i + 1).saturating_sub(at(i)) as f64;
                Some(Duration::from_nanos((ticks * f64::from(tick)) as u64))
            };
            (self.timing.cull, self.timing.fuse) = (between(0), between(2));
            self.timing.extract = between(4);
        }
        Ok(())
    }
}

/// The descent from the list of `first` blocks at `level`; which of the two lists then holds the bricks.
/// An edit looks at chunks, those from `linked` on being new.
fn descend(
    recorder: &mut Recorder,
    k: &Kernels,
    room: &Room,
    level: u32,
    first: u32,
    linked: Option<u32>,
) -> u32 {
    recorder.pass("cull", |p| {
        if linked.is_some() {
            p.run(&k.touch, Stage::default(), Groups::Count(first), &[]);
        }
        let mut list = 0;
        for at in (0..=level).rev() {
            let top = at == level;
            let count_in = counter::LEVELS + at as usize + 1;
            let split = if top { 1 } else { 8 };
            let groups = if top {
                Groups::Count(first.div_ceil(64))
            } else {
                p.find(&k.args, count_in, room.blocks, split, 64)
            };
            let stage = Stage {
                level: at,
                split,
                from_block: list * room.blocks,
                to_block: (1 - list) * room.blocks,
                count_in: count_in as u32,
                count_out: counter::LEVELS as u32 + at,
                ..Stage::default()
            };
            p.run(&k.cull, stage, groups, &[]);
            list = 1 - list;
        }
        let groups = p.find(&k.args, counter::CHUNKS, room.chunks, 1, 64);
        let stage = Stage {
            from_block: linked.unwrap_or(0),
            ..Stage::default()
        };
        p.run(&k.link, stage, groups, &[]);
        list
    })
}

/// Classify, count, emit: all slots, or those of an edit.
pub(crate) fn extract(p: &mut crate::passes::Passes, k: &Kernels, room: &Room, update: bool) {
    let counted = if update {
        counter::WORK
    } else {
        counter::SLOTS
    };
    let groups = p.find(&k.args, counted, room.slots, 1, 1);
    for kernel in [&k.classify, &k.count, &k.emit] {
        p.run(kernel, Stage::default(), groups, &[]);
    }
}

/// How much of a program's box another is.
fn share(dirty: &Aabb, program: &Program) -> f64 {
    let volume = |b: &Aabb| f64::from(b.size().element_product());
    if dirty.is_empty() {
        0.0
    } else {
        volume(dirty) / volume(&program.bounds())
    }
}

/// All coordinates from `low` to `high`, both included.
pub(crate) fn corners(low: IVec3, high: IVec3) -> impl Iterator<Item = IVec3> {
    (low.z..=high.z).flat_map(move |z| {
        (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| IVec3::new(x, y, z)))
    })
}

/// The bricks that have a node within a cell of the box.
fn bricks_touching(b: &Aabb, step: f32) -> (IVec3, IVec3) {
    let side = BRICK as f32 * step;
    let low = (b.min - step).max(Vec3::splat(-1.0e9 * step)) / side;
    let high = (b.max + step).min(Vec3::splat(1.0e9 * step)) / side;
    (low.floor().as_ivec3(), high.floor().as_ivec3())
}

/// Room for a solid whose surface is about that of its box.
fn guess(program: &Program, flat: &Flat, options: SolidOptions) -> Result<Room, GpuError> {
    let step = program.step();
    let region = program.bounds().grown(step);
    let mut near = 0.0f64;
    if !region.is_empty() {
        let reach = region.min.abs().max(region.max.abs()).max_element();
        // Beyond this, single precision cannot tell neighbouring nodes apart.
        if reach / step > 4.0e6 || reach.is_nan() {
            return Err(GpuError::TooFine(step));
        }
        let (low, high) = bricks_touching(&region, step);
        let n = (high - low + 1).as_dvec3();
        near = (2.4 * (n.x * n.y + n.y * n.z + n.z * n.x)).min(n.x * n.y * n.z);
    }
    let slots = (near as u32).saturating_add(64);
    let len = flat.tape.len() as u32;
    Ok(Room {
        quantised: options.quantises(step, flat.flattest),
        slots,
        chunks: slots / 12 + 160,
        tables: slots / 16 + 128,
        blocks: slots + slots / 4 + 256,
        tape: (8 * slots)
            .saturating_mul(len.clamp(1, 6))
            .saturating_add(512u32.saturating_mul(len))
            .saturating_add(4096),
        vertices: 96 * slots,
        triangles: 192 * slots,
        program: flat.program.len() as u32,
        volumes: (flat.volume_bytes() / 4).min(u64::from(u32::MAX)) as u32,
    })
}

fn holds(room: &Room, wanted: &Room) -> bool {
    room.quantised == wanted.quantised
        && room.program >= wanted.program
        && room.volumes >= wanted.volumes
        && room.tape >= wanted.tape / 4
}

fn larger(a: &Room, b: &Room) -> Room {
    Room {
        quantised: b.quantised,
        slots: a.slots.max(b.slots),
        chunks: a.chunks.max(b.chunks),
        tables: a.tables.max(b.tables),
        blocks: a.blocks.max(b.blocks),
        tape: a.tape.max(b.tape),
        vertices: a.vertices.max(b.vertices),
        triangles: a.triangles.max(b.triangles),
        program: a.program.max(b.program) + a.program.max(b.program) / 2,
        volumes: a.volumes.max(b.volumes),
    }
}
