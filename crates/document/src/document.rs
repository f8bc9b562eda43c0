use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use midair_field::{Op, Recipe};
use midair_mesh::MeshHash;
use serde::{Deserialize, Serialize};

use crate::recipes::walk;
use crate::stored::Stored;
use crate::{Edit, Group, GroupId, ImageHash, Kind, Layer, LayerId, Object, ObjectId};

/// The whole of the user's work, but for the meshes it names: a plain value.
///
/// It is compared and cloned cheaply (its parts are shared until they change) and only an [`Edit`]
/// changes it, through [`crate::History`].
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "Stored", into = "Stored")]
pub struct Document {
    pub(crate) step: f32,
    pub(crate) next_id: u64,
    pub(crate) objects: Arc<BTreeMap<ObjectId, Arc<Object>>>,
    pub(crate) layers: Arc<BTreeMap<LayerId, Layer>>,
    pub(crate) groups: Arc<BTreeMap<GroupId, Group>>,
    pub(crate) pending: Arc<Vec<(ObjectId, Op)>>,
}

impl Document {
    /// The smallest and the largest S_global, in metres.
    pub const STEPS: (f32, f32) = (0.001, 0.02);

    /// An empty document: one layer, S_global 0.01 m.
    pub fn new() -> Self {
        Self {
            step: 0.01,
            next_id: 1,
            objects: Arc::default(),
            layers: Arc::new(BTreeMap::from([(LayerId::BASE, Layer::new("Layer"))])),
            groups: Arc::default(),
            pending: Arc::default(),
        }
    }

    /// S_global, metres between the nodes of the fields that are fused (EasyVRModeling §5.3).
    pub fn step(&self) -> f32 {
        self.step
    }

    /// The id that the next object, layer or group gets.
    pub fn next_id(&self) -> u64 {
        self.next_id
    }

    /// The object of that name.
    pub fn object(&self, id: ObjectId) -> Option<&Object> {
        self.objects.get(&id).map(|o| &**o)
    }

    /// The object of that name, shared: two documents hold the same one for as long as it is
    /// unchanged, so that `Arc::ptr_eq` finds what changed.
    pub fn object_shared(&self, id: ObjectId) -> Option<&Arc<Object>> {
        self.objects.get(&id)
    }

    /// All objects, oldest first.
    pub fn objects(&self) -> impl DoubleEndedIterator<Item = (ObjectId, &Object)> {
        self.objects.iter().map(|(&id, o)| (id, &**o))
    }

    /// How many objects there are.
    pub fn len(&self) -> usize {
        self.objects.len()
    }

    /// Whether there is no object.
    pub fn is_empty(&self) -> bool {
        self.objects.is_empty()
    }

    /// The layer of that name.
    pub fn layer(&self, id: LayerId) -> Option<&Layer> {
        self.layers.get(&id)
    }

    /// All layers, oldest first.
    pub fn layers(&self) -> impl DoubleEndedIterator<Item = (LayerId, &Layer)> {
        self.layers.iter().map(|(&id, l)| (id, l))
    }

    /// The group of that name.
    pub fn group(&self, id: GroupId) -> Option<&Group> {
        self.groups.get(&id)
    }

    /// All groups, oldest first.
    pub fn groups(&self) -> impl DoubleEndedIterator<Item = (GroupId, &Group)> {
        self.groups.iter().map(|(&id, g)| (id, g))
    }

    /// The objects in a group, those of groups within it included.
    pub fn members(&self, group: GroupId) -> Vec<ObjectId> {
        self.objects()
            .filter(|(_, o)| self.groups_above(o.group).any(|g| g == group))
            .map(|(id, _)| id)
            .collect()
    }

    /// The outermost group an object lies in: what a hand picks when it touches the object.
    pub fn outermost_group(&self, id: ObjectId) -> Option<GroupId> {
        self.groups_above(self.object(id)?.group).last()
    }

    /// From a group outwards. Bounded, so that a cycle in an unchecked document cannot hang.
    pub(crate) fn groups_above(&self, from: Option<GroupId>) -> impl Iterator<Item = GroupId> {
        std::iter::successors(from, |g| self.groups.get(g)?.parent).take(self.groups.len() + 1)
    }

    /// The operands marked for the next fusion, in the order they were marked.
    pub fn pending(&self) -> &[(ObjectId, Op)] {
        &self.pending
    }

    /// An object's place in the marked sequence and its operator.
    pub fn mark(&self, id: ObjectId) -> Option<(usize, Op)> {
        let at = self.pending.iter().position(|&(o, _)| o == id)?;
        Some((at, self.pending[at].1))
    }

    /// Whether an object is drawn: it and its layer are visible.
    pub fn is_visible(&self, id: ObjectId) -> bool {
        self.object(id)
            .is_some_and(|o| o.visible && self.layer(o.layer).is_none_or(|l| l.visible))
    }

    /// Whether hands pass through an object: it or its layer is locked.
    pub fn is_locked(&self, id: ObjectId) -> bool {
        self.object(id)
            .is_some_and(|o| o.locked || self.layer(o.layer).is_some_and(|l| l.locked))
    }

    /// The meshes the document needs.
    pub fn meshes(&self) -> BTreeSet<MeshHash> {
        let mut meshes = BTreeSet::new();
        let mut seen = Default::default();
        for object in self.objects.values() {
            meshes_of(&object.kind, &mut seen, &mut meshes);
        }
        meshes
    }

    /// The pictures the document needs.
    pub fn images(&self) -> BTreeSet<ImageHash> {
        let of = |object: &Arc<Object>| Some(object.reference()?.image);
        self.objects.values().filter_map(of).collect()
    }

    /// The edit that puts `members` into a new group of its own, inside the group they share.
    pub fn group_edit(&self, name: impl Into<String>, members: &[ObjectId]) -> Edit {
        let id = GroupId(self.next_id);
        let mut shared = members
            .iter()
            .map(|&m| self.object(m).and_then(|o| o.group));
        let parent = shared.next().flatten();
        let parent = parent.filter(|_| shared.all(|g| g == parent));
        let group = Group {
            name: name.into(),
            parent,
        };
        let mut edits = vec![Edit::AddGroup { id, group }];
        edits.extend(members.iter().map(|&member| Edit::SetGroup {
            id: member,
            group: Some(id),
        }));
        Edit::Composite {
            name: "Group".into(),
            edits,
        }
    }

    /// The edit that dissolves a group: what lay in it lies where the group lay.
    pub fn ungroup_edit(&self, id: GroupId) -> Edit {
        let parent = self.group(id).and_then(|g| g.parent);
        let objects = self.objects().filter(|(_, o)| o.group == Some(id));
        let groups = self.groups().filter(|(_, g)| g.parent == Some(id));
        let mut edits: Vec<Edit> = objects
            .map(|(id, _)| Edit::SetGroup { id, group: parent })
            .collect();
        edits.extend(groups.map(|(id, g)| {
            let group = Group {
                parent,
                ..g.clone()
            };
            Edit::ReplaceGroup { id, group }
        }));
        edits.push(Edit::RemoveGroup { id });
        Edit::Composite {
            name: "Ungroup".into(),
            edits,
        }
    }

    /// A name for this state: BLAKE3 of the bytes it is saved as.
    pub fn content_hash(&self) -> [u8; 32] {
        *blake3::hash(self.to_ron().as_bytes()).as_bytes()
    }

    /// Whether nothing the user can see differs; the counter of ids does not take part.
    pub(crate) fn looks_like(&self, other: &Self) -> bool {
        fn same<T: PartialEq>(a: &Arc<T>, b: &Arc<T>) -> bool {
            Arc::ptr_eq(a, b) || a == b
        }
        let objects = Arc::ptr_eq(&self.objects, &other.objects)
            || self.objects.len() == other.objects.len()
                && self
                    .objects
                    .iter()
                    .zip(other.objects.iter())
                    .all(|((a, x), (b, y))| a == b && same(x, y));
        objects
            && self.step == other.step
            && same(&self.layers, &other.layers)
            && same(&self.groups, &other.groups)
            && same(&self.pending, &other.pending)
    }
}

impl PartialEq for Document {
    fn eq(&self, other: &Self) -> bool {
        self.next_id == other.next_id && self.looks_like(other)
    }
}

impl Default for Document {
    fn default() -> Self {
        Self::new()
    }
}

/// The meshes an object of this kind needs; recipes in `seen` are not walked again.
pub(crate) fn meshes_of(
    kind: &Kind,
    seen: &mut std::collections::HashSet<midair_field::RecipeHash>,
    meshes: &mut BTreeSet<MeshHash>,
) {
    use midair_field::Node;
    match kind {
        Kind::Foreign { mesh, .. } => {
            meshes.insert(*mesh);
        }
        Kind::Solid(recipe) | Kind::Sheet(recipe) => walk(recipe, seen, &mut |r: &Recipe| {
            if let Node::Mesh { mesh, .. } | Node::Foreign { mesh, .. } = r.node() {
                meshes.insert(*mesh);
            }
        }),
        Kind::Reference(_) => {}
        Kind::Line(_) | Kind::Stroke(_) => {}
    }
}
