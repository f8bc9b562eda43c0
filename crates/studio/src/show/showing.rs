//! What draws an object: its finished solid, and before that what can be seen of it already.

use std::sync::Arc;

use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use midair_field::{Recipe, RecipeHash};
use midair_gpu::Emitted;
use midair_mesh::MeshHash;

use super::{CardMesh, CardWrites, Seen};
use crate::evaluate::{Evaluations, Key, Made};

/// What an entity shows at the moment.
#[derive(Component, Default)]
pub(super) struct Showing {
    pub solid: Option<Key>,
    pub mesh: Option<MeshHash>,
    /// Keeps what is drawn in memory.
    pub made: Option<Arc<Made>>,
    pub proxy: Option<Entity>,
    /// What is drawn in place of that before it is finished, in main memory.
    early: Option<Key>,
    /// The recipe that it came with.
    first: Option<RecipeHash>,
    /// What the card draws it with, once it was changed.
    card: Option<OnCard>,
}

/// A mesh that the card writes into, and what it shows; `None` while another mesh is shown.
struct OnCard {
    mesh: CardMesh,
    shows: Option<Key>,
}

impl Showing {
    /// Whether nothing of the object is drawn yet.
    pub fn is_empty(&self) -> bool {
        self.made.is_none() && self.early.is_none()
    }

    /// What was drawn early and is none of `wanted` any more gives way to what was there: it could not be touched yet.
    pub fn take_back(&mut self, wanted: impl Fn(&Key) -> bool) {
        let on_card = self.card.as_ref().and_then(|c| c.shows);
        let on_card = on_card.filter(|k| !wanted(k) && Some(*k) != self.solid);
        if self.early.take_if(|k| !wanted(k)).or(on_card).is_some() {
            self.solid = None;
        }
    }

    /// Draws what can be seen already of the finest of `coming`: where it lies on the card, or as marching cubes leaves it;
    /// whether there was anything new.
    pub fn draw_coming(
        &mut self,
        coming: impl Iterator<Item = Key> + Clone,
        recipe: &Recipe,
        evaluations: &Evaluations,
        (writes, drawn, meshes): (&mut CardWrites, &mut Drawn, &mut Assets<Mesh>),
        entity: &mut EntityCommands,
    ) -> bool {
        let on_card = coming
            .clone()
            .find_map(|k| Some((k, evaluations.surface(&k)?)));
        if on_card.is_some_and(|s| self.draw_early(s, recipe, writes, entity)) {
            return true;
        }
        let there = self.card.as_ref().and_then(|c| c.shows);
        let plain = coming
            .take_while(|k| there != Some(*k) && self.early != Some(*k))
            .find_map(|k| Some((k, drawn.early(k, evaluations, meshes)?)));
        let Some((key, handle)) = plain else {
            return false;
        };
        self.wear(handle, entity);
        self.early = Some(key);
        true
    }

    /// Draws an ordinary mesh.
    fn wear(&mut self, mesh: Handle<Mesh>, entity: &mut EntityCommands) {
        match self.card.as_mut().and_then(|c| c.shows.take()) {
            Some(_) => Seen::from(mesh).worn_by(entity),
            None => {
                entity.try_insert(Mesh3d(mesh));
            }
        }
    }

    /// What the card has made is drawn before it can be touched, if there is room for it and it is not drawn yet.
    fn draw_early(
        &mut self,
        (key, surface): (Key, Emitted),
        recipe: &Recipe,
        writes: &mut CardWrites,
        entity: &mut EntityCommands,
    ) -> bool {
        let fresh = |card: &&mut OnCard| card.shows != Some(key);
        let Some(card) = self.card.as_mut().filter(fresh) else {
            return false;
        };
        if !card.mesh.write(&surface, writes) {
            return false;
        }
        card.shows = Some(key);
        let around = recipe.bounds().grown(key.step());
        card.mesh.seen(around).worn_by(entity);
        true
    }

    /// Draws a solid that has come: where it lies on the card, or from main memory.
    pub fn draw(
        &mut self,
        (key, made): (Key, &Made),
        recipe: &Recipe,
        surface: Option<Emitted>,
        (writes, drawn, meshes): (&mut CardWrites, &mut Drawn, &mut Assets<Mesh>),
        entity: &mut EntityCommands,
    ) {
        // A finer one that can be seen already stays; it can be touched soon.
        let finer = |early: Key| early.recipe == key.recipe && early.step() < key.step();
        if self.early.is_some_and(finer) {
            return;
        }
        self.early = None;
        let lies_there = surface.is_some();
        if surface.is_some_and(|s| self.draw_early((key, s), recipe, writes, entity)) {
            return;
        }
        let around = recipe.bounds().grown(key.step());
        if let Some(card) = self.card.as_ref().filter(|c| c.shows == Some(key)) {
            card.mesh.seen(around).worn_by(entity);
            return;
        }
        // The first is shared with all that look like it; what then changes has a mesh of its own.
        let changed = *self.first.get_or_insert(key.recipe) != key.recipe;
        if lies_there && changed {
            let mesh = CardMesh::new(&made.mesh, meshes);
            mesh.seen(around).worn_by(entity);
            self.card = Some(OnCard {
                mesh,
                shows: Some(key),
            });
            return;
        }
        self.wear(drawn.handle(key, made, meshes), entity);
    }
}

/// Bevy meshes by what they were made from, so that copies share one.
#[derive(Resource, Default)]
pub struct Drawn {
    made: HashMap<Key, Handle<Mesh>>,
    /// What is on its way, without its edges.
    early: HashMap<Key, Handle<Mesh>>,
}

impl Drawn {
    /// What draws a solid; the first time it is taken over from where it was made.
    pub fn handle(&mut self, key: Key, made: &Made, meshes: &mut Assets<Mesh>) -> Handle<Mesh> {
        let known = self.made.get(&key).filter(|h| meshes.contains(h.id()));
        known.cloned().unwrap_or_else(|| {
            let mesh = made.drawn.lock().ok().and_then(|mut m| m.take());
            let handle = meshes.add(mesh.unwrap_or_else(|| made.drawing()));
            self.made.insert(key, handle.clone());
            handle
        })
    }

    /// What draws a solid that is made already and drawn by something.
    pub(super) fn get(&self, key: &Key) -> Option<&Handle<Mesh>> {
        self.made.get(key)
    }

    /// What draws a solid before it has its edges, once that can be seen.
    fn early(
        &mut self,
        key: Key,
        evaluations: &Evaluations,
        meshes: &mut Assets<Mesh>,
    ) -> Option<Handle<Mesh>> {
        if let Some(plain) = evaluations.take_plain(&key) {
            self.early.insert(key, meshes.add(plain));
        }
        self.early.get(&key).cloned()
    }

    /// Lets go of what nothing draws any more.
    pub(super) fn tidy(&mut self, evaluations: &Evaluations) {
        // Handles that only this table holds belong to nothing on screen.
        self.made.retain(|_, handle| match handle {
            Handle::Strong(strong) => Arc::strong_count(strong) > 1,
            Handle::Uuid(..) => true,
        });
        self.early.retain(|key, _| evaluations.is_coming(key));
    }
}
