use std::f32::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

use glam::{Affine3A, DMat3, Mat3A, Vec3};
use midair_mesh::{Aabb, MeshHash, TriMesh};
use midair_swept::{Sweep, SweepError};
use rustc_hash::FxHashMap;
use thiserror::Error;

use crate::bake::{BakeOptions, Progress, Volume, bake};
use crate::canvas::{Bench, Canvas, Painting};
use crate::leaf::{Leaf, Source};
use crate::recipe::{restricted, transformed};
use crate::shape::Shape;
use crate::stretch::stretched;
use crate::{Node, Op, Operand, Placement, Primitive, PrimitiveError, Recipe, RecipeError};

mod point;

pub use point::{Part, TOGETHER};

/// The most primitives and meshes one program may have.
pub const MAX_LEAVES: u64 = 65_536;

/// Where a program finds the meshes a recipe names.
pub trait MeshSource: Sync {
    /// The mesh's baked distance, with nodes no further apart than `local_step` metres in the
    /// mesh's own frame; `None` where the mesh is not known.
    fn volume(&self, mesh: &MeshHash, local_step: f32) -> Option<Arc<Volume>>;

    /// The same for a mesh that follows from a recipe, under the recipe's name: `make` is called
    /// where it is not kept. `None` where it cannot be baked, or the work was given up.
    fn baked(
        &self,
        name: &MeshHash,
        local_step: f32,
        make: &dyn Fn() -> TriMesh,
    ) -> Option<Arc<Volume>> {
        let _ = name;
        let options = BakeOptions::with_step(local_step);
        bake(&make(), &options, &Progress::new()).ok().map(Arc::new)
    }
}

/// A source without meshes, for recipes of primitives alone.
impl MeshSource for () {
    fn volume(&self, _: &MeshHash, _: f32) -> Option<Arc<Volume>> {
        None
    }
}

/// The step at which a mesh scaled by at most `scale` is baked, so that its nodes stand no further
/// apart than `step` in the world: 0.01·2^(−k/2) metres with k from 0 to 12, so that steps and scales
/// that are much alike share one volume (0.01 is S_local of EasyVRModeling §5.2).
pub fn local_step(step: f32, scale: f32) -> f32 {
    // A thousandth of slack: 0.005 asked for is 0.005 given, whatever the rounding.
    let wanted = step / scale * 1.001;
    let mut local = 0.01;
    for _ in 0..6 {
        if local <= wanted {
            return local;
        }
        // Between two halvings: half as many bricks at a surface as the finer one.
        let between = local * FRAC_1_SQRT_2;
        if between <= wanted {
            return between;
        }
        local *= 0.5;
    }
    local
}

/// Why a recipe cannot be evaluated.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CompileError {
    /// The recipe is unsound.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// A mesh that nobody has.
    #[error("mesh {0} is missing; import it again or delete what uses it")]
    MissingMesh(MeshHash),
    /// A sweep that encloses nothing.
    #[error("a sweep in it is no solid: {0}")]
    Sweep(#[from] SweepError),
    /// A sweep too large for its step.
    #[error("a sweep in it is too large for its step; choose a larger step")]
    TooLarge,
    /// More leaves than can be evaluated.
    #[error("the solid has {0} parts; at most {MAX_LEAVES} are possible")]
    TooManyLeaves(u64),
    /// A thing scaled to nothing, beyond all measure, or moved out of reach.
    #[error("a part is placed or scaled beyond what can be evaluated; bring its scale nearer to 1")]
    Scale,
    /// A step that is not a positive number.
    #[error("a step of {0} metres is not possible")]
    Step(f32),
}

impl From<PrimitiveError> for CompileError {
    fn from(e: PrimitiveError) -> Self {
        Self::Recipe(e.into())
    }
}

/// One instruction of a stack machine that leaves φ of the whole solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Instr {
    /// Pushes φ of a leaf.
    Load(u32),
    /// Replaces φ by −φ.
    Negate,
    /// min(φ₁, φ₂).
    Min,
    /// max(φ₁, φ₂).
    Max,
    /// max(φ₁, −φ₂).
    MaxNegated,
}

/// A recipe made ready for evaluation at one place and step.
///
/// Nested placements are composed to one transform per leaf. A leaf with transform T has
/// φ(p) = s·φ_local(T⁻¹p), where s is the smallest singular value of T's linear part: the zero set
/// is that of the transformed solid, and since |∇φ_local| ≤ 1 also |∇φ| ≤ 1, so the magnitude is
/// conservative. Under even scaling it is exact. Where a primitive scaled along its own axes is a
/// primitive again (a sphere an ellipsoid, a box a box …) that one is evaluated instead, so it stays
/// exact under uneven scaling too. Negative scales mirror.
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) leaves: Vec<Leaf>,
    pub(crate) tape: Vec<Instr>,
    pub(crate) outline: Option<Outline>,
    step: f32,
}

/// What stands where, for finding what an edit changed.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    /// A name for the content and its place.
    pub key: [u8; 32],
    pub bounds: Aabb,
    /// Empty for a leaf. The first operator is a union.
    pub parts: Vec<(Op, Outline)>,
}

impl Program {
    /// Compiles `recipe` standing at `placement`, for nodes `step` metres apart.
    ///
    /// # Errors
    /// An unsound recipe, a missing mesh, or an impossible scale or step.
    pub fn compile(
        recipe: &Recipe,
        placement: &Placement,
        step: f32,
        meshes: &dyn MeshSource,
    ) -> Result<Self, CompileError> {
        recipe.validate()?;
        if recipe.leaves() > MAX_LEAVES {
            return Err(CompileError::TooManyLeaves(recipe.leaves()));
        }
        if !(step > 0.0 && step.is_finite()) {
            return Err(CompileError::Step(step));
        }
        if !placement.is_sound() {
            return Err(CompileError::Scale);
        }
        let mut compiler = Compiler {
            leaves: Vec::new(),
            tape: Vec::new(),
            shapes: FxHashMap::default(),
            step,
            meshes,
        };
        let outline = compiler.emit(recipe, placement.affine())?;
        Ok(Self {
            leaves: compiler.leaves,
            tape: compiler.tape,
            outline,
            step,
        })
    }

    /// Metres between the nodes it was compiled for.
    pub fn step(&self) -> f32 {
        self.step
    }

    /// Whether it is a painting and nothing else.
    pub fn is_painting(&self) -> bool {
        matches!(&self.leaves[..], [leaf] if leaf.painting().is_some())
    }

    /// A box around the solid, in metres; [`Aabb::EMPTY`] where nothing can be left (Eq. 8).
    pub fn bounds(&self) -> Aabb {
        self.outline.as_ref().map_or(Aabb::EMPTY, |o| o.bounds)
    }
}

struct Compiler<'a> {
    leaves: Vec<Leaf>,
    tape: Vec<Instr>,
    /// Equal primitives at equal scales are prepared once.
    shapes: FxHashMap<([u8; 32], [u32; 3]), Arc<Shape>>,
    step: f32,
    meshes: &'a dyn MeshSource,
}

impl Compiler<'_> {
    /// Appends the instructions that push `recipe`; none and `None` where it is empty.
    fn emit(
        &mut self,
        recipe: &Recipe,
        to_world: Affine3A,
    ) -> Result<Option<Outline>, CompileError> {
        match recipe.node() {
            Node::Primitive(p) => self.primitive(recipe, p, to_world).map(Some),
            Node::Mesh { mesh, .. } | Node::Foreign { mesh, .. } => {
                self.mesh(recipe, mesh, to_world).map(Some)
            }
            Node::Component { recipe, .. } => self.emit(recipe, to_world),
            Node::Canvas(canvas) => self.canvas(recipe, canvas, to_world),
            Node::Sweep(sweep) => self.sweep(recipe, sweep, to_world).map(Some),
            Node::Clones { row, recipe } => {
                let places = row.places();
                let operands = places.iter().map(|place| Operand {
                    op: Op::Union,
                    placement: place.into(),
                    recipe: recipe.clone(),
                    muted: false,
                });
                let operands: Vec<Operand> = operands.collect();
                self.sequence(&operands, to_world)
            }
            Node::Solid(operands) => self.sequence(operands, to_world),
        }
    }

    /// Operands read left to right.
    fn sequence(
        &mut self,
        operands: &[Operand],
        to_world: Affine3A,
    ) -> Result<Option<Outline>, CompileError> {
        let mut parts: Vec<(Op, Outline)> = Vec::with_capacity(operands.len());
        for (i, operand) in operands.iter().filter(|o| !o.muted).enumerate() {
            let op = if i == 0 { Op::Union } else { operand.op };
            let start = self.tape.len();
            let part = self.emit(&operand.recipe, to_world * operand.placement.affine())?;
            match (part, op) {
                (Some(part), Op::Union) => {
                    if !parts.is_empty() {
                        self.tape.push(Instr::Min);
                    }
                    parts.push((op, part));
                }
                (Some(part), _) if !parts.is_empty() => {
                    let intersect = op == Op::Intersect;
                    self.tape.push(if intersect {
                        Instr::Max
                    } else {
                        Instr::MaxNegated
                    });
                    parts.push((op, part));
                }
                // Taken from nothing.
                (Some(_), _) => self.tape.truncate(start),
                // Cut with nothing: nothing of what stands so far is left.
                (None, Op::Intersect) => {
                    let nothing = start - tail(&self.tape[..start], parts.len());
                    self.tape.truncate(nothing);
                    parts.clear();
                }
                (None, _) => {}
            }
        }
        Ok((!parts.is_empty()).then(|| Outline {
            key: key_of(&parts),
            bounds: restricted(parts.iter().map(|(op, o)| (*op, o.bounds))),
            parts,
        }))
    }

    fn canvas(
        &mut self,
        recipe: &Recipe,
        canvas: &Canvas,
        to_world: Affine3A,
    ) -> Result<Option<Outline>, CompileError> {
        let (painting, parts) = Painting::new(canvas, to_world, self)?;
        let bounds = transformed(&painting.bounds(), &to_world);
        if bounds.is_empty() {
            return Ok(None);
        }
        let name = (recipe.hash().0, Vec3::ONE);
        let source = Source::Canvas(Arc::new(painting));
        let leaf = self.leaf(source, to_world, bounds, name)?;
        // Each by itself, so that one stroke's change is told from another's.
        let part = |p: crate::canvas::Part| {
            let outline = Outline {
                key: p.key,
                bounds: transformed(&p.bounds, &to_world),
                parts: Vec::new(),
            };
            (Op::Union, outline)
        };
        let parts: Vec<_> = parts.into_iter().map(part).collect();
        Ok(Some(Outline {
            key: key_of(&parts),
            bounds: leaf.bounds,
            parts,
        }))
    }

    fn primitive(
        &mut self,
        recipe: &Recipe,
        primitive: &Primitive,
        to_world: Affine3A,
    ) -> Result<Outline, CompileError> {
        let (scale, rigid) = axes(&to_world.matrix3);
        let even = scale.max_element() - scale.min_element() <= 1.0e-6 * scale.max_element();
        let folded = (rigid && !even)
            .then(|| stretched(primitive, scale))
            .flatten();
        let folded_scale = if folded.is_some() { scale } else { Vec3::ONE };
        let primitive = folded.as_ref().unwrap_or(primitive);
        let to_world = Affine3A {
            matrix3: to_world.matrix3 * Mat3A::from_diagonal(folded_scale.recip()),
            ..to_world
        };
        let key = (recipe.hash().0, folded_scale.to_array().map(f32::to_bits));
        let shape = match self.shapes.get(&key) {
            Some(shape) => shape.clone(),
            None => {
                let shape = Arc::new(Shape::new(primitive)?);
                self.shapes.insert(key, shape.clone());
                shape
            }
        };
        let bounds = transformed(&primitive.bounds(), &to_world);
        let name = (recipe.hash().0, folded_scale);
        self.leaf(Source::Shape(shape), to_world, bounds, name)
    }

    fn mesh(
        &mut self,
        recipe: &Recipe,
        mesh: &MeshHash,
        to_world: Affine3A,
    ) -> Result<Outline, CompileError> {
        let (_, largest) = singular(&to_world.matrix3);
        let wanted = local_step(self.step, largest);
        let volume = self.meshes.volume(mesh, wanted);
        let volume = volume.ok_or(CompileError::MissingMesh(*mesh))?;
        let bounds = transformed(&volume.bounds(), &to_world);
        // The volume found may be coarser than the one found later.
        let name = (recipe.hash().0, Vec3::splat(volume.step()));
        self.leaf(Source::Volume(volume), to_world, bounds, name)
    }

    fn sweep(
        &mut self,
        recipe: &Recipe,
        sweep: &Sweep,
        to_world: Affine3A,
    ) -> Result<Outline, CompileError> {
        let (_, largest) = singular(&to_world.matrix3);
        // A wall has nodes within it, however coarse the rest is.
        let thin = if sweep.thickness > 0.0 {
            0.4 * sweep.thickness * largest
        } else {
            f32::MAX
        };
        let wanted = local_step(self.step.min(thin), largest);
        let mesh = std::cell::OnceCell::new();
        let make = || mesh.get_or_init(|| sweep.solid()).clone();
        let name = MeshHash(recipe.hash().0);
        let bake = || make().map(|s| s.mesh).unwrap_or_default();
        let volume = match self.meshes.baked(&name, wanted, &bake) {
            Some(volume) => volume,
            None => return Err(make().err().map_or(CompileError::TooLarge, Into::into)),
        };
        let bounds = transformed(&volume.bounds(), &to_world);
        let name = (recipe.hash().0, Vec3::splat(volume.step()));
        self.leaf(Source::Volume(volume), to_world, bounds, name)
    }

    fn leaf(
        &mut self,
        source: Source,
        to_world: Affine3A,
        bounds: Aabb,
        name: ([u8; 32], Vec3),
    ) -> Result<Outline, CompileError> {
        let (smallest, largest) = singular(&to_world.matrix3);
        let fits = smallest > 1.0e-6 && largest < 1.0e6;
        if !(fits && to_world.is_finite() && bounds.min.is_finite() && bounds.max.is_finite()) {
            return Err(CompileError::Scale);
        }
        let mut hasher = blake3::Hasher::new();
        hasher.update(&name.0);
        let place = to_world.to_cols_array();
        for x in name.1.to_array().iter().chain(&place) {
            hasher.update(&(x + 0.0).to_bits().to_le_bytes());
        }
        self.tape.push(Instr::Load(self.leaves.len() as u32));
        self.leaves.push(Leaf::new(source, to_world, smallest));
        Ok(Outline {
            key: *hasher.finalize().as_bytes(),
            bounds,
            parts: Vec::new(),
        })
    }
}

impl Bench for Compiler<'_> {
    fn solid(
        &mut self,
        recipe: &Recipe,
        to_world: Affine3A,
    ) -> Result<Option<Program>, CompileError> {
        let mut inner = Compiler {
            leaves: Vec::new(),
            tape: Vec::new(),
            shapes: FxHashMap::default(),
            step: self.step,
            meshes: self.meshes,
        };
        let outline = inner.emit(recipe, to_world)?;
        Ok(outline.map(|outline| Program {
            leaves: inner.leaves,
            tape: inner.tape,
            outline: Some(outline),
            step: self.step,
        }))
    }

    fn smallest(&self, m: &Affine3A) -> f32 {
        singular(&m.matrix3).0
    }
}

/// How many instructions at the end of `tape` push the one value of a sequence of `parts`.
fn tail(tape: &[Instr], parts: usize) -> usize {
    if parts == 0 {
        return 0;
    }
    let mut wanted = 1;
    for (n, instr) in tape.iter().rev().enumerate() {
        match instr {
            Instr::Load(_) => wanted -= 1,
            Instr::Negate => {}
            Instr::Min | Instr::Max | Instr::MaxNegated => wanted += 1,
        }
        if wanted == 0 {
            return n + 1;
        }
    }
    tape.len()
}

fn key_of(parts: &[(Op, Outline)]) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    for (op, part) in parts {
        hasher.update(&[*op as u8]);
        hasher.update(&part.key);
    }
    *hasher.finalize().as_bytes()
}

/// The lengths of a matrix's columns, and whether these stand at right angles.
fn axes(m: &Mat3A) -> (Vec3, bool) {
    let scale = Vec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
    let skew = |a: glam::Vec3A, b: glam::Vec3A, s: f32| a.dot(b).abs() <= 2.0e-6 * s;
    let right = skew(m.x_axis, m.y_axis, scale.x * scale.y)
        && skew(m.y_axis, m.z_axis, scale.y * scale.z)
        && skew(m.z_axis, m.x_axis, scale.z * scale.x);
    (
        scale,
        right && scale.is_finite() && scale.min_element() > 0.0,
    )
}

/// The smallest and the largest singular value.
pub(crate) fn singular(m: &Mat3A) -> (f32, f32) {
    let (scale, right) = axes(m);
    if right {
        // Rotations leave lengths a few bits off; what is rigid is exactly so.
        let rigid = |x: f32| if (x - 1.0).abs() < 1.0e-6 { 1.0 } else { x };
        return (rigid(scale.min_element()), rigid(scale.max_element()));
    }
    // The eigenvalues of MᵀM by the trigonometric formula for symmetric 3×3 matrices.
    let columns = [m.x_axis, m.y_axis, m.z_axis].map(|c| Vec3::from(c).as_dvec3());
    let a = DMat3::from_cols(columns[0], columns[1], columns[2]);
    let s = a.transpose() * a;
    let mean = (s.x_axis.x + s.y_axis.y + s.z_axis.z) / 3.0;
    let b = s - DMat3::from_diagonal(glam::DVec3::splat(mean));
    let spread =
        (b.x_axis.length_squared() + b.y_axis.length_squared() + b.z_axis.length_squared()) / 6.0;
    let p = libm::sqrt(spread);
    if p.is_nan() || p <= 0.0 {
        let even = libm::sqrt(mean.max(0.0)) as f32;
        return (even * (1.0 - 1.0e-6), even);
    }
    let r = (0.5 * (b * (1.0 / p)).determinant()).clamp(-1.0, 1.0);
    let angle = libm::acos(r) / 3.0;
    let largest = mean + 2.0 * p * libm::cos(angle);
    let smallest = mean + 2.0 * p * libm::cos(angle + std::f64::consts::TAU / 3.0);
    let root = |x: f64| libm::sqrt(x.max(0.0)) as f32;
    (root(smallest) * (1.0 - 1.0e-6), root(largest))
}
