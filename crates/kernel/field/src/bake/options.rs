/// The longest side a component is scaled to before it is baked, metres (EasyVRModeling §5.2, 3).
pub const LONGEST_SIDE: f32 = 0.4;
/// How far the grid reaches beyond the mesh on every side, metres (EasyVRModeling §5.2, 3).
pub const PADDING: f32 = 0.1;
/// The step between two nodes, S_local, metres (EasyVRModeling §5.2, 4).
pub const STEP: f32 = 0.01;

/// How finely and how far around a mesh is baked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakeOptions {
    /// Distance between two nodes, metres.
    pub step: f32,
    /// How far the grid reaches beyond the mesh, metres; one step at the least.
    pub padding: f32,
}

impl Default for BakeOptions {
    /// [`STEP`] and [`PADDING`].
    fn default() -> Self {
        Self {
            step: STEP,
            padding: PADDING,
        }
    }
}

impl BakeOptions {
    /// Another step, metres, and the default's ten steps around the mesh: no more than [`PADDING`], and
    /// enough for what melts into a mesh of [`LONGEST_SIDE`] at any step.
    pub fn with_step(step: f32) -> Self {
        let padding = (PADDING / STEP * step).clamp(0.4 * PADDING, PADDING);
        Self { step, padding }
    }
}

/// Why a mesh could not be baked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BakeError {
    /// It was cancelled through its [`Progress`](super::Progress).
    #[error("the bake was cancelled")]
    Cancelled,
    /// There is nothing to bake.
    #[error("the mesh has no triangles")]
    NoTriangles,
    /// A corner or the box is not a number, or beyond all measure.
    #[error("the mesh has a position that is not a finite number")]
    NotFinite,
    /// Every triangle is a line or a point.
    #[error("the mesh has no extent: every triangle is a line or a point")]
    NoExtent,
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} names vertex {vertex}, but the mesh has {vertices} vertices")]
    NoSuchVertex {
        /// The triangle's index.
        triangle: usize,
        /// The index it names.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// The step is not a positive number.
    #[error("the step must be a positive number of metres, not {0}")]
    Step(f32),
    /// The padding is negative or not a number.
    #[error("the padding must be a number of metres and not negative, not {0}")]
    Padding(f32),
    /// The grid would take more than 2 GiB.
    #[error("a grid of step {step} m would take more than 2 GiB; a step of {fits:.6} m fits")]
    TooLarge {
        /// The step asked for, metres.
        step: f32,
        /// A step that fits, metres.
        fits: f32,
    },
}
