//! Entities follow the document.

use std::sync::Arc;

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::platform::collections::HashMap;
use bevy::platform::collections::hash_map::Entry;
use bevy::prelude::*;
use bevy_rapier3d::prelude::Collider;
use midair_document::{Document, Kind, Object, ObjectId};
use midair_field::{Node, Placement, Recipe};
use midair_mesh::TriMesh;

use super::material::{Dress, Worn};
use super::showing::{Drawn, Showing};
use super::{CardWrites, Drafts, transform};
use crate::StudioSet;
use crate::evaluate::{Deliver, Delivered, Delivery, Evaluations, Key, Made, ONE_BY_ONE, merged};
use crate::pick::Proxy;
use crate::project::Project;
use crate::settings::{LinesShown, Settings};

/// Which object an entity shows.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObjectEntity(pub ObjectId);

/// The step in which there comes to be one entity per object, where the object stands.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct ShowObjects;

/// Where the entity of an object is.
#[derive(Resource, Debug, Default)]
pub struct ObjectMap(HashMap<ObjectId, Entity>);

impl ObjectMap {
    /// The entity that shows an object.
    pub fn get(&self, object: ObjectId) -> Option<Entity> {
        self.0.get(&object).copied()
    }
}

/// What is in the document and not in the room yet: so many come in a frame, those that were made first before the others, so
/// that a thousand at once cost no frame.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Arriving {
    /// Objects without an entity.
    objects: usize,
    /// Objects whose solid is made and not shown.
    solids: usize,
}

impl Arriving {
    /// How many are on their way.
    pub fn count(&self) -> usize {
        self.objects + self.solids
    }
}

/// How many come in a frame: a player that waits for them takes in all at once.
fn most(delivery: &Delivery) -> usize {
    match delivery {
        Delivery::All => usize::MAX,
        Delivery::AsTheyCome | Delivery::Exactly(_) => A_FRAME,
    }
}

/// Objects that come to be, and solids that are shown, in one frame.
const A_FRAME: usize = 48;

/// One clone of a row: a child of the row's own entity.
#[derive(Component, Clone, Copy, Debug)]
pub(super) struct CloneOf(pub ObjectId);

/// Operands shown in place of a result that is still being made.
#[derive(Component)]
struct StandIn;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<ObjectMap>()
        .init_resource::<Drawn>()
        .init_resource::<Arriving>()
        .init_resource::<super::halo::HaloLook>()
        // Not in the midst of what follows the document: that would have to wait for what it spawns.
        .add_systems(
            Update,
            (super::halo::halos, super::halo::dress).after(StudioSet::Cue),
        )
        .add_systems(
            Update,
            (spawn, place, show, super::ink::draw)
                .chain()
                .in_set(ShowObjects)
                .in_set(StudioSet::Rebuild)
                .after(Deliver),
        );
}

/// One entity per object.
fn spawn(
    (project, settings, delivery): (Res<Project>, Res<Settings>, Res<Delivery>),
    mut map: ResMut<ObjectMap>,
    mut arriving: ResMut<Arriving>,
    mut commands: Commands,
) {
    if !project.is_changed() && arriving.objects == 0 {
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
    let (mut left, mut waiting) = (most(&delivery), 0);
    for (id, object) in document.objects() {
        let Entry::Vacant(free) = map.0.entry(id) else {
            continue;
        };
        if left == 0 {
            waiting += 1;
            continue;
        }
        left -= 1;
        let entity = commands.spawn((
            Name::new(object.name.clone()),
            ObjectEntity(id),
            Showing::default(),
            MeshMaterial3d::<StandardMaterial>::default(),
            transform(&object.placement),
            seen(document, &settings, id, object),
        ));
        free.insert(entity.id());
    }
    arriving.objects = waiting;
}

/// Whether an object is to be seen.
fn seen(document: &Document, settings: &Settings, id: ObjectId, object: &Object) -> Visibility {
    let hidden = settings.scaffold.lines == LinesShown::Hidden && object.line().is_some();
    if document.is_visible(id) && !hidden {
        Visibility::Inherited
    } else {
        Visibility::Hidden
    }
}

/// Everything stands where the document, or the hand that holds it, says. While hands move, only what they hold is
/// looked at.
fn place(
    (project, drafts, settings): (Res<Project>, Res<Drafts>, Res<Settings>),
    map: Res<ObjectMap>,
    mut objects: Query<(&ObjectEntity, &mut Transform, &mut Visibility)>,
    mut held: Local<Vec<ObjectId>>,
) {
    let all = project.is_changed() || settings.is_changed();
    if !all && !drafts.is_changed() {
        return;
    }
    let document = project.document();
    let stand = |id: &ObjectEntity, mut at: Mut<Transform>, mut visibility: Mut<Visibility>| {
        let Some(object) = document.object(id.0) else {
            return;
        };
        at.set_if_neq(transform(drafts.get(id.0).unwrap_or(&object.placement)));
        visibility.set_if_neq(seen(document, &settings, id.0, object));
    };
    // What a hand let go of goes back to where the document has it.
    let before = std::mem::replace(&mut *held, drafts.iter().map(|(id, _)| id).collect());
    if all {
        for (id, at, visibility) in &mut objects {
            stand(id, at, visibility);
        }
        return;
    }
    for &id in before.iter().chain(held.iter()) {
        if let Some((id, at, visibility)) = map.get(id).and_then(|e| objects.get_mut(e).ok()) {
            stand(id, at, visibility);
        }
    }
}

/// Each solid is shown at the document's step in the world, whatever its scale.
fn show(
    project: Res<Project>,
    mut evaluations: ResMut<Evaluations>,
    (mut drawn, mut writes): (ResMut<Drawn>, ResMut<CardWrites>),
    mut meshes: ResMut<Assets<Mesh>>,
    (map, mut arriving): (Res<ObjectMap>, ResMut<Arriving>),
    mut objects: Query<(&mut Showing, Worn, Option<&Children>)>,
    stand_ins: Query<(), StoodIn>,
    (delivery, delivered): (Res<Delivery>, Res<Delivered>),
    mut awake: Local<u8>,
    mut commands: Commands,
) {
    let busy =
        evaluations.progress().next().is_some() || !delivered.0.is_empty() || arriving.count() > 0;
    // What was given up on the way is asked for once more.
    *awake = match *awake {
        _ if busy || project.is_changed() => 3,
        0 => return,
        left => left - 1,
    };
    let document = project.document();
    let (mut left, mut waiting) = (most(&delivery), 0);
    // In the order in which they were made.
    for (id, object) in document.objects() {
        let Some(entity) = map.get(id) else { continue };
        let Ok((mut showing, look, children)) = objects.get_mut(entity) else {
            continue;
        };
        let made = match &object.kind {
            // Drawn without being made.
            Kind::Line(_) | Kind::Stroke(_) => continue,
            Kind::Solid(recipe) | Kind::Sheet(recipe) => {
                // The document's step first, which is what update makes; then finer, for the eye.
                let mut steps = display_steps(document, object, recipe);
                showing.take_back(|k| steps.iter().any(|&s| *k == Key::new(recipe, s)));
                let shown = showing.solid;
                let painted = matches!(recipe.node(), Node::Canvas(_));
                let before = shown.filter(|_| painted).map(|k| k.recipe);
                // A painting shown finely is made again from that, sooner than coarsely from nothing.
                if before.is_some() && shown.map(|k| k.step()) == steps.first().copied() {
                    steps.truncate(1);
                }
                let best = steps
                    .iter()
                    .copied()
                    .take_while(|&s| shown != Some(Key::new(recipe, s)))
                    .filter_map(|s| {
                        let made = evaluations.want_after(recipe, s, before)?;
                        Some((Key::new(recipe, s), made))
                    })
                    .next();
                let Some((key, made)) = best else {
                    let coming = steps
                        .iter()
                        .map(|&s| Key::new(recipe, s))
                        .take_while(|k| shown != Some(*k));
                    let with = (&mut *writes, &mut *drawn, &mut *meshes);
                    let mut entity = commands.entity(entity);
                    if left > 0
                        && showing.draw_coming(coming, recipe, &evaluations, with, &mut entity)
                    {
                        left -= 1;
                        clear(children, &stand_ins, &mut commands);
                        continue;
                    }
                    let entity = entity.id();
                    if showing.is_empty() && children.is_none() {
                        stand_in(
                            recipe,
                            &mut evaluations,
                            &drawn,
                            entity,
                            document,
                            &mut commands,
                        );
                    }
                    continue;
                };
                if left == 0 {
                    waiting += 1;
                    continue;
                }
                left -= 1;
                showing.solid = Some(key);
                match &made.places {
                    Some(places) => {
                        let handle = drawn.handle(key, &made, &mut meshes);
                        commands.entity(entity).remove::<Mesh3d>();
                        let pieces = made.pieces.lock().map(|mut p| std::mem::take(&mut *p));
                        // They were drawn before, and let go since.
                        let pieces = pieces.unwrap_or_default();
                        let pieces = if pieces.is_empty() && places.len() > ONE_BY_ONE {
                            merged(&made.mesh, places)
                        } else {
                            pieces
                        };
                        let pieces: Vec<_> = pieces
                            .into_iter()
                            .map(|m| (meshes.add(m), Transform::IDENTITY))
                            .collect();
                        let each = if pieces.is_empty() {
                            one_by_one(places, &handle)
                        } else {
                            pieces
                        };
                        stand(each, &Dress::of(look), entity, id, &mut commands);
                    }
                    None => {
                        // Its edges are sharp in main memory alone.
                        let surface = evaluations.surface(&key).filter(|_| !made.has_edges());
                        let with = (&mut *writes, &mut *drawn, &mut *meshes);
                        let mut entity = commands.entity(entity);
                        showing.draw((key, &made), recipe, surface, with, &mut entity);
                    }
                }
                made
            }
            // Shown by a room of its own.
            Kind::Reference(_) => continue,
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
        clear(children, &stand_ins, &mut commands);
        if let Some(proxy) = showing.proxy.take() {
            commands.entity(proxy).despawn();
        }
        showing.proxy = made.shape.clone().map(|shape| {
            commands
                .spawn((
                    Proxy {
                        object: id,
                        size: (made.bounds.size() * object.placement.scale).length(),
                    },
                    Collider::from(shape),
                    transform(&object.placement),
                ))
                .id()
        });
        showing.made = Some(made);
    }
    arriving.solids = waiting;
    drawn.tidy(&evaluations);
}

/// What a solid of one piece takes the place of.
type StoodIn = Or<(With<StandIn>, With<CloneOf>)>;

fn clear(children: Option<&Children>, stand_ins: &Query<(), StoodIn>, commands: &mut Commands) {
    for &child in children.into_iter().flatten() {
        if stand_ins.contains(child) {
            commands.entity(child).despawn();
        }
    }
}

/// The steps in the object's own frame at which it is shown, the finest first: the one that gives the
/// document's step in the world, and half of it, since a screen shows what a quick update need not.
/// In powers of two, so that scaling makes few of them.
pub fn display_steps(document: &Document, object: &Object, recipe: &Recipe) -> Vec<f32> {
    let scale = object.placement.scale.abs().max_element();
    let halvings = scale.max(1e-3).log2().ceil().clamp(-4.0, 6.0);
    let step = document.step() * (-halvings).exp2();
    // Below this the eye gains nothing and the memory pays.
    let fine = document.step() >= 0.004;
    match recipe.node() {
        Node::Component { .. } | Node::Primitive(_) | Node::Sweep(_) | Node::Clones { .. }
            if fine =>
        {
            vec![0.5 * step]
        }
        _ if fine => vec![0.5 * step, step],
        _ => vec![step],
    }
}

/// The clones of a row, each an entity that shares its mesh with the others, so that they are drawn
/// together.
fn one_by_one(
    places: &[midair_field::Place],
    mesh: &Handle<Mesh>,
) -> Vec<(Handle<Mesh>, Transform)> {
    let at = |p| (mesh.clone(), transform(&Placement::from(p)));
    places.iter().map(at).collect()
}

/// What a row of clones is drawn as: children of its entity, that look as it does.
fn stand(
    each: Vec<(Handle<Mesh>, Transform)>,
    look: &Dress,
    row: Entity,
    object: ObjectId,
    commands: &mut Commands,
) {
    let clone = move |(mesh, at)| (CloneOf(object), Mesh3d(mesh), at, ChildOf(row));
    let each = each.into_iter().map(clone);
    match look.clone() {
        Dress::Plain(look) => {
            let drawn = each.map(move |clone| (clone, MeshMaterial3d(look.clone())));
            commands.spawn_batch(drawn.collect::<Vec<_>>());
        }
        Dress::Living(look) => {
            let drawn = each.map(move |clone| (clone, MeshMaterial3d(look.clone())));
            commands.spawn_batch(drawn.collect::<Vec<_>>());
        }
    }
}

/// Until a fresh result is there, its operands are shown where they stood.
fn stand_in(
    recipe: &Recipe,
    evaluations: &mut Evaluations,
    drawn: &Drawn,
    parent: Entity,
    document: &Document,
    commands: &mut Commands,
) {
    let Node::Solid(operands) = recipe.node() else {
        return;
    };
    for operand in operands
        .iter()
        .filter(|o| o.op == midair_field::Op::Union && !o.muted)
    {
        let as_object = Object::solid("", operand.recipe.clone()).placed(operand.placement);
        let found = display_steps(document, &as_object, &operand.recipe)
            .into_iter()
            .map(|step| Key::new(&operand.recipe, step))
            .find_map(|key| evaluations.peek(&key).and(drawn.get(&key)));
        if let Some(handle) = found {
            commands.spawn((
                StandIn,
                Mesh3d(handle.clone()),
                MeshMaterial3d::<StandardMaterial>::default(),
                transform(&operand.placement),
                ChildOf(parent),
            ));
        }
    }
}

/// As Bevy draws it.
pub fn to_bevy_mesh(mesh: &TriMesh) -> Mesh {
    if mesh.positions.is_empty() {
        // The engine has no room for nothing, and says so where a person reads it: a triangle without area.
        return to_bevy_mesh(&TriMesh {
            positions: vec![Vec3::ZERO; 3],
            triangles: vec![[0, 1, 2]],
            ..TriMesh::default()
        });
    }
    let normals: Vec<Vec3> = if mesh.normals.len() == mesh.positions.len() {
        mesh.normals.clone()
    } else {
        vec![Vec3::Y; mesh.positions.len()]
    };
    Mesh::new(
        PrimitiveTopology::TriangleList,
        // The line around what is touched is drawn from the mesh in main memory as well.
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, mesh.positions.clone())
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
    .with_inserted_indices(Indices::U32(
        mesh.triangles.iter().flatten().copied().collect(),
    ))
}
