//! What is run, in which order.

use crate::kernels::{Kernel, binding};
use crate::layout::{ROW, Stage};
use crate::memory::{Buffers, MOST_STAGES, Room, STAGE_BYTES};
use crate::{Gpu, GpuError};

/// How many groups a pass has.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Groups {
    /// So many.
    Count(u32),
    /// As an `args` pass has found, by its number.
    Found(u32),
}

/// Buffers that only some passes have.
pub(crate) type Extra<'a> = &'a [(u32, &'a wgpu::Buffer)];

/// Records passes and the stages that they read.
pub(crate) struct Recorder<'a> {
    pub gpu: &'a Gpu,
    pub buffers: &'a Buffers,
    pub encoder: wgpu::CommandEncoder,
    stages: Vec<Stage>,
    found: u32,
    times: Option<&'a wgpu::QuerySet>,
    timed: u32,
}

impl<'a> Recorder<'a> {
    pub fn new(gpu: &'a Gpu, buffers: &'a Buffers, times: Option<&'a wgpu::QuerySet>) -> Self {
        let encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: None });
        Self {
            gpu,
            buffers,
            encoder,
            stages: Vec::new(),
            found: 0,
            times,
            timed: 0,
        }
    }

    /// Nothing in the page table.
    pub fn clear_pages(&mut self, room: &Room) {
        let pages = &self.buffers.pages;
        let hash = 4 * u64::from(room.hash());
        self.encoder.clear_buffer(pages, 0, Some(hash));
        let tables = 4 * u64::from(room.table_base());
        self.encoder.clear_buffer(pages, tables, None);
    }

    /// Runs some passes one after the other; their time is taken together.
    pub fn pass<T>(&mut self, label: &str, run: impl FnOnce(&mut Passes<'_, 'a>) -> T) -> T {
        let writes = self.times.map(|set| wgpu::ComputePassTimestampWrites {
            query_set: set,
            beginning_of_pass_write_index: Some(self.timed),
            end_of_pass_write_index: Some(self.timed + 1),
        });
        self.timed += 2;
        let pass = self
            .encoder
            .begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(label),
                timestamp_writes: writes,
            });
        let mut passes = Passes {
            gpu: self.gpu,
            buffers: self.buffers,
            stages: &mut self.stages,
            found: &mut self.found,
            pass,
        };
        run(&mut passes)
    }

    /// Hands everything to the device.
    pub fn submit(self) -> Result<(), GpuError> {
        if self.stages.len() as u64 > MOST_STAGES {
            return Err(GpuError::Refused("too many stages".to_owned()));
        }
        let mut bytes = vec![0u8; STAGE_BYTES as usize * self.stages.len()];
        for (to, stage) in bytes.chunks_mut(STAGE_BYTES as usize).zip(&self.stages) {
            let from = bytemuck::bytes_of(stage);
            to[..from.len()].copy_from_slice(from);
        }
        if !bytes.is_empty() {
            self.gpu.queue.write_buffer(&self.buffers.stages, 0, &bytes);
        }
        self.gpu.queue.submit([self.encoder.finish()]);
        Ok(())
    }
}

/// Passes that are being recorded.
pub(crate) struct Passes<'p, 'a> {
    gpu: &'a Gpu,
    buffers: &'a Buffers,
    stages: &'p mut Vec<Stage>,
    found: &'p mut u32,
    pass: wgpu::ComputePass<'p>,
}

impl Passes<'_, '_> {
    pub fn run(&mut self, kernel: &Kernel, stage: Stage, groups: Groups, extra: Extra) {
        let at = STAGE_BYTES * self.stages.len() as u64;
        self.stages.push(stage);
        let b = self.buffers;
        let entries: Vec<_> = kernel
            .bindings
            .iter()
            .map(|&binding| {
                let resource = match binding {
                    binding::GLOBALS => whole_of(&b.globals, size_of::<crate::layout::Globals>()),
                    binding::STAGE => wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: &b.stages,
                        offset: at,
                        size: std::num::NonZeroU64::new(size_of::<Stage>() as u64),
                    }),
                    other => {
                        let buffer = match other {
                            binding::PROGRAM => &b.program,
                            binding::VOLUMES => &b.volumes,
                            binding::TAPE => &b.tape,
                            binding::BLOCKS => &b.blocks,
                            binding::COUNTERS => &b.counters,
                            binding::PAGES => &b.pages,
                            binding::VALUES => &b.values,
                            binding::BRICKS => &b.bricks,
                            binding::WORK => &b.work,
                            binding::VERTICES => &b.vertices,
                            binding::INDICES => &b.indices,
                            binding::INDIRECT => &b.indirect,
                            binding::CASES => &b.cases,
                            other => {
                                let own = extra.iter().find(|(n, _)| *n == other);
                                own.map_or(&b.counters, |(_, buffer)| buffer)
                            }
                        };
                        buffer.as_entire_binding()
                    }
                };
                wgpu::BindGroupEntry { binding, resource }
            })
            .collect();
        let group = self
            .gpu
            .device
            .create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &kernel.pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
        self.pass.set_pipeline(&kernel.pipeline);
        self.pass.set_bind_group(0, &group, &[]);
        match groups {
            Groups::Count(0) => {}
            Groups::Count(n) => self
                .pass
                .dispatch_workgroups(n.min(ROW), n.div_ceil(ROW), 1),
            Groups::Found(i) => self
                .pass
                .dispatch_workgroups_indirect(&b.indirect, 12 * u64::from(i)),
        }
    }

    /// How many groups a later pass has: a counter's value, at most `most`, times `split`, in groups of `group`.
    pub fn find(
        &mut self,
        args: &Kernel,
        counter: usize,
        most: u32,
        split: u32,
        group: u32,
    ) -> Groups {
        let target = *self.found;
        *self.found += 1;
        let stage = Stage {
            count_in: counter as u32,
            most,
            split,
            group,
            target_args: target,
            ..Stage::default()
        };
        self.run(args, stage, Groups::Count(1), &[]);
        Groups::Found(target)
    }
}

fn whole_of(buffer: &wgpu::Buffer, bytes: usize) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
        buffer,
        offset: 0,
        size: std::num::NonZeroU64::new(bytes as u64),
    })
}
