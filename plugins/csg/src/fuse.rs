//! From marked operands to one solid: the lazy update of EasyVRModeling §5.4 Eq. 9–10.

use bevy::prelude::*;
use midair_document::{Document, Edit, Kind, Object, ObjectId};
use midair_field::{Node, Op, Operand, Placement, Recipe};
use midair_studio::{
    evaluate::{Evaluations, Key},
    notice::Notices,
    project::Project,
    show::Drafts,
    snap::box_of,
};

/// What one press of update will do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pending {
    /// Nothing is marked.
    Nothing,
    /// One operand: it will be copied (EasyVRModeling §4.4).
    Copy(ObjectId),
    /// This many operands: they will be fused.
    Fuse(usize),
}

impl Pending {
    /// What the marks of a document come to.
    pub fn of(document: &Document) -> Self {
        match document.pending() {
            [] => Self::Nothing,
            [(one, _)] => Self::Copy(*one),
            several => Self::Fuse(several.len()),
        }
    }
}

/// The solid that the marked sequence makes, and where it stands: in the frame of the first
/// operand's position, so that moving the others leaves its lattice where it is.
pub fn fused_recipe(document: &Document) -> Option<(Recipe, Vec3)> {
    drafted_recipe(document, &Drafts::default())
}

/// The same while hands move operands, in the frame of where the first one stood.
pub(crate) fn drafted_recipe(document: &Document, drafts: &Drafts) -> Option<(Recipe, Vec3)> {
    let pending = document.pending();
    if pending.len() < 2 {
        return None;
    }
    let origin = document.object(pending.first()?.0)?.placement.translation;
    let operands = pending
        .iter()
        .enumerate()
        .map(|(i, &(id, op))| {
            let object = document.object(id)?;
            let standing = drafts.get(id).unwrap_or(&object.placement);
            let placement = Placement {
                translation: standing.translation - origin,
                ..*standing
            };
            Some(Operand {
                // The first one is what the others join.
                op: if i == 0 { Op::Union } else { op },
                placement,
                recipe: object.recipe()?.clone(),
                muted: false,
            })
        })
        .collect::<Option<Vec<_>>>()?;
    Some((Recipe::new(Node::Solid(operands)), origin))
}

/// The marked operands that are to be taken away and stand clear of all before them: what is marked so would vanish, and
/// nothing else would change. Goes by boxes, so what it names does nothing for certain.
fn idle_cuts(document: &Document) -> Vec<&str> {
    let mut before: Option<(Vec3, Vec3)> = None;
    let mut idle = Vec::new();
    for (i, &(id, op)) in document.pending().iter().enumerate() {
        let Some(object) = document.object(id) else {
            continue;
        };
        let own = object.recipe().map(Recipe::bounds);
        let own = own.filter(|b| !b.is_empty());
        let own = own.map(|b| box_of(&object.placement, (b.min, b.max)));
        let common = before.zip(own).map(|((a, b), (c, d))| (a.max(c), b.min(d)));
        let common = common.filter(|(low, high)| low.cmple(*high).all());
        match op {
            Op::Subtract if i > 0 => {
                if common.is_none() {
                    idle.push(&*object.name);
                }
            }
            Op::Intersect if i > 0 => before = common,
            // The first one is what the others join.
            _ => {
                let both = before.zip(own).map(|((a, b), (c, d))| (a.min(c), b.max(d)));
                before = both.or(before).or(own);
            }
        }
    }
    idle
}

/// Carries the marks out as one step that can be undone. Returns whether anything was done.
pub(crate) fn finish(
    project: &mut Project,
    evaluations: &mut Evaluations,
    notices: &mut Notices,
) -> bool {
    match Pending::of(project.document()) {
        Pending::Nothing => {
            notices.info(
                "Mark what to fuse first: open SceneOperate with the cross, then touch and mark.",
            );
            false
        }
        Pending::Copy(id) => copy(project, notices, id),
        Pending::Fuse(count) => fuse(project, evaluations, notices, count),
    }
}

fn copy(project: &mut Project, notices: &mut Notices, original: ObjectId) -> bool {
    let document = project.document();
    let Some(object) = document.object(original) else {
        return false;
    };
    let aside = aside(object);
    let mut twin = object.clone();
    twin.placement.translation += aside;
    twin.fresh = true;
    let name = format!("Copy {}", twin.name);
    let id = ObjectId(document.next_id());
    project.commit(
        name,
        [
            Edit::Add {
                id,
                object: twin.into(),
            },
            Edit::SetPending {
                pending: Vec::new(),
            },
        ],
        notices,
    )
}

/// A copy stands beside its original, a tenth of its width away.
fn aside(object: &Object) -> Vec3 {
    let bounds = object.recipe().map(|r| r.bounds());
    let width = bounds.filter(|b| !b.is_empty()).map_or(0.1, |b| {
        let half = 0.5 * b.size() * object.placement.scale.abs();
        let turned = Mat3::from_quat(object.placement.rotation);
        // The half width of the turned box along the world's x.
        2.0 * (turned.row(0).abs().dot(half))
    });
    Vec3::X * width * 1.1
}

fn fuse(
    project: &mut Project,
    evaluations: &mut Evaluations,
    notices: &mut Notices,
    count: usize,
) -> bool {
    let document = project.document();
    let Some((recipe, origin)) = fused_recipe(document) else {
        notices.warn("An operand is not a closed solid: unmark it, then update again.");
        return false;
    };
    let id = ObjectId(document.next_id());
    let mut result = Object::new(format!("Solid {}", id.0), Kind::Solid(recipe.clone()))
        .placed(Placement::at(origin));
    result.fresh = true;
    if let Some(first) = document
        .pending()
        .first()
        .and_then(|(o, _)| document.object(*o))
    {
        result.layer = first.layer;
        result.group = first.group;
    }
    let key = Key::new(&recipe, document.step());
    let told = match idle_cuts(document)[..] {
        [] => None,
        [name] => Some(format!(
            "{name} takes nothing away: it stands clear of the others. Undo, move it into them, then update again."
        )),
        [name, ..] => Some(format!(
            "{name} and others take nothing away: they stand clear. Undo, move them where they are to cut, then update again."
        )),
    };
    let mut edits: Vec<_> = document
        .pending()
        .iter()
        .map(|&(id, _)| Edit::Remove { id })
        .collect();
    edits.push(Edit::Add {
        id,
        object: result.into(),
    });
    let done = project.commit(format!("Fuse {count}"), edits, notices);
    if done {
        evaluations.count_update(key);
        if let Some(told) = told {
            notices.info(told);
        }
    }
    done
}

/// While the hands rest, the result is made ahead, so that update shows it at once.
pub(crate) fn anticipate(
    project: Res<Project>,
    drafts: Res<Drafts>,
    mut evaluations: ResMut<Evaluations>,
) {
    if !drafts.is_empty() {
        return;
    }
    if let Some((recipe, _)) = fused_recipe(project.document()) {
        evaluations.want(&recipe, project.document().step());
    }
}
