//! What the card made is drawn where it lies: copied, on the card, into a mesh with room to spare, once a frame before
//! any camera looks. Materials, shadows and outlines see a mesh like any other.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use bevy::asset::RenderAssetUsages;
use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::NoAutoAabb;
use bevy::core_pipeline::schedule::camera_driver;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::render::mesh::allocator::MeshAllocator;
use bevy::render::renderer::{RenderContext, RenderGraph};
use bevy::render::{ExtractSchedule, MainWorld, RenderApp};
use midair_gpu::{Emitted, Stretch};
use midair_mesh::TriMesh;

/// A mesh with room to spare that the card writes into.
///
/// In main memory it stays as it was made: whatever needs its points goes by what was made of the recipe, and its box
/// is set beside it ([`Seen`]).
#[derive(Debug)]
pub struct CardMesh {
    handle: Handle<Mesh>,
    vertices: u32,
    indices: u32,
}

impl CardMesh {
    /// Of a surface that came to main memory, with room for one half larger.
    pub fn new(mesh: &TriMesh, meshes: &mut Assets<Mesh>) -> Self {
        Roomy::new(mesh).added(meshes)
    }

    /// Room in vertices and indices.
    pub fn room(&self) -> (u32, u32) {
        (self.vertices, self.indices)
    }

    /// What draws it.
    pub fn handle(&self) -> &Handle<Mesh> {
        &self.handle
    }

    /// Has the card write a surface into it before the next picture; false where it does not fit.
    pub fn write(&self, surface: &Emitted, writes: &mut CardWrites) -> bool {
        let fits = surface.fits(self.vertices, self.indices);
        if fits {
            writes.asked.retain(|w| w.mesh.id() != self.handle.id());
            writes.asked.push(Write {
                mesh: self.handle.clone(),
                surface: surface.clone(),
            });
        }
        fits
    }

    /// What shows it, `around` being about all that is written into it.
    pub fn seen(&self, around: midair_mesh::Aabb) -> Seen {
        Seen {
            mesh: self.handle.clone(),
            around: Some(around),
        }
    }
}

/// A mesh with room to spare, made off the frame.
pub(crate) struct Roomy {
    drawn: Mesh,
    vertices: u32,
    indices: u32,
}

impl Roomy {
    pub fn new(mesh: &TriMesh) -> Self {
        let room = |n: usize| n + n / 2 + 1024;
        let vertices = room(mesh.positions.len());
        let indices = 3 * room(mesh.triangles.len());
        let mut positions = mesh.positions.clone();
        positions.resize(vertices, Vec3::ZERO);
        let mut normals = mesh.normals.clone();
        normals.resize(vertices, Vec3::Y);
        // What is left over are triangles without area.
        let mut corners = mesh.triangles.as_flattened().to_vec();
        corners.resize(indices, 0);
        let drawn = Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::default(),
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_indices(Indices::U32(corners));
        Self {
            drawn,
            vertices: vertices as u32,
            indices: indices as u32,
        }
    }

    pub fn added(self, meshes: &mut Assets<Mesh>) -> CardMesh {
        CardMesh {
            handle: meshes.add(self.drawn),
            vertices: self.vertices,
            indices: self.indices,
        }
    }
}

/// What draws something at the moment: an ordinary mesh, or one that the card writes into, with the box around it.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// The mesh.
    pub mesh: Handle<Mesh>,
    /// Around what the card wrote.
    pub around: Option<midair_mesh::Aabb>,
}

impl From<Handle<Mesh>> for Seen {
    fn from(mesh: Handle<Mesh>) -> Self {
        Self { mesh, around: None }
    }
}

/// What an entity wears of it.
pub type SeenParts = (&'static Mesh3d, Option<&'static Aabb>, Has<NoAutoAabb>);

impl Seen {
    /// What an entity shows now.
    pub fn of((mesh, around, fixed): (&Mesh3d, Option<&Aabb>, bool)) -> Self {
        let around = around.filter(|_| fixed);
        Self {
            mesh: mesh.0.clone(),
            around: around.map(|a| midair_mesh::Aabb {
                min: a.min().into(),
                max: a.max().into(),
            }),
        }
    }

    /// An entity shows it from now on.
    pub fn worn_by(&self, entity: &mut EntityCommands) {
        entity.try_insert(Mesh3d(self.mesh.clone()));
        match &self.around {
            Some(b) => {
                entity.try_insert((Aabb::from_min_max(b.min, b.max), NoAutoAabb));
            }
            None => bare(entity),
        }
    }
}

/// What an entity no longer wears that shows an ordinary mesh again: its box is worked out anew.
pub(super) fn bare(entity: &mut EntityCommands) {
    entity.try_remove::<(Aabb, NoAutoAabb)>();
}

/// What the card is to write before the next picture, and how often it did.
#[derive(Resource, Default)]
pub struct CardWrites {
    asked: Vec<Write>,
    written: Arc<AtomicUsize>,
}

impl CardWrites {
    /// How many surfaces were drawn without passing through main memory.
    pub fn written(&self) -> usize {
        self.written.load(Ordering::Relaxed)
    }
}

/// A surface and where it goes. The handle keeps the mesh there until it is written.
struct Write {
    mesh: Handle<Mesh>,
    surface: Emitted,
}

/// What is still to be written, where things are drawn.
#[derive(Resource, Default)]
struct Pending {
    writes: Vec<Write>,
    written: Arc<AtomicUsize>,
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<CardWrites>();
    let written = app.world().resource::<CardWrites>().written.clone();
    let Some(render) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    render
        .insert_resource(Pending {
            writes: Vec::new(),
            written,
        })
        .add_systems(ExtractSchedule, extract)
        // Once a frame, not once an eye; before the first camera draws.
        .add_systems(RenderGraph, write.before(camera_driver));
}

fn extract(mut main: ResMut<MainWorld>, mut pending: ResMut<Pending>) {
    let Some(mut writes) = main.get_resource_mut::<CardWrites>() else {
        return;
    };
    if writes.asked.is_empty() {
        return;
    }
    let asked = std::mem::take(&mut writes.asked);
    // The latest wins.
    pending
        .writes
        .retain(|w| asked.iter().all(|a| a.mesh.id() != w.mesh.id()));
    pending.writes.extend(asked);
}

fn write(
    mut context: RenderContext,
    allocator: Option<Res<MeshAllocator>>,
    mut pending: ResMut<Pending>,
) {
    let Some(allocator) = allocator.filter(|_| !pending.writes.is_empty()) else {
        return;
    };
    let Pending { writes, written } = &mut *pending;
    writes.retain(|w| {
        let id = w.mesh.id();
        let slices = allocator
            .mesh_vertex_slice(&id)
            .zip(allocator.mesh_index_slice(&id));
        // Not there yet: the next frame has it.
        let Some((vertices, indices)) = slices else {
            return true;
        };
        let stretch = |buffer, range: std::ops::Range<u32>| Stretch {
            buffer,
            at: range.start,
            room: range.end - range.start,
        };
        let copied = w.surface.copy(
            context.command_encoder(),
            stretch(vertices.buffer, vertices.range),
            stretch(indices.buffer, indices.range),
        );
        written.fetch_add(usize::from(copied), Ordering::Relaxed);
        false
    });
}
