//! While hands move things, their images move along.

use std::collections::BTreeMap;

use bevy::light::NotShadowCaster;
use bevy::prelude::*;
use midair_document::ObjectId;
use midair_field::Placement;

use super::spread::{Standing, apart, has_images};
use crate::project::Project;
use crate::show::{Drafts, ObjectMap, transform};

/// Where the images of what hands hold were put in the frame before.
#[derive(Resource, Default)]
pub(super) struct Reflected(BTreeMap<ObjectId, Placement>);

/// An image that is not in the document yet: it will be added when the hand lets go.
#[derive(Component)]
pub(super) struct Ghost;

pub(super) fn reflect(
    project: Res<Project>,
    map: Res<ObjectMap>,
    mut drafts: ResMut<Drafts>,
    mut reflected: ResMut<Reflected>,
    looks: Query<(&Mesh3d, Option<&MeshMaterial3d<StandardMaterial>>), Without<Ghost>>,
    mut ghosts: Query<
        (
            Entity,
            &mut Mesh3d,
            &mut MeshMaterial3d<StandardMaterial>,
            &mut Transform,
        ),
        With<Ghost>,
    >,
    mut commands: Commands,
) {
    let images = project.images();
    let idle = images.is_empty() || drafts.is_empty();
    if idle && reflected.0.is_empty() && ghosts.is_empty() {
        return;
    }
    // An image that a hand has taken meanwhile is that hand's.
    for (id, placement) in std::mem::take(&mut reflected.0) {
        if drafts.get(id) == Some(&placement) {
            drafts.take(id);
        }
    }
    let document = project.document();
    let held: Vec<_> = drafts.iter().map(|(id, p)| (id, *p)).collect();
    let mut missing = Vec::new();
    if !images.is_empty() && !held.is_empty() {
        let standing = Standing::new(document);
        for (id, now) in held {
            let Some(object) = document.object(id).filter(|o| has_images(o)) else {
                continue;
            };
            let partners = standing.partners(id, images);
            for &(partner, at) in &partners {
                let stays = drafts.get(partner).is_some() || document.is_locked(partner);
                if !stays {
                    let there = images[at].placement(&now);
                    drafts.set(partner, there);
                    reflected.0.insert(partner, there);
                }
            }
            let known = |image: &super::Image| {
                let mut with = partners.iter().map(|&(_, at)| &images[at]);
                with.any(|i| i == image)
            };
            for image in apart(object, &now, images) {
                if !known(image) {
                    missing.push((id, image.placement(&now)));
                }
            }
        }
    }
    let mut missing = missing.into_iter().filter_map(|(id, there)| {
        let (mesh, look) = looks.get(map.get(id)?).ok()?;
        // One that is written in WGSL is seen plain until it is let go.
        Some((
            mesh.clone(),
            look.cloned().unwrap_or_default(),
            transform(&there),
        ))
    });
    for (entity, mut mesh, mut look, mut at) in &mut ghosts {
        match missing.next() {
            Some((its_mesh, its_look, there)) => {
                mesh.set_if_neq(its_mesh);
                look.set_if_neq(its_look);
                at.set_if_neq(there);
            }
            None => commands.entity(entity).despawn(),
        }
    }
    for (mesh, look, at) in missing {
        commands.spawn((Name::new("image"), Ghost, NotShadowCaster, mesh, look, at));
    }
}
