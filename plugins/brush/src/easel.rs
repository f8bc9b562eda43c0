//! The painting on the easel: where the next stroke goes.

use bevy::prelude::*;
use midair_document::{Document, Object, ObjectId};
use midair_field::{Canvas, Node, Recipe, RecipeHash};
use midair_studio::project::{Project, Selection};

/// What is worked on.
#[derive(Resource, Debug, Default)]
pub struct Easel {
    painting: Option<ObjectId>,
    /// What was selected when it was last looked at.
    seen: Vec<ObjectId>,
    /// The stroke that is being changed, by its place in the painting.
    pub selected: Option<usize>,
    /// The next press selects a stroke.
    pub picking: bool,
    /// A solid that turned out to enclose nothing: no brush.
    pub(crate) hollow: Option<RecipeHash>,
    /// A mesh that turned out to enclose something.
    pub(crate) full: Option<RecipeHash>,
    /// A solid that was carried in as a brush, and what it is called.
    pub carried: Option<(String, Recipe)>,
    /// Which object that is: what is painted with it follows it.
    pub source: Option<ObjectId>,
    /// How strokes blend while a slider is dragged: exponent and reach.
    pub mix: Option<(f32, f32)>,
}

/// The strokes of an object that is a painting.
pub fn canvas(object: &Object) -> Option<&Canvas> {
    match object.recipe()?.node() {
        Node::Canvas(canvas) => Some(canvas),
        _ => None,
    }
}

impl Easel {
    /// Whether nobody knows yet that a brush encloses something: a mesh may be open, and its ghost is not made.
    pub(crate) fn is_unknown(&self, brush: &Recipe) -> bool {
        self.full != Some(brush.hash()) && !brush.meshes().is_empty()
    }

    /// The painting as the document has it.
    pub fn painting<'a>(
        &self,
        document: &'a Document,
    ) -> Option<(ObjectId, &'a Object, &'a Canvas)> {
        let id = self.painting?;
        let object = document.object(id)?;
        Some((id, object, canvas(object)?))
    }

    /// Takes a painting up, or none: the next stroke begins one.
    pub fn take(&mut self, painting: Option<ObjectId>) {
        if self.painting != painting {
            self.painting = painting;
            self.selected = None;
            self.mix = None;
        }
    }

    /// Goes on with what somebody selected elsewhere.
    fn look(&mut self, document: &Document, selection: &[ObjectId]) {
        if self.seen != selection {
            self.seen = selection.to_vec();
            if let [id] = *selection
                && document.object(id).and_then(canvas).is_some()
            {
                self.take(Some(id));
            }
        }
        // The brush in hand is what its source is now.
        let source = self.source.and_then(|id| document.object(id));
        if let (Some(object), Some((name, recipe))) = (source, &mut self.carried)
            && let Some(now) = object.operand().filter(|now| now != recipe)
        {
            (*name, *recipe) = (object.name.clone(), now);
        }
        let count = self
            .painting(document)
            .map_or(0, |(_, _, c)| c.strokes.len());
        if self.selected.is_some_and(|s| s >= count) {
            self.selected = None;
        }
    }
}

pub(crate) fn follow(project: Res<Project>, selection: Res<Selection>, mut easel: ResMut<Easel>) {
    if project.is_changed() || selection.is_changed() || easel.is_changed() {
        easel
            .bypass_change_detection()
            .look(project.document(), &selection.0);
    }
}
