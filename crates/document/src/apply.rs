use std::collections::HashSet;
use std::sync::Arc;

use midair_field::{Canvas, Node, Op, Recipe, Stroke};

use crate::drawing::DrawingFault;
use crate::recipes::{RecipeFault, check_recipe, check_sheet, is_box};
use crate::{Dials, Document, Edit, Group, GroupId, Kind, Layer, LayerId, Object, ObjectId};

/// Why an edit was refused. The document is as it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EditError {
    /// No such object.
    #[error("there is no object {0}")]
    NoObject(ObjectId),
    /// No such layer.
    #[error("there is no layer {0}")]
    NoLayer(LayerId),
    /// No such group.
    #[error("there is no group {0}")]
    NoGroup(GroupId),
    /// An id that is not the next one, or not one that was handed out.
    #[error("{found} is not the next free id, {expected}")]
    Id {
        /// The id in the edit.
        found: u64,
        /// The document's next id.
        expected: u64,
    },
    /// An id in use.
    #[error("{0} is in use already")]
    InUse(u64),
    /// A placement that is not finite, has a zero scale or no rotation.
    #[error("an object cannot stand there: its placement is not finite, or a scale is zero")]
    Placement,
    /// A line or stroke that is not sound.
    #[error("it cannot be drawn: {0}")]
    Drawing(#[from] DrawingFault),
    /// A recipe that is not sound.
    #[error("the solid cannot be taken: {0}")]
    Recipe(#[from] RecipeFault),
    /// A picture with impossible numbers.
    #[error("a picture is 0.001 to 100 metres wide and high, and its opacity 0 to 1")]
    Reference,
    /// A material's number that is none.
    #[error("{0} of a material is not a number")]
    Dial(String),
    /// An object that is no painting.
    #[error("{0} is not a painting")]
    NoPainting(ObjectId),
    /// Strokes that a painting does not have.
    #[error("the painting has no strokes {0} to {1}")]
    NoStroke(usize, usize),
    /// A step that is not a number.
    #[error("{0} is not a step")]
    Step(f32),
    /// A layer or group that holds something.
    #[error("it is not empty: move what it holds first")]
    NotEmpty,
    /// The base layer cannot be removed.
    #[error("the base layer stays")]
    BaseLayer,
    /// A group inside itself.
    #[error("a group cannot lie inside itself")]
    GroupCycle,
    /// An object marked twice.
    #[error("object {0} is marked twice")]
    MarkedTwice(ObjectId),
    /// Composites inside composites without end.
    #[error("the edit is nested too deeply")]
    Nested,
}

const MAX_NESTING: usize = 32;

impl Document {
    /// Changes the document and returns the edit that undoes it. Reads no field and no mesh.
    ///
    /// # Errors
    /// [`EditError`], the document being as it was.
    pub fn apply(&mut self, edit: &Edit) -> Result<Edit, EditError> {
        self.apply_at(edit, 0)
    }

    fn apply_at(&mut self, edit: &Edit, depth: usize) -> Result<Edit, EditError> {
        Ok(match edit {
            Edit::Add { id, object } => {
                self.fits(object)?;
                self.take_id(id.0)?;
                Arc::make_mut(&mut self.objects).insert(*id, object.clone());
                Edit::Forget { id: *id }
            }
            Edit::Forget { id } => {
                let object = self.shared(*id)?.clone();
                self.may_give_back(id.0)?;
                if self.mark(*id).is_some() {
                    return Err(EditError::NotEmpty);
                }
                Arc::make_mut(&mut self.objects).remove(id);
                self.next_id = id.0;
                Edit::Add { id: *id, object }
            }
            Edit::Remove { id } => {
                let object = self.shared(*id)?.clone();
                Arc::make_mut(&mut self.objects).remove(id);
                let restore = Edit::Restore { id: *id, object };
                if self.mark(*id).is_none() {
                    restore
                } else {
                    let pending = self.pending.to_vec();
                    Arc::make_mut(&mut self.pending).retain(|(o, _)| o != id);
                    Edit::Composite {
                        name: restore.describe().into(),
                        edits: vec![restore, Edit::SetPending { pending }],
                    }
                }
            }
            Edit::Restore { id, object } => {
                self.fits(object)?;
                self.was_handed_out(id.0)?;
                Arc::make_mut(&mut self.objects).insert(*id, object.clone());
                Edit::Remove { id: *id }
            }
            Edit::Replace { id, object } => {
                self.fits(object)?;
                self.shared(*id)?;
                let before = Arc::make_mut(&mut self.objects).insert(*id, object.clone());
                Edit::Replace {
                    id: *id,
                    object: before.unwrap_or_else(|| object.clone()),
                }
            }
            Edit::SetPlacement { id, placement } => {
                if !placement.is_sound() {
                    return Err(EditError::Placement);
                }
                let mut placement = *placement;
                std::mem::swap(&mut self.change(*id)?.placement, &mut placement);
                Edit::SetPlacement { id: *id, placement }
            }
            Edit::SetKind { id, kind } => {
                kind_fits(kind)?;
                let kind = std::mem::replace(&mut self.change(*id)?.kind, kind.clone());
                Edit::SetKind { id: *id, kind }
            }
            Edit::SetStrokes {
                id,
                at,
                gone,
                strokes,
            } => self.set_strokes(*id, *at, *gone, strokes)?,
            Edit::Rename { id, name } => Edit::Rename {
                id: *id,
                name: std::mem::replace(&mut self.change(*id)?.name, name.clone()),
            },
            Edit::SetVisible { id, visible } => Edit::SetVisible {
                id: *id,
                visible: std::mem::replace(&mut self.change(*id)?.visible, *visible),
            },
            Edit::SetLocked { id, locked } => Edit::SetLocked {
                id: *id,
                locked: std::mem::replace(&mut self.change(*id)?.locked, *locked),
            },
            Edit::SetFresh { id, fresh } => Edit::SetFresh {
                id: *id,
                fresh: std::mem::replace(&mut self.change(*id)?.fresh, *fresh),
            },
            Edit::SetDimmed { id, dimmed } => Edit::SetDimmed {
                id: *id,
                dimmed: std::mem::replace(&mut self.change(*id)?.dimmed, *dimmed),
            },
            Edit::SetLinks { id, links } => Edit::SetLinks {
                id: *id,
                links: std::mem::replace(&mut self.change(*id)?.links, links.clone()),
            },
            Edit::SetColour { id, colour } => Edit::SetColour {
                id: *id,
                colour: std::mem::replace(&mut self.change(*id)?.colour, *colour),
            },
            Edit::SetMaterial {
                id,
                material,
                dials,
            } => {
                sound(dials)?;
                let object = self.change(*id)?;
                Edit::SetMaterial {
                    id: *id,
                    material: std::mem::replace(&mut object.material, material.clone()),
                    dials: std::mem::replace(&mut object.dials, dials.clone()),
                }
            }
            Edit::SetLayer { id, layer } => {
                self.layer(*layer).ok_or(EditError::NoLayer(*layer))?;
                let layer = std::mem::replace(&mut self.change(*id)?.layer, *layer);
                Edit::SetLayer { id: *id, layer }
            }
            Edit::SetGroup { id, group } => {
                self.has_group(*group)?;
                let group = std::mem::replace(&mut self.change(*id)?.group, *group);
                Edit::SetGroup { id: *id, group }
            }
            Edit::AddLayer { id, layer } => {
                self.take_id(id.0)?;
                Arc::make_mut(&mut self.layers).insert(*id, layer.clone());
                Edit::ForgetLayer { id: *id }
            }
            Edit::ForgetLayer { id } => {
                self.may_give_back(id.0)?;
                let layer = self.take_layer(*id)?;
                self.next_id = id.0;
                Edit::AddLayer { id: *id, layer }
            }
            Edit::RemoveLayer { id } => {
                let layer = self.take_layer(*id)?;
                Edit::RestoreLayer { id: *id, layer }
            }
            Edit::RestoreLayer { id, layer } => {
                self.was_handed_out(id.0)?;
                Arc::make_mut(&mut self.layers).insert(*id, layer.clone());
                Edit::RemoveLayer { id: *id }
            }
            Edit::ReplaceLayer { id, layer } => {
                let slot = Arc::make_mut(&mut self.layers).get_mut(id);
                let slot = slot.ok_or(EditError::NoLayer(*id))?;
                let layer = std::mem::replace(slot, layer.clone());
                Edit::ReplaceLayer { id: *id, layer }
            }
            Edit::AddGroup { id, group } => {
                self.has_group(group.parent)?;
                self.take_id(id.0)?;
                Arc::make_mut(&mut self.groups).insert(*id, group.clone());
                Edit::ForgetGroup { id: *id }
            }
            Edit::ForgetGroup { id } => {
                self.may_give_back(id.0)?;
                let group = self.take_group(*id)?;
                self.next_id = id.0;
                Edit::AddGroup { id: *id, group }
            }
            Edit::RemoveGroup { id } => {
                let group = self.take_group(*id)?;
                Edit::RestoreGroup { id: *id, group }
            }
            Edit::RestoreGroup { id, group } => {
                self.has_group(group.parent)?;
                self.was_handed_out(id.0)?;
                Arc::make_mut(&mut self.groups).insert(*id, group.clone());
                Edit::RemoveGroup { id: *id }
            }
            Edit::ReplaceGroup { id, group } => {
                self.has_group(group.parent)?;
                if self.groups_above(group.parent).any(|g| g == *id) {
                    return Err(EditError::GroupCycle);
                }
                let slot = Arc::make_mut(&mut self.groups).get_mut(id);
                let slot = slot.ok_or(EditError::NoGroup(*id))?;
                let group = std::mem::replace(slot, group.clone());
                Edit::ReplaceGroup { id: *id, group }
            }
            Edit::SetMark { id, op } => self.set_mark(*id, *op)?,
            Edit::SetPending { pending } => {
                let mut seen = HashSet::new();
                for &(id, _) in pending {
                    self.shared(id)?;
                    if !seen.insert(id) {
                        return Err(EditError::MarkedTwice(id));
                    }
                }
                let before = std::mem::replace(&mut self.pending, Arc::new(pending.clone()));
                Edit::SetPending {
                    pending: before.to_vec(),
                }
            }
            Edit::SetStep { step } => {
                if !step.is_finite() {
                    return Err(EditError::Step(*step));
                }
                let (least, most) = Self::STEPS;
                let step = std::mem::replace(&mut self.step, step.clamp(least, most));
                Edit::SetStep { step }
            }
            Edit::Composite { name, edits } => {
                if depth >= MAX_NESTING {
                    return Err(EditError::Nested);
                }
                let before = self.clone();
                let mut inverse = Vec::with_capacity(edits.len());
                for edit in edits {
                    match self.apply_at(edit, depth + 1) {
                        Ok(undo) => inverse.push(undo),
                        Err(e) => {
                            *self = before;
                            return Err(e);
                        }
                    }
                }
                inverse.reverse();
                Edit::Composite {
                    name: name.clone(),
                    edits: inverse,
                }
            }
        })
    }

    fn set_strokes(
        &mut self,
        id: ObjectId,
        at: usize,
        gone: usize,
        strokes: &[Stroke],
    ) -> Result<Edit, EditError> {
        let object = self.shared(id)?;
        let Kind::Solid(recipe) = &object.kind else {
            return Err(EditError::NoPainting(id));
        };
        let Node::Canvas(canvas) = recipe.node() else {
            return Err(EditError::NoPainting(id));
        };
        let end = at.saturating_add(gone);
        if end > canvas.strokes.len() {
            return Err(EditError::NoStroke(at.saturating_add(1), end));
        }
        let mut next = canvas.strokes.clone();
        let gone: Vec<Stroke> = next.splice(at..end, strokes.iter().cloned()).collect();
        let canvas = Canvas {
            strokes: next,
            ..*canvas
        };
        let kind = Kind::Solid(Recipe::new(Node::Canvas(canvas)));
        kind_fits(&kind)?;
        self.change(id)?.kind = kind;
        Ok(Edit::SetStrokes {
            id,
            at,
            gone: strokes.len(),
            strokes: gone,
        })
    }

    fn set_mark(&mut self, id: ObjectId, op: Option<Op>) -> Result<Edit, EditError> {
        self.shared(id)?;
        let before = self.pending.to_vec();
        let pending = Arc::make_mut(&mut self.pending);
        let at = pending.iter().position(|&(o, _)| o == id);
        match (at, op) {
            (Some(i), Some(op)) => pending[i].1 = op,
            (Some(i), None) => drop(pending.remove(i)),
            (None, Some(op)) => pending.push((id, op)),
            (None, None) => {}
        }
        Ok(Edit::SetPending { pending: before })
    }

    fn shared(&self, id: ObjectId) -> Result<&Arc<Object>, EditError> {
        self.objects.get(&id).ok_or(EditError::NoObject(id))
    }

    fn change(&mut self, id: ObjectId) -> Result<&mut Object, EditError> {
        // Asked first, so that a refused edit leaves even the sharing as it was.
        self.shared(id)?;
        match Arc::make_mut(&mut self.objects).get_mut(&id) {
            Some(object) => Ok(Arc::make_mut(object)),
            None => Err(EditError::NoObject(id)),
        }
    }

    fn fits(&self, object: &Object) -> Result<(), EditError> {
        if !object.placement.is_sound() {
            return Err(EditError::Placement);
        }
        self.layer(object.layer)
            .ok_or(EditError::NoLayer(object.layer))?;
        self.has_group(object.group)?;
        sound(&object.dials)?;
        kind_fits(&object.kind)
    }

    fn has_group(&self, group: Option<GroupId>) -> Result<(), EditError> {
        match group {
            Some(id) if !self.groups.contains_key(&id) => Err(EditError::NoGroup(id)),
            _ => Ok(()),
        }
    }

    fn take_id(&mut self, id: u64) -> Result<(), EditError> {
        let expected = self.next_id;
        if id != expected {
            return Err(EditError::Id {
                found: id,
                expected,
            });
        }
        self.next_id = expected.checked_add(1).ok_or(EditError::InUse(id))?;
        Ok(())
    }

    fn may_give_back(&self, id: u64) -> Result<(), EditError> {
        let last = self.next_id.wrapping_sub(1);
        if id == last {
            Ok(())
        } else {
            Err(EditError::Id {
                found: id,
                expected: last,
            })
        }
    }

    fn was_handed_out(&self, id: u64) -> Result<(), EditError> {
        if id >= self.next_id {
            return Err(EditError::Id {
                found: id,
                expected: self.next_id,
            });
        }
        let used = self.objects.contains_key(&ObjectId(id))
            || self.layers.contains_key(&LayerId(id))
            || self.groups.contains_key(&GroupId(id));
        if used {
            Err(EditError::InUse(id))
        } else {
            Ok(())
        }
    }

    fn take_layer(&mut self, id: LayerId) -> Result<Layer, EditError> {
        if id == LayerId::BASE {
            return Err(EditError::BaseLayer);
        }
        if !self.layers.contains_key(&id) {
            return Err(EditError::NoLayer(id));
        }
        if self.objects.values().any(|o| o.layer == id) {
            return Err(EditError::NotEmpty);
        }
        let layer = Arc::make_mut(&mut self.layers).remove(&id);
        layer.ok_or(EditError::NoLayer(id))
    }

    fn take_group(&mut self, id: GroupId) -> Result<Group, EditError> {
        if !self.groups.contains_key(&id) {
            return Err(EditError::NoGroup(id));
        }
        let holds = self.objects.values().any(|o| o.group == Some(id))
            || self.groups.values().any(|g| g.parent == Some(id));
        if holds {
            return Err(EditError::NotEmpty);
        }
        let group = Arc::make_mut(&mut self.groups).remove(&id);
        group.ok_or(EditError::NoGroup(id))
    }
}

fn sound(dials: &Dials) -> Result<(), EditError> {
    match dials.iter().find(|(_, value)| !value.is_finite()) {
        Some((name, _)) => Err(EditError::Dial(name.clone())),
        None => Ok(()),
    }
}

fn kind_fits(kind: &Kind) -> Result<(), EditError> {
    match kind {
        Kind::Solid(recipe) => Ok(check_recipe(recipe, &mut HashSet::new())?),
        Kind::Foreign { bounds, .. } if !is_box(bounds) => Err(RecipeFault::Bounds.into()),
        Kind::Foreign { .. } => Ok(()),
        Kind::Reference(reference) if !reference.is_sound() => Err(EditError::Reference),
        Kind::Reference(_) => Ok(()),
        Kind::Line(line) => Ok(line.check()?),
        Kind::Stroke(stroke) => Ok(stroke.check()?),
        Kind::Sheet(recipe) => Ok(check_sheet(recipe)?),
    }
}
