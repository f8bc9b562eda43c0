//! Entities follow the document.

use std::sync::Arc;

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy_rapier3d::prelude::Collider;
use midair_document::{Document, Kind, Object, ObjectId};
use midair_field::{Node, Recipe};
use midair_mesh::{MeshHash, TriMesh};

use super::{Drafts, transform};
use crate::StudioSet;
use crate::evaluate::{Deliver, Evaluations, Key, Made};
use crate::pick::Proxy;
use crate::project::Project;

/// Which object an entity shows.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObjectEntity(pub ObjectId);

/// Where the entity of an object is.
#[derive(Resource, Debug, Default)]
pub struct ObjectMap(HashMap<ObjectId, Entity>);

impl ObjectMap {
    /// The entity that shows an object.
    pub fn get(&self, object: ObjectId) -> Option<Entity> {
        self.0.get(&object).copied()
    }
}

/// What an entity shows at the moment.
#[derive(Component, Default)]
struct Showing {
    solid: Option<Key>,
    mesh: Option<MeshHash>,
    /// Keeps what is drawn in memory.
    made: Option<Arc<Made>>,
    proxy: Option<Entity>,
}

/// Operands shown in place of a result that is still being made.
#[derive(Component)]
struct StandIn;

/// Bevy meshes by what they were made from, so that copies share one.
#[derive(Resource, Default)]
struct Drawn(HashMap<Key, Handle<Mesh>>);

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<ObjectMap>()
        .init_resource::<Drawn>()
        .add_systems(
            Update,
            (spawn, place, show)
                .chain()
                .in_set(StudioSet::Rebuild)
                .after(Deliver),
        );
}

/// One entity per object.
fn spawn(project: Res<Project>, mut map: ResMut<ObjectMap>, mut commands: Commands) {
    if !project.is_changed() {
        return;
    }
    let document = project.document();
    map.0.retain(|&id, &mut entity| {
        let lives = document.object(id).is_some();
        if !lives {
            commands.entity(entity).despawn();
        }
        lives
    });
    for (id, object) in document.objects() {
        map.0.entry(id).or_insert_with(|| {
            commands
                .spawn((
                    Name::new(object.name.clone()),
                    ObjectEntity(id),
                    Showing::default(),
                    MeshMaterial3d::<StandardMaterial>::default(),
                    transform(&object.placement),
                    Visibility::default(),
                ))
                .id()
        });
    }
}

/// Everything stands where the document, or the hand that holds it, says.
fn place(
    project: Res<Project>,
    drafts: Res<Drafts>,
    mut objects: Query<(&ObjectEntity, &mut Transform, &mut Visibility)>,
) {
    if !project.is_changed() && !drafts.is_changed() {
        return;
    }
    let document = project.document();
    for (id, mut at, mut visibility) in &mut objects {
        let Some(object) = document.object(id.0) else {
            continue;
        };
        at.set_if_neq(transform(drafts.get(id.0).unwrap_or(&object.placement)));
        visibility.set_if_neq(if document.is_visible(id.0) {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        });
    }
}

/// Each solid is shown at the document's step in the world, whatever its scale.
fn show(
    project: Res<Project>,
    mut evaluations: ResMut<Evaluations>,
    mut drawn: ResMut<Drawn>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut objects: Query<(Entity, &ObjectEntity, &mut Showing, Option<&Children>)>,
    stand_ins: Query<(), With<StandIn>>,
    mut commands: Commands,
) {
    let document = project.document();
    for (entity, id, mut showing, children) in &mut objects {
        let Some(object) = document.object(id.0) else {
            continue;
        };
        let made = match &object.kind {
            Kind::Solid(recipe) => {
                let step = display_step(document, object, recipe);
                let key = Key::new(recipe, step);
                if showing.solid == Some(key) {
                    continue;
                }
                match evaluations.want(recipe, step) {
                    Some(made) => {
                        showing.solid = Some(key);
                        let handle = drawn.0.get(&key).filter(|h| meshes.contains(h.id())).cloned();
                        let handle = handle.unwrap_or_else(|| {
                            let mesh = made.drawn.lock().ok().and_then(|mut m| m.take());
                            let handle =
                                meshes.add(mesh.unwrap_or_else(|| to_bevy_mesh(&made.mesh)));
                            drawn.0.insert(key, handle.clone());
                            handle
                        });
                        commands.entity(entity).insert(Mesh3d(handle));
                        made
                    }
                    None => {
                        if showing.made.is_none() && children.is_none() {
                            stand_in(recipe, step, entity, &mut evaluations, &drawn, &mut commands);
                        }
                        continue;
                    }
                }
            }
            Kind::Foreign { mesh: hash, .. } => {
                if showing.mesh == Some(*hash) {
                    continue;
                }
                let Some(mesh) = project.mesh(hash) else {
                    continue;
                };
                showing.mesh = Some(*hash);
                let made = Arc::new(Made::from_mesh(mesh));
                commands
                    .entity(entity)
                    .insert(Mesh3d(meshes.add(to_bevy_mesh(&made.mesh))));
                made
            }
        };
        for child in children.into_iter().flatten() {
            if stand_ins.contains(*child) {
                commands.entity(*child).despawn();
            }
        }
        if let Some(proxy) = showing.proxy.take() {
            commands.entity(proxy).despawn();
        }
        showing.proxy = made.shape.clone().map(|shape| {
            commands
                .spawn((
                    Proxy {
                        object: id.0,
                        size: (made.mesh.bounds().size() * object.placement.scale).length(),
                    },
                    Collider::from(shape),
                    transform(&object.placement),
                ))
                .id()
        });
        showing.made = Some(made);
    }
    // Handles that only this table holds belong to nothing on screen.
    drawn.0.retain(|_, handle| match handle {
        Handle::Strong(strong) => Arc::strong_count(strong) > 1,
        Handle::Uuid(..) => true,
    });
}

/// The step in the object's own frame that gives the document's step in the world, halved for single
/// components, whose edges are what one sees. In powers of two, so that scaling makes few of them.
pub(crate) fn display_step(document: &Document, object: &Object, recipe: &Recipe) -> f32 {
    let scale = object.placement.scale.abs().max_element();
    let halvings = scale.max(1e-3).log2().ceil().clamp(-4.0, 6.0);
    let fine = if is_component(recipe) { 0.5 } else { 1.0 };
    document.step() * fine * (-halvings).exp2()
}

fn is_component(recipe: &Recipe) -> bool {
    matches!(recipe.node(), Node::Component { .. } | Node::Primitive(_))
}

/// Until a fresh result is there, its operands are shown where they stood.
fn stand_in(
    recipe: &Recipe,
    step: f32,
    parent: Entity,
    evaluations: &mut Evaluations,
    drawn: &Drawn,
    commands: &mut Commands,
) {
    let Node::Solid(operands) = recipe.node() else {
        return;
    };
    for operand in operands {
        if operand.op != midair_field::Op::Union {
            continue;
        }
        let found = [1.0, 0.5, 0.25, 2.0]
            .map(|f| Key::new(&operand.recipe, step * f))
            .into_iter()
            .find_map(|key| evaluations.peek(&key).and(drawn.0.get(&key)));
        if let Some(handle) = found {
            let child = commands
                .spawn((
                    StandIn,
                    Mesh3d(handle.clone()),
                    MeshMaterial3d::<StandardMaterial>::default(),
                    transform(&operand.placement),
                    ChildOf(parent),
                ))
                .id();
            let _ = child;
        }
    }
}

/// As Bevy draws it. The vertices stay in main memory for picking and export of what is shown.
pub fn to_bevy_mesh(mesh: &TriMesh) -> Mesh {
    let normals: Vec<Vec3> = if mesh.normals.len() == mesh.positions.len() {
        mesh.normals.clone()
    } else {
        vec![Vec3::Y; mesh.positions.len()]
    };
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::RENDER_WORLD,
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, mesh.positions.clone())
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
    .with_inserted_indices(Indices::U32(
        mesh.triangles.iter().flatten().copied().collect(),
    ))
}
