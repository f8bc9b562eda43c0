use std::collections::{HashMap, HashSet};

use midair_field::{
    Canvas, CanvasError, MAX_DEPTH, MAX_LEAVES, MAX_OPERANDS, Node, Op, Operand, Placement,
    Primitive, PrimitiveError, Recipe, RecipeHash, Row, Stroke, Sweep, SweepError,
};
use midair_mesh::{Aabb, MeshHash};
use serde::{Deserialize, Serialize};

/// Visits every recipe in `recipe` once, parts before the whole.
pub(crate) fn walk(
    recipe: &Recipe,
    seen: &mut HashSet<RecipeHash>,
    visit: &mut impl FnMut(&Recipe),
) {
    if !seen.insert(recipe.hash()) {
        return;
    }
    match recipe.node() {
        Node::Solid(operands) => {
            for operand in operands {
                walk(&operand.recipe, seen, visit);
            }
        }
        Node::Component { recipe, .. } | Node::Clones { recipe, .. } => walk(recipe, seen, visit),
        Node::Canvas(canvas) => canvas.recipes().for_each(|r| walk(r, seen, visit)),
        Node::Primitive(_) | Node::Mesh { .. } | Node::Foreign { .. } | Node::Sweep(_) => {}
    }
    visit(recipe);
}

/// Why a recipe cannot be part of a document.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RecipeFault {
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
    #[error("operand {0} stands nowhere: its placement is not finite, or a scale is zero")]
    Placement(usize),
    /// A surface that is no sweep.
    #[error("a surface without inside must be a sweep")]
    NoSweep,
    /// A mesh whose box is not finite.
    #[error("a mesh has a box that is not finite")]
    Bounds,
    /// Deeper than a recipe may be.
    #[error("solids lie within solids more than {MAX_DEPTH} deep")]
    Depth,
    /// More operands than one solid may have, or than can be evaluated in all.
    #[error("it has too many operands ({0})")]
    Operands(u64),
}

/// Whether a recipe's numbers are sound and its size is bounded. Parts in `sound` are known to be.
///
/// # Errors
/// The first fault found.
pub(crate) fn check_recipe(
    recipe: &Recipe,
    sound: &mut HashSet<RecipeHash>,
) -> Result<(), RecipeFault> {
    check_size(recipe)?;
    let mut found = Ok(());
    walk(recipe, sound, &mut |part| {
        if found.is_ok() {
            found = check_node(part.node());
        }
    });
    found
}

/// Whether a recipe is one sweep with sound numbers, open or not.
///
/// # Errors
/// The first fault found.
pub(crate) fn check_sheet(recipe: &Recipe) -> Result<(), RecipeFault> {
    match recipe.node() {
        Node::Sweep(sweep) => Ok(sweep.validate()?),
        _ => Err(RecipeFault::NoSweep),
    }
}

fn check_size(recipe: &Recipe) -> Result<(), RecipeFault> {
    if recipe.depth() > MAX_DEPTH {
        return Err(RecipeFault::Depth);
    }
    // A row that stands by itself is drawn and never evaluated: only what is cloned counts.
    let leaves = match recipe.node() {
        Node::Clones { recipe, .. } => recipe.leaves(),
        _ => recipe.leaves(),
    };
    if leaves > MAX_LEAVES {
        return Err(RecipeFault::Operands(leaves));
    }
    Ok(())
}

fn check_node(node: &Node) -> Result<(), RecipeFault> {
    match node {
        Node::Primitive(p) => Ok(p.validate()?),
        Node::Mesh { bounds, .. } | Node::Foreign { bounds, .. } => {
            let sound = is_box(bounds) && !bounds.is_empty();
            sound.then_some(()).ok_or(RecipeFault::Bounds)
        }
        Node::Component { .. } => Ok(()),
        Node::Canvas(canvas) => Ok(canvas.validate()?),
        Node::Sweep(sweep) => {
            sweep.validate()?;
            let closed = sweep.is_closed();
            Ok(closed.then_some(()).ok_or(SweepError::Open)?)
        }
        Node::Clones { row, .. } => Ok(row.validate()?),
        Node::Solid(operands) if operands.len() > MAX_OPERANDS => {
            Err(RecipeFault::Operands(operands.len() as u64))
        }
        Node::Solid(operands) => match operands.iter().position(|o| !o.placement.is_sound()) {
            Some(at) => Err(RecipeFault::Placement(at + 1)),
            None => Ok(()),
        },
    }
}

/// A box between finite corners, or [`Aabb::EMPTY`].
pub(crate) fn is_box(b: &Aabb) -> bool {
    *b == Aabb::EMPTY || b.min.is_finite() && b.max.is_finite()
}

/// A recipe's place in a [`RecipeTable`].
pub(crate) type RecipeIndex = u32;

/// Recipes as they are written: each distinct one once, its parts before it and named by their
/// place. A solid fused with itself thirty times over stays thirty entries, and no file can nest.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct RecipeTable {
    nodes: Vec<StoredNode>,
    #[serde(skip)]
    known: HashMap<RecipeHash, RecipeIndex>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
enum StoredNode {
    Primitive(Primitive),
    Mesh {
        mesh: MeshHash,
        bounds: Aabb,
    },
    Solid(Vec<StoredOperand>),
    Component {
        id: String,
        recipe: RecipeIndex,
    },
    /// The strokes, and the recipe that each volume among them is, in their order; in the strokes
    /// themselves an empty solid stands for it.
    Canvas {
        canvas: Canvas,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        volumes: Vec<RecipeIndex>,
    },
    Sweep(Sweep),
    Clones {
        row: Row,
        recipe: RecipeIndex,
    },
    Foreign {
        tool: String,
        data: String,
        mesh: MeshHash,
        bounds: Aabb,
    },
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct StoredOperand {
    op: Op,
    #[serde(default)]
    placement: Placement,
    recipe: RecipeIndex,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    muted: bool,
}

impl RecipeTable {
    /// A recipe's place, entered with its parts where it is new.
    pub(crate) fn enter(&mut self, recipe: &Recipe) -> RecipeIndex {
        if let Some(&at) = self.known.get(&recipe.hash()) {
            return at;
        }
        let node = match recipe.node() {
            Node::Primitive(p) => StoredNode::Primitive(p.clone()),
            Node::Mesh { mesh, bounds } => StoredNode::Mesh {
                mesh: *mesh,
                bounds: *bounds,
            },
            Node::Solid(operands) => StoredNode::Solid(
                operands
                    .iter()
                    .map(|o| StoredOperand {
                        op: o.op,
                        placement: o.placement,
                        recipe: self.enter(&o.recipe),
                        muted: o.muted,
                    })
                    .collect(),
            ),
            Node::Component { id, recipe } => StoredNode::Component {
                id: id.clone(),
                recipe: self.enter(recipe),
            },
            Node::Canvas(canvas) => {
                let volumes: Vec<_> = canvas.recipes().map(|r| self.enter(r)).collect();
                StoredNode::Canvas {
                    canvas: if volumes.is_empty() {
                        canvas.clone()
                    } else {
                        with_volumes(canvas, || {
                            Ok::<_, TableError>(Recipe::new(Node::Solid(Vec::new())))
                        })
                        .unwrap_or_default()
                    },
                    volumes,
                }
            }
            Node::Sweep(sweep) => StoredNode::Sweep(sweep.clone()),
            Node::Clones { row, recipe } => StoredNode::Clones {
                row: row.clone(),
                recipe: self.enter(recipe),
            },
            Node::Foreign {
                tool,
                data,
                mesh,
                bounds,
            } => StoredNode::Foreign {
                tool: tool.clone(),
                data: data.clone(),
                mesh: *mesh,
                bounds: *bounds,
            },
        };
        let at = self.nodes.len() as RecipeIndex;
        self.nodes.push(node);
        self.known.insert(recipe.hash(), at);
        at
    }

    /// The recipes, in the order of the table.
    ///
    /// # Errors
    /// A part that does not stand before its whole, or one that is too large.
    pub(crate) fn build(self) -> Result<Vec<Recipe>, TableError> {
        let mut built: Vec<Recipe> = Vec::with_capacity(self.nodes.len());
        for (at, node) in self.nodes.into_iter().enumerate() {
            let part = |i: RecipeIndex| {
                built
                    .get(i as usize)
                    .cloned()
                    .ok_or(TableError::Order { at, part: i })
            };
            let recipe = Recipe::new(match node {
                StoredNode::Primitive(p) => Node::Primitive(p),
                StoredNode::Mesh { mesh, bounds } => Node::Mesh { mesh, bounds },
                StoredNode::Solid(operands) => Node::Solid(
                    operands
                        .into_iter()
                        .map(|o| {
                            Ok(Operand {
                                op: o.op,
                                placement: o.placement,
                                recipe: part(o.recipe)?,
                                muted: o.muted,
                            })
                        })
                        .collect::<Result<_, TableError>>()?,
                ),
                StoredNode::Component { id, recipe } => Node::Component {
                    id,
                    recipe: part(recipe)?,
                },
                StoredNode::Canvas { canvas, volumes } => {
                    let mut volumes = volumes.into_iter();
                    let mut next = || {
                        let i = volumes.next().ok_or(TableError::Volumes(at))?;
                        part(i)
                    };
                    Node::Canvas(with_volumes(&canvas, &mut next)?)
                }
                StoredNode::Sweep(sweep) => Node::Sweep(sweep),
                StoredNode::Clones { row, recipe } => Node::Clones {
                    row,
                    recipe: part(recipe)?,
                },
                StoredNode::Foreign {
                    tool,
                    data,
                    mesh,
                    bounds,
                } => Node::Foreign {
                    tool,
                    data,
                    mesh,
                    bounds,
                },
            });
            // At each step, so that none ever is too deep to be walked or dropped.
            check_size(&recipe).map_err(|fault| TableError::Fault { at, fault })?;
            built.push(recipe);
        }
        Ok(built)
    }
}

/// A canvas with other solids in the place of its volumes, one after the other.
fn with_volumes<E>(
    canvas: &Canvas,
    mut next: impl FnMut() -> Result<Recipe, E>,
) -> Result<Canvas, E> {
    let one = |stroke: &Stroke| stroke.map(&mut |_| next());
    Ok(Canvas {
        strokes: canvas.strokes.iter().map(one).collect::<Result<_, E>>()?,
        ..*canvas
    })
}

/// Why a list of recipes cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// A recipe names one that does not stand before it.
    #[error("recipe {at} names recipe {part}, which does not stand before it")]
    Order {
        /// The recipe's place, from 0.
        at: usize,
        /// The place it names.
        part: u32,
    },
    /// A painting with fewer solids than strokes that are one.
    #[error("recipe {0} is a painting whose volumes are not all named")]
    Volumes(usize),
    /// A recipe that is too large.
    #[error("recipe {at}: {fault}")]
    Fault {
        /// The recipe's place, from 0.
        at: usize,
        /// What is wrong.
        fault: RecipeFault,
    },
    /// An object names a recipe that is not in the list.
    #[error("an object names recipe {0}, which is not in the list")]
    Missing(u32),
}

pub(crate) fn look_up(recipes: &[Recipe], at: RecipeIndex) -> Result<Recipe, TableError> {
    recipes
        .get(at as usize)
        .cloned()
        .ok_or(TableError::Missing(at))
}
