//! The field on the GPU: bricks, fusion and marching cubes as compute passes on plain wgpu, without Bevy.
//!
//! A [`Gpu`] is a device with its passes compiled. A [`GpuSolid`] is one solid on it: a pool of 8³ bricks and a page
//! table without fixed extent, made from a [`midair_field::Program`] and brought up to date by
//! [`GpuSolid::update`], which runs again only the bricks that an edit touched. The processor's kernels are the
//! reference: fields agree to 1e-4 steps near the surface, and the mesh has the same topology.
//!
//! Everything that can be missing or fail is a [`GpuError`], so that the caller can go on without a GPU.
//!
//! ```no_run
//! use std::sync::Arc;
//!
//! use midair_field::{Placement, Primitive, Program};
//! use midair_gpu::{Gpu, GpuOptions, GpuSolid};
//!
//! let gpu = Arc::new(Gpu::open(&GpuOptions::default())?);
//! let ball = Primitive::Sphere { radius: 0.2 }.into();
//! let program = Program::compile(&ball, &Placement::IDENTITY, 0.01, &())?;
//! let solid = GpuSolid::make(&gpu, &program)?;
//! let mesh = solid.mesh()?;
//! assert!(!mesh.triangles.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! - `device`: adapters, limits, what is lost.
//! - `kernels`: the passes by name, compiled from `shaders/`.
//! - `layout`: structs and numbers that Rust and WGSL share.
//! - `flatten`: a program as words for the device; `paint`: a painting in it.
//! - `memory`: buffers within a budget.
//! - `solid`: making and updating; `passes`: what is run for it, in which order.
//! - [`measure`]: workloads that are timed.
//! - `voxels`: a mesh as a volume brush.
//! - `emit`: a surface that is drawn where it is, or read back; `read`: fields back in main memory.

mod device;
mod emit;
mod error;
mod flatten;
mod kernels;
mod layout;
pub mod measure;
mod memory;
mod paint;
mod passes;
mod read;
mod solid;
mod voxels;
mod wait;

pub use device::{Adapter, Gpu, GpuOptions};
pub use emit::{Emitted, INDEX_BYTES, Stretch, VERTEX_BYTES};
pub use error::GpuError;
pub use flatten::can_make;
pub use solid::{GpuSolid, Memory, SolidOptions, Timing};

#[cfg(test)]
mod tests;
