//! What a step of the tutorial waits for, and what goes wrong on the way.

use bevy::math::Vec3;
use midair_document::{Document, Object, ObjectId};
use midair_field::{Node, Op};
use serde::Deserialize;

use crate::objects::extent;
use crate::project::Project;

/// Something that is so or not so in the studio. Parts are named as in the library; `chair/leg`
/// stands for all that begin so. Only what is to be seen counts.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(crate) enum Goal {
    /// The library is open.
    Library,
    /// So many of a part stand in the room.
    Has(String, usize),
    /// So many of the first part overlap one of the second.
    Meet(String, String, usize),
    /// Of two of a part one stands within the other seen from above, and its top is higher.
    Hollow(String),
    /// One of a part is this many metres above the ground, with all of it.
    High(String, f32),
    /// One of a part is nearly as tall as it is wide, or taller: what lies flat was stood up.
    Upright(String),
    /// Of two of a part one is clearly narrower than the other, to both sides.
    Narrower(String),
    /// Things are dragged along the work plane.
    Plane,
    /// So many of a part are marked so; for the first operand any mark will do.
    Marked(String, Op, usize),
    /// A solid was fused of so many of each part, each joined so.
    Made(Vec<(String, Op, usize)>),
    /// The work is in a file.
    Saved,
    /// Every one of them.
    All(Vec<Goal>),
    /// Not that.
    Not(Box<Goal>),
}

/// Metres that parts must reach into each other.
const DEEP: f32 = 0.002;

/// What goals look at.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub project: &'a Project,
    pub library_open: bool,
    /// Whether the work plane is in use.
    pub plane_shown: bool,
}

impl Goal {
    /// Whether it is so.
    pub fn is_met(&self, scene: Scene<'_>) -> bool {
        let project = scene.project;
        let document = project.document();
        match self {
            Self::Library => scene.library_open,
            Self::Plane => scene.plane_shown,
            Self::High(part, metres) => boxes(document, part).any(|(low, _)| low.y >= *metres),
            Self::Upright(part) => boxes(document, part).any(|(low, high)| {
                let size = high - low;
                size.y >= 0.8 * size.x.max(size.z)
            }),
            Self::Narrower(part) => narrower(document, part),
            Self::Has(part, count) => parts(document, part).count() >= *count,
            Self::Meet(part, other, count) => meeting(document, part, other) >= *count,
            Self::Hollow(part) => hollow(document, part),
            Self::Marked(part, op, count) => {
                let marked = document.pending().iter().enumerate();
                marked
                    .filter(|(i, (id, mark))| {
                        let is_part = document.object(*id).is_some_and(|o| is(o, part));
                        is_part && (*i == 0 || mark == op)
                    })
                    .count()
                    >= *count
            }
            Self::Made(of) => document
                .objects()
                .any(|(id, o)| document.is_visible(id) && made_of(o, of)),
            Self::Saved => project.path().is_some() && !project.history().is_unsaved(),
            Self::All(goals) => goals.iter().all(|g| g.is_met(scene)),
            Self::Not(goal) => !goal.is_met(scene),
        }
    }
}

/// What of a part is to be seen.
pub(crate) fn parts<'a>(
    document: &'a Document,
    part: &'a str,
) -> impl Iterator<Item = ObjectId> + 'a {
    document
        .objects()
        .filter(move |&(id, o)| document.is_visible(id) && is(o, part))
        .map(|(id, _)| id)
}

fn is(object: &Object, part: &str) -> bool {
    object.recipe().is_some_and(|r| names(r.node(), part))
}

fn names(node: &Node, part: &str) -> bool {
    matches!(node, Node::Component { id, .. } if id.starts_with(part))
}

fn made_of(object: &Object, of: &[(String, Op, usize)]) -> bool {
    let Some(Node::Solid(operands)) = object.recipe().map(|r| r.node()) else {
        return false;
    };
    of.iter().all(|(part, op, count)| {
        let joined = operands.iter().enumerate();
        joined
            .filter(|(i, o)| (*i == 0 || o.op == *op) && names(o.recipe.node(), part))
            .count()
            >= *count
    })
}

fn meeting(document: &Document, part: &str, other: &str) -> usize {
    let others: Vec<_> = parts(document, other).collect();
    parts(document, part)
        .filter(|&id| {
            let boxed = extent(document, [id]);
            others.iter().filter(|&&o| o != id).any(|&o| {
                let (Some(a), Some(b)) = (boxed, extent(document, [o])) else {
                    return false;
                };
                (a.1.min(b.1) - a.0.max(b.0)).min_element() > DEEP
            })
        })
        .count()
}

/// The boxes of what is to be seen of a part.
fn boxes<'a>(document: &'a Document, part: &'a str) -> impl Iterator<Item = (Vec3, Vec3)> + 'a {
    parts(document, part).filter_map(|id| extent(document, [id]))
}

fn narrower(document: &Document, part: &str) -> bool {
    let sizes: Vec<_> = boxes(document, part)
        .map(|(low, high)| high - low)
        .collect();
    sizes.iter().any(|a| {
        let clearly = |b: &Vec3| a.x < 0.95 * b.x && a.z < 0.95 * b.z;
        sizes.iter().any(clearly)
    })
}

fn hollow(document: &Document, part: &str) -> bool {
    let boxes: Vec<_> = boxes(document, part).collect();
    boxes.iter().any(|(low, high)| {
        boxes.iter().any(|(l, h)| {
            let within = l.x > low.x + DEEP
                && h.x < high.x - DEEP
                && l.z > low.z + DEEP
                && h.z < high.z - DEEP;
            within && h.y > high.y + DEEP && l.y > low.y + DEEP
        })
    })
}
