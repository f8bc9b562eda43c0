//! From the edits of one side to those of all sides.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use midair_document::{Document, Edit, Group, GroupId, Kind, Object, ObjectId};
use midair_field::{Op, Placement};

use super::Image;

/// How far a thing may stand from where the symmetry would have it and still count as the image.
const NEAR: f32 = 1e-3;
/// The same for its rotation, in radians: what single precision tells apart near none.
const TURNED: f32 = 4e-3;
/// A thing whose middle is nearer to its image's than this part of its size lies on the plane or the
/// axis: it is its own image.
const OWN: f32 = 0.02;

/// Edits of objects together with the same for their images, which are added where there are none yet.
/// What the edits themselves name keeps what they say; locked images stay. Edits of groups and layers,
/// and reference images, are nobody's image.
pub fn spread(document: &Document, edits: Vec<Edit>, images: &[Image]) -> Vec<Edit> {
    if images.is_empty() {
        return edits;
    }
    let mut sides = Sides::new(document, &edits, images);
    for edit in &edits {
        sides.take(edit);
    }
    let Sides { more, pending, .. } = sides;
    let mut all: Vec<Edit> = edits
        .into_iter()
        .map(|edit| match (edit, &pending) {
            (Edit::SetPending { .. }, Some(pending)) => Edit::SetPending {
                pending: pending.clone(),
            },
            (edit, _) => edit,
        })
        .collect();
    all.extend(more);
    all
}

/// Whether the studio makes images of such a thing at all.
pub(super) fn has_images(object: &Object) -> bool {
    !matches!(object.kind, Kind::Reference(_))
}

/// The images of a thing standing there, without those that coincide with it or with each other:
/// what lies on a plane or the axis has fewer.
pub(super) fn apart<'a>(
    object: &Object,
    placement: &Placement,
    images: &'a [Image],
) -> Vec<&'a Image> {
    let bounds = object.bounds();
    let (middle, size) = if bounds.is_empty() {
        (placement.translation, 0.0)
    } else {
        let affine = placement.affine();
        let diagonal = (bounds.size() * placement.scale).length();
        (affine.transform_point3(bounds.centre()), diagonal)
    };
    let reach = (OWN * size).max(NEAR);
    let mut taken = vec![middle];
    let mut kept = Vec::new();
    for image in images {
        let there = image.point(middle);
        if taken.iter().all(|t| t.distance(there) > reach) {
            taken.push(there);
            kept.push(image);
        }
    }
    kept
}

/// Where the objects of a document stand, to be asked for one that stands there.
pub(super) struct Standing<'a> {
    document: &'a Document,
    /// By their place along X.
    along: Vec<(f32, ObjectId)>,
}

impl<'a> Standing<'a> {
    pub fn new(document: &'a Document) -> Self {
        let mut along: Vec<_> = document
            .objects()
            .filter(|(_, o)| has_images(o))
            .map(|(id, o)| (o.placement.translation.x, id))
            .collect();
        along.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { document, along }
    }

    /// The object that is what `of` is and stands at `placement`.
    pub fn find(&self, of: &Object, not: ObjectId, placement: &Placement) -> Option<ObjectId> {
        let x = placement.translation.x;
        let from = self.along.partition_point(|(at, _)| *at < x - NEAR);
        self.along[from..]
            .iter()
            .take_while(|(at, _)| *at <= x + NEAR)
            .map(|&(_, id)| id)
            .filter(|&id| id != not)
            .find(|&id| {
                let found = self.document.object(id);
                found.is_some_and(|o| stands(&o.placement, placement) && o.kind == of.kind)
            })
    }

    /// Those of its images that are there, each once.
    pub fn partners(&self, id: ObjectId, images: &[Image]) -> Vec<(ObjectId, usize)> {
        let mut found: Vec<(ObjectId, usize)> = Vec::new();
        if let Some(object) = self.document.object(id).filter(|o| has_images(o)) {
            for (at, image) in images.iter().enumerate() {
                let there = image.placement(&object.placement);
                if let Some(partner) = self.find(object, id, &there)
                    && found.iter().all(|(known, _)| *known != partner)
                {
                    found.push((partner, at));
                }
            }
        }
        found
    }
}

fn stands(at: &Placement, there: &Placement) -> bool {
    let scale = there.scale.abs().max_element();
    at.translation.distance(there.translation) < NEAR
        && at.scale.distance(there.scale) < NEAR * scale
        && at.rotation.angle_between(there.rotation) < TURNED
}

struct Sides<'a> {
    document: &'a Document,
    images: &'a [Image],
    standing: Standing<'a>,
    /// What the edits name themselves.
    named: HashSet<ObjectId>,
    partners: HashMap<ObjectId, Vec<(ObjectId, usize)>>,
    /// What is added, by the edits or beside them.
    added: Vec<Arc<Object>>,
    groups: HashMap<(GroupId, usize), GroupId>,
    next: u64,
    more: Vec<Edit>,
    pending: Option<Vec<(ObjectId, Op)>>,
}

impl<'a> Sides<'a> {
    fn new(document: &'a Document, edits: &[Edit], images: &'a [Image]) -> Self {
        let mut next = document.next_id();
        let mut added = Vec::new();
        for edit in edits {
            next = next.max(match edit {
                Edit::Add { id, object } => {
                    added.push(object.clone());
                    id.0 + 1
                }
                Edit::AddGroup { id, .. } => id.0 + 1,
                Edit::AddLayer { id, .. } => id.0 + 1,
                _ => 0,
            });
        }
        Self {
            document,
            images,
            standing: Standing::new(document),
            named: edits.iter().filter_map(named).collect(),
            partners: HashMap::new(),
            added,
            groups: HashMap::new(),
            next,
            more: Vec::new(),
            pending: None,
        }
    }

    fn take(&mut self, edit: &Edit) {
        match edit {
            Edit::Add { object, .. } => {
                for (at, image) in self.images.iter().enumerate() {
                    let there = image.placement(&object.placement);
                    self.add(object, &object.placement, at, there);
                }
            }
            Edit::SetPlacement { id, placement } => self.place(*id, placement),
            Edit::Remove { id } => self.each(*id, |id| Edit::Remove { id }),
            Edit::SetKind { id, kind } => self.each(*id, |id| Edit::SetKind {
                id,
                kind: kind.clone(),
            }),
            Edit::SetVisible { id, visible } => self.each(*id, |id| Edit::SetVisible {
                id,
                visible: *visible,
            }),
            Edit::SetLocked { id, locked } => self.each(*id, |id| Edit::SetLocked {
                id,
                locked: *locked,
            }),
            Edit::SetFresh { id, fresh } => {
                self.each(*id, |id| Edit::SetFresh { id, fresh: *fresh });
            }
            Edit::SetColour { id, colour } => self.each(*id, |id| Edit::SetColour {
                id,
                colour: *colour,
            }),
            Edit::SetMaterial {
                id,
                material,
                dials,
            } => self.each(*id, |id| Edit::SetMaterial {
                id,
                material: material.clone(),
                dials: dials.clone(),
            }),
            Edit::SetLayer { id, layer } => {
                self.each(*id, |id| Edit::SetLayer { id, layer: *layer });
            }
            Edit::SetMark { id, op } => self.each(*id, |id| Edit::SetMark { id, op: *op }),
            Edit::SetPending { pending } => self.mark(pending),
            _ => {}
        }
    }

    fn partners(&mut self, id: ObjectId) -> Vec<(ObjectId, usize)> {
        let found = self
            .partners
            .entry(id)
            .or_insert_with(|| self.standing.partners(id, self.images));
        found.clone()
    }

    fn each(&mut self, id: ObjectId, edit: impl Fn(ObjectId) -> Edit) {
        for (partner, _) in self.partners(id) {
            if !self.named.contains(&partner) {
                self.more.push(edit(partner));
            }
        }
    }

    fn place(&mut self, id: ObjectId, placement: &Placement) {
        let Some(object) = self.document.object(id).filter(|o| has_images(o)) else {
            return;
        };
        let partners = self.partners(id);
        for at in 0..self.images.len() {
            let there = self.images[at].placement(placement);
            match partners.iter().find(|(_, of)| *of == at) {
                Some((partner, _)) => {
                    let stays = self.named.contains(partner) || self.document.is_locked(*partner);
                    if !stays {
                        self.more.push(Edit::SetPlacement {
                            id: *partner,
                            placement: there,
                        });
                    }
                }
                None => self.add(&Arc::new(object.clone()), placement, at, there),
            }
        }
    }

    /// One more image, unless something is there already.
    fn add(&mut self, object: &Arc<Object>, from: &Placement, at: usize, there: Placement) {
        let image = &self.images[at];
        let own = !has_images(object)
            || !apart(object, from, self.images)
                .iter()
                .any(|i| std::ptr::eq(*i, image));
        let nobody = ObjectId(u64::MAX);
        let known = own
            || self.standing.find(object, nobody, &there).is_some()
            || self
                .added
                .iter()
                .any(|o| stands(&o.placement, &there) && o.kind == object.kind);
        if known {
            return;
        }
        let group = object.group.map(|group| self.group(group, at));
        let copy = Arc::new(Object {
            placement: there,
            group,
            locked: false,
            fresh: false,
            // What its original follows is on the other side.
            links: Vec::new(),
            ..(**object).clone()
        });
        self.added.push(copy.clone());
        self.more.push(Edit::Add {
            id: ObjectId(self.next),
            object: copy,
        });
        self.next += 1;
    }

    /// What was grouped is grouped on the other side too.
    fn group(&mut self, of: GroupId, at: usize) -> GroupId {
        if let Some(&known) = self.groups.get(&(of, at)) {
            return known;
        }
        let id = GroupId(self.next);
        self.next += 1;
        let name = self
            .document
            .group(of)
            .map_or_else(|| "Group".to_owned(), |g| g.name.clone());
        self.groups.insert((of, at), id);
        self.more.push(Edit::AddGroup {
            id,
            group: Group { name, parent: None },
        });
        id
    }

    /// What is marked otherwise than before is so on the other sides too, right behind it.
    fn mark(&mut self, wanted: &[(ObjectId, Op)]) {
        let before: HashMap<_, _> = self.document.pending().iter().copied().collect();
        let after: HashMap<_, _> = wanted.iter().copied().collect();
        let mut all = wanted.to_vec();
        for &(id, op) in wanted {
            if before.get(&id) == Some(&op) {
                continue;
            }
            for (partner, _) in self.partners(id) {
                // What changed by itself stays as it was asked for.
                if after.get(&partner) != before.get(&partner) {
                    continue;
                }
                match all.iter_mut().find(|(o, _)| *o == partner) {
                    Some(mark) => mark.1 = op,
                    None => {
                        let behind = all.iter().position(|(o, _)| *o == id);
                        all.insert(behind.map_or(all.len(), |i| i + 1), (partner, op));
                    }
                }
            }
        }
        let unmarked: Vec<_> = before
            .keys()
            .filter(|id| !after.contains_key(*id) && self.document.object(**id).is_some())
            .copied()
            .collect();
        // Where nothing is left the marks were put away as a whole.
        if !wanted.is_empty() {
            for id in unmarked {
                for (partner, _) in self.partners(id) {
                    all.retain(|(o, _)| *o != partner);
                }
            }
        }
        self.pending = Some(all);
    }
}

/// The object that an edit is about.
fn named(edit: &Edit) -> Option<ObjectId> {
    Some(match edit {
        Edit::Add { id, .. }
        | Edit::Remove { id }
        | Edit::SetPlacement { id, .. }
        | Edit::SetKind { id, .. }
        | Edit::SetVisible { id, .. }
        | Edit::SetLocked { id, .. }
        | Edit::SetFresh { id, .. }
        | Edit::SetColour { id, .. }
        | Edit::SetMaterial { id, .. }
        | Edit::SetLayer { id, .. }
        | Edit::SetMark { id, .. }
        | Edit::Rename { id, .. }
        | Edit::Replace { id, .. } => *id,
        _ => return None,
    })
}

#[cfg(test)]
mod tests;
