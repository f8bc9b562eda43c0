//! A triangle mesh as a volume brush: voxels, filled and smoothed on the device (3DBrushVR §4.2).

use std::sync::Arc;
use std::time::Instant;

use glam::{IVec3, Vec3};
use midair_mesh::TriMesh;

use crate::Gpu;
use crate::error::GpuError;
use crate::kernels::{For, binding};
use crate::layout::{Stage, counter};
use crate::memory::{Room, buffer};
use crate::passes::{Groups, Recorder};
use crate::solid::{GpuSolid, SolidOptions, corners, extract};

/// The most voxels: 1024 along each side, at two bits each.
const MOST_VOXELS: f64 = (1u64 << 30) as f64;

impl GpuSolid {
    /// The convolution surface of a closed mesh at a step (3DBrushVR §4.2): its voxels stand about the nodes of the
    /// lattice, those that triangles touch and those inside are filled, the potential of a node is the mean of the 27 around
    /// it, and the surface lies where that is a half. It is up to a step and a half thicker than the mesh.
    ///
    /// # Errors
    /// A mesh too large for its step, or what the device lacks.
    pub fn from_mesh(gpu: &Arc<Gpu>, mesh: &TriMesh, step: f32) -> Result<Self, GpuError> {
        gpu.watched(|| Self::brushed(gpu, mesh, step))
    }

    fn brushed(gpu: &Arc<Gpu>, mesh: &TriMesh, step: f32) -> Result<Self, GpuError> {
        let bounds = mesh.bounds();
        let (low, high) = (bounds.min / step, bounds.max / step);
        let sound = step > 0.0 && low.is_finite() && high.is_finite();
        let size = (high - low).as_dvec3() + 4.0;
        let reach = low.abs().max(high.abs()).max_element();
        if mesh.triangles.is_empty()
            || !sound
            || size.element_product() > MOST_VOXELS
            || reach > 4.0e6
        {
            return Err(GpuError::TooFine(step));
        }
        let (first, last) = (low.round().as_ivec3() - 1, high.round().as_ivec3() + 1);
        // Felt one node further.
        let (brick_low, brick_high): (IVec3, IVec3) = ((first - 1) >> 3, (last + 1) >> 3);
        let (chunk_low, chunk_high): (IVec3, IVec3) = (brick_low >> 3, brick_high >> 3);
        let chunks: Vec<IVec3> = corners(chunk_low, chunk_high).collect();
        let n = (brick_high - brick_low + 1).as_uvec3();
        let all = n.element_product();
        let mut slots = (3 * (n.x * n.y + n.y * n.z + n.z * n.x)).min(all);
        loop {
            let room = Room {
                quantised: false,
                slots,
                chunks: chunks.len() as u32 + 1,
                tables: chunks.len() as u32 + 1,
                blocks: 1,
                tape: 1,
                vertices: 160 * slots,
                triangles: 320 * slots,
                program: 1,
                volumes: 1,
            };
            let started = Instant::now();
            let mut solid = Self::empty(gpu, room, SolidOptions::default())?;
            let g = &mut solid.globals;
            (g.step, g.eps, g.top) = (step, 1.0e-4 * step, 3);
            (g.low, g.high) = (brick_low.to_array(), brick_high.to_array());
            (g.mesh_low, g.mesh_high) = (first.to_array(), last.to_array());
            g.shapes = mesh.triangles.len() as u32;
            solid.voxelise(mesh, &chunks, all)?;
            if solid.counters[counter::OVERFLOW] == 0 {
                solid.timing.total = started.elapsed();
                return Ok(solid);
            }
            if slots == all && solid.counters[counter::SLOTS] <= all {
                // Bricks all fit: the mesh did not.
                return Err(GpuError::Refused("a brush's mesh found no room".to_owned()));
            }
            slots = (2 * slots).min(all);
        }
    }

    fn voxelise(&mut self, mesh: &TriMesh, chunks: &[IVec3], bricks: u32) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        let buffers = self.buffers.clone();
        let room = self.room;
        self.size_globals();
        self.counters[counter::CHUNKS] = chunks.len() as u32;
        self.counters[counter::TABLES] = chunks.len() as u32;
        self.write_numbers();
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let step = self.globals.step;
        let triangles: Vec<Vec3> = (0..mesh.triangles.len())
            .flat_map(|t| mesh.corners(t).map(|p| p / step))
            .collect();
        let size = IVec3::from(self.globals.mesh_high) - IVec3::from(self.globals.mesh_low) + 1;
        let lines = (size.y * size.z) as u32;
        let words = u64::from((size.x as u32).div_ceil(32)) * u64::from(lines);
        let corners = buffer(
            &gpu,
            "a brush's triangles",
            12 * triangles.len() as u64,
            usage,
        )?;
        let voxels = buffer(&gpu, "a brush's voxels", 8 * words, usage)?;
        gpu.queue
            .write_buffer(&corners, 0, bytemuck::cast_slice(&triangles));
        let mut records = Vec::new();
        for (i, at) in chunks.iter().enumerate() {
            records.extend(at.to_array().map(|x| x as u32));
            records.extend([3, i as u32]);
        }
        let info = 4 * u64::from(room.info_base());
        gpu.queue
            .write_buffer(&buffers.pages, info, bytemuck::cast_slice(&records));
        let extra = [(binding::CORNERS, &corners), (binding::VOXELS, &voxels)];
        let k = gpu.kernels(For::Plain)?;
        let times = self.times();
        let mut recorder = Recorder::new(&gpu, &buffers, times.as_ref());
        let stage = Stage::default();
        recorder.pass("voxels", |p| {
            let groups = Groups::Count((chunks.len() as u32).div_ceil(64));
            p.run(&k.link, stage, groups, &[]);
            let triangles = mesh.triangles.len() as u32;
            p.run(&k.shell, stage, Groups::Count(triangles), &extra);
            p.run(&k.fill, stage, Groups::Count(lines.div_ceil(64)), &extra);
        });
        recorder.pass("smooth", |p| {
            p.run(&k.smoothed, stage, Groups::Count(bricks), &extra);
        });
        recorder.pass("extract", |p| extract(p, k, &room, false));
        self.tell(recorder, times.as_ref())
    }
}
