//! Surfaces that are drawn where they lie, on a device that is somebody else's.

use std::sync::Arc;

use midair_field::{Primitive, Recipe};

use super::support::*;
use crate::device::{describe, found};
use crate::memory::{buffer, read_back};
use crate::wait::block_on;
use crate::{Gpu, GpuError, GpuOptions, GpuSolid, INDEX_BYTES, Stretch, VERTEX_BYTES};

/// A card on a device that was opened by whoever draws.
fn shared() -> Option<(Arc<Gpu>, wgpu::Device, wgpu::Queue)> {
    gpu()?;
    let adapter = found().into_iter().next()?;
    let asked = wgpu::DeviceDescriptor {
        required_limits: adapter.limits(),
        ..Default::default()
    };
    let (device, queue) = block_on(adapter.request_device(&asked)).unwrap();
    let options = GpuOptions {
        software: true,
        ..GpuOptions::default()
    };
    let gpu = Gpu::share(device.clone(), queue.clone(), describe(&adapter), &options).unwrap();
    assert!(gpu.is_shared());
    Some((Arc::new(gpu), device, queue))
}

fn ball(radius: f32) -> Recipe {
    Primitive::Sphere { radius }.into()
}

#[test]
fn a_surface_is_copied_to_where_it_is_drawn() {
    let Some((gpu, device, queue)) = shared() else {
        return;
    };
    let solid = GpuSolid::make(&gpu, &compile(&ball(0.1), 0.01)).unwrap();
    let surface = solid.emit().unwrap();
    let mesh = surface.mesh().unwrap();
    assert_eq!(surface.vertices() as usize, mesh.positions.len());
    assert_eq!(surface.triangles() as usize, mesh.triangles.len());
    assert!(surface.is_drawn());
    // Somebody's buffers, with things of others before and after.
    let (v, i) = (surface.vertices(), 3 * surface.triangles());
    let (before, more) = (7u32, 30u32);
    use wgpu::BufferUsages as Use;
    let slab = |what, bytes| buffer(&gpu, what, bytes, Use::COPY_DST | Use::COPY_SRC).unwrap();
    let vertices = slab("vertices", VERTEX_BYTES * u64::from(before + v));
    let words = before + i + more + 1;
    let indices = slab("indices", INDEX_BYTES * u64::from(words));
    let marked = vec![9u32; words as usize];
    queue.write_buffer(&indices, 0, bytemuck::cast_slice(&marked));
    let at = |buffer, room| Stretch {
        buffer,
        at: before,
        room,
    };
    let mut encoder = device.create_command_encoder(&Default::default());
    assert!(!surface.copy(&mut encoder, at(&vertices, v - 1), at(&indices, i)));
    assert!(!surface.copy(&mut encoder, at(&vertices, v), at(&indices, i - 1)));
    assert!(surface.copy(&mut encoder, at(&vertices, v), at(&indices, i + more)));
    let told = |what, bytes| buffer(&gpu, what, bytes, Use::MAP_READ | Use::COPY_DST).unwrap();
    let told_vertices = told("vertices", vertices.size());
    let told_indices = told("indices", indices.size());
    encoder.copy_buffer_to_buffer(&vertices, 0, &told_vertices, 0, None);
    encoder.copy_buffer_to_buffer(&indices, 0, &told_indices, 0, None);
    queue.submit([encoder.finish()]);
    let drawn = read_back(&gpu, &told_vertices, vertices.size()).unwrap();
    let points = drawn[6 * before as usize..].chunks_exact(6);
    for (p, (q, n)) in points.zip(mesh.positions.iter().zip(&mesh.normals)) {
        let bits = [q.x, q.y, q.z, n.x, n.y, n.z].map(f32::to_bits);
        assert_eq!(p, bits);
    }
    let drawn = read_back(&gpu, &told_indices, indices.size()).unwrap();
    let (own, rest) = drawn[before as usize..].split_at(i as usize);
    assert_eq!(own, mesh.triangles.as_flattened());
    // Triangles without area, and nothing beyond what was lent.
    assert!(rest[..more as usize].iter().all(|x| *x == 0));
    assert_eq!(rest[more as usize], 9);
    assert!(drawn[..before as usize].iter().all(|x| *x == 9));

    // It stays as it is when its solid changes.
    let mut solid = solid;
    solid.update(&compile(&ball(0.13), 0.01)).unwrap();
    assert_eq!(surface.mesh().unwrap(), mesh);
    assert!(solid.emit().unwrap().vertices() > surface.vertices());
}

#[test]
fn a_shared_device_that_is_lost_is_an_error_and_no_panic() {
    let Some((gpu, device, _queue)) = shared() else {
        return;
    };
    let program = compile(&ball(0.1), 0.01);
    let mut solid = GpuSolid::make(&gpu, &program).unwrap();
    let surface = solid.emit().unwrap();
    device.destroy();
    let failed = |e: GpuError| {
        let line = e.to_string();
        assert!(!line.contains('\n') && !line.is_empty(), "{line}");
    };
    failed(surface.mesh().unwrap_err());
    // Nobody waits for what is emitted, so nobody is told; its owner draws no more.
    let _ = solid.emit();
    failed(solid.update(&compile(&ball(0.12), 0.01)).unwrap_err());
    failed(GpuSolid::make(&gpu, &program).err().unwrap());
}

#[test]
fn software_is_shared_only_where_it_counts() {
    let Some(adapter) = found().into_iter().next() else {
        return;
    };
    let (device, queue) = block_on(adapter.request_device(&Default::default())).unwrap();
    let mut described = describe(&adapter);
    described.software = true;
    let refused = Gpu::share(
        device.clone(),
        queue.clone(),
        described.clone(),
        &GpuOptions::default(),
    );
    assert!(matches!(refused, Err(GpuError::Software(_))));
    // The least limits that a device may have are enough.
    let options = GpuOptions {
        software: true,
        ..GpuOptions::default()
    };
    Gpu::share(device, queue, described, &options).unwrap();
}
