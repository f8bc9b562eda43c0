use midair_document::{Document, ObjectId};

use super::{Ask, How};
use crate::project::Selection;

/// What is picked with one object: the whole of its outermost group.
pub fn picked(document: &Document, object: ObjectId) -> Vec<ObjectId> {
    match document.outermost_group(object) {
        Some(group) => document.members(group),
        None => vec![object],
    }
}

/// What is selected after an ask that only selects; `None` for any other.
pub(super) fn selected(ask: &Ask, document: &Document, now: &Selection) -> Option<Selection> {
    let can = |id: ObjectId| document.is_visible(id) && !document.is_locked(id);
    let ids = match ask {
        Ask::Select { ids, how } => {
            let mut named: Vec<ObjectId> = Vec::new();
            for &id in ids.iter().filter(|&&id| document.object(id).is_some()) {
                for member in picked(document, id) {
                    if !named.contains(&member) {
                        named.push(member);
                    }
                }
            }
            let mut next = now.0.clone();
            let all = named.iter().all(|id| next.contains(id));
            match how {
                How::Set => next = named,
                How::Remove => next.retain(|id| !named.contains(id)),
                // A group is toggled as a whole.
                How::Toggle if all => next.retain(|id| !named.contains(id)),
                How::Add | How::Toggle => {
                    named.retain(|id| !next.contains(id));
                    next.append(&mut named);
                }
            }
            next
        }
        Ask::SelectAll => document
            .objects()
            .map(|(id, _)| id)
            .filter(|&id| can(id))
            .collect(),
        Ask::SelectNone => Vec::new(),
        Ask::SelectOthers => document
            .objects()
            .map(|(id, _)| id)
            .filter(|&id| can(id) && !now.0.contains(&id))
            .collect(),
        _ => return None,
    };
    Some(Selection(ids))
}
