//! A triangle mesh as a volume brush: voxels, filled and smoothed on the device (3DBrushVR §4.2).

use std::sync::Arc;
use std::time::Instant;

use glam::IVec3;
use midair_mesh::TriMesh;

use crate::Gpu;
use crate::error::GpuError;
use crate::kernels::{For, binding};
use crate::layout::{Stage, counter};
use crate::memory::Room;
use crate::passes::{Groups, Recorder};
use crate::solid::{GpuSolid, SolidOptions, corners, extract_all};

/// The most voxels: 1024 along each side, at two bits each.
const MOST_VOXELS: f64 = (1u64 << 30) as f64;

/// Where a brush's voxels, bricks and chunks lie.
struct Brush {
    step: f32,
    /// First and last voxel.
    voxels: [IVec3; 2],
    /// Bricks that feel them.
    bricks: [IVec3; 2],
    chunks: Vec<IVec3>,
    triangles: u32,
    /// Words of triangles and corners.
    corners: u32,
}

impl Brush {
    fn new(mesh: &TriMesh, step: f32) -> Result<Self, GpuError> {
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
        let voxels = [low.round().as_ivec3() - 1, high.round().as_ivec3() + 1];
        // Felt one node further.
        let bricks = [(voxels[0] - 1) >> 3, (voxels[1] + 1) >> 3];
        Ok(Self {
            step,
            voxels,
            bricks,
            chunks: corners(bricks[0] >> 3, bricks[1] >> 3).collect(),
            triangles: mesh.triangles.len() as u32,
            corners: 3 * (mesh.triangles.len() + mesh.positions.len()) as u32,
        })
    }

    fn most_slots(&self) -> u32 {
        (self.bricks[1] - self.bricks[0] + 1)
            .as_uvec3()
            .element_product()
    }

    /// About the bricks of a surface as large as that of the box.
    fn slots(&self) -> u32 {
        let n = (self.bricks[1] - self.bricks[0] + 1).as_uvec3();
        (3 * (n.x * n.y + n.y * n.z + n.z * n.x)).min(self.most_slots())
    }

    /// Rows of voxels along x.
    fn lines(&self) -> u32 {
        let size = self.voxels[1] - self.voxels[0] + 1;
        (size.y * size.z) as u32
    }

    /// Words of a bit for each voxel.
    fn words(&self) -> u32 {
        let along = self.voxels[1].x - self.voxels[0].x + 1;
        (along as u32).div_ceil(32) * self.lines()
    }

    /// Triangles go where baked meshes lie else, voxels where tapes do.
    fn room(&self, slots: u32) -> Room {
        let chunks = self.chunks.len() as u32 + 1;
        Room {
            quantised: false,
            slots,
            chunks,
            tables: chunks,
            blocks: 1,
            tape: 2 * self.words(),
            vertices: 160 * slots,
            triangles: 320 * slots,
            program: 1,
            volumes: self.corners,
        }
    }
}

impl GpuSolid {
    /// The convolution surface of a closed mesh at a step (3DBrushVR §4.2): its voxels stand about the nodes of the
    /// lattice, those that triangles touch and those inside are filled, the potential of a node is the mean of the 27 around
    /// it, and the surface lies where that is a half. It is up to a step and a half thicker than the mesh.
    ///
    /// # Errors
    /// A mesh too large for its step, or what the device lacks.
    pub fn from_mesh(gpu: &Arc<Gpu>, mesh: &TriMesh, step: f32) -> Result<Self, GpuError> {
        gpu.watched(|| {
            let brush = Brush::new(mesh, step)?;
            let room = brush.room(brush.slots());
            let mut solid = Self::empty(gpu, room, SolidOptions::default())?;
            solid.brushed(mesh, &brush)?;
            Ok(solid)
        })
    }

    /// As [`GpuSolid::from_mesh`], on the buffers that are there.
    ///
    /// # Errors
    /// As [`GpuSolid::from_mesh`].
    pub fn make_again_from(&mut self, mesh: &TriMesh, step: f32) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        gpu.watched(|| self.brushed(mesh, &Brush::new(mesh, step)?))
    }

    fn brushed(&mut self, mesh: &TriMesh, brush: &Brush) -> Result<(), GpuError> {
        self.forget();
        self.made_for = For::Plain;
        let most = brush.most_slots();
        let mut slots = brush.slots();
        let started = Instant::now();
        loop {
            let wanted = brush.room(slots);
            if !self.room.covers(&wanted) {
                self.grow(wanted)?;
            }
            let g = &mut self.globals;
            (g.step, g.eps, g.top, g.update) = (brush.step, 1.0e-4 * brush.step, 3, 0);
            (g.low, g.high) = (brush.bricks[0].to_array(), brush.bricks[1].to_array());
            (g.mesh_low, g.mesh_high) = (brush.voxels[0].to_array(), brush.voxels[1].to_array());
            g.shapes = brush.triangles;
            self.voxelise(mesh, brush)?;
            if self.counters[counter::OVERFLOW] == 0 {
                self.timing.total = started.elapsed();
                return Ok(());
            }
            if slots == most && self.counters[counter::SLOTS] <= most {
                // Bricks all fit: the mesh did not.
                return Err(GpuError::Refused("a brush's mesh found no room".to_owned()));
            }
            slots = (2 * slots).min(most);
        }
    }

    fn voxelise(&mut self, mesh: &TriMesh, brush: &Brush) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        let buffers = self.buffers.clone();
        let room = self.room;
        let chunks = brush.chunks.len() as u32;
        self.size_globals();
        self.counters = [0; counter::COUNT];
        self.counters[counter::CHUNKS] = chunks;
        self.counters[counter::TABLES] = chunks;
        self.write_numbers();
        let queue = &gpu.queue;
        queue.write_buffer(&buffers.volumes, 0, bytemuck::cast_slice(&mesh.triangles));
        let places = 12 * u64::from(brush.triangles);
        queue.write_buffer(
            &buffers.volumes,
            places,
            bytemuck::cast_slice(&mesh.positions),
        );
        let mut records = Vec::new();
        for (i, at) in brush.chunks.iter().enumerate() {
            records.extend(at.to_array().map(|x| x as u32));
            records.extend([3, i as u32]);
        }
        let info = 4 * u64::from(room.info_base());
        queue.write_buffer(&buffers.pages, info, bytemuck::cast_slice(&records));
        let extra = [
            (binding::CORNERS, &buffers.volumes),
            (binding::VOXELS, &buffers.tape),
        ];
        let k = gpu.kernels(For::Plain)?;
        let times = self.times();
        let mut recorder = Recorder::new(&gpu, &buffers, times.as_ref());
        recorder.clear_pages(&room);
        let voxels = 8 * u64::from(brush.words());
        recorder
            .encoder
            .clear_buffer(&buffers.tape, 0, Some(voxels));
        let stage = Stage::default();
        recorder.pass("voxels", |p| {
            let groups = Groups::Count(chunks.div_ceil(64));
            p.run(&k.link, stage, groups, &[]);
            p.run(&k.shell, stage, Groups::Count(brush.triangles), &extra);
            let groups = Groups::Count(brush.lines().div_ceil(64));
            p.run(&k.fill, stage, groups, &extra);
        });
        recorder.pass("smooth", |p| {
            p.run(
                &k.smoothed,
                stage,
                Groups::Count(brush.most_slots()),
                &extra,
            );
        });
        recorder.pass("extract", |p| extract_all(p, k, &room));
        self.tell(recorder, times.as_ref())
    }
}
