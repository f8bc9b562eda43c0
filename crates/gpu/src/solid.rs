mod room;
mod run;

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::IVec3;
use midair_field::{Program, changed_box};
use midair_mesh::Aabb;

use crate::Gpu;
use crate::error::GpuError;
use crate::flatten::Flat;
use crate::kernels::For;
use crate::layout::{Globals, counter};
use crate::memory::{Buffers, Room};
use room::{asked, guess, holds, larger};
use run::bricks_touching;
pub(crate) use run::{corners, extract_all};

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
            if self.counters[counter::OVERFLOW] == 0 {
                self.timing.total = started.elapsed();
                self.program = Some(program.clone());
                return Ok(());
            }
            self.grow(asked(self.room, &self.counters))?;
        }
        Err(GpuError::Refused(format!(
            "the solid found no room ({:#x})",
            self.counters[counter::OVERFLOW]
        )))
    }

    /// What it was made of is no longer what it holds.
    pub(crate) fn forget(&mut self) {
        self.program = None;
        self.meshes.clear();
    }

    pub(crate) fn grow(&mut self, room: Room) -> Result<(), GpuError> {
        room.check(&self.gpu)?;
        self.buffers = Arc::new(Buffers::new(&self.gpu, &room)?);
        self.room = room;
        self.meshes.clear();
        Ok(())
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
