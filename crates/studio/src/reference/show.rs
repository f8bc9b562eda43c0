//! Pictures on screen: a quad that light does not fall on, seen from both sides.

use std::sync::Arc;

use bevy::asset::RenderAssetUsages;
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy::tasks::{AsyncComputeTaskPool, Task, block_on, poll_once};
use bevy_mod_outline::ATTRIBUTE_OUTLINE_NORMAL;
use bevy_rapier3d::prelude::Collider;
use midair_document::{ImageHash, Reference};

use super::read;
use crate::StudioSet;
use crate::pick::Proxy;
use crate::project::Project;
use crate::show::{ObjectEntity, ShowObjects, transform};

/// The colour of a picture that is not there, or not yet.
const EMPTY: Color = Color::srgba(0.5, 0.52, 0.56, 0.35);

/// Half the thickness that a picture has for hands, in metres.
const THIN: f32 = 0.001;

/// What one entity shows.
#[derive(Component)]
struct Shown {
    reference: Reference,
    /// Whether its picture is drawn, and no longer the empty quad.
    whole: bool,
    proxy: Entity,
}

/// The textures of the pictures in the document; those that are in it no longer are let go.
#[derive(Resource, Default)]
struct Textures(HashMap<ImageHash, Texture>);

enum Texture {
    Coming(Task<Option<Image>>),
    Here(Handle<Image>),
    None,
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Textures>().add_systems(
        Update,
        (fetch, show)
            .chain()
            .in_set(StudioSet::Rebuild)
            .after(ShowObjects),
    );
}

/// Pictures are unpacked off the frame.
fn fetch(project: Res<Project>, mut textures: ResMut<Textures>, mut images: ResMut<Assets<Image>>) {
    let textures = &mut textures.bypass_change_detection().0;
    if project.is_changed() {
        let wanted = project.document().images();
        textures.retain(|hash, _| wanted.contains(hash));
        for hash in wanted {
            let found = textures.contains_key(&hash);
            if !found && let Some(bytes) = project.meshes().image(hash) {
                let task = AsyncComputeTaskPool::get().spawn(async move { unpack(bytes) });
                textures.insert(hash, Texture::Coming(task));
            }
        }
    }
    for texture in textures.values_mut() {
        if let Texture::Coming(task) = texture
            && let Some(done) = block_on(poll_once(task))
        {
            *texture = done.map_or(Texture::None, |image| Texture::Here(images.add(image)));
        }
    }
}

fn unpack(bytes: Arc<[u8]>) -> Option<Image> {
    let pixels = read::pixels(&bytes)?;
    let size = Extent3d {
        width: pixels.width(),
        height: pixels.height(),
        depth_or_array_layers: 1,
    };
    Some(Image::new(
        size,
        TextureDimension::D2,
        pixels.into_raw(),
        TextureFormat::Rgba8UnormSrgb,
        RenderAssetUsages::default(),
    ))
}

fn show(
    project: Res<Project>,
    textures: Res<Textures>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut objects: Query<(Entity, &ObjectEntity, Option<&mut Shown>)>,
    fresh: Query<(), Added<ObjectEntity>>,
    mut waiting: Local<bool>,
    mut commands: Commands,
) {
    if !project.is_changed() && !*waiting && fresh.is_empty() {
        return;
    }
    *waiting = false;
    let document = project.document();
    for (entity, id, shown) in &mut objects {
        let Some(object) = document.object(id.0) else {
            continue;
        };
        let Some(&reference) = object.reference() else {
            continue;
        };
        let texture = match textures.0.get(&reference.image) {
            Some(Texture::Here(handle)) => Some(handle.clone()),
            Some(Texture::Coming(_)) => {
                *waiting = true;
                None
            }
            Some(Texture::None) | None => None,
        };
        let whole = texture.is_some();
        let same_look = |s: &Shown| s.whole == whole && s.reference.opacity == reference.opacity;
        let mut entity = commands.entity(entity);
        if !shown
            .as_ref()
            .is_some_and(|s| same_look(s) && s.reference.image == reference.image)
        {
            entity.insert((
                MeshMaterial3d(materials.add(material(texture, reference.opacity))),
                NotShadowCaster,
                NotShadowReceiver,
            ));
        }
        let resized = shown
            .as_ref()
            .is_none_or(|s| s.reference.size != reference.size);
        if resized {
            entity.insert(Mesh3d(meshes.add(quad(reference.size))));
        }
        match shown {
            Some(mut shown) => {
                if resized {
                    let collider = collider(reference.size);
                    commands.entity(shown.proxy).try_insert(collider);
                }
                shown.reference = reference;
                shown.whole = whole;
            }
            None => {
                let size = Vec2::from(reference.size).extend(0.0) * object.placement.scale;
                let proxy = Proxy {
                    object: id.0,
                    size: size.length(),
                };
                let place = transform(&object.placement);
                let entity = entity.id();
                let proxy = commands
                    .spawn((proxy, collider(reference.size), place))
                    .id();
                commands.entity(entity).insert(Shown {
                    reference,
                    whole,
                    proxy,
                });
            }
        }
    }
}

fn collider([width, height]: [f32; 2]) -> Collider {
    Collider::cuboid(0.5 * width, 0.5 * height, THIN)
}

fn material(texture: Option<Handle<Image>>, opacity: f32) -> StandardMaterial {
    let base = if texture.is_some() {
        Color::WHITE.with_alpha(opacity)
    } else {
        EMPTY
    };
    StandardMaterial {
        base_color: base,
        base_color_texture: texture,
        unlit: true,
        alpha_mode: AlphaMode::Blend,
        ..default()
    }
}

/// Two faces back to back; the line around what is selected grows out of their edges.
fn quad([width, height]: [f32; 2]) -> Mesh {
    let (x, y) = (0.5 * width, 0.5 * height);
    let corners = [[-x, -y], [x, -y], [x, y], [-x, y]];
    let places = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let both = |z: f32| corners.map(|[x, y]| [x, y, z]);
    let outwards = corners.map(|[x, y]| Vec3::new(x.signum(), y.signum(), 0.0).normalize());
    Mesh::new(
        PrimitiveTopology::TriangleList,
        // The line around what is touched is drawn from the mesh in main memory as well.
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, [both(0.0), both(0.0)].concat())
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_NORMAL,
        [[[0.0, 0.0, 1.0]; 4], [[0.0, 0.0, -1.0]; 4]].concat(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, [places, places].concat())
    .with_inserted_attribute(ATTRIBUTE_OUTLINE_NORMAL, [outwards, outwards].concat())
    .with_inserted_indices(Indices::U32(vec![0, 1, 2, 0, 2, 3, 6, 5, 4, 7, 6, 4]))
}
