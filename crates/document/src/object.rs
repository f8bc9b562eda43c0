use midair_field::{Node, Placement, Recipe};
use midair_mesh::{Aabb, MeshHash};
use serde::{Deserialize, Serialize};

use crate::{GroupId, LayerId};

/// One thing in the scene.
///
/// `R` is how recipes are held: by value everywhere but inside files, where each is written once
/// and referred to by its place in a list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Object<R = Recipe> {
    /// What the user calls it; need not be unique.
    pub name: String,
    /// What it is.
    pub kind: Kind<R>,
    /// Where it stands in the world.
    #[serde(default)]
    pub placement: Placement,
    /// The layer it lies on.
    #[serde(default = "base_layer")]
    pub layer: LayerId,
    /// The group it belongs to.
    #[serde(default)]
    pub group: Option<GroupId>,
    /// Whether it is drawn, as far as the object itself has a say.
    #[serde(default = "yes")]
    pub visible: bool,
    /// Whether hands pass through it.
    #[serde(default)]
    pub locked: bool,
    /// The result of the latest operation, not touched since.
    #[serde(default)]
    pub fresh: bool,
    /// Drawn faintly: what was made of it stands in its place (a stroke that became a skeleton, say).
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub dimmed: bool,
    /// The user's own colour for it.
    #[serde(default)]
    pub colour: Option<Colour>,
    /// A material by its id; the set of materials is open.
    #[serde(default)]
    pub material: Option<String>,
}

fn base_layer() -> LayerId {
    LayerId::BASE
}

fn yes() -> bool {
    true
}

impl<R> Object<R> {
    /// A visible, unlocked thing on the base layer.
    pub fn new(name: impl Into<String>, kind: Kind<R>) -> Self {
        Self {
            name: name.into(),
            kind,
            placement: Placement::IDENTITY,
            layer: LayerId::BASE,
            group: None,
            visible: true,
            locked: false,
            fresh: false,
            dimmed: false,
            colour: None,
            material: None,
        }
    }

    /// The same, standing at `placement`.
    #[must_use]
    pub fn placed(self, placement: Placement) -> Self {
        Self { placement, ..self }
    }

    pub(crate) fn map<S, E>(&self, f: &mut impl FnMut(&R) -> Result<S, E>) -> Result<Object<S>, E> {
        Ok(Object {
            name: self.name.clone(),
            kind: self.kind.map(f)?,
            placement: self.placement,
            layer: self.layer,
            group: self.group,
            visible: self.visible,
            locked: self.locked,
            fresh: self.fresh,
            dimmed: self.dimmed,
            colour: self.colour,
            material: self.material.clone(),
        })
    }
}

impl Object {
    /// A solid.
    pub fn solid(name: impl Into<String>, recipe: impl Into<Recipe>) -> Self {
        Self::new(name, Kind::Solid(recipe.into()))
    }

    /// The recipe of a solid.
    pub fn recipe(&self) -> Option<&Recipe> {
        match &self.kind {
            Kind::Solid(recipe) => Some(recipe),
            Kind::Foreign { .. } => None,
        }
    }

    /// The object as an operand: a solid's recipe, or the baked mesh of any other tool's object.
    pub fn operand(&self) -> Recipe {
        match &self.kind {
            Kind::Solid(recipe) => recipe.clone(),
            Kind::Foreign {
                tool,
                data,
                mesh,
                bounds,
            } => Recipe::new(Node::Foreign {
                tool: tool.clone(),
                data: data.clone(),
                mesh: *mesh,
                bounds: *bounds,
            }),
        }
    }
}

/// What an object is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Kind<R = Recipe> {
    /// A closed solid: its recipe is the truth.
    Solid(R),
    /// Made by a tool whose plugin may be missing: drawn from its baked mesh, its data kept as it
    /// is.
    Foreign {
        /// The tool that made it, by its id.
        tool: String,
        /// The tool's own data, opaque to everyone else.
        data: String,
        /// The mesh it last had.
        mesh: MeshHash,
        /// The mesh's box, in the object's own frame.
        bounds: Aabb,
    },
}

impl<R> Kind<R> {
    pub(crate) fn map<S, E>(&self, f: &mut impl FnMut(&R) -> Result<S, E>) -> Result<Kind<S>, E> {
        Ok(match self {
            Self::Solid(recipe) => Kind::Solid(f(recipe)?),
            Self::Foreign {
                tool,
                data,
                mesh,
                bounds,
            } => Kind::Foreign {
                tool: tool.clone(),
                data: data.clone(),
                mesh: *mesh,
                bounds: *bounds,
            },
        })
    }
}

/// An sRGB colour: red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Colour(pub [u8; 3]);

/// A layer: objects shown, hidden and locked together.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Layer {
    /// What the user calls it.
    pub name: String,
    /// Whether its objects are drawn.
    #[serde(default = "yes")]
    pub visible: bool,
    /// Whether hands pass through its objects.
    #[serde(default)]
    pub locked: bool,
}

impl Layer {
    /// A visible, unlocked layer.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            visible: true,
            locked: false,
        }
    }
}

/// A group: objects, and other groups, picked and moved as one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Group {
    /// What the user calls it.
    pub name: String,
    /// The group it lies in.
    #[serde(default)]
    pub parent: Option<GroupId>,
}
