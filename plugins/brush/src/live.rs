//! The painting while a stroke is painted: made again off the frame where the stroke changes it, coarse
//! when it has to be, and shown in the place of what the document has.

use std::time::Duration;

use bevy::prelude::*;
use midair_document::ObjectId;
use midair_field::{Canvas, Node, Recipe, RecipeHash};
use midair_studio::{
    evaluate::{Delivery, Evaluations, Key, Live},
    hands::Hands,
    project::Project,
    show::{CardWrites, ObjectMap, Seen, SeenParts, StandIn, display_steps, transform},
};

use crate::{
    phase::Draft,
    start,
    work::{self, Studio, Work},
};

/// What is seen of a stroke that is not finished.
#[derive(Resource, Default)]
pub struct Sketchpad {
    live: Live,
    /// What was there when the stroke was begun.
    begun: Option<(Option<ObjectId>, Option<RecipeHash>)>,
    mesh: Option<Seen>,
    /// What the painting showed before.
    before: Option<Seen>,
    /// What shows a painting that the document does not have yet.
    picture: StandIn,
    shown: Option<Key>,
}

impl Sketchpad {
    /// Of which recipe it shows a picture, at which step.
    pub fn shown(&self) -> Option<Key> {
        self.shown
    }

    /// How long the latest pictures took to make.
    pub fn took(&self) -> impl Iterator<Item = Duration> + '_ {
        self.picture.took.iter()
    }

    /// Gives up what is shown.
    pub(crate) fn clear(&mut self, commands: &mut Commands) {
        self.live.clear();
        self.begun = None;
        self.mesh = None;
        self.before = None;
        self.shown = None;
        self.picture.clear(commands);
    }
}

/// What is to be seen: a stroke that was begun, or other blending while its slider is dragged.
fn wanted(studio: &Studio, draft: &Draft, hands: &Hands) -> Option<Work> {
    if let Some(work) = work::begun(studio, draft, hands) {
        return Some(work);
    }
    let (blend, reach) = studio.easel.mix?;
    let mut work = studio.untouched()?;
    work.canvas = Canvas {
        blend,
        reach,
        strokes: start::refitted(&work.canvas, reach),
    };
    Some(work)
}

/// Nothing that a session makes depends on it, so a session that is played without a pace of its
/// own, where nobody looks, goes without.
pub(crate) fn follow(
    studio: Studio,
    draft: Res<Draft>,
    hands: Res<Hands>,
    delivery: Res<Delivery>,
    evaluations: Res<Evaluations>,
    map: Res<ObjectMap>,
    mut pad: ResMut<Sketchpad>,
    (mut meshes, mut writes): (ResMut<Assets<Mesh>>, ResMut<CardWrites>),
    mut materials: ResMut<Assets<StandardMaterial>>,
    drawn: Query<SeenParts>,
    mut commands: Commands,
) {
    let work = (*delivery == Delivery::AsTheyCome)
        .then(|| wanted(&studio, &draft, &hands))
        .flatten();
    let Some(work) = work else {
        rest(&studio.project, &map, &drawn, &mut pad, &mut commands);
        return;
    };
    let recipe = work.recipe();
    let finest = finest(&studio.project, &work, &recipe);
    if pad.begun.is_none() {
        let there = work
            .painting
            .map(|_| Recipe::new(Node::Canvas(work.canvas.clone())));
        let hash = there.as_ref().map(Recipe::hash);
        // From what is shown already: the first picture is as quick as the next.
        let base = there.and_then(|r| {
            [finest, 2.0 * finest]
                .into_iter()
                .find_map(|step| evaluations.made(&Key::new(&r, step))?.solid.clone())
        });
        pad.picture.clear(&mut commands);
        pad.live.clear();
        if let Some(base) = base {
            pad.live.begin(base, finest);
        }
        pad.begun = Some((work.painting, hash));
        pad.mesh = None;
        pad.before = None;
    }
    if let Some(sketch) = pad.live.ask(&recipe, finest, &evaluations) {
        pad.picture.took.push(sketch.took);
        pad.shown = Some(sketch.key);
        if let Some(seen) = pad.live.draw(sketch, &mut meshes, &mut writes) {
            pad.mesh = Some(seen);
        }
    }
    let Some(mesh) = pad.mesh.clone() else {
        return;
    };
    match work.painting.and_then(|id| map.get(id)) {
        Some(entity) => {
            let now = drawn.get(entity).ok().map(Seen::of);
            if now.as_ref() != Some(&mesh) {
                // Sketches come one after the other; anything else is the document's own.
                if pad.before.is_none() {
                    pad.before = now;
                }
                mesh.worn_by(&mut commands.entity(entity));
            }
        }
        None => {
            let at = transform(&work.placement);
            let name = "Painting that is begun";
            pad.picture
                .show(name, &mesh, at, &mut materials, &mut commands);
        }
    }
}

fn finest(project: &Project, work: &Work, recipe: &Recipe) -> f32 {
    let document = project.document();
    let object = work.painting.and_then(|id| document.object(id)).cloned();
    let object = object.unwrap_or_else(|| {
        midair_document::Object::solid("", recipe.clone()).placed(work.placement)
    });
    let steps = display_steps(document, &object, recipe);
    steps.first().copied().unwrap_or(document.step())
}

/// Nothing is being painted: what was committed is shown by the document soon, what was given up
/// at once.
fn rest(
    project: &Project,
    map: &ObjectMap,
    drawn: &Query<SeenParts>,
    pad: &mut ResMut<Sketchpad>,
    commands: &mut Commands,
) {
    if pad.begun.is_none() && !pad.picture.is_shown() {
        return;
    }
    let document = project.document();
    let now = |id: ObjectId| Some(document.object(id)?.recipe()?.hash());
    if let Some((painting, hash)) = pad.bypass_change_detection().begun.take() {
        pad.live.clear();
        if let (Some(id), Some(mesh)) = (painting, pad.mesh.take()) {
            let entity = map.get(id);
            let shows = entity.and_then(|e| drawn.get(e).ok());
            if now(id) == hash
                && shows.is_some_and(|(m, ..)| m.0 == mesh.mesh)
                && let (Some(entity), Some(before)) = (entity, pad.before.take())
            {
                before.worn_by(&mut commands.entity(entity));
            }
        }
    }
    if pad.picture.is_shown() {
        // The new painting is shown by the document, or there is none.
        let last = document.objects().next_back().map(|(id, _)| id);
        let shown = last
            .and_then(|id| map.get(id))
            .is_none_or(|e| drawn.contains(e));
        if shown {
            pad.picture.clear(commands);
        }
    }
}
