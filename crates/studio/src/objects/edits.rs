//! From what was asked to the edits that do it.

use std::sync::Arc;

use bevy::math::Vec3;
use midair_document::{
    Colour, Dials, Document, Edit, GroupId, Kind, Layer, LayerId, Object, ObjectId,
};
use midair_field::Placement;
use midair_solid::Materials;

use super::extent::{corners, extent};
use super::{Ask, mirrored, turned};

/// Why nothing was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum Refused {
    #[error("Nothing is selected. Click an object first, or press Ctrl+A for all of them.")]
    Nothing,
    #[error("Everything that is selected is locked. Unlock it in the outline first.")]
    Locked,
    #[error("Select two objects or more to group them.")]
    One,
    #[error("Nothing that is selected lies in a group.")]
    NoGroup,
    #[error("The base layer stays: every object needs one to lie on.")]
    Base,
    #[error("A name needs at least one letter.")]
    Name,
    #[error("A picture has no colour and no material to take.")]
    NoLook,
    #[error("That is no picture: only reference images have a width and an opacity of their own.")]
    NoPicture,
    #[error("What it is made of has no such number to set.")]
    NoDial,
    #[error("Copies around the vertical are 2 to 64, the first included.")]
    Count,
}

type Step = (String, Vec<Edit>);

pub(super) fn edits(
    ask: &Ask,
    document: &Document,
    materials: &Materials,
    selection: &[ObjectId],
) -> Result<Step, Refused> {
    let named = |ids: &[ObjectId]| -> Result<Vec<ObjectId>, Refused> {
        let ids = if ids.is_empty() { selection } else { ids };
        let ids: Vec<_> = ids
            .iter()
            .copied()
            .filter(|&id| document.object(id).is_some())
            .collect();
        if ids.is_empty() {
            Err(Refused::Nothing)
        } else {
            Ok(ids)
        }
    };
    let free = |ids: &[ObjectId]| -> Result<Vec<ObjectId>, Refused> {
        let mut ids = named(ids)?;
        ids.retain(|&id| !document.is_locked(id));
        if ids.is_empty() {
            Err(Refused::Locked)
        } else {
            Ok(ids)
        }
    };
    let count =
        |verb: &str, ids: &[ObjectId]| match (ids, ids.first().and_then(|&id| document.object(id)))
        {
            ([_], Some(object)) => format!("{verb} {}", object.name),
            _ => format!("{verb} {} objects", ids.len()),
        };
    Ok(match ask {
        Ask::Select { .. }
        | Ask::SelectAll
        | Ask::SelectNone
        | Ask::SelectOthers
        | Ask::Dropper { .. } => {
            return Err(Refused::Nothing);
        }
        Ask::Like { ids, of } => {
            let ids = named(ids)?;
            let source = document.object(*of).ok_or(Refused::Nothing)?;
            if source.reference().is_some() {
                return Err(Refused::NoLook);
            }
            let others = ids.iter().filter(|id| *id != of);
            let edits =
                others.flat_map(|&id| look(id, source.colour, &source.material, &source.dials));
            (format!("Look of {}", source.name), edits.collect())
        }
        Ask::Look {
            ids,
            colour,
            material,
        } => {
            let ids = named(ids)?;
            let edits = ids
                .iter()
                .flat_map(|&id| look(id, *colour, material, &Dials::new()));
            (count("Look of", &ids), edits.collect())
        }
        Ask::Picture { id, width, opacity } => {
            let object = document.object(*id).ok_or(Refused::Nothing)?;
            let mut picture = *object.reference().ok_or(Refused::NoPicture)?;
            if let Some(width) = width {
                if document.is_locked(*id) {
                    return Err(Refused::Locked);
                }
                picture = picture.at_width(width / object.placement.scale.x.abs());
            }
            if let Some(opacity) = opacity.filter(|o| o.is_finite()) {
                picture.opacity = opacity.clamp(0.0, 1.0);
            }
            let kind = Kind::Reference(picture);
            let name = format!("Change {}", object.name);
            (name, vec![Edit::SetKind { id: *id, kind }])
        }
        Ask::Duplicate => {
            let ids = named(&[])?;
            let aside = Vec3::new(1.0, 0.0, 1.0) * offset(document, &ids);
            let there = |p: &Placement| Placement {
                translation: p.translation + aside,
                ..*p
            };
            (count("Duplicate", &ids), copies(document, &ids, &[&there]))
        }
        Ask::Mirror { axis } => {
            let ids = named(&[])?;
            let there = |p: &Placement| mirrored(p, *axis);
            (count("Mirror", &ids), copies(document, &ids, &[&there]))
        }
        Ask::Around { count: all } => {
            if !(2..=64).contains(all) {
                return Err(Refused::Count);
            }
            let ids = named(&[])?;
            let angle = std::f32::consts::TAU / *all as f32;
            let turns: Vec<_> = (1..*all)
                .map(|i| move |p: &Placement| turned(p, angle * i as f32))
                .collect();
            let turns: Vec<&dyn Fn(&Placement) -> Placement> = turns
                .iter()
                .map(|t| t as &dyn Fn(&Placement) -> Placement)
                .collect();
            (count("Copy around", &ids), copies(document, &ids, &turns))
        }
        Ask::Group => {
            let ids = named(&[])?;
            if ids.len() < 2 {
                return Err(Refused::One);
            }
            // Groups that are selected whole go in as they are.
            let mut edits = vec![document.group_edit("Group", &[])];
            let group = GroupId(document.next_id());
            let mut moved: Vec<GroupId> = Vec::new();
            for &id in &ids {
                match document.outermost_group(id) {
                    Some(outer) if document.members(outer).iter().all(|m| ids.contains(m)) => {
                        if !moved.contains(&outer) {
                            moved.push(outer);
                        }
                    }
                    _ => edits.push(Edit::SetGroup {
                        id,
                        group: Some(group),
                    }),
                }
            }
            for id in moved {
                if let Some(inner) = document.group(id) {
                    let mut inner = inner.clone();
                    inner.parent = Some(group);
                    edits.push(Edit::ReplaceGroup { id, group: inner });
                }
            }
            (count("Group", &ids), edits)
        }
        Ask::Ungroup => {
            let ids = named(&[])?;
            let mut groups: Vec<GroupId> = ids
                .iter()
                .filter_map(|&id| document.outermost_group(id))
                .collect();
            groups.sort();
            groups.dedup();
            if groups.is_empty() {
                return Err(Refused::NoGroup);
            }
            let edits = groups
                .into_iter()
                .map(|g| document.ungroup_edit(g))
                .collect();
            ("Ungroup".into(), edits)
        }
        Ask::Delete => {
            let ids = free(&[])?;
            let name = count("Delete", &ids);
            let mut edits: Vec<Edit> = ids.iter().map(|&id| Edit::Remove { id }).collect();
            edits.extend(empty_groups(document, &ids));
            (name, edits)
        }
        Ask::Rename { id, name } => {
            let name = name.trim();
            if name.is_empty() {
                return Err(Refused::Name);
            }
            named(&[*id])?;
            (
                "Rename".into(),
                vec![Edit::Rename {
                    id: *id,
                    name: name.into(),
                }],
            )
        }
        Ask::RenameGroup { id, name } => {
            let name = name.trim();
            if name.is_empty() {
                return Err(Refused::Name);
            }
            let mut group = document.group(*id).ok_or(Refused::NoGroup)?.clone();
            group.name = name.into();
            (
                "Rename group".into(),
                vec![Edit::ReplaceGroup { id: *id, group }],
            )
        }
        Ask::Visible { ids, visible } => {
            let ids = named(ids)?;
            let name = count(if *visible { "Show" } else { "Hide" }, &ids);
            (
                name,
                each(&ids, |id| Edit::SetVisible {
                    id,
                    visible: *visible,
                }),
            )
        }
        Ask::ShowAll => {
            let hidden = document.objects().filter(|(_, o)| !o.visible);
            let mut edits: Vec<Edit> = hidden
                .map(|(id, _)| Edit::SetVisible { id, visible: true })
                .collect();
            edits.extend(
                document
                    .layers()
                    .filter(|(_, l)| !l.visible)
                    .map(|(id, l)| {
                        let layer = Layer {
                            visible: true,
                            ..l.clone()
                        };
                        Edit::ReplaceLayer { id, layer }
                    }),
            );
            ("Show everything".into(), edits)
        }
        Ask::Locked { ids, locked } => {
            let ids = named(ids)?;
            let name = count(if *locked { "Lock" } else { "Unlock" }, &ids);
            (
                name,
                each(&ids, |id| Edit::SetLocked {
                    id,
                    locked: *locked,
                }),
            )
        }
        Ask::Into { ids, group } => {
            let ids = named(ids)?;
            if let Some(group) = group {
                document.group(*group).ok_or(Refused::NoGroup)?;
            }
            (
                count("Regroup", &ids),
                each(&ids, |id| Edit::SetGroup { id, group: *group }),
            )
        }
        Ask::OnLayer { ids, layer } => {
            let ids = named(ids)?;
            (
                count("Change layer of", &ids),
                each(&ids, |id| Edit::SetLayer { id, layer: *layer }),
            )
        }
        Ask::NewLayer { name } => {
            let name = name.trim();
            if name.is_empty() {
                return Err(Refused::Name);
            }
            let id = LayerId(document.next_id());
            (
                "New layer".into(),
                vec![Edit::AddLayer {
                    id,
                    layer: Layer::new(name),
                }],
            )
        }
        Ask::ChangeLayer { id, layer } => {
            if layer.name.trim().is_empty() {
                return Err(Refused::Name);
            }
            (
                "Change layer".into(),
                vec![Edit::ReplaceLayer {
                    id: *id,
                    layer: layer.clone(),
                }],
            )
        }
        Ask::RemoveLayer { id } => {
            if *id == LayerId::BASE {
                return Err(Refused::Base);
            }
            let on = document.objects().filter(|(_, o)| o.layer == *id);
            let mut edits: Vec<Edit> = on
                .map(|(id, _)| Edit::SetLayer {
                    id,
                    layer: LayerId::BASE,
                })
                .collect();
            edits.push(Edit::RemoveLayer { id: *id });
            ("Delete layer".into(), edits)
        }
        Ask::Place(places) => {
            let ids: Vec<_> = places.iter().map(|(id, _)| *id).collect();
            let ids = free(&ids)?;
            let edits = places
                .iter()
                .filter(|(id, _)| ids.contains(id))
                .flat_map(|&(id, placement)| placed(document, id, placement))
                .collect();
            (count("Move", &ids), edits)
        }
        Ask::Ground { ids } => {
            let ids = free(ids)?;
            let edits = ids.iter().flat_map(|&id| {
                let object = document.object(id)?;
                let mut placement = object.placement;
                placement.translation.y -= corners(object).map(|p| p.y).reduce(f32::min)?;
                Some(placed(document, id, placement))
            });
            (count("Put on the ground", &ids), edits.flatten().collect())
        }
        Ask::Colour { ids, colour } => {
            let ids = named(ids)?;
            (
                count("Colour", &ids),
                each(&ids, |id| Edit::SetColour {
                    id,
                    colour: *colour,
                }),
            )
        }
        Ask::Material {
            ids,
            material,
            dials,
        } => {
            let ids = named(ids)?;
            let set = |id| Edit::SetMaterial {
                id,
                material: material.clone(),
                dials: dials.clone(),
            };
            (count("Material of", &ids), each(&ids, set))
        }
        Ask::Dial {
            ids, dial, value, ..
        } => {
            let ids = named(ids)?;
            let set = |&id: &ObjectId| {
                let object = document.object(id)?;
                let info = materials.at(materials.place(object));
                let known = info.dials.iter().find(|d| d.id == *dial)?;
                let mut dials = object.dials.clone();
                dials.insert(dial.clone(), known.bound(*value));
                Some(Edit::SetMaterial {
                    id,
                    material: object.material.clone(),
                    dials,
                })
            };
            let edits: Vec<_> = ids.iter().filter_map(set).collect();
            if edits.is_empty() {
                return Err(Refused::NoDial);
            }
            (count("Material of", &ids), edits)
        }
    })
}

fn each(ids: &[ObjectId], edit: impl Fn(ObjectId) -> Edit) -> Vec<Edit> {
    ids.iter().map(|&id| edit(id)).collect()
}

fn look(
    id: ObjectId,
    colour: Option<Colour>,
    material: &Option<String>,
    dials: &Dials,
) -> [Edit; 2] {
    [
        Edit::SetColour { id, colour },
        Edit::SetMaterial {
            id,
            material: material.clone(),
            dials: dials.clone(),
        },
    ]
}

/// A new place; a result that is moved is fresh no longer.
fn placed(document: &Document, id: ObjectId, placement: Placement) -> Vec<Edit> {
    let mut edits = vec![Edit::SetPlacement { id, placement }];
    if document.object(id).is_some_and(|o| o.fresh) {
        edits.push(Edit::SetFresh { id, fresh: false });
    }
    edits
}

/// One copy of each object for each of `there`; what is grouped is grouped again.
fn copies(
    document: &Document,
    ids: &[ObjectId],
    there: &[&dyn Fn(&Placement) -> Placement],
) -> Vec<Edit> {
    let mut edits = Vec::new();
    let mut next = document.next_id();
    for there in there {
        let mut groups: Vec<(GroupId, GroupId)> = Vec::new();
        for object in ids.iter().filter_map(|&id| document.object(id)) {
            let group = object
                .group
                .map(|old| match groups.iter().find(|(o, _)| *o == old) {
                    Some(&(_, new)) => new,
                    None => {
                        let new = GroupId(next);
                        next += 1;
                        groups.push((old, new));
                        let mut group =
                            document
                                .group(old)
                                .cloned()
                                .unwrap_or(midair_document::Group {
                                    name: "Group".into(),
                                    parent: None,
                                });
                        group.parent = None;
                        edits.push(Edit::AddGroup { id: new, group });
                        new
                    }
                });
            let copy = Object {
                placement: there(&object.placement),
                group,
                locked: false,
                fresh: false,
                // A copy stands elsewhere: it has its own shape.
                links: Vec::new(),
                ..object.clone()
            };
            edits.push(Edit::Add {
                id: ObjectId(next),
                object: Arc::new(copy),
            });
            next += 1;
        }
    }
    edits
}

/// Groups that have nothing in them once these are gone, the innermost first.
fn empty_groups(document: &Document, gone: &[ObjectId]) -> Vec<Edit> {
    let empty = |group: GroupId| document.members(group).iter().all(|m| gone.contains(m));
    let touched = |group: GroupId| document.members(group).iter().any(|m| gone.contains(m));
    let mut groups: Vec<(usize, GroupId)> = document
        .groups()
        .map(|(id, _)| id)
        .filter(|&id| touched(id) && empty(id))
        .map(|id| (document.members(id).len(), id))
        .collect();
    groups.sort_by_key(|&(size, id)| {
        let depth = std::iter::successors(document.group(id), |g| document.group(g.parent?))
            .take(64)
            .count();
        (usize::MAX - depth, size, id)
    });
    groups
        .into_iter()
        .map(|(_, id)| Edit::RemoveGroup { id })
        .collect()
}

/// How far a copy is put aside: a quarter of what is copied, so that both can be seen.
fn offset(document: &Document, ids: &[ObjectId]) -> f32 {
    let size = extent(document, ids.iter().copied()).map_or(0.0, |(l, h)| (h - l).max_element());
    (0.25 * size).clamp(0.02, 0.5)
}
