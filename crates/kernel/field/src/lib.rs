//! Signed distance fields: exact primitives, meshes baked to grids, booleans on sparse bricks.
//!
//! A solid is a [`Recipe`]: an immutable tree of operands. Its field φ is negative inside, positive
//! outside, in metres, and never claims more than the true distance (|∇φ| ≤ 1 up to sampling), so
//! that whole bricks can be skipped (EasyVRModeling §5, with `papers/errata.md`).

#[macro_use]
mod wide;

pub mod bake;
mod canvas;
mod dirty;
mod fuse;
mod grid;
mod hash;
mod leaf;
mod placement;
mod primitive;
mod program;
mod prune;
mod recipe;
mod scratch;
mod shape;
mod stretch;
mod view;

pub use canvas::{
    CANVAS_THRESHOLD, Canvas, CanvasError, ChunkView, HARD, MAX_POINTS, MAX_STROKES, PaintingView,
    Skeleton, SkeletonView, Stroke, StrokeView,
};
pub use dirty::{changed_box, refuse, refuse_from};
pub use fuse::{FuseError, FuseOptions, fuse};
pub use grid::{BRICK, Brick, BrickCoord, Grid};
pub use hash::RecipeHash;
pub use midair_swept::{Place, Profile, Rib, Row, Surface, Sweep, SweepError};
pub use placement::Placement;
pub use primitive::{MAX_CONTOUR_POINTS, MAX_HULL_POINTS, MAX_LENGTH, Primitive, PrimitiveError};
pub use program::{CompileError, MAX_LEAVES, MeshSource, Part, Program, TOGETHER, local_step};
pub use recipe::{MAX_DEPTH, MAX_OPERANDS, Node, Op, Operand, Recipe, RecipeError};
pub use view::{ConvexView, Form, LeafView, OutlineEdge, TapeStep, VolumeView};

#[cfg(test)]
mod tests;
