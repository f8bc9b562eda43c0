//! Fields back in main memory, and from there.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use glam::IVec3;
use midair_field::{BRICK, Brick, Grid};

use crate::Gpu;
use crate::error::GpuError;
use crate::kernels::For;
use crate::layout::{ALIVE, INSIDE, NEAR, NONE, STRIDE, Stage, TABLE, counter};
use crate::memory::{Room, buffer, read_back};
use crate::passes::{Groups, Recorder};
use crate::solid::{GpuSolid, SolidOptions, corners, extract_all};

/// Nodes of a brick.
const NODES: usize = BRICK * BRICK * BRICK;

impl GpuSolid {
    /// The whole field. Inside bricks are given one by one: meant for tests and small solids.
    ///
    /// # Errors
    /// As [`GpuSolid::mesh`].
    pub fn grid(&self) -> Result<Grid, GpuError> {
        self.gpu.watched(|| self.whole_grid())
    }

    fn whole_grid(&self) -> Result<Grid, GpuError> {
        let slots = u64::from(self.counters[counter::SLOTS]);
        let mut grid = Grid::new(self.globals.step);
        if slots == 0 {
            self.gpu.check()?;
            return Ok(grid);
        }
        let pages = self.copy(&self.buffers.pages, self.buffers.pages.size())?;
        let chunks = self.counters[counter::CHUNKS] as usize;
        let records = &pages[self.room.info_base() as usize..][..5 * chunks];
        // Large blocks first, so that what an edit put into them comes later.
        let mut records: Vec<&[u32]> = records.chunks_exact(5).collect();
        records.sort_by_key(|r| std::cmp::Reverse(r[3]));
        for r in records {
            let at = IVec3::new(r[0] as i32, r[1] as i32, r[2] as i32);
            if r[4] == NONE {
                let low = at << r[3];
                for c in corners(low, low + (1 << r[3]) - 1) {
                    grid.set(c, Some(Brick::Inside));
                }
                continue;
            }
            let table = &pages[self.room.table_base() as usize + 512 * r[4] as usize..][..512];
            for (c, entry) in corners(at * 8, at * 8 + 7).zip(table) {
                grid.set(c, (*entry == INSIDE).then_some(Brick::Inside));
            }
        }
        let brick = self.room.brick() as usize;
        let values = self.copy(&self.buffers.values, slots * 4 * brick as u64)?;
        let records = self.copy(&self.buffers.bricks, slots * 4 * STRIDE as u64)?;
        for (v, r) in values.chunks_exact(brick).zip(records.chunks_exact(STRIDE)) {
            if r[ALIVE] == 1 {
                let at = IVec3::new(r[0] as i32, r[1] as i32, r[2] as i32);
                grid.set(at, Some(self.brick_of(v)));
            }
        }
        Ok(grid)
    }

    fn brick_of(&self, words: &[u32]) -> Brick {
        let mut values = [0.0f32; NODES];
        for (i, v) in values.iter_mut().enumerate() {
            *v = if self.room.quantised {
                let half = (words[i / 2] >> (16 * (i % 2))) as u16 as i16;
                f32::from(half) * self.globals.eps
            } else {
                f32::from_bits(words[i])
            };
        }
        Brick::Values {
            min: values.iter().copied().fold(f32::INFINITY, f32::min),
            max: values.iter().copied().fold(f32::NEG_INFINITY, f32::max),
            values: Arc::new(values),
        }
    }

    fn copy(&self, from: &wgpu::Buffer, bytes: u64) -> Result<Vec<u32>, GpuError> {
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let told = buffer(&self.gpu, "a field on its way", bytes, usage)?;
        let mut recorder = Recorder::new(&self.gpu, &self.buffers, None);
        recorder
            .encoder
            .copy_buffer_to_buffer(from, 0, &told, 0, Some(bytes));
        recorder.submit()?;
        read_back(&self.gpu, &told, bytes)
    }

    /// A field of the processor's on the device, and its surface there.
    ///
    /// # Errors
    /// As [`GpuSolid::make`].
    pub fn from_grid(gpu: &Arc<Gpu>, grid: &Grid) -> Result<Self, GpuError> {
        let bricks = explicit(grid);
        let mut tables: BTreeMap<[i32; 3], Vec<u32>> = Default::default();
        let (mut values, mut records) = (Vec::new(), Vec::new());
        let mut enter = |c: IVec3, entry: u32| {
            let at = ((c.z & 7) << 6 | (c.y & 7) << 3 | c.x & 7) as usize;
            let chunk: IVec3 = c >> 3;
            tables
                .entry(chunk.to_array())
                .or_insert_with(|| vec![0; 512])[at] = entry;
        };
        for (c, brick) in &bricks {
            match brick {
                Brick::Inside => enter(*c, INSIDE),
                Brick::Values { values: v, .. } => {
                    enter(*c, NEAR + (records.len() / STRIDE) as u32);
                    let far = BRICK as f32 * grid.step();
                    values.extend(v.iter().map(|v| sane(*v, far).to_bits()));
                    let mut record = [0u32; STRIDE];
                    record[..3].copy_from_slice(&c.to_array().map(|x| x as u32));
                    record[ALIVE] = 1;
                    records.extend(record);
                }
            }
        }
        let places: HashMap<[i32; 3], u32> = tables.keys().copied().zip(0..).collect();
        for record in records.chunks_exact_mut(STRIDE) {
            let at = [
                record[0] as i32 >> 3,
                record[1] as i32 >> 3,
                record[2] as i32 >> 3,
            ];
            record[TABLE] = places.get(&at).copied().unwrap_or(NONE);
        }
        let slots = (records.len() / STRIDE) as u32;
        let room = Room {
            quantised: false,
            slots: slots.max(1),
            chunks: tables.len() as u32 + 1,
            tables: tables.len() as u32 + 1,
            blocks: 1,
            tape: 1,
            // What hostile fields may ask for.
            vertices: 2048 * slots.max(1),
            triangles: 4096 * slots.max(1),
            program: 1,
            volumes: 1,
        };
        let mut solid = Self::empty(gpu, room, SolidOptions::default())?;
        solid.size_globals();
        solid.globals.step = grid.step();
        solid.globals.eps = 1.0e-4 * grid.step();
        solid.globals.top = 3;
        solid.counters[counter::SLOTS] = slots;
        solid.counters[counter::CHUNKS] = tables.len() as u32;
        solid.counters[counter::TABLES] = tables.len() as u32;
        solid.write_numbers();
        let mut pages = Vec::new();
        for (i, at) in tables.keys().enumerate() {
            pages.extend(at.map(|x| x as u32));
            pages.extend([3, i as u32]);
        }
        let words: Vec<u32> = tables.values().flatten().copied().collect();
        let queue = &gpu.queue;
        let b = &solid.buffers;
        queue.write_buffer(
            &b.pages,
            4 * u64::from(room.info_base()),
            bytemuck::cast_slice(&pages),
        );
        queue.write_buffer(
            &b.pages,
            4 * u64::from(room.table_base()),
            bytemuck::cast_slice(&words),
        );
        queue.write_buffer(&b.values, 0, bytemuck::cast_slice(&values));
        queue.write_buffer(&b.bricks, 0, bytemuck::cast_slice(&records));
        let k = gpu.kernels(For::Plain)?;
        let mut recorder = Recorder::new(gpu, &solid.buffers, None);
        recorder.pass("extract", |p| {
            let groups = Groups::Count((tables.len() as u32).div_ceil(64));
            p.run(&k.link, Stage::default(), groups, &[]);
            extract_all(p, k, &room);
        });
        recorder.submit()?;
        let told = solid.copy(&solid.buffers.counters, 4 * counter::COUNT as u64)?;
        solid.counters.copy_from_slice(&told);
        Ok(solid)
    }
}

/// A value that the device's arithmetic reads as the processor does: what is no number or beyond all
/// measure lies outside.
fn sane(v: f32, far: f32) -> f32 {
    if v.abs() <= f32::MAX / 4.0 {
        v
    } else if (f32::MIN..0.0).contains(&v) {
        -far
    } else {
        far
    }
}

/// The bricks of a field, those that own crossed edges without holding values written out.
fn explicit(grid: &Grid) -> Vec<(IVec3, Brick)> {
    let far = BRICK as f32 * grid.step();
    let full = |v: f32| Brick::Values {
        values: Arc::new([v; NODES]),
        min: v,
        max: v,
    };
    let mut all = Vec::new();
    for c in grid.sorted_coords() {
        let Some(brick) = grid.brick(c) else {
            continue;
        };
        let around = || corners(c - 1, c + 1);
        let exposed = *brick == Brick::Inside && around().any(|n| grid.brick(n).is_none());
        all.push((c, if exposed { full(-far) } else { brick.clone() }));
        // Those before it that hold nothing: their last nodes have edges into this one.
        for n in corners(c - 1, c) {
            if grid.brick(n).is_none() {
                all.push((n, full(far)));
            }
        }
    }
    all.sort_by_key(|(c, _)| (c.z, c.y, c.x));
    all.dedup_by_key(|(c, _)| *c);
    all
}
