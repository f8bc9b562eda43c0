use std::f32::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

use midair_mesh::{Aabb, MeshHash, TriMesh};
use midair_swept::SweepError;
use thiserror::Error;

use crate::bake::{BakeOptions, Progress, Volume, bake};
use crate::leaf::Leaf;
use crate::{Op, Placement, PrimitiveError, Recipe, RecipeError};

mod compile;
mod point;

use compile::Compiler;
pub(crate) use compile::singular;
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
        Compiler::new(step, meshes).program(recipe, placement.affine())
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
