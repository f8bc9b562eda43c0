//! Materials that are written in WGSL, as Bevy draws them: its own standard material, with a surface and a shape that a
//! file makes.

use bevy::asset::{AssetId, uuid::Uuid};
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{
    ExtendedMaterial, MaterialExtension, MaterialExtensionKey, MaterialExtensionPipeline,
    MaterialPlugin, PbrPlugin,
};
use bevy::prelude::*;
use bevy::reflect::TypePath;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, SpecializedMeshPipelineError,
};
use bevy::shader::{Shader, ShaderRef};
use midair_solid::{MOST_DIALS, MaterialInfo};

use super::text::whole;

/// A material that is written in WGSL, on an object.
pub type Living = ExtendedMaterial<StandardMaterial, Written>;

/// What a file adds to the standard material.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
#[bind_group_data(WrittenKey)]
pub struct Written {
    /// Its dials, then the pace of time: 0 where it stands still, then how many pixels wide the line is that it draws
    /// around itself: 0 where it is no line.
    #[uniform(100)]
    dials: [Vec4; 3],
    /// The place of the material among all.
    place: u32,
}

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct WrittenKey {
    place: u32,
}

impl From<&Written> for WrittenKey {
    fn from(written: &Written) -> Self {
        Self {
            place: written.place,
        }
    }
}

impl Written {
    /// The material at a place, with its dials, that changes with time or stands still.
    pub(crate) fn new(place: usize, values: &[f32], moves: bool) -> Self {
        let mut all = [0.0; 12];
        for (slot, value) in all[..MOST_DIALS].iter_mut().zip(values) {
            *slot = *value;
        }
        all[MOST_DIALS] = if moves { 1.0 } else { 0.0 };
        let dials = [0, 1, 2].map(|i| Vec4::from_slice(&all[4 * i..]));
        Self {
            dials,
            place: place as u32,
        }
    }

    /// The place of the material among all.
    pub(crate) fn place(&self) -> usize {
        self.place as usize
    }

    /// The line around what is made of it, in the colour of the base: the same shape, wider by so many pixels.
    pub(crate) fn line(mut self, width: f32) -> Self {
        const AT: usize = MOST_DIALS + 1;
        self.dials[AT / 4][AT % 4] = width;
        self
    }
}

/// Each place has a shader of its own, found by number: pipelines are told apart by no more.
const FIRST: u128 = 0x2f1c_7a52_98d4_4b0f_9a35_6d0e_0000_0000;

fn shader(place: u32) -> Handle<Shader> {
    Handle::from(Uuid::from_u128(FIRST + u128::from(place)))
}

impl MaterialExtension for Written {
    // Never drawn with: each place puts its own there. Named so that shadows, too, get the dials.
    fn vertex_shader() -> ShaderRef {
        shader(0).into()
    }

    fn fragment_shader() -> ShaderRef {
        shader(0).into()
    }

    fn prepass_vertex_shader() -> ShaderRef {
        shader(0).into()
    }

    fn specialize(
        _: &MaterialExtensionPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        key: MaterialExtensionKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let its = shader(key.bind_group_data.place);
        descriptor.vertex.buffers = vec![layout.0.get_layout(&[
            Mesh::ATTRIBUTE_POSITION.at_shader_location(0),
            Mesh::ATTRIBUTE_NORMAL.at_shader_location(1),
        ])?];
        descriptor.vertex.shader = its.clone();
        // Before the main pass, what is drawn is as for any other.
        let early = "PREPASS_PIPELINE".into();
        if !descriptor.vertex.shader_defs.contains(&early)
            && let Some(fragment) = descriptor.fragment.as_mut()
        {
            fragment.shader = its;
        }
        Ok(())
    }
}

/// What is drawn with from now on; pipelines that are there are made anew.
pub(super) fn compile(place: usize, info: &MaterialInfo, shaders: &mut Assets<Shader>) {
    let AssetId::Uuid { uuid } = shader(place as u32).id() else {
        return;
    };
    let source = Shader::from_wgsl(whole(info), format!("materials/{}.wgsl", info.id));
    // Refused only for an id that was given up, which none is.
    let _ = shaders.insert(AssetId::Uuid { uuid }, source);
}

pub(super) fn plugin(app: &mut App) {
    if !app.world().contains_resource::<Assets<Shader>>() {
        app.init_asset::<Shader>();
    }
    if app.is_plugin_added::<PbrPlugin>() {
        app.add_plugins(MaterialPlugin::<Living>::default());
    } else {
        app.init_asset::<Living>();
    }
}
