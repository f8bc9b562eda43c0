//! What a program is made of, for evaluators elsewhere: the GPU's passes read it.

use std::sync::Arc;

use glam::{Affine3A, UVec3, Vec3};

use crate::Program;
use crate::bake::Volume;
use crate::canvas::PaintingView;
use crate::leaf::{Leaf, Source};
use crate::program::{Instr, singular};
use crate::shape::Shape;

/// One instruction of the stack machine that leaves φ of the whole solid (EasyVRModeling §5.3 Eq. 7).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TapeStep {
    /// Pushes φ of a leaf, by its number.
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

/// A primitive, mesh or painting in its place: φ(p) = scale · form(`to_local`·p), metres.
#[derive(Clone, Debug)]
pub struct LeafView<'a> {
    /// From the world to the leaf's own frame.
    pub to_local: Affine3A,
    /// Metres of the world that φ claims for one of the leaf's own.
    pub scale: f32,
    /// The longest half diagonal of the cube [−1, 1]³ in the leaf's own frame.
    pub diagonal: f32,
    /// Half extents of that cube's box there.
    pub extent: Vec3,
    /// And of the unit ball's.
    pub reach: Vec3,
    /// The least |∇φ| where the form's own is 1: small under very uneven scaling.
    pub flattest: f32,
    /// What it is.
    pub form: Form<'a>,
}

/// An edge of a plane outline: start, direction, 1/|d|², y of the end, dx/dy.
pub type OutlineEdge = [f32; 7];

/// A baked mesh as it is kept: bricks of 8³ cells ([`Volume`]).
#[derive(Clone, Copy, Debug)]
pub struct VolumeView<'a> {
    /// Where the first node lies, metres.
    pub origin: Vec3,
    /// Metres between nodes.
    pub step: f32,
    /// Cells along each axis.
    pub cells: UVec3,
    /// For each brick, x fastest, where its values begin; the highest bit is set where it keeps all
    /// 9³ nodes and not its 8 corners.
    pub table: &'a [u32],
    /// The least and greatest value of each brick, and how much it changes per cell at most.
    pub ranges: &'a [[f32; 3]],
    /// Signed distances, metres.
    pub values: &'a [f32],
}

/// The shape of a leaf in its own frame, ready for evaluation. Lengths in metres.
#[derive(Clone, Debug)]
pub enum Form<'a> {
    /// Radius.
    Sphere(f32),
    /// Inner half extents and rounding.
    Cuboid(Vec3, f32),
    /// Inner radius, inner half height and rounding.
    Cylinder(f32, f32, f32),
    /// Bottom radius, top radius and half height.
    Frustum(f32, f32, f32),
    /// From the axis to the tube, and the tube's radius.
    Torus(f32, f32),
    /// Radius and half height.
    Capsule(f32, f32),
    /// Smallest half extent; half extents divided by it; their squares less 1.
    Ellipsoid(f32, Vec3, Vec3),
    /// Outline, inner half height and rounding.
    Extrusion(Vec<OutlineEdge>, f32, f32),
    /// Outline of (radius, y).
    Revolution(Vec<OutlineEdge>),
    /// A convex polyhedron.
    Convex(ConvexView),
    /// Major and minor radius, rise per radian, hand (±1), and the angle of its end.
    Helix([f32; 5]),
    /// A baked mesh.
    Volume(&'a Arc<Volume>),
    /// Strokes that melt into one surface.
    Painting(PaintingView<'a>),
}

/// A convex polyhedron: its planes, edges, and the walls that stand on each face's edges.
#[derive(Clone, Debug, Default)]
pub struct ConvexView {
    /// Normal and offset.
    pub planes: Vec<[f32; 4]>,
    /// For each plane, normals and offsets of its walls.
    pub walls: Vec<Vec<[f32; 4]>>,
    /// Start, direction, 1/|d|².
    pub edges: Vec<[f32; 7]>,
}

impl Program {
    /// The instructions in order.
    pub fn tape(&self) -> impl Iterator<Item = TapeStep> + '_ {
        self.tape.iter().map(|i| match *i {
            Instr::Load(leaf) => TapeStep::Load(leaf),
            Instr::Negate => TapeStep::Negate,
            Instr::Min => TapeStep::Min,
            Instr::Max => TapeStep::Max,
            Instr::MaxNegated => TapeStep::MaxNegated,
        })
    }

    /// The leaves that the tape names, by number.
    pub fn leaves(&self) -> impl Iterator<Item = LeafView<'_>> {
        self.leaves.iter().map(Leaf::view)
    }
}

impl Leaf {
    fn view(&self) -> LeafView<'_> {
        let (to_local, scale) = self.place();
        let (diagonal, extent, reach) = self.sizes();
        LeafView {
            to_local,
            scale,
            diagonal,
            extent,
            reach,
            flattest: scale * singular(&to_local.matrix3).0,
            form: match self.source() {
                Source::Shape(shape) => form_of(shape),
                Source::Volume(volume) => Form::Volume(volume),
                Source::Canvas(painting) => Form::Painting(painting.view()),
            },
        }
    }
}

fn form_of(shape: &Shape) -> Form<'static> {
    match shape {
        Shape::Sphere(r) => Form::Sphere(*r),
        Shape::Cuboid(half, r) => Form::Cuboid(*half, *r),
        Shape::Cylinder(a, h, r) => Form::Cylinder(*a, *h, *r),
        Shape::Frustum(f) => {
            let [bottom, top, half] = f.numbers();
            Form::Frustum(bottom, top, half)
        }
        Shape::Torus(a, b) => Form::Torus(*a, *b),
        Shape::Capsule(r, h) => Form::Capsule(*r, *h),
        Shape::Ellipsoid(e) => {
            let (unit, half, excess) = e.numbers();
            Form::Ellipsoid(unit, half, excess)
        }
        Shape::Extrusion(outline, h, r) => Form::Extrusion(outline.numbers(), *h, *r),
        Shape::Revolution(outline) => Form::Revolution(outline.numbers()),
        Shape::Convex(c) => Form::Convex(c.view()),
        Shape::Helix(h) => Form::Helix(h.numbers()),
    }
}
