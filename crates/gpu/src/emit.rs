//! A surface without gaps in buffers of its own: to be drawn where it is, or read back.

use std::sync::Arc;

use glam::Vec3;
use midair_mesh::TriMesh;

use crate::Gpu;
use crate::error::GpuError;
use crate::kernels::binding;
use crate::layout::{Stage, counter};
use crate::memory::{buffer, read_back};
use crate::passes::{Groups, Recorder};
use crate::solid::GpuSolid;

/// Bytes of a vertex: place and unit normal, three `f32` each.
pub const VERTEX_BYTES: u64 = 24;
/// Bytes of an index.
pub const INDEX_BYTES: u64 = 4;

/// One welded surface on the device, laid out as triangles are drawn: vertices of [`VERTEX_BYTES`] one after the
/// other, three `u32` to a triangle. It stays as it is when its solid changes.
#[derive(Clone)]
pub struct Emitted(Arc<Inner>);

struct Inner {
    gpu: Arc<Gpu>,
    /// Vertices and indices; `None` where the solid is empty.
    buffers: Option<(wgpu::Buffer, wgpu::Buffer)>,
    vertices: u32,
    triangles: u32,
}

/// A stretch of somebody's buffer, in vertices or indices.
#[derive(Clone, Copy, Debug)]
pub struct Stretch<'a> {
    /// It can be copied to.
    pub buffer: &'a wgpu::Buffer,
    /// Where it begins.
    pub at: u32,
    /// How many fit.
    pub room: u32,
}

impl Emitted {
    /// How many vertices.
    pub fn vertices(&self) -> u32 {
        self.0.vertices
    }

    /// How many triangles.
    pub fn triangles(&self) -> u32 {
        self.0.triangles
    }

    /// Whether the device that it lies on is one that draws.
    pub fn is_drawn(&self) -> bool {
        self.0.gpu.is_shared()
    }

    /// Whether it fits into so many vertices and indices.
    pub fn fits(&self, vertices: u32, indices: u32) -> bool {
        self.0.vertices <= vertices && 3 * self.0.triangles <= indices
    }

    /// Records a copy into what somebody draws, on the same device; indices that are left over become triangles
    /// without area. False, and nothing is recorded, where it does not fit.
    pub fn copy(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        vertices: Stretch,
        indices: Stretch,
    ) -> bool {
        if !self.fits(vertices.room, indices.room) {
            return false;
        }
        let used = 3 * self.0.triangles;
        let to = INDEX_BYTES * u64::from(indices.at);
        let bytes = INDEX_BYTES * u64::from(used);
        if let Some((from_vertices, from_indices)) = &self.0.buffers {
            encoder.copy_buffer_to_buffer(
                from_vertices,
                0,
                vertices.buffer,
                VERTEX_BYTES * u64::from(vertices.at),
                Some(VERTEX_BYTES * u64::from(self.0.vertices)),
            );
            encoder.copy_buffer_to_buffer(from_indices, 0, indices.buffer, to, Some(bytes));
        }
        if used < indices.room {
            let rest = INDEX_BYTES * u64::from(indices.room - used);
            encoder.clear_buffer(indices.buffer, to + bytes, Some(rest));
        }
        true
    }

    /// The same in main memory.
    ///
    /// # Errors
    /// The device has no memory left or is lost.
    pub fn mesh(&self) -> Result<TriMesh, GpuError> {
        self.0.gpu.watched(|| self.read())
    }

    fn read(&self) -> Result<TriMesh, GpuError> {
        let gpu = &self.0.gpu;
        let Some((vertices, indices)) = &self.0.buffers else {
            return Ok(TriMesh::default());
        };
        let (v_bytes, t_bytes) = (
            VERTEX_BYTES * u64::from(self.0.vertices),
            3 * INDEX_BYTES * u64::from(self.0.triangles),
        );
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let told = buffer(gpu, "a mesh on its way", v_bytes + t_bytes, usage)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(vertices, 0, &told, 0, Some(v_bytes));
        encoder.copy_buffer_to_buffer(indices, 0, &told, v_bytes, Some(t_bytes));
        gpu.queue.submit([encoder.finish()]);
        let words = read_back(gpu, &told, v_bytes + t_bytes)?;
        let (points, corners) = words.split_at(6 * self.0.vertices as usize);
        let three = |w: &[u32]| Vec3::from_array([w[0], w[1], w[2]].map(f32::from_bits));
        Ok(TriMesh {
            positions: points.chunks_exact(6).map(three).collect(),
            normals: points.chunks_exact(6).map(|w| three(&w[3..])).collect(),
            triangles: corners
                .chunks_exact(3)
                .map(|t| [t[0], t[1], t[2]])
                .collect(),
        })
    }
}

impl std::fmt::Debug for Emitted {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Emitted")
            .field("vertices", &self.0.vertices)
            .field("triangles", &self.0.triangles)
            .finish_non_exhaustive()
    }
}

impl GpuSolid {
    /// The whole surface as one welded mesh with unit normals. Vertices and triangles come in the order of the
    /// bricks on the device, which may differ from run to run.
    ///
    /// # Errors
    /// The device has no memory left or is lost.
    pub fn mesh(&self) -> Result<TriMesh, GpuError> {
        self.emit()?.mesh()
    }

    /// The whole surface without gaps, in buffers of its own on the device. Nothing comes back to main memory, and
    /// nobody waits for it: what is submitted to the same queue afterwards finds it there.
    ///
    /// # Errors
    /// The device has no memory left or is lost.
    pub fn emit(&self) -> Result<Emitted, GpuError> {
        self.gpu.watched(|| self.emitted())
    }

    fn emitted(&self) -> Result<Emitted, GpuError> {
        use wgpu::BufferUsages as Use;
        let gpu = &self.gpu;
        let (triangles, vertices) = self.size();
        let slots = self.counters[counter::SLOTS];
        if triangles == 0 || slots == 0 {
            gpu.check()?;
            return Ok(Emitted(Arc::new(Inner {
                gpu: gpu.clone(),
                buffers: None,
                vertices: 0,
                triangles: 0,
            })));
        }
        let made = |what, bytes| buffer(gpu, what, bytes, Use::STORAGE | Use::COPY_SRC);
        let tiles = self.room.slots.div_ceil(256);
        let offsets = made("offsets", 8 * u64::from(self.room.slots + tiles))?;
        let tight_vertices = made("a mesh's vertices", VERTEX_BYTES * u64::from(vertices))?;
        let tight_indices = made("a mesh's triangles", 3 * INDEX_BYTES * u64::from(triangles))?;
        let renumbered = made(
            "a mesh's numbers",
            4 * u64::from(self.counters[counter::VERTICES]),
        )?;
        let extra = [
            (binding::OFFSETS, &offsets),
            (binding::TIGHT_VERTICES, &tight_vertices),
            (binding::TIGHT_INDICES, &tight_indices),
            (binding::RENUMBERED, &renumbered),
        ];
        let k = gpu.kernels(self.made_for)?;
        let mut recorder = Recorder::new(gpu, &self.buffers, None);
        recorder.pass("compact", |p| {
            let stage = Stage::default();
            p.run(&k.scan_tiles, stage, Groups::Count(tiles), &extra);
            p.run(&k.scan_sums, stage, Groups::Count(1), &extra);
            p.run(&k.compact_vertices, stage, Groups::Count(slots), &extra);
            p.run(&k.compact_triangles, stage, Groups::Count(slots), &extra);
        });
        recorder.submit()?;
        Ok(Emitted(Arc::new(Inner {
            gpu: gpu.clone(),
            buffers: Some((tight_vertices, tight_indices)),
            vertices,
            triangles,
        })))
    }
}
