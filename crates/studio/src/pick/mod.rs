//! What a hand touches or points at, found in Rapier's bounding volume tree.
//!
//! Each object has a collider made from its mesh, off the frame, as an entity of its own: it
//! follows the object's place every frame, its scale only once a gesture is over, since a scaled
//! collider is built anew.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use midair_document::ObjectId;

use crate::{
    StudioSet,
    drawing::Drawing,
    hands::{Hands, Side},
    project::Project,
    show::{Drafts, ObjectEntity},
};

/// A hand touches what its tip is inside of or nearer to than this, in physical metres: things
/// smaller than a fingertip can still be grasped.
pub const PICK_RADIUS: f32 = 0.02;

/// How far a wand reaches, in metres of world.
pub const WAND_REACH: f32 = 20.0;

/// What one hand touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touched {
    /// The object.
    pub object: ObjectId,
    /// The nearest point of its surface, in world metres; the tip itself where it is inside.
    pub point: Vec3,
    /// Metres from the tip to that point.
    pub distance: f32,
}

/// What the wand points at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The object.
    pub object: ObjectId,
    /// Where the ray meets it, in world metres.
    pub point: Vec3,
    /// The surface's outward normal there.
    pub normal: Vec3,
    /// Metres along the ray.
    pub distance: f32,
}

/// What both hands touch in this frame.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Touch {
    hands: [Option<Touched>; 2],
}

impl Touch {
    /// What one hand touches.
    pub fn get(&self, side: Side) -> Option<Touched> {
        self.hands[side as usize]
    }
}

/// The collider of an object: an entity beside the object's own.
#[derive(Component, Clone, Copy, Debug)]
pub struct Proxy {
    /// Which object it stands for.
    pub object: ObjectId,
    /// The diagonal of its box in metres of world.
    pub size: f32,
}

pub(crate) fn plugin(app: &mut App) {
    app.add_plugins(RapierPhysicsPlugin::<NoUserData>::default().in_schedule(PostUpdate))
        .init_resource::<Touch>()
        .add_systems(Update, touch.in_set(StudioSet::Pick))
        .add_systems(
            Update,
            follow
                // The proxies follow what this frame showed, so that the next one picks it.
                .in_set(StudioSet::Cue),
        );
}

fn touch(
    hands: Res<Hands>,
    context: ReadRapierContext,
    proxies: Query<&Proxy>,
    drawing: Res<Drawing>,
    mut touch: ResMut<Touch>,
) {
    let Ok(context) = context.single() else {
        return;
    };
    let reach = PICK_RADIUS / hands.metres_per_world;
    let found = Side::BOTH.map(|side| {
        let tip = hands.get(side).pose.position;
        // Of everything the tip is inside of or near to, the smallest: a bead on a plate, or within a
        // ball, can be taken.
        let mut best: Option<(f32, Touched)> = None;
        let mut consider = |entity: Entity, point: Vec3| {
            let Ok(proxy) = proxies.get(entity) else {
                return;
            };
            let touched = Touched {
                object: proxy.object,
                point,
                distance: point.distance(tip),
            };
            let better = best.is_none_or(|(size, held)| {
                (proxy.size, touched.distance, touched.object) < (size, held.distance, held.object)
            });
            if touched.distance <= reach && better {
                best = Some((proxy.size, touched));
            }
        };
        let mut within = Vec::new();
        context.with_query_pipeline(QueryFilter::default(), |pipeline| {
            within.extend(pipeline.intersect_point(tip));
        });
        for &entity in &within {
            consider(entity, tip);
        }
        let outside = |entity: Entity| !within.contains(&entity);
        let filter = QueryFilter::default().predicate(&outside);
        if let Some((entity, nearest)) = context.project_point(tip, reach, true, filter) {
            consider(entity, nearest.point);
        }
        // A line is thinner than anything.
        let drawn = drawing
            .nearest(tip.as_dvec3(), reach.into())
            .map(|on| Touched {
                object: on.id,
                point: on.point.as_vec3(),
                distance: on.distance as f32,
            });
        drawn.or(best.map(|(_, touched)| touched))
    });
    touch.set_if_neq(Touch { hands: found });
}

/// What a ray from `origin` along the unit `direction` meets first.
pub fn cast(
    context: &RapierContext,
    proxies: &Query<&Proxy>,
    origin: Vec3,
    direction: Dir3,
) -> Option<Hit> {
    let (entity, hit) = context.cast_ray_and_get_normal(
        origin,
        *direction,
        WAND_REACH,
        true,
        QueryFilter::default(),
    )?;
    Some(Hit {
        object: proxies.get(entity).ok()?.object,
        point: hit.point,
        normal: hit.normal,
        distance: hit.time_of_impact,
    })
}

/// The proxies go where their objects went. In a frame in which nothing moved nothing is looked at, and Rapier, whose
/// step does no more here than bring its tree up to date, rests as well: a thousand things that stand still cost nothing.
fn follow(
    (project, drafts): (Res<Project>, Res<Drafts>),
    objects: Query<(&ObjectEntity, &Transform, &Visibility), Without<Proxy>>,
    moved: Query<
        &ObjectEntity,
        (
            With<ObjectEntity>,
            Without<Proxy>,
            Or<(Changed<Transform>, Changed<Visibility>)>,
        ),
    >,
    fresh: Query<(), Added<Proxy>>,
    mut gone: RemovedComponents<Proxy>,
    mut physics: Query<&mut RapierConfiguration>,
    (mut awake, mut held): (Local<u8>, Local<Vec<ObjectId>>),
    mut proxies: Query<(&Proxy, &mut Transform, Has<ColliderDisabled>, Entity)>,
    map: Res<crate::show::ObjectMap>,
    mut commands: Commands,
) {
    let resources = project.is_changed() || drafts.is_changed();
    let entities = !fresh.is_empty() || !moved.is_empty() || gone.read().count() > 0;
    let changed = resources || entities;
    // What is despawned here is noticed there in the frames after.
    *awake = if changed { 3 } else { awake.saturating_sub(1) };
    for mut rapier in &mut physics {
        if rapier.physics_pipeline_active != (*awake > 0) {
            rapier.physics_pipeline_active = *awake > 0;
        }
    }
    if !changed {
        return;
    }
    // While hands move, and nothing else does, only what they hold is looked at.
    let all = project.is_changed() || !fresh.is_empty();
    let mut few = std::mem::replace(&mut *held, drafts.iter().map(|(id, _)| id).collect());
    few.extend(held.iter().copied().chain(moved.iter().map(|o| o.0)));
    few.sort_unstable();
    few.dedup();
    for (proxy, mut transform, disabled, entity) in &mut proxies {
        if !all && few.binary_search(&proxy.object).is_err() {
            continue;
        }
        let Some((_, shown, visibility)) = map.get(proxy.object).and_then(|e| objects.get(e).ok())
        else {
            commands.entity(entity).despawn();
            continue;
        };
        // Hands pass through what is hidden and what is locked.
        let passed =
            *visibility == Visibility::Hidden || project.document().is_locked(proxy.object);
        if passed != disabled {
            if passed {
                commands.entity(entity).insert(ColliderDisabled);
            } else {
                commands.entity(entity).remove::<ColliderDisabled>();
            }
        }
        let mut wanted = *shown;
        if drafts.get(proxy.object).is_some() {
            wanted.scale = transform.scale;
        }
        if *transform != wanted {
            *transform = wanted;
        }
    }
}
