use std::cell::Cell;
use std::collections::{BTreeSet, HashSet};
use std::convert::Infallible;
use std::fmt;
use std::sync::Arc;

use glam::{Affine3A, Vec3};
use midair_mesh::{Aabb, MeshHash};
use midair_swept::{Row, Sweep, SweepError};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use thiserror::Error;

use crate::{Canvas, CanvasError, Placement, Primitive, PrimitiveError, RecipeHash};

/// How an operand joins what stands to its left (EasyVRModeling §5.3 Eq. 7).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Op {
    /// min(φ₁, φ₂).
    Union,
    /// max(φ₁, φ₂).
    Intersect,
    /// max(φ₁, −φ₂).
    Subtract,
}

/// One member of a boolean sequence, held by value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Operand {
    /// How it joins; that of the first that is not muted is ignored.
    pub op: Op,
    /// Where it stands in the solid's own frame.
    #[serde(default)]
    pub placement: Placement,
    /// What it is.
    pub recipe: Recipe,
    /// It is kept but left out: the solid is the one without it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub muted: bool,
}

/// What a recipe is made of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Node {
    /// An exact primitive.
    Primitive(Primitive),
    /// An imported mesh, named by the hash of its content; evaluated through a grid baked per
    /// (mesh, step).
    Mesh {
        /// Which mesh; the document or the library holds it.
        mesh: MeshHash,
        /// Its box, so that extents are known without the mesh.
        bounds: Aabb,
    },
    /// Operands read left to right: ((A ∘ B) ∘ C) ∘ D.
    Solid(Vec<Operand>),
    /// A named library component: the same solid as `recipe`.
    Component {
        /// Its id in the library, never renamed.
        id: String,
        /// What it is, by value: the shape survives a library that lost it.
        recipe: Recipe,
    },
    /// Strokes that melt into one surface.
    Canvas(Canvas),
    /// A curve dragged through space, closed by a thickness or by caps; evaluated as a mesh that is
    /// baked.
    Sweep(Sweep),
    /// The same solid many times over, united: one operand.
    Clones {
        /// Where they stand.
        row: Row,
        /// What stands there.
        recipe: Recipe,
    },
    /// Made by a plugin that may be missing: evaluated through its baked mesh, its data untouched.
    Foreign {
        /// The tool that made it.
        tool: String,
        /// The tool's own data, opaque to everyone else.
        data: String,
        /// The mesh it last had.
        mesh: MeshHash,
        /// The mesh's box.
        bounds: Aabb,
    },
}

/// No recipe nests deeper than this, so that reading and walking one cannot exhaust the stack.
pub const MAX_DEPTH: u32 = 64;

/// The most operands one solid may have.
pub const MAX_OPERANDS: usize = 16_384;

/// Why a recipe is not sound; one line for the person whose file it is in.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum RecipeError {
    /// A primitive with impossible numbers.
    #[error(transparent)]
    Primitive(#[from] PrimitiveError),
    /// A painting with impossible numbers.
    #[error(transparent)]
    Canvas(#[from] CanvasError),
    /// A sweep or a row of clones that cannot be.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// An operand that stands nowhere.
    #[error(
        "operand {0} has a placement that is not finite, not a unit rotation, or scaled by zero"
    )]
    Placement(usize),
    /// A box that is not finite.
    #[error("mesh {0} has bounds that are empty or not finite")]
    Bounds(MeshHash),
    /// Too many operands side by side.
    #[error("a solid of {0} operands; at most {MAX_OPERANDS} are possible, so group them")]
    TooManyOperands(usize),
    /// Too many solids within solids.
    #[error("solids are nested more than {MAX_DEPTH} deep; fuse some into one first")]
    TooDeep,
}

/// An immutable solid, named by the hash of its content. Cheap to clone.
#[derive(Clone)]
pub struct Recipe(Arc<Inner>);

struct Inner {
    node: Node,
    hash: RecipeHash,
    bounds: Aabb,
    depth: u32,
    leaves: u64,
}

impl Recipe {
    /// Wraps a node and names it. Unsound numbers are kept as they are; [`Recipe::validate`] and
    /// compilation report them.
    pub fn new(node: Node) -> Self {
        let (mut depth, mut leaves) = (0, 1);
        match &node {
            Node::Solid(operands) => {
                depth = operands.iter().map(|o| o.recipe.depth()).max().unwrap_or(0);
                let each = operands.iter().map(|o| o.recipe.leaves());
                leaves = each.fold(0, u64::saturating_add);
            }
            Node::Component { recipe, .. } => (depth, leaves) = (recipe.depth(), recipe.leaves()),
            Node::Canvas(canvas) => {
                depth = canvas.recipes().map(Recipe::depth).max().unwrap_or(0);
                let each = canvas.recipes().map(Recipe::leaves);
                leaves = each.fold(1, u64::saturating_add);
            }
            Node::Clones { row, recipe } => {
                depth = recipe.depth();
                leaves = recipe.leaves().saturating_mul(row.len() as u64);
            }
            Node::Primitive(_) | Node::Mesh { .. } | Node::Foreign { .. } | Node::Sweep(_) => {}
        }
        Self(Arc::new(Inner {
            hash: RecipeHash::of(&node),
            bounds: bounds_of(&node),
            depth: depth.saturating_add(1),
            leaves,
            node,
        }))
    }

    /// As [`Recipe::new`], checked.
    ///
    /// # Errors
    /// What [`Recipe::validate`] reports.
    pub fn checked(node: Node) -> Result<Self, RecipeError> {
        let recipe = Self::new(node);
        recipe.validate().map(|()| recipe)
    }

    /// The same solid standing elsewhere in its frame: one placed operand; itself where nothing changes.
    pub fn placed(&self, placement: Placement) -> Self {
        if placement == Placement::IDENTITY {
            return self.clone();
        }
        Self::new(Node::Solid(vec![Operand {
            op: Op::Union,
            placement,
            recipe: self.clone(),
            muted: false,
        }]))
    }

    /// What it is made of.
    pub fn node(&self) -> &Node {
        &self.0.node
    }

    /// Its name.
    pub fn hash(&self) -> RecipeHash {
        self.0.hash
    }

    /// A box around the solid in its own frame, in metres: the restricted region of
    /// EasyVRModeling §5.3 Eq. 8. [`Aabb::EMPTY`] where nothing can be left.
    pub fn bounds(&self) -> Aabb {
        self.0.bounds
    }

    /// How many recipes lie within each other, itself included: 1 for a primitive.
    pub fn depth(&self) -> u32 {
        self.0.depth
    }

    /// How many primitives and meshes it is made of, each use counted.
    pub fn leaves(&self) -> u64 {
        self.0.leaves
    }

    /// The meshes it needs, each once, in the order of their hashes.
    pub fn meshes(&self) -> Vec<MeshHash> {
        let mut found = BTreeSet::new();
        self.visit(&mut |node| {
            if let Node::Mesh { mesh, .. } | Node::Foreign { mesh, .. } = node {
                found.insert(*mesh);
            }
            Ok::<_, Infallible>(())
        })
        .unwrap_or_else(|never| match never {});
        found.into_iter().collect()
    }

    /// Whether every number in it makes sense and its size is within limits.
    ///
    /// # Errors
    /// The first thing that is not so.
    pub fn validate(&self) -> Result<(), RecipeError> {
        if self.depth() > MAX_DEPTH {
            return Err(RecipeError::TooDeep);
        }
        self.visit(&mut check)
    }

    /// Calls `f` once for each different recipe in the tree.
    fn visit<E>(&self, f: &mut impl FnMut(&Node) -> Result<(), E>) -> Result<(), E> {
        let mut seen = HashSet::new();
        let mut rest = vec![self];
        while let Some(recipe) = rest.pop() {
            if seen.insert(recipe.hash()) {
                f(recipe.node())?;
                match recipe.node() {
                    Node::Solid(operands) => rest.extend(operands.iter().map(|o| &o.recipe)),
                    Node::Component { recipe, .. } | Node::Clones { recipe, .. } => {
                        rest.push(recipe);
                    }
                    Node::Canvas(canvas) => rest.extend(canvas.recipes()),
                    _ => {}
                }
            }
        }
        Ok(())
    }
}

/// What one node says about itself, its children aside.
fn check(node: &Node) -> Result<(), RecipeError> {
    match node {
        Node::Primitive(p) => Ok(p.validate()?),
        Node::Mesh { mesh, bounds } | Node::Foreign { mesh, bounds, .. } => {
            let sound = bounds.min.is_finite() && bounds.max.is_finite() && !bounds.is_empty();
            sound.then_some(()).ok_or(RecipeError::Bounds(*mesh))
        }
        Node::Solid(operands) if operands.len() > MAX_OPERANDS => {
            Err(RecipeError::TooManyOperands(operands.len()))
        }
        Node::Solid(operands) => match operands.iter().position(|o| !o.placement.is_sound()) {
            Some(i) => Err(RecipeError::Placement(i + 1)),
            None => Ok(()),
        },
        Node::Canvas(canvas) => Ok(canvas.validate()?),
        // Open ones are recipes too, and are refused where a solid is made of them.
        Node::Sweep(sweep) => Ok(sweep.validate()?),
        Node::Clones { row, .. } => Ok(row.validate()?),
        Node::Component { .. } => Ok(()),
    }
}

fn bounds_of(node: &Node) -> Aabb {
    match node {
        Node::Primitive(p) => p.bounds(),
        Node::Mesh { bounds, .. } | Node::Foreign { bounds, .. } => *bounds,
        Node::Component { recipe, .. } => recipe.bounds(),
        Node::Canvas(canvas) => canvas.bounds(),
        Node::Sweep(sweep) => sweep.bounds(),
        Node::Clones { row, recipe } => {
            let own = recipe.bounds();
            let each = row.places();
            let each = each
                .iter()
                .map(|p| transformed(&own, &Placement::from(p).affine()));
            each.fold(Aabb::EMPTY, |all, b| all.union(&b))
        }
        Node::Solid(operands) => {
            let placed = operands
                .iter()
                .filter(|o| !o.muted)
                .map(|o| (o.op, transformed(&o.recipe.bounds(), &o.placement.affine())));
            restricted(placed)
        }
    }
}

/// The region a sequence can fill: union D₁ ∪ D₂, intersect D₁ ∩ D₂, subtract D₁ (Eq. 8).
pub(crate) fn restricted(parts: impl Iterator<Item = (Op, Aabb)>) -> Aabb {
    let mut all: Option<Aabb> = None;
    for (op, b) in parts {
        all = Some(match (all, op) {
            (None, _) => b,
            (Some(a), Op::Union) => a.union(&b),
            (Some(a), Op::Intersect) => a.intersection(&b),
            (Some(a), Op::Subtract) => a,
        });
    }
    match all {
        Some(b) if !b.is_empty() => b,
        _ => Aabb::EMPTY,
    }
}

/// The box around a transformed box.
pub(crate) fn transformed(b: &Aabb, by: &Affine3A) -> Aabb {
    if b.is_empty() {
        return Aabb::EMPTY;
    }
    let centre = by.transform_point3(b.centre());
    let m = by.matrix3;
    let half = 0.5 * b.size();
    let half = Vec3::from(m.x_axis.abs()) * half.x
        + Vec3::from(m.y_axis.abs()) * half.y
        + Vec3::from(m.z_axis.abs()) * half.z;
    // Rounding must not lose a hair of the solid.
    let slack = 1.0e-6 * (centre.abs() + half).max_element();
    Aabb::around(centre, half).grown(slack)
}

impl From<Primitive> for Recipe {
    fn from(p: Primitive) -> Self {
        Self::new(Node::Primitive(p))
    }
}

impl PartialEq for Recipe {
    fn eq(&self, other: &Self) -> bool {
        self.0.hash == other.0.hash
    }
}

impl fmt::Debug for Recipe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.node.fmt(f)
    }
}

impl Serialize for Recipe {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        self.0.node.serialize(s)
    }
}

thread_local! {
    /// How many recipes are being read within each other on this thread.
    static READING: Cell<u32> = const { Cell::new(0) };
}

struct Deeper;

impl Deeper {
    fn enter() -> Option<Self> {
        READING.with(|r| {
            (r.get() < MAX_DEPTH).then(|| {
                r.set(r.get() + 1);
                Self
            })
        })
    }
}

impl Drop for Deeper {
    fn drop(&mut self) {
        READING.with(|r| r.set(r.get() - 1));
    }
}

/// Refuses what [`Recipe::validate`] refuses, while reading: nesting cannot exhaust the stack.
impl<'de> Deserialize<'de> for Recipe {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        let _deeper = Deeper::enter().ok_or_else(|| D::Error::custom(RecipeError::TooDeep))?;
        let node = Node::deserialize(d)?;
        check(&node).map_err(D::Error::custom)?;
        Ok(Self::new(node))
    }
}
