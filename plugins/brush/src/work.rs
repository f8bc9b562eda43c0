//! What a gesture will make of the painting: shown while it lasts, committed when it ends.

use std::sync::Arc;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use midair_document::{Document, Edit, Object, ObjectId};
use midair_field::{Canvas, Node, Placement, Recipe, Stroke};
use midair_studio::{
    hands::{Hands, Pose, Side},
    notice::Notices,
    project::{Project, Selection, Shelf},
    settings::{BrushSettings, BrushSkeleton, Settings},
};

use crate::{
    easel::Easel,
    follow,
    phase::{Draft, Phase},
    stroke::{self, Frame, StrokeFault},
};

/// A change of one painting.
#[derive(Clone, Debug)]
pub struct Work {
    /// The painting; a new one where `None`.
    pub painting: Option<ObjectId>,
    /// Where it stands.
    pub placement: Placement,
    /// Its strokes before.
    pub canvas: Canvas,
    /// The place from which strokes go.
    pub at: usize,
    /// How many go.
    pub gone: usize,
    /// What comes.
    pub strokes: Vec<Stroke>,
    /// What each of those that come follows from now on; shorter where the last ones follow nothing.
    pub sources: Vec<Option<ObjectId>>,
}

impl Work {
    /// What the painting comes to.
    pub fn recipe(&self) -> Recipe {
        let mut canvas = self.canvas.clone();
        let end = (self.at + self.gone).min(canvas.strokes.len());
        canvas
            .strokes
            .splice(self.at.min(end)..end, self.strokes.iter().cloned());
        Recipe::new(Node::Canvas(canvas))
    }
}

/// What strokes are made from and go to.
#[derive(SystemParam)]
pub struct Studio<'w> {
    /// The document.
    pub project: ResMut<'w, Project>,
    /// What is painted on.
    pub easel: ResMut<'w, Easel>,
    /// The library, for volume brushes.
    pub shelf: Res<'w, Shelf>,
    /// What is set on the panel.
    pub settings: ResMut<'w, Settings>,
    /// What is selected.
    pub selection: ResMut<'w, Selection>,
    /// What there is to say.
    pub notices: ResMut<'w, Notices>,
}

impl Studio<'_> {
    /// Makes a change one step that can be undone. Returns whether it was made.
    pub fn commit(&mut self, work: Work, name: &str) -> bool {
        self.commit_with(work, Vec::new(), name)
    }

    /// The same with other edits in the same step.
    pub fn commit_with(&mut self, work: Work, more: Vec<Edit>, name: &str) -> bool {
        commit(
            work,
            more,
            name,
            &self.settings.brush.material,
            &mut self.project,
            &mut self.easel,
            &mut self.selection,
            &mut self.notices,
        )
    }

    /// The painting with nothing changed yet.
    pub fn untouched(&self) -> Option<Work> {
        self.easel.painting(self.project.document())?;
        Some(self.base(Vec3::ZERO))
    }

    /// The painting with one stroke put in the place of another, or taken out.
    pub fn changed(&self, stroke: usize, next: Option<Stroke>) -> Option<Work> {
        let mut work = self.untouched()?;
        if stroke >= work.canvas.strokes.len() {
            return None;
        }
        (work.at, work.gone) = (stroke, 1);
        work.strokes = next.into_iter().collect();
        Some(work)
    }

    /// What is set, as it can be painted with.
    pub fn brush(&self) -> BrushSettings {
        self.settings.brush.sound()
    }

    /// The volume brush: what it is called and what it is.
    ///
    /// # Errors
    /// The library does not have it, or it turned out to enclose nothing.
    pub fn volume(&self) -> Result<(String, Recipe), StrokeFault> {
        let (name, recipe) = volume(&self.easel, &self.shelf, &self.settings.brush)?;
        if self.easel.hollow == Some(recipe.hash()) {
            return Err(StrokeFault::NoVolume(name));
        }
        Ok((name, recipe))
    }

    /// The painting, or the one that is to be.
    pub(crate) fn base(&self, first: Vec3) -> Work {
        base(self.project.document(), &self.easel, &self.brush(), first)
    }

    /// The change that what a hand has begun comes to, if it were ended now; `None` where there is
    /// nothing to show yet.
    ///
    /// # Errors
    /// Why it cannot be.
    pub fn work(
        &self,
        draft: &Draft,
        side: Side,
        pose: &Pose,
        metres_per_world: f32,
    ) -> Result<Option<Work>, StrokeFault> {
        let brush = self.brush();
        let radius = brush.radius / metres_per_world;
        let mut work;
        let made = match draft.phase(side) {
            Phase::Idle | Phase::Alt => return Ok(None),
            Phase::Leading { way, now } => {
                work = self.base(way.first().unwrap_or(now).truncate());
                let mut all = way.clone();
                if all.last() != Some(now) {
                    all.push(*now);
                }
                stroke::led(&all, &Frame::of(&work.placement))
            }
            Phase::Line { from } => {
                work = self.base(*from);
                let frame = Frame::of(&work.placement);
                stroke::line(*from, pose.position, radius, work.canvas.reach, &frame)?
            }
            Phase::Polygon { corners } => {
                work = self.base(corners.first().copied().unwrap_or(pose.position));
                let frame = Frame::of(&work.placement);
                stroke::polygon(corners, radius, work.canvas.reach, &frame)?
            }
            Phase::Stamping => {
                work = self.base(pose.position);
                let (name, recipe) = self.volume()?;
                let held = stroke::held(&recipe, pose, brush.size / metres_per_world);
                stroke::volume((name.as_str(), &recipe), &held, &Frame::of(&work.placement))?
            }
            Phase::Moving {
                stroke,
                before,
                from,
            } => {
                work = self.base(pose.position);
                let moved = moved(before, from, pose, &work.placement);
                (work.at, work.gone, work.strokes) = (*stroke, 1, vec![moved]);
                return Ok(Some(work));
            }
        };
        if draft.erase && work.painting.is_none() {
            return Err(StrokeFault::NothingToErase);
        }
        // What live symmetry makes of it is painted with it.
        let images = self.project.images();
        let joined = images
            .iter()
            .any(|image| stroke::meets_image(&made, &work.placement, image));
        let made = Stroke {
            weight: made.weight * brush.strength,
            erase: draft.erase,
            twin: if joined { work.canvas.next_twin() } else { 0 },
            ..made
        };
        let images = images
            .iter()
            .map(|image| stroke::mirrored(&made, &work.placement, image));
        work.strokes = images.collect();
        work.strokes.insert(0, made);
        if matches!(draft.phase(side), Phase::Stamping) && self.settings.brush.volume.is_empty() {
            work.sources = vec![self.easel.source; work.strokes.len()];
        }
        Ok(Some(work))
    }
}

/// The volume brush that is set.
pub(crate) fn volume(
    easel: &Easel,
    shelf: &Shelf,
    brush: &BrushSettings,
) -> Result<(String, Recipe), StrokeFault> {
    if brush.volume.is_empty()
        && let Some(carried) = &easel.carried
    {
        return Ok(carried.clone());
    }
    let found = shelf.library.get(&brush.volume).filter(|c| !c.missing);
    let found = found.ok_or_else(|| StrokeFault::NoBrush(brush.volume.clone()))?;
    Ok((found.name.clone(), found.recipe.clone()))
}

/// The painting on the easel, nothing changed yet; a new one stands where its first stroke begins.
pub(crate) fn base(document: &Document, easel: &Easel, brush: &BrushSettings, first: Vec3) -> Work {
    let (painting, placement, canvas) = match easel.painting(document) {
        Some((id, object, canvas)) => (Some(id), object.placement, canvas.clone()),
        None => {
            let canvas = Canvas {
                strokes: Vec::new(),
                blend: brush.blend,
                reach: brush.reach,
            };
            (None, Placement::at(first), canvas)
        }
    };
    Work {
        painting,
        placement,
        at: canvas.strokes.len(),
        canvas,
        gone: 0,
        strokes: Vec::new(),
        sources: Vec::new(),
    }
}

/// A stroke that goes along with a hand.
fn moved(before: &Stroke, from: &Pose, now: &Pose, painting: &Placement) -> Stroke {
    let local = painting.affine().inverse();
    let turn = now.rotation * from.rotation.inverse();
    let turn = painting.rotation.inverse() * turn * painting.rotation;
    let about = local.transform_point3(from.position);
    let to = local.transform_point3(now.position);
    let mut next = before.clone();
    next.placement.translation = to + turn * (before.placement.translation - about);
    next.placement.rotation = (turn * before.placement.rotation).normalize();
    next
}

/// Makes a change one step that can be undone. Returns whether it was made.
fn commit(
    work: Work,
    more: Vec<Edit>,
    name: &str,
    material: &str,
    project: &mut Project,
    easel: &mut Easel,
    selection: &mut Selection,
    notices: &mut Notices,
) -> bool {
    for stroke in &work.strokes {
        let alone = Canvas {
            strokes: vec![stroke.clone()],
            ..Canvas::default()
        };
        if let Err(fault) = alone.validate() {
            notices.warn(format!("The stroke was not painted: {fault}."));
            return false;
        }
    }
    tell_if_too_fine(&work, project.document(), notices);
    let links = follow::links(work.at, &work.sources);
    match work.painting {
        Some(id) => {
            let edit = Edit::SetStrokes {
                id,
                at: work.at,
                gone: work.gone,
                strokes: work.strokes,
            };
            let linked = (!links.is_empty()).then(|| {
                let own = project.document().object(id);
                let own = own.map_or(Vec::new(), |o| o.links.clone());
                let links = own.into_iter().chain(links).collect();
                Edit::SetLinks { id, links }
            });
            let edits = [edit].into_iter().chain(linked).chain(more);
            project.commit(name, edits, notices)
        }
        None => {
            let document = project.document();
            let id = ObjectId(document.next_id());
            let count = document
                .objects()
                .filter(|(_, o)| o.name.starts_with("Painting"))
                .count();
            let title = format!("Painting {}", count + 1);
            let mut object = Object::solid(title, work.recipe()).placed(work.placement);
            object.material = (!material.is_empty()).then(|| material.to_owned());
            object.links = links;
            let add = Edit::Add {
                id,
                object: Arc::new(object),
            };
            let done = project.commit(name, [add].into_iter().chain(more), notices);
            if done {
                easel.take(Some(id));
                *selection = Selection(vec![id]);
            }
            done
        }
    }
}

/// A stroke finer than the step would not be seen.
fn tell_if_too_fine(work: &Work, document: &Document, notices: &mut Notices) {
    let scale = work.placement.scale.abs().max_element();
    let finest = work
        .strokes
        .iter()
        .map(|s| stroke::finest(s) * scale)
        .fold(f32::INFINITY, f32::min);
    // A ball is sure to hold a node where its radius is most of half a cell's diagonal.
    if finest >= 0.75 * document.step() {
        return;
    }
    let way = match finest / 0.75 {
        step if step < Document::STEPS.0 => format!(
            "no step shows it, the finest being {:.1} mm. Make the brush larger, or scale the painting up",
            Document::STEPS.0 * 1e3
        ),
        // Rounded so that it does show it.
        step => format!(
            "set the step to {:.1} mm to see it",
            (step * 1e4).floor() * 0.1
        ),
    };
    notices.info(format!(
        "A brush of {:.1} mm is finer than the step of {:.1} mm: {way}.",
        finest * 1e3,
        document.step() * 1e3,
    ));
}

/// The pose of the hand that has begun something, and what it comes to.
pub(crate) fn begun(studio: &Studio, draft: &Draft, hands: &Hands) -> Option<Work> {
    let side = draft.busy()?;
    let pose = hands.get(side).pose;
    studio
        .work(draft, side, &pose, hands.metres_per_world)
        .ok()
        .flatten()
}

/// What the next stroke is called in the undo list.
pub(crate) fn step_name(skeleton: BrushSkeleton, erase: bool) -> &'static str {
    match (skeleton, erase) {
        (_, true) => "Erase",
        (BrushSkeleton::Point, _) => "Paint point",
        (BrushSkeleton::Line, _) => "Paint line",
        (BrushSkeleton::Polygon, _) => "Paint polygon",
        (BrushSkeleton::Volume, _) => "Paint volume",
    }
}
