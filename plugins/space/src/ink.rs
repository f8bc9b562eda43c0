//! What is printed, as a material: panels and labels in the colours they were drawn in.

use std::f32::consts::FRAC_PI_2;

use bevy::asset::{RenderAssetUsages, load_internal_asset, uuid_handle};
use bevy::mesh::{Indices, MeshVertexBufferLayoutRef, PrimitiveTopology};
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::reflect::TypePath;
use bevy::render::render_resource::{
    AsBindGroup, CompareFunction, RenderPipelineDescriptor, SpecializedMeshPipelineError,
};
use bevy::shader::{Shader, ShaderRef};

const SHADER: Handle<Shader> = uuid_handle!("8a0b52cf-4c3b-4a0e-9d8c-0f6a6f0c2e11");

/// A printed thing.
#[derive(Asset, TypePath, AsBindGroup, Debug, Clone)]
#[bind_group_data(InkKey)]
pub(crate) struct Ink {
    /// What is printed; where vertices have colours, it is multiplied by them.
    #[texture(0)]
    #[sampler(1)]
    pub page: Handle<Image>,
    /// How it lies over what is behind it.
    pub over: Over,
}

/// How a printed thing lies over what is behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Over {
    /// Nothing is seen through it.
    Opaque,
    /// Seen through where its alpha, which its colours are multiplied by, is below 1.
    Clear,
    /// The same, before everything else.
    Front,
}

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct InkKey {
    front: bool,
}

impl From<&Ink> for InkKey {
    fn from(ink: &Ink) -> Self {
        Self {
            front: ink.over == Over::Front,
        }
    }
}

impl Material for Ink {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn alpha_mode(&self) -> AlphaMode {
        match self.over {
            Over::Opaque => AlphaMode::Opaque,
            Over::Clear | Over::Front => AlphaMode::Premultiplied,
        }
    }

    fn depth_bias(&self) -> f32 {
        match self.over {
            Over::Opaque => 0.0,
            Over::Clear => 10.0,
            Over::Front => 1_000.0,
        }
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _: &MeshVertexBufferLayoutRef,
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        descriptor.primitive.cull_mode = None;
        if let Some(depth) = descriptor.depth_stencil.as_mut()
            && key.bind_group_data.front
        {
            depth.depth_compare = Some(CompareFunction::Always);
            depth.depth_write_enabled = Some(false);
        }
        Ok(())
    }
}

pub(crate) fn plugin(app: &mut App) {
    load_internal_asset!(app, SHADER, "ink.wgsl", Shader::from_wgsl);
    app.add_plugins(MaterialPlugin::<Ink>::default());
}

/// Segments of a rounded corner.
const CORNER: usize = 6;

/// A sheet of `size` metres about its middle, facing +Z, with rounded corners; `uv` is the lower right corner of what is
/// printed on it.
pub(crate) fn sheet(size: Vec2, radius: f32, uv: Vec2) -> Mesh {
    let half = 0.5 * size;
    let inner = (half - radius).max(Vec2::ZERO);
    let mut positions = vec![[0.0, 0.0, 0.0]];
    for corner in 0..4 {
        let around = corner as f32 * FRAC_PI_2;
        let sign = Vec2::new(
            if corner == 0 || corner == 3 {
                1.0
            } else {
                -1.0
            },
            if corner < 2 { 1.0 } else { -1.0 },
        );
        for step in 0..=CORNER {
            let angle = around + FRAC_PI_2 * step as f32 / CORNER as f32;
            let at = sign * inner + radius * Vec2::from_angle(angle);
            positions.push([at.x, at.y, 0.0]);
        }
    }
    let uvs: Vec<_> = positions
        .iter()
        .map(|[x, y, _]| [(x / size.x + 0.5) * uv.x, (0.5 - y / size.y) * uv.y])
        .collect();
    let rim = positions.len() as u32 - 1;
    let indices = (0..rim)
        .flat_map(|i| [0, 1 + i, 1 + (i + 1) % rim])
        .collect();
    let normals = vec![[0.0, 0.0, 1.0]; positions.len()];
    Mesh::new(
        PrimitiveTopology::TriangleList,
        // What hides outlines is looked at in the main world.
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
    .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
    .with_inserted_indices(Indices::U32(indices))
}
