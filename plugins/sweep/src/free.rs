//! What stands on its own again: sweeps and rows of clones that follow no stroke any more, and clones
//! that are objects of their own.

use std::sync::Arc;

use midair_document::{Document, Edit, Group, GroupId, Kind, Object, ObjectId};
use midair_field::{Node, Place, Placement, Recipe, Row};
use midair_studio::{
    notice::Notices,
    project::{Project, Selection},
};

/// More clones than this are left in their row: each would be a row of every list.
pub(crate) const MOST: usize = 1000;

/// The row of an object that is one, and what is cloned along it.
pub(crate) fn row(object: &Object) -> Option<(&Row, &Recipe)> {
    match object.recipe()?.node() {
        Node::Clones { row, recipe } => Some((row, recipe)),
        _ => None,
    }
}

/// The first row of clones among what is selected, with its object.
pub(crate) fn selected_row<'a>(
    document: &'a Document,
    selection: &Selection,
) -> Option<(ObjectId, &'a Object, &'a Row, &'a Recipe)> {
    selection.0.iter().find_map(|&id| {
        let object = document.object(id)?;
        let (row, recipe) = row(object)?;
        Some((id, object, row, recipe))
    })
}

/// Whether it came of a sweep.
fn swept(object: &Object) -> bool {
    object.sweep().is_some() || row(object).is_some()
}

/// The selected sweeps and rows of clones follow nothing any more.
pub(crate) fn free(project: &mut Project, selection: &Selection, notices: &mut Notices) {
    let document = project.document();
    let found = selection.0.iter().filter_map(|&id| {
        let object = document.object(id).filter(|o| swept(o))?;
        Some((id, !object.links.is_empty()))
    });
    let found: Vec<(ObjectId, bool)> = found.collect();
    if found.is_empty() {
        notices.info("Select a sweep or a row of clones first.");
        return;
    }
    let linked = found.into_iter().filter(|(_, linked)| *linked);
    let edits: Vec<Edit> = linked
        .map(|(id, _)| Edit::SetLinks {
            id,
            links: Vec::new(),
        })
        .collect();
    if edits.is_empty() {
        notices.info("It follows no stroke.");
        return;
    }
    project.commit("Follow no stroke", edits, notices);
}

/// The selected row becomes its clones: as many objects, in a group, each standing where it stood.
pub(crate) fn apart(project: &mut Project, selection: &mut Selection, notices: &mut Notices) {
    let document = project.document();
    let Some((id, object, row, recipe)) = selected_row(document, selection) else {
        notices.info("Select a row of clones first.");
        return;
    };
    if row.len() > MOST {
        notices.warn(format!(
            "{} has {} clones; at most {MOST} can be taken apart. Cut the row, or sweep it with fewer.",
            object.name,
            row.len()
        ));
        return;
    }
    let first = document.next_id();
    let group = GroupId(first);
    let name = object.name.clone();
    let mut edits = vec![Edit::AddGroup {
        id: group,
        group: Group {
            name: name.clone(),
            parent: object.group,
        },
    }];
    let mut ids = Vec::new();
    for (k, place) in row.places().iter().enumerate() {
        let (placement, recipe) = own(&object.placement, place, recipe);
        let one = Object {
            name: format!("{name}, {}", k + 1),
            kind: Kind::Solid(recipe),
            placement,
            group: Some(group),
            links: Vec::new(),
            ..object.clone()
        };
        let one_id = ObjectId(first + 1 + k as u64);
        ids.push(one_id);
        edits.push(Edit::Add {
            id: one_id,
            object: Arc::new(one),
        });
    }
    edits.push(Edit::Remove { id });
    if project.commit(format!("Take {name} apart"), edits, notices) {
        *selection = Selection(ids);
    }
}

/// One clone where it stands in the world. In a row that is scaled unevenly it is skewed, which no
/// placement is: its own place then goes into its recipe.
fn own(row: &Placement, place: &Place, recipe: &Recipe) -> (Placement, Recipe) {
    let there = Placement::from(place);
    let scale = row.scale;
    if scale.x == scale.y && scale.y == scale.z && scale.x > 0.0 {
        let placement = Placement {
            translation: row.affine().transform_point3(there.translation),
            rotation: (row.rotation * there.rotation).normalize(),
            scale: there.scale * scale.x,
        };
        return (placement, recipe.clone());
    }
    (*row, recipe.placed(there))
}
