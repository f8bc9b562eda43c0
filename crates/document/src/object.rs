use std::collections::BTreeMap;
use std::sync::Arc;

use midair_field::{Node, Placement, Recipe, Sweep};
use midair_mesh::{Aabb, MeshHash};
use serde::{Deserialize, Serialize};

use crate::drawing::{ConstructionLine, DrawnStroke, around};
use crate::{GroupId, ImageHash, LayerId, ObjectId};

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
    /// What is set of the material, by the names it has for it; what is missing here is as usual.
    #[serde(default, skip_serializing_if = "Dials::is_empty")]
    pub dials: Dials,
    /// What its shape follows, beside the shape it has now.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub links: Vec<Link>,
}

/// A part of an object follows another object: a sweep its rail, a skeleton its stroke. The shape is as
/// it last came to be; where the source is gone it stays so. Whoever made the link brings it after
/// its source, in the step that changes that.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Link {
    /// What it follows; it may be gone.
    pub source: ObjectId,
    /// Which part follows, as the tool counts that made it.
    pub part: u32,
}

/// What a person sets of a material: numbers by name.
pub type Dials = BTreeMap<String, f32>;

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
            dials: Dials::new(),
            links: Vec::new(),
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
            dials: self.dials.clone(),
            links: self.links.clone(),
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
            _ => None,
        }
    }

    /// The open sweep that it is.
    pub fn sheet(&self) -> Option<&Sweep> {
        self.sweep().filter(|_| matches!(self.kind, Kind::Sheet(_)))
    }

    /// The sweep that it is, open or closed.
    pub fn sweep(&self) -> Option<&Sweep> {
        match self.shown()?.node() {
            Node::Sweep(sweep) => Some(sweep),
            _ => None,
        }
    }

    /// What is drawn of it: a solid's recipe, or that of an open sweep.
    pub fn shown(&self) -> Option<&Recipe> {
        match &self.kind {
            Kind::Solid(recipe) | Kind::Sheet(recipe) => Some(recipe),
            _ => None,
        }
    }

    /// The construction line that it is.
    pub fn line(&self) -> Option<&ConstructionLine> {
        match &self.kind {
            Kind::Line(line) => Some(line),
            _ => None,
        }
    }

    /// The stroke that it is.
    pub fn stroke(&self) -> Option<&DrawnStroke> {
        match &self.kind {
            Kind::Stroke(stroke) => Some(stroke),
            _ => None,
        }
    }

    /// The object as an operand: a solid's recipe, or the baked mesh of any other tool's object.
    /// Nothing for what is not closed.
    pub fn operand(&self) -> Option<Recipe> {
        match &self.kind {
            Kind::Solid(recipe) => Some(recipe.clone()),
            Kind::Foreign {
                tool,
                data,
                mesh,
                bounds,
            } => Some(Recipe::new(Node::Foreign {
                tool: tool.clone(),
                data: data.clone(),
                mesh: *mesh,
                bounds: *bounds,
            })),
            _ => None,
        }
    }

    /// The picture that a reference image shows.
    pub fn reference(&self) -> Option<&Reference> {
        match &self.kind {
            Kind::Reference(reference) => Some(reference),
            _ => None,
        }
    }

    /// The object's box in its own frame, before its scale: metres.
    pub fn bounds(&self) -> Aabb {
        match &self.kind {
            Kind::Solid(recipe) | Kind::Sheet(recipe) => recipe.bounds(),
            Kind::Foreign { bounds, .. } => *bounds,
            Kind::Reference(reference) => reference.bounds(),
            Kind::Line(line) => around(line.ends(), 0.0),
            Kind::Stroke(stroke) => around(stroke.points(), 0.5 * stroke.width),
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
    /// A picture to work from: seen, and part of nothing.
    Reference(Reference),
    /// A straight construction line (ScaffoldSketch §3.2).
    Line(ConstructionLine),
    /// A shape stroke: a curve, drawn as a tube.
    Stroke(Arc<DrawnStroke>),
    /// A sweep that is open, a surface without inside: a recipe of one [`Node::Sweep`], which is no
    /// operand until it is closed.
    Sheet(R),
}

/// A picture that stands in the room to work from. It lies in the x and y of its own frame, its
/// middle at the origin, and is seen from both sides.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// The picture file, by its content.
    pub image: ImageHash,
    /// Width and height in metres, before the object's scale.
    pub size: [f32; 2],
    /// 0 for a picture that is not seen, 1 for one that nothing is seen through.
    #[serde(default = "opaque")]
    pub opacity: f32,
}

fn opaque() -> f32 {
    1.0
}

impl Reference {
    /// How wide and high a picture may be, in metres.
    pub const SIZES: (f32, f32) = (0.001, 100.0);

    /// Whether its numbers are a picture's.
    pub fn is_sound(&self) -> bool {
        let (least, most) = Self::SIZES;
        self.size.iter().all(|s| (least..=most).contains(s)) && (0.0..=1.0).contains(&self.opacity)
    }

    /// The same picture at another width, its height in proportion; both within [`Self::SIZES`].
    #[must_use]
    pub fn at_width(self, width: f32) -> Self {
        let (least, most) = Self::SIZES;
        let [w, h] = self.size;
        let factor = (width / w).clamp(least / w.min(h), most / w.max(h));
        // A width that is no number leaves it as it is.
        let factor = if factor.is_finite() { factor } else { 1.0 };
        let size = self.size.map(|s| (s * factor).clamp(least, most));
        Self { size, ..self }
    }

    /// Its box: without thickness.
    pub fn bounds(&self) -> Aabb {
        let half = glam::Vec3::new(0.5 * self.size[0], 0.5 * self.size[1], 0.0);
        Aabb {
            min: -half,
            max: half,
        }
    }
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
            Self::Reference(reference) => Kind::Reference(*reference),
            Self::Line(line) => Kind::Line(line.clone()),
            Self::Stroke(stroke) => Kind::Stroke(stroke.clone()),
            Self::Sheet(recipe) => Kind::Sheet(f(recipe)?),
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
