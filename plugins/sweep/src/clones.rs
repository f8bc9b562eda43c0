//! The clones that would stand on the curve, while it is held.

use bevy::light::NotShadowCaster;
use bevy::prelude::*;
use midair_studio::{
    evaluate::{Evaluations, Key},
    notice::Notices,
    project::{Project, Shelf},
    settings::{Settings, SweepShape},
    show::Drawn,
};
use midair_swept::Row as Placed;

use crate::phase::{Draft, Phase};
use crate::write;

/// The entities that show them.
#[derive(Resource, Default)]
pub(crate) struct Row {
    shown: Vec<Entity>,
    mesh: Option<(Key, Handle<Mesh>)>,
    material: Option<Handle<StandardMaterial>>,
    /// What was last said of an item that cannot be cloned.
    said: Option<String>,
}

/// One of them.
#[derive(Component)]
pub(crate) struct Shown;

/// No more than so many are shown on a curve that is held.
const MOST: usize = 256;

impl Row {
    pub fn clear(&mut self, commands: &mut Commands) {
        for entity in self.shown.drain(..) {
            commands.entity(entity).try_despawn();
        }
        self.mesh = None;
    }
}

/// Along the control curve alone, so that the view stays clear (§4.1).
pub(crate) fn draw(
    draft: Res<Draft>,
    settings: Res<Settings>,
    project: Res<Project>,
    shelf: Res<Shelf>,
    mut evaluations: ResMut<Evaluations>,
    mut drawn: ResMut<Drawn>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut row: ResMut<Row>,
    mut shown: Query<&mut Transform, With<Shown>>,
    mut notices: ResMut<Notices>,
    mut commands: Commands,
) {
    let wanted =
        settings.sweep.shape == SweepShape::Clones && !matches!(draft.phase, Phase::Editing { .. });
    let Some(rib) = draft.live.filter(|_| wanted) else {
        if !row.shown.is_empty() {
            row.clear(&mut commands);
        }
        return;
    };
    let (recipe, longest) = match write::item(&settings.sweep, &project, &shelf) {
        Ok(found) => found,
        Err(reason) => {
            if row.said.as_ref() != Some(&reason) {
                notices.info(reason.clone());
                row.said = Some(reason);
            }
            row.clear(&mut commands);
            return;
        }
    };
    let step = project.document().step();
    let key = Key::new(&recipe, step);
    if row.mesh.as_ref().is_none_or(|(k, _)| *k != key) {
        let Some(made) = evaluations.want(&recipe, step) else {
            return;
        };
        row.clear(&mut commands);
        if made.mesh.triangles.is_empty() {
            if row.said.as_deref() != Some(write::EMPTY) {
                notices.info(write::EMPTY);
                row.said = Some(write::EMPTY.to_owned());
            }
            return;
        }
        row.said = None;
        row.mesh = Some((key, drawn.handle(key, &made, &mut meshes)));
    }
    let Some((_, mesh)) = row.mesh.clone() else {
        return;
    };
    let material = row
        .material
        .get_or_insert_with(|| {
            materials.add(StandardMaterial {
                base_color: Color::srgba(0.85, 0.86, 0.9, 0.55),
                alpha_mode: AlphaMode::Blend,
                perceptual_roughness: 0.7,
                ..default()
            })
        })
        .clone();
    let places = Placed {
        ribs: [rib].into(),
        count: settings.sweep.clones.clamp(1, MOST as u32),
        size: settings.sweep.clone_size / longest,
        paced: settings.sweep.paced,
    }
    .places();
    while row.shown.len() > places.len() {
        if let Some(entity) = row.shown.pop() {
            commands.entity(entity).try_despawn();
        }
    }
    for (i, place) in places.iter().enumerate() {
        let at = Transform {
            translation: place.translation,
            rotation: place.rotation,
            scale: Vec3::splat(place.scale),
        };
        match row.shown.get(i) {
            Some(&entity) => {
                if let Ok(mut shown) = shown.get_mut(entity) {
                    shown.set_if_neq(at);
                }
            }
            None => {
                let look = (Mesh3d(mesh.clone()), MeshMaterial3d(material.clone()));
                let entity = commands.spawn((Shown, look, at, NotShadowCaster));
                row.shown.push(entity.id());
            }
        }
    }
}
