//! A painting: strokes with skeletons that melt into one convolution surface (3DBrushVR §3–4).

mod area;
mod bounds;
mod build;
mod kernel;
mod nodes;
mod paint;
mod reach;
mod stroke;
mod view;

pub(crate) use build::{Bench, Part};
pub use kernel::T as CANVAS_THRESHOLD;
pub(crate) use paint::{Block, Painting, Place};
pub use stroke::{Canvas, CanvasError, HARD, MAX_POINTS, MAX_STROKES, Skeleton, Stroke};
pub use view::{ChunkView, PaintingView, SkeletonView, StrokeView};

#[cfg(test)]
mod tests;
