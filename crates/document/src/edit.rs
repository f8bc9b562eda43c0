mod bytes;

use std::sync::Arc;

use midair_field::{Op, Placement, Recipe, Skeleton, Stroke};
use serde::{Deserialize, Serialize};

use crate::{Colour, Dials, Group, GroupId, Kind, Layer, LayerId, Link, Object, ObjectId};

/// A change to the document: small, serialisable, and undone by another edit.
///
/// `Forget…` and `Restore…` are what undoing `Add…` and `Remove…` takes: the former hands the id
/// back, the latter uses one that was handed out before. Tools have no use for them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Edit<R = Recipe> {
    /// A new object. Its id is [`crate::Document::next_id`].
    Add {
        /// Its id from now on.
        id: ObjectId,
        /// The object.
        object: Arc<Object<R>>,
    },
    /// Takes the newest object away, as if it had never been.
    Forget {
        /// The id handed out last.
        id: ObjectId,
    },
    /// Takes an object away, and its mark.
    Remove {
        /// Which.
        id: ObjectId,
    },
    /// Brings a removed object back.
    Restore {
        /// The id it had.
        id: ObjectId,
        /// The object.
        object: Arc<Object<R>>,
    },
    /// Puts another object in the place of one.
    Replace {
        /// Which.
        id: ObjectId,
        /// What stands there from now on.
        object: Arc<Object<R>>,
    },
    /// Moves, turns, scales.
    SetPlacement {
        /// Which.
        id: ObjectId,
        /// Where it stands from now on.
        placement: Placement,
    },
    /// Changes what an object is; [`Edit::set_recipe`] for a solid.
    SetKind {
        /// Which.
        id: ObjectId,
        /// What it is from now on.
        kind: Kind<R>,
    },
    /// Puts strokes into a painting, in the place of some of its own or between them.
    SetStrokes {
        /// Which painting.
        id: ObjectId,
        /// Before which of its strokes, from 0.
        at: usize,
        /// How many of its strokes from there on go.
        gone: usize,
        /// What comes in their place.
        strokes: Vec<Stroke<R>>,
    },
    /// Calls an object something else.
    Rename {
        /// Which.
        id: ObjectId,
        /// Its name from now on.
        name: String,
    },
    /// Shows or hides.
    SetVisible {
        /// Which.
        id: ObjectId,
        /// Whether it is drawn.
        visible: bool,
    },
    /// Locks or unlocks.
    SetLocked {
        /// Which.
        id: ObjectId,
        /// Whether hands pass through it.
        locked: bool,
    },
    /// Marks an object as a fresh result, or as one no longer.
    SetFresh {
        /// Which.
        id: ObjectId,
        /// Whether it is fresh.
        fresh: bool,
    },
    /// Draws an object faintly, or as usual.
    SetDimmed {
        /// Which.
        id: ObjectId,
        /// Whether it is faint.
        dimmed: bool,
    },
    /// Says what an object's shape follows from now on.
    SetLinks {
        /// Which.
        id: ObjectId,
        /// All of its links.
        links: Vec<Link>,
    },
    /// Gives an object a colour, or takes it.
    SetColour {
        /// Which.
        id: ObjectId,
        /// Its colour from now on.
        colour: Option<Colour>,
    },
    /// Gives an object a material, or takes it.
    SetMaterial {
        /// Which.
        id: ObjectId,
        /// Its material's id.
        material: Option<String>,
        /// What is set of it.
        #[serde(default, skip_serializing_if = "Dials::is_empty")]
        dials: Dials,
    },
    /// Puts an object on a layer.
    SetLayer {
        /// Which.
        id: ObjectId,
        /// Where it lies from now on.
        layer: LayerId,
    },
    /// Puts an object into a group, or takes it out.
    SetGroup {
        /// Which.
        id: ObjectId,
        /// Its group from now on.
        group: Option<GroupId>,
    },
    /// A new layer. Its id is [`crate::Document::next_id`].
    AddLayer {
        /// Its id from now on.
        id: LayerId,
        /// The layer.
        layer: Layer,
    },
    /// Takes the newest layer away, as if it had never been.
    ForgetLayer {
        /// The id handed out last.
        id: LayerId,
    },
    /// Takes away a layer on which nothing lies.
    RemoveLayer {
        /// Which; not [`LayerId::BASE`].
        id: LayerId,
    },
    /// Brings a removed layer back.
    RestoreLayer {
        /// The id it had.
        id: LayerId,
        /// The layer.
        layer: Layer,
    },
    /// Renames, shows, hides, locks a layer.
    ReplaceLayer {
        /// Which.
        id: LayerId,
        /// What it is from now on.
        layer: Layer,
    },
    /// A new, empty group. Its id is [`crate::Document::next_id`].
    AddGroup {
        /// Its id from now on.
        id: GroupId,
        /// The group.
        group: Group,
    },
    /// Takes the newest group away, as if it had never been.
    ForgetGroup {
        /// The id handed out last.
        id: GroupId,
    },
    /// Takes away a group in which nothing lies.
    RemoveGroup {
        /// Which.
        id: GroupId,
    },
    /// Brings a removed group back.
    RestoreGroup {
        /// The id it had.
        id: GroupId,
        /// The group.
        group: Group,
    },
    /// Renames a group or puts it into another.
    ReplaceGroup {
        /// Which.
        id: GroupId,
        /// What it is from now on.
        group: Group,
    },
    /// Marks an object as the last operand of the sequence, changes its operator in place, or
    /// takes its mark away.
    SetMark {
        /// Which.
        id: ObjectId,
        /// How it joins.
        op: Option<Op>,
    },
    /// Sets the whole sequence of operands.
    SetPending {
        /// The operands from left to right.
        pending: Vec<(ObjectId, Op)>,
    },
    /// Sets S_global, clamped to [`crate::Document::STEPS`].
    SetStep {
        /// Metres.
        step: f32,
    },
    /// Several edits as one; undone in reverse order.
    Composite {
        /// What the undo list calls it.
        name: String,
        /// From first to last.
        edits: Vec<Edit<R>>,
    },
}

impl<R: Clone> Edit<R> {
    /// The same edit with recipes held in another way.
    pub(crate) fn map<S, E>(&self, f: &mut impl FnMut(&R) -> Result<S, E>) -> Result<Edit<S>, E> {
        use Edit::*;
        Ok(match self.clone() {
            Add { id, object } => Add {
                id,
                object: Arc::new(object.map(f)?),
            },
            Restore { id, object } => Restore {
                id,
                object: Arc::new(object.map(f)?),
            },
            Replace { id, object } => Replace {
                id,
                object: Arc::new(object.map(f)?),
            },
            SetKind { id, kind } => SetKind {
                id,
                kind: kind.map(f)?,
            },
            SetStrokes {
                id,
                at,
                gone,
                strokes,
            } => SetStrokes {
                id,
                at,
                gone,
                strokes: strokes.iter().map(|s| s.map(f)).collect::<Result<_, _>>()?,
            },
            Composite { name, edits } => {
                // A loop, so that the closure's type does not grow with each level.
                let mut mapped = Vec::with_capacity(edits.len());
                for edit in &edits {
                    mapped.push(edit.map(f)?);
                }
                Composite {
                    name,
                    edits: mapped,
                }
            }
            Forget { id } => Forget { id },
            Remove { id } => Remove { id },
            SetPlacement { id, placement } => SetPlacement { id, placement },
            Rename { id, name } => Rename { id, name },
            SetVisible { id, visible } => SetVisible { id, visible },
            SetLocked { id, locked } => SetLocked { id, locked },
            SetFresh { id, fresh } => SetFresh { id, fresh },
            SetDimmed { id, dimmed } => SetDimmed { id, dimmed },
            SetLinks { id, links } => SetLinks { id, links },
            SetColour { id, colour } => SetColour { id, colour },
            SetMaterial {
                id,
                material,
                dials,
            } => SetMaterial {
                id,
                material,
                dials,
            },
            SetLayer { id, layer } => SetLayer { id, layer },
            SetGroup { id, group } => SetGroup { id, group },
            AddLayer { id, layer } => AddLayer { id, layer },
            ForgetLayer { id } => ForgetLayer { id },
            RemoveLayer { id } => RemoveLayer { id },
            RestoreLayer { id, layer } => RestoreLayer { id, layer },
            ReplaceLayer { id, layer } => ReplaceLayer { id, layer },
            AddGroup { id, group } => AddGroup { id, group },
            ForgetGroup { id } => ForgetGroup { id },
            RemoveGroup { id } => RemoveGroup { id },
            RestoreGroup { id, group } => RestoreGroup { id, group },
            ReplaceGroup { id, group } => ReplaceGroup { id, group },
            SetMark { id, op } => SetMark { id, op },
            SetPending { pending } => SetPending { pending },
            SetStep { step } => SetStep { step },
        })
    }
}

impl Edit {
    /// Makes an object a solid of this recipe.
    pub fn set_recipe(id: ObjectId, recipe: impl Into<Recipe>) -> Self {
        Self::SetKind {
            id,
            kind: Kind::Solid(recipe.into()),
        }
    }

    /// A few words for the undo list: "Move", "Remove".
    pub fn describe(&self) -> &str {
        match self {
            Self::Add { .. } | Self::Restore { .. } => "Add",
            Self::Remove { .. } | Self::Forget { .. } => "Delete",
            Self::Replace { .. } | Self::SetKind { .. } => "Change",
            Self::SetStrokes { gone: 0, .. } => "Paint",
            Self::SetStrokes { strokes, .. } if strokes.is_empty() => "Delete stroke",
            Self::SetStrokes { .. } => "Change stroke",
            Self::SetPlacement { .. } => "Move",
            Self::Rename { .. } => "Rename",
            Self::SetVisible { visible: true, .. } => "Show",
            Self::SetVisible { .. } => "Hide",
            Self::SetLocked { locked: true, .. } => "Lock",
            Self::SetLocked { .. } => "Unlock",
            Self::SetFresh { .. } => "Settle",
            Self::SetDimmed { dimmed: true, .. } => "Dim",
            Self::SetDimmed { .. } => "Undim",
            Self::SetLinks { links, .. } if links.is_empty() => "Free",
            Self::SetLinks { .. } => "Follow",
            Self::SetColour { .. } => "Colour",
            Self::SetMaterial { .. } => "Material",
            Self::SetLayer { .. } => "Change layer",
            Self::SetGroup { .. } => "Change group",
            Self::AddLayer { .. } | Self::RestoreLayer { .. } => "Add layer",
            Self::RemoveLayer { .. } | Self::ForgetLayer { .. } => "Delete layer",
            Self::ReplaceLayer { .. } => "Change layer",
            Self::AddGroup { .. } | Self::RestoreGroup { .. } => "Group",
            Self::RemoveGroup { .. } | Self::ForgetGroup { .. } => "Ungroup",
            Self::ReplaceGroup { .. } => "Change group",
            Self::SetMark { op, .. } => match op {
                Some(Op::Union) => "Mark union",
                Some(Op::Intersect) => "Mark intersect",
                Some(Op::Subtract) => "Mark subtract",
                None => "Unmark",
            },
            Self::SetPending { .. } => "Change marks",
            Self::SetStep { .. } => "Set step",
            Self::Composite { name, .. } => name,
        }
    }

    /// What a later edit of the same slot overwrites wholly, without anything else depending on
    /// the order: such edits merge.
    pub(crate) fn slot(&self) -> Option<(u8, u64)> {
        Some(match self {
            Self::SetPlacement { id, .. } => (0, id.0),
            Self::SetKind { id, .. } => (1, id.0),
            Self::Rename { id, .. } => (2, id.0),
            Self::SetVisible { id, .. } => (3, id.0),
            Self::SetLocked { id, .. } => (4, id.0),
            Self::SetFresh { id, .. } => (5, id.0),
            Self::SetColour { id, .. } => (6, id.0),
            Self::SetMaterial { id, .. } => (7, id.0),
            Self::SetLayer { id, .. } => (8, id.0),
            Self::SetGroup { id, .. } => (9, id.0),
            Self::SetDimmed { id, .. } => (12, id.0),
            Self::SetLinks { id, .. } => (13, id.0),
            Self::SetPending { .. } => (10, 0),
            Self::SetStep { .. } => (11, 0),
            _ => return None,
        })
    }

    /// Calls `f` with every kind the edit brings in.
    pub(crate) fn kinds(&self, f: &mut impl FnMut(&Kind)) {
        match self {
            Self::Add { object, .. }
            | Self::Restore { object, .. }
            | Self::Replace { object, .. } => f(&object.kind),
            Self::SetKind { kind, .. } => f(kind),
            Self::SetStrokes { strokes, .. } => {
                for stroke in strokes {
                    if let Skeleton::Volume(recipe) = &stroke.skeleton {
                        f(&Kind::Solid(recipe.clone()));
                    }
                }
            }
            Self::Composite { edits, .. } => {
                for edit in edits {
                    edit.kinds(f);
                }
            }
            _ => {}
        }
    }
}
