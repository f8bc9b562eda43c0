use std::borrow::Cow;

use bytemuck::cast_slice;
use glam::{Vec2, Vec3};
use gltf::binary::{Glb, Header};
use gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use gltf::json::buffer::{Target, View};
use gltf::json::material::{AlphaMode, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::scene::{Node, Scene};
use gltf::json::validation::Checked::Valid;
use gltf::json::validation::USize64;
use gltf::json::{Accessor, Asset, Buffer, Index, Material, Mesh, Root};

use crate::Finish;

use super::{Lines, Part, WriteReason};

/// A GLB with one node per mesh, with normals where a mesh has them, one per curve, and one material
/// per look.
pub(super) fn encode(parts: &[Part], curves: &[Lines]) -> Result<Vec<u8>, WriteReason> {
    let mut root = Root {
        asset: Asset {
            generator: Some("Midair".into()),
            ..Asset::default()
        },
        ..Root::default()
    };
    let buffer = root.push(Buffer {
        byte_length: USize64(0),
        name: None,
        uri: None,
        extensions: None,
        extras: Default::default(),
    });
    let mut data = Data {
        root,
        buffer,
        bytes: Vec::new(),
        finishes: Vec::new(),
    };
    let mut nodes = Vec::new();
    for part in parts {
        let position = data.vectors(&part.positions, true);
        let mut attributes = [(Valid(Semantic::Positions), position)]
            .into_iter()
            .collect::<std::collections::BTreeMap<_, _>>();
        if let Some(normals) = part.normals() {
            attributes.insert(Valid(Semantic::Normals), data.vectors(normals, false));
        }
        if !part.uv.is_empty() {
            // glTF counts from the upper edge of a picture.
            let uv: Vec<Vec2> = part.uv.iter().map(|p| Vec2::new(p.x, 1.0 - p.y)).collect();
            let at = data.add(
                cast_slice(&uv),
                uv.len(),
                Type::Vec2,
                ComponentType::F32,
                Target::ArrayBuffer,
            );
            attributes.insert(Valid(Semantic::TexCoords(0)), at);
        }
        let indices = data.add(
            cast_slice(&part.mesh.triangles),
            3 * part.mesh.triangles.len(),
            Type::Scalar,
            ComponentType::U32,
            Target::ElementArrayBuffer,
        );
        let material = part.finish.map(|finish| data.material(finish));
        let mesh = data.root.push(Mesh {
            extensions: None,
            extras: Default::default(),
            name: Some(part.name.into()),
            primitives: vec![Primitive {
                attributes,
                extensions: None,
                extras: Default::default(),
                indices: Some(indices),
                material,
                mode: Valid(Mode::Triangles),
                targets: None,
            }],
            weights: None,
        });
        nodes.push(data.root.push(Node {
            mesh: Some(mesh),
            name: Some(part.name.into()),
            ..Node::default()
        }));
    }
    for curve in curves {
        let position = data.vectors(&curve.positions, true);
        let material = curve.finish.map(|finish| data.material(finish));
        let mesh = data.root.push(Mesh {
            extensions: None,
            extras: Default::default(),
            name: Some(curve.name.into()),
            primitives: vec![Primitive {
                attributes: [(Valid(Semantic::Positions), position)]
                    .into_iter()
                    .collect(),
                extensions: None,
                extras: Default::default(),
                indices: None,
                material,
                mode: Valid(if curve.closed {
                    Mode::LineLoop
                } else {
                    Mode::LineStrip
                }),
                targets: None,
            }],
            weights: None,
        });
        nodes.push(data.root.push(Node {
            mesh: Some(mesh),
            name: Some(curve.name.into()),
            ..Node::default()
        }));
    }
    let scene = data.root.push(Scene {
        extensions: None,
        extras: Default::default(),
        name: None,
        nodes,
    });
    data.root.scene = Some(scene);
    data.root.buffers[0].byte_length = data.bytes.len().into();
    let failed = |error: String| WriteReason::Io(error);
    let json = data
        .root
        .to_vec()
        .map_err(|error| failed(error.to_string()))?;
    Glb {
        // The length is worked out on writing.
        header: Header {
            magic: *b"glTF",
            version: 2,
            length: 0,
        },
        json: Cow::Owned(json),
        bin: Some(Cow::Owned(data.bytes)),
    }
    .to_vec()
    .map_err(|error| failed(error.to_string()))
}

struct Data {
    root: Root,
    buffer: Index<Buffer>,
    bytes: Vec<u8>,
    /// The looks written so far; each stands at the place of its material.
    finishes: Vec<Finish>,
}

impl Data {
    fn material(&mut self, finish: Finish) -> Index<Material> {
        if let Some(at) = self.finishes.iter().position(|f| *f == finish) {
            return Index::new(at as u32);
        }
        self.finishes.push(finish);
        self.root.push(Material {
            alpha_mode: Valid(if finish.opacity < 1.0 {
                AlphaMode::Blend
            } else {
                AlphaMode::Opaque
            }),
            pbr_metallic_roughness: PbrMetallicRoughness {
                base_color_factor: PbrBaseColorFactor(finish.linear()),
                metallic_factor: StrengthFactor(finish.metallic),
                roughness_factor: StrengthFactor(finish.roughness),
                ..PbrMetallicRoughness::default()
            },
            ..Material::default()
        })
    }

    /// Adds vectors; positions must state their box.
    fn vectors(&mut self, vectors: &[Vec3], with_box: bool) -> Index<Accessor> {
        let index = self.add(
            cast_slice(vectors),
            vectors.len(),
            Type::Vec3,
            ComponentType::F32,
            Target::ArrayBuffer,
        );
        if with_box {
            let fold = |of: fn(Vec3, Vec3) -> Vec3| {
                vectors
                    .iter()
                    .copied()
                    .reduce(of)
                    .map(|v| v.to_array().to_vec().into())
            };
            let accessor = &mut self.root.accessors[index.value()];
            accessor.min = fold(Vec3::min);
            accessor.max = fold(Vec3::max);
        }
        index
    }

    fn add(
        &mut self,
        bytes: &[u8],
        count: usize,
        type_: Type,
        component: ComponentType,
        target: Target,
    ) -> Index<Accessor> {
        let view = self.root.push(View {
            buffer: self.buffer,
            byte_length: bytes.len().into(),
            byte_offset: Some(self.bytes.len().into()),
            byte_stride: None,
            name: None,
            target: Some(Valid(target)),
            extensions: None,
            extras: Default::default(),
        });
        self.bytes.extend_from_slice(bytes);
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: Some(USize64(0)),
            count: count.into(),
            component_type: Valid(GenericComponentType(component)),
            extensions: None,
            extras: Default::default(),
            type_: Valid(type_),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
        })
    }
}
