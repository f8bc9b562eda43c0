//! What the device is told to do: the descent to the bricks near the surface, their fields, the surface.

use std::sync::Arc;
use std::time::Duration;

use glam::{IVec3, Vec3};
use midair_field::{BRICK, Program};
use midair_mesh::Aabb;

use super::{GpuSolid, QUANTUM, Timing};
use crate::error::GpuError;
use crate::flatten::Flat;
use crate::kernels::{For, Kernels};
use crate::layout::{Block, Stage, counter};
use crate::memory::{Room, TIMES, read_back};
use crate::passes::{Groups, Passes, Recorder};

/// Steps around a crossing where values are there, as the processor has it.
const AROUND: f32 = 2.0;

impl GpuSolid {
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
    pub(super) fn whole(&mut self, program: &Program, flat: &Flat) -> Result<(), GpuError> {
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
        recorder.clear_pages(&self.room);
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
    pub(super) fn edit(
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

/// Signs, counts and the surface of all slots, whose values something else than `fuse` has made.
pub(crate) fn extract_all(p: &mut Passes, k: &Kernels, room: &Room) {
    let groups = p.find(&k.args, counter::SLOTS, room.slots, 1, 1);
    for kernel in [&k.classify, &k.count, &k.emit] {
        p.run(kernel, Stage::default(), groups, &[]);
    }
}

/// Counts and the surface of all slots that were fused, or of those of an edit.
fn extract(p: &mut Passes, k: &Kernels, room: &Room, update: bool) {
    let counted = if update {
        counter::WORK
    } else {
        counter::SLOTS
    };
    let groups = p.find(&k.args, counted, room.slots, 1, 1);
    for kernel in [&k.count, &k.emit] {
        p.run(kernel, Stage::default(), groups, &[]);
    }
}

/// All coordinates from `low` to `high`, both included.
pub(crate) fn corners(low: IVec3, high: IVec3) -> impl Iterator<Item = IVec3> {
    (low.z..=high.z).flat_map(move |z| {
        (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| IVec3::new(x, y, z)))
    })
}

/// The bricks that have a node within a cell of the box.
pub(super) fn bricks_touching(b: &Aabb, step: f32) -> (IVec3, IVec3) {
    let side = BRICK as f32 * step;
    let low = (b.min - step).max(Vec3::splat(-1.0e9 * step)) / side;
    let high = (b.max + step).min(Vec3::splat(1.0e9 * step)) / side;
    (low.floor().as_ivec3(), high.floor().as_ivec3())
}
