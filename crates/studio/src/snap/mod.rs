//! Snaps: what a hand moves comes to rest on lines, whole angles and surfaces.
//!
//! Each has its own switch in the settings; [`Action::Free`] holds all of them off. A tool asks the
//! [`Snapper`] where what it moves comes to rest, shows that, and commits that.

mod pull;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_rapier3d::prelude::{QueryFilter, ReadRapierContext};
use midair_document::{Kind, Object, ObjectId};
use midair_field::Placement;

pub use pull::{Pull, Snapped, box_feet, box_of, feet, snap};

use crate::StudioSet;
use crate::evaluate::Evaluations;
use crate::hands::{Action, Hands, Side};
use crate::pick::Proxy;
use crate::plane::WorkPlane;
use crate::project::Project;
use crate::settings::Settings;
use crate::show::form;

/// How far a surface is felt, in physical metres.
pub const SURFACE_REACH: f32 = 0.03;

/// What snaps in this frame, to be shown before it is committed.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct SnapPreview(pub Vec<Snapped>);

/// Says where what a tool moves comes to rest.
#[derive(SystemParam)]
pub struct Snapper<'w, 's> {
    settings: Res<'w, Settings>,
    plane: Res<'w, WorkPlane>,
    project: Res<'w, Project>,
    evaluations: Res<'w, Evaluations>,
    context: ReadRapierContext<'w, 's>,
    proxies: Query<'w, 's, &'static Proxy>,
    preview: ResMut<'w, SnapPreview>,
}

impl Snapper<'_, '_> {
    /// Where `object` comes to rest when the hand on `side` would have it at `wanted`. What else the
    /// hand moves is carried along and belongs into `along`, so that nothing snaps to
    /// what it moves with.
    pub fn place(
        &mut self,
        object: ObjectId,
        along: &[ObjectId],
        wanted: Placement,
        hands: &Hands,
        side: Side,
    ) -> Placement {
        let free = hands.get(side).held(Action::Free);
        self.rest(object, along, wanted, free, hands.metres_per_world)
    }

    /// The same for what moves things otherwise than by a hand.
    pub fn rest(
        &mut self,
        object: ObjectId,
        along: &[ObjectId],
        wanted: Placement,
        free: bool,
        metres_per_world: f32,
    ) -> Placement {
        let snaps = &self.settings.snap;
        let on = snaps.grid.on || snaps.angle.on || snaps.surface.on;
        let Some(standing) = self.project.document().object(object) else {
            return wanted;
        };
        if !on || free || !wanted.is_sound() {
            return wanted;
        }
        let Some(bounds) = own_box(&self.project, standing) else {
            return wanted;
        };
        let context = self.context.single().ok();
        let proxies = &self.proxies;
        let floor = |foot: Vec3, reach: f32| {
            let from = foot + reach * Vec3::Y;
            // The ground is there without a collider.
            let ground = (from.y >= 0.0 && from.y <= 2.0 * reach).then_some(0.0);
            let passed = |entity: Entity| {
                proxies
                    .get(entity)
                    .is_ok_and(|p| p.object != object && !along.contains(&p.object))
            };
            let hit = context.as_ref().and_then(|c| {
                let filter = QueryFilter::default().predicate(&passed);
                c.cast_ray(from, Vec3::NEG_Y, 2.0 * reach, false, filter)
            });
            let surface = hit.map(|(_, far)| from.y - far);
            surface.into_iter().chain(ground).reduce(f32::max)
        };
        let pull = Pull {
            settings: snaps,
            plane: &self.plane,
            reach: SURFACE_REACH / metres_per_world,
        };
        let form = form(&self.project, &self.evaluations, standing);
        let feet = |at: &Placement| match &form {
            Some(form) => feet(at, &form.positions),
            None => box_feet(at, bounds),
        };
        let snapped = snap(&pull, &standing.placement, wanted, bounds, feet, floor);
        self.preview.0.push(snapped);
        snapped.placement
    }
}

/// The box of an object in its own frame, in metres before its scale.
pub fn own_box(project: &Project, object: &Object) -> Option<(Vec3, Vec3)> {
    let bounds = match &object.kind {
        // What is drawn is the mesh, whatever its tool says of its box.
        Kind::Foreign { mesh, .. } => project.mesh(mesh)?.bounds(),
        _ => object.bounds(),
    };
    let (low, high) = (bounds.min, bounds.max);
    low.cmple(high).all().then_some((low, high))
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<SnapPreview>().add_systems(
        Update,
        // What snapped in the frame before is shown no longer.
        (|mut preview: ResMut<SnapPreview>| {
            if !preview.0.is_empty() {
                preview.0.clear();
            }
        })
        .in_set(StudioSet::Gather)
        .in_set(ClearGuides),
    );
}

/// The step that clears what was shown for one frame only; what fills it anew runs after it.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct ClearGuides;
