//! What is shown in the place of things that the document does not have yet.

use std::collections::VecDeque;
use std::time::Duration;

use bevy::prelude::*;

use super::{Seen, Tint};

/// Figures are kept of so many pictures.
const KEPT: usize = 4096;

/// The latest of some figures.
#[derive(Debug, Default)]
pub struct Latest(VecDeque<Duration>);

impl Latest {
    /// One more; the oldest goes where there are many.
    pub fn push(&mut self, one: Duration) {
        if self.0.len() == KEPT {
            self.0.pop_front();
        }
        self.0.push_back(one);
    }

    /// All that are kept, the oldest first.
    pub fn iter(&self) -> impl Iterator<Item = Duration> + '_ {
        self.0.iter().copied()
    }
}

/// A picture in the plain colour that is no object: what a gesture will come to.
#[derive(Debug, Default)]
pub struct StandIn {
    entity: Option<Entity>,
    material: Option<Handle<StandardMaterial>>,
    /// How long its pictures took to make.
    pub took: Latest,
}

impl StandIn {
    /// Whether it is there.
    pub fn is_shown(&self) -> bool {
        self.entity.is_some()
    }

    /// Shows a mesh at a place, in the place of the one before.
    pub fn show(
        &mut self,
        name: &'static str,
        seen: &Seen,
        at: Transform,
        materials: &mut Assets<StandardMaterial>,
        commands: &mut Commands,
    ) {
        let Some(entity) = self.entity else {
            let material = self.material.get_or_insert_with(|| {
                materials.add(StandardMaterial {
                    base_color: Tint::Plain.colour(),
                    perceptual_roughness: 0.62,
                    reflectance: 0.35,
                    ..default()
                })
            });
            let look = MeshMaterial3d(material.clone());
            let mut entity = commands.spawn((Name::new(name), look, at));
            seen.worn_by(&mut entity);
            self.entity = Some(entity.id());
            return;
        };
        let mut entity = commands.entity(entity);
        entity.try_insert(at);
        seen.worn_by(&mut entity);
    }

    /// Takes it away.
    pub fn clear(&mut self, commands: &mut Commands) {
        if let Some(entity) = self.entity.take() {
            commands.entity(entity).try_despawn();
        }
    }
}
