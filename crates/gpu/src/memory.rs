//! Buffers within a budget.

use crate::layout::{STRIDE, counter};
use crate::wait::block_on;
use crate::{Gpu, GpuError};

/// How many of each thing there is room for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Room {
    pub quantised: bool,
    /// Bricks with values.
    pub slots: u32,
    /// Records of chunks and inside blocks; twice as many places in the hash.
    pub chunks: u32,
    /// Tables of 8³ entries.
    pub tables: u32,
    /// Blocks in each of two lists.
    pub blocks: u32,
    /// Words of tape.
    pub tape: u32,
    pub vertices: u32,
    pub triangles: u32,
    /// Words of the program and of its meshes.
    pub program: u32,
    pub volumes: u32,
}

impl Room {
    /// Places in the hash of chunks, a power of two.
    pub fn hash(&self) -> u32 {
        (2 * self.chunks).next_power_of_two()
    }

    /// Where records of chunks begin in `pages`.
    pub fn info_base(&self) -> u32 {
        self.hash()
    }

    /// Where tables begin in `pages`.
    pub fn table_base(&self) -> u32 {
        self.hash() + 5 * self.chunks
    }

    /// Whether there is as much room of each kind that a brush takes.
    pub fn covers(&self, wanted: &Room) -> bool {
        self.quantised == wanted.quantised
            && self.slots >= wanted.slots
            && self.chunks >= wanted.chunks
            && self.tables >= wanted.tables
            && self.tape >= wanted.tape
            && self.vertices >= wanted.vertices
            && self.triangles >= wanted.triangles
            && self.volumes >= wanted.volumes
    }

    /// Words of values of one brick.
    pub fn brick(&self) -> u32 {
        if self.quantised { 256 } else { 512 }
    }

    /// The bytes of each buffer, in the order of [`Buffers`].
    pub fn sizes(&self) -> [(&'static str, u64); 10] {
        let words = |n: u64| 4 * n.max(1);
        let slots = u64::from(self.slots);
        [
            ("operands", words(self.program.into())),
            ("meshes", words(self.volumes.into())),
            ("operands of blocks", words(self.tape.into())),
            ("blocks", 24 * 2 * u64::from(self.blocks.max(1))),
            (
                "the page table",
                words(u64::from(self.table_base()) + 512 * u64::from(self.tables)),
            ),
            ("bricks", words(slots * u64::from(self.brick()))),
            ("records of bricks", words(slots * STRIDE as u64)),
            ("a list of bricks", words(slots)),
            ("vertices", words(6 * u64::from(self.vertices))),
            ("triangles", words(3 * u64::from(self.triangles))),
        ]
    }

    pub fn bytes(&self) -> u64 {
        self.sizes().iter().map(|(_, b)| b).sum()
    }

    /// An error where it is more than was granted or than one buffer may have.
    pub fn check(&self, gpu: &Gpu) -> Result<(), GpuError> {
        let most = gpu
            .limits
            .max_buffer_size
            .min(gpu.limits.max_storage_buffer_binding_size);
        for (what, needs) in self.sizes() {
            if needs > most {
                return Err(GpuError::Budget {
                    what,
                    needs,
                    budget: most,
                });
            }
        }
        if self.bytes() > gpu.budget {
            return Err(GpuError::Budget {
                what: "its field and surface",
                needs: self.bytes(),
                budget: gpu.budget,
            });
        }
        Ok(())
    }
}

/// What a solid has on the device.
#[derive(Debug)]
pub(crate) struct Buffers {
    pub globals: wgpu::Buffer,
    pub stages: wgpu::Buffer,
    pub cases: wgpu::Buffer,
    pub indirect: wgpu::Buffer,
    pub counters: wgpu::Buffer,
    /// Counters, then times, for reading.
    pub told: wgpu::Buffer,
    pub program: wgpu::Buffer,
    pub volumes: wgpu::Buffer,
    pub tape: wgpu::Buffer,
    pub blocks: wgpu::Buffer,
    pub pages: wgpu::Buffer,
    pub values: wgpu::Buffer,
    pub bricks: wgpu::Buffer,
    pub work: wgpu::Buffer,
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
}

/// Bytes between stages: the largest alignment that a device may ask for.
pub(crate) const STAGE_BYTES: u64 = 256;
/// The most stages and indirect dispatches of one go.
pub(crate) const MOST_STAGES: u64 = 96;
/// Times taken in one go: begin and end of three passes.
pub(crate) const TIMES: u32 = 6;

impl Buffers {
    pub fn new(gpu: &Gpu, room: &Room) -> Result<Self, GpuError> {
        use wgpu::BufferUsages as Use;
        room.check(gpu)?;
        let storage = Use::STORAGE | Use::COPY_DST | Use::COPY_SRC;
        let [
            program,
            volumes,
            tape,
            blocks,
            pages,
            values,
            bricks,
            work,
            vertices,
            indices,
        ] = room.sizes();
        let stored = |(what, bytes): (&'static str, u64)| buffer(gpu, what, bytes, storage);
        let told = 4 * counter::COUNT as u64 + 8 * u64::from(TIMES);
        let made = Self {
            globals: buffer(gpu, "uniforms", 256, Use::UNIFORM | Use::COPY_DST)?,
            stages: buffer(
                gpu,
                "stages",
                STAGE_BYTES * MOST_STAGES,
                Use::UNIFORM | Use::COPY_DST,
            )?,
            cases: buffer(gpu, "cases", 4096, Use::UNIFORM | Use::COPY_DST)?,
            indirect: buffer(
                gpu,
                "dispatches",
                12 * MOST_STAGES,
                Use::STORAGE | Use::INDIRECT,
            )?,
            counters: buffer(gpu, "counters", 4 * counter::COUNT as u64, storage)?,
            told: buffer(gpu, "counters", told, Use::MAP_READ | Use::COPY_DST)?,
            program: stored(program)?,
            volumes: stored(volumes)?,
            tape: stored(tape)?,
            blocks: stored(blocks)?,
            pages: stored(pages)?,
            values: stored(values)?,
            bricks: stored(bricks)?,
            work: stored(work)?,
            vertices: stored(vertices)?,
            indices: stored(indices)?,
        };
        let cases = crate::layout::case_rows();
        gpu.queue
            .write_buffer(&made.cases, 0, bytemuck::cast_slice(&cases));
        Ok(made)
    }
}

/// A buffer, or the error that there is no memory for it.
pub(crate) fn buffer(
    gpu: &Gpu,
    what: &'static str,
    bytes: u64,
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, GpuError> {
    gpu.check()?;
    if bytes > gpu.left.load(std::sync::atomic::Ordering::Relaxed) {
        return Err(GpuError::OutOfMemory { what, bytes });
    }
    let memory = gpu.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let valid = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(what),
        size: bytes,
        usage,
        mapped_at_creation: false,
    });
    let invalid = block_on(valid.pop());
    if block_on(memory.pop()).is_some() {
        return Err(GpuError::OutOfMemory { what, bytes });
    }
    gpu.check()?;
    match invalid {
        Some(e) => Err(GpuError::refused(&e)),
        None => Ok(buffer),
    }
}

/// The bytes of a buffer that can be read, once everything submitted is done.
pub(crate) fn read_back(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    bytes: u64,
) -> Result<Vec<u32>, GpuError> {
    let (tell, told) = std::sync::mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, 0..bytes, move |done| {
        let _ = tell.send(done);
    });
    gpu.wait()?;
    match told.recv() {
        Ok(Ok(())) => {}
        Ok(Err(e)) => return Err(GpuError::refused(&e)),
        Err(e) => return Err(GpuError::Lost(e.to_string())),
    }
    let view = buffer.get_mapped_range(0..bytes);
    let words = view
        .chunks_exact(4)
        .map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]]))
        .collect();
    drop(view);
    buffer.unmap();
    Ok(words)
}
