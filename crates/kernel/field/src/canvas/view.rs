//! What a painting is made of, for evaluators elsewhere.

use glam::{Affine3A, Vec2};
use midair_mesh::Aabb;

use super::paint::{Inked, Inking, Painting};
use crate::Program;

/// A painting, in its canvas's frame: metres.
#[derive(Clone, Debug)]
pub struct PaintingView<'a> {
    /// The reach, 1/reach², and the weights of a point, a line and a polygon of support 1.
    pub family: [f32; 5],
    /// The exponent of its blending.
    pub blend: f32,
    /// The least of what strokes make of one unit of potential.
    pub least: f32,
    /// In the order they were painted.
    pub strokes: Vec<StrokeView<'a>>,
    /// Where they are felt, by stroke.
    pub chunks: Vec<ChunkView>,
    /// Parts of led points: start, way, radius at the start, and how much wider it gets.
    pub segments: Vec<[f32; 8]>,
}

/// One stroke of a painting.
#[derive(Clone, Debug)]
pub struct StrokeView<'a> {
    /// What it is convolved from.
    pub skeleton: SkeletonView<'a>,
    /// The factor on its potential.
    pub weight: f32,
    /// It takes away from those before it.
    pub erase: bool,
    /// The same for strokes that follow each other and are one; 0 for one by itself.
    pub twins: u32,
    /// Metres for one unit of potential at its surface; of a painting, the factor on its own.
    pub scale: f32,
    /// A bound of |∇F|, per metre; of a solid, metres of the world in one of the canvas.
    pub slope: f32,
    /// To its own frame, where that is not the canvas's.
    pub to_local: Option<Affine3A>,
}

/// What a stroke is convolved from, in its own frame.
#[derive(Clone, Debug)]
pub enum SkeletonView<'a> {
    /// A led point: the segments of its chunks.
    Points,
    /// Start, unit direction, length, 1/support.
    Line([f32; 8]),
    /// Origin, two axes in the plane and its normal, 1/support; corners, and edges as start, unit direction and
    /// length, both in supports.
    Polygon([f32; 13], Vec<Vec2>, Vec<[f32; 5]>),
    /// A solid, in the frame of the world, and how many metres of its φ its potential falls off in either way.
    Solid(&'a Program, f32),
    /// A painting with its own potential, in the stroke's frame.
    Painting(Box<PaintingView<'a>>),
}

/// A part of a stroke that is looked up by itself.
#[derive(Clone, Debug)]
pub struct ChunkView {
    /// Where it is felt.
    pub bounds: Aabb,
    /// Of which stroke.
    pub stroke: u32,
    /// Its first segment, and the one after its last.
    pub segments: [u32; 2],
}

impl Painting {
    /// What it is made of.
    pub fn view(&self) -> PaintingView<'_> {
        let f = &self.family;
        PaintingView {
            strokes: self.strokes.iter().map(Inked::view).collect(),
            family: [f.reach, f.inverse, f.point, f.line, f.polygon],
            blend: self.blend,
            least: self.least,
            chunks: self
                .chunks
                .iter()
                .map(|c| ChunkView {
                    bounds: c.bounds,
                    stroke: c.stroke,
                    segments: [c.from, c.to],
                })
                .collect(),
            segments: self
                .segments
                .iter()
                .map(|s| {
                    let (a, b) = (s.from, s.along);
                    [a.x, a.y, a.z, b.x, b.y, b.z, s.radius, s.wider]
                })
                .collect(),
        }
    }
}

impl Inked {
    fn view(&self) -> StrokeView<'_> {
        let skeleton = match &self.kind {
            Inking::Points => SkeletonView::Points,
            Inking::Line(from, along, length, inverse) => SkeletonView::Line([
                from.x, from.y, from.z, along.x, along.y, along.z, *length, *inverse,
            ]),
            Inking::Polygon(area) => {
                let mut frame = [area.inverse; 13];
                let columns = [area.origin].into_iter().chain(area.axes);
                for (to, from) in frame.iter_mut().zip(columns.flat_map(|c| c.to_array())) {
                    *to = from;
                }
                let edges = area.edges.iter().map(|e| e.numbers()).collect();
                SkeletonView::Polygon(frame, area.corners.clone(), edges)
            }
            Inking::Field(program, radius) => SkeletonView::Solid(program, *radius),
            Inking::Canvas(painting) => SkeletonView::Painting(Box::new(painting.view())),
        };
        StrokeView {
            skeleton,
            weight: self.weight,
            erase: self.erase,
            twins: self.twins,
            scale: self.scale,
            slope: self.slope,
            to_local: self.to_local,
        }
    }
}
