use std::sync::Arc;

use glam::{Affine3A, IVec3, Vec3};
use midair_mesh::Aabb;

use crate::bake::Volume;
use crate::canvas::{Block, Painting, Place};
use crate::program::TOGETHER;
use crate::shape::{NODES, Points, Shape};

/// A primitive or baked mesh in its place.
#[derive(Clone, Debug)]
pub(crate) struct Leaf {
    source: Source,
    to_local: Affine3A,
    /// The smallest singular value of the transform to the world.
    scale: f32,
    /// Half a diagonal of the cube [−1, 1]³ in local metres, the longest of the four.
    diagonal: f32,
    /// Half extents of that cube's local box.
    extent: Vec3,
    /// And of the unit ball's.
    reach: Vec3,
}

#[derive(Clone, Debug)]
pub(crate) enum Source {
    Shape(Arc<Shape>),
    Volume(Arc<Volume>),
    Canvas(Arc<Painting>),
}

impl Leaf {
    pub fn new(source: Source, to_world: Affine3A, scale: f32) -> Self {
        let to_local = to_world.inverse();
        let m = to_local.matrix3;
        let diagonals = [
            m.x_axis + m.y_axis + m.z_axis,
            m.x_axis + m.y_axis - m.z_axis,
            m.x_axis - m.y_axis + m.z_axis,
            m.x_axis - m.y_axis - m.z_axis,
        ];
        Self {
            source,
            to_local,
            scale,
            diagonal: diagonals
                .map(|d| d.length())
                .into_iter()
                .fold(0.0, f32::max)
                * 1.000_001,
            extent: Vec3::from(m.x_axis.abs() + m.y_axis.abs() + m.z_axis.abs()),
            reach: Vec3::from(
                (m.x_axis * m.x_axis + m.y_axis * m.y_axis + m.z_axis * m.z_axis)
                    .map(|x| x.sqrt() * 1.000_001),
            ),
        }
    }

    /// What stands there.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The way into its own frame, and the metres that φ claims for one there.
    pub fn place(&self) -> (Affine3A, f32) {
        (self.to_local, self.scale)
    }

    /// How large a cube and a ball of the world are there: half diagonal, half extents, half extents.
    pub fn sizes(&self) -> (f32, Vec3, Vec3) {
        (self.diagonal, self.extent, self.reach)
    }

    /// φ at a point of the world.
    pub fn at(&self, p: Vec3) -> f32 {
        let world = p;
        let p = self.to_local.transform_point3(p);
        self.scale
            * match &self.source {
                Source::Shape(s) => s.at(p),
                Source::Volume(v) => v.sample(p),
                Source::Canvas(c) => c.at(p, world),
            }
    }

    /// φ at some points of the world, to the bit what [`Self::at`] gives.
    pub fn at_all(&self, points: &[Vec3; TOGETHER]) -> [f32; TOGETHER] {
        match &self.source {
            Source::Shape(s) => {
                let local = points.map(|p| self.to_local.transform_point3(p));
                s.at_all(&local).map(|d| self.scale * d)
            }
            Source::Volume(_) | Source::Canvas(_) => points.map(|p| self.at(p)),
        }
    }

    /// The painting that it is.
    pub fn painting(&self) -> Option<&Painting> {
        match &self.source {
            Source::Canvas(painting) => Some(painting),
            _ => None,
        }
    }

    /// Whether two leaves have one frame.
    pub fn stands_as(&self, other: &Self) -> bool {
        self.to_local == other.to_local
    }

    /// Steps of the world in metres of its own, at least.
    pub fn local(&self, step: f32) -> f32 {
        step / self.scale
    }

    /// The cube of half side `half` about `centre` and `around` it, in its own frame too.
    pub fn block(&self, centre: Vec3, half: f32, around: f32) -> Block {
        let c = self.to_local.transform_point3(centre);
        Block {
            within: Aabb::around(c, self.extent * half + self.reach * around),
            centre: c,
            radius: half * self.diagonal + around / self.scale,
            world: centre,
            half,
            around,
        }
    }

    /// The greatest |∇φ| no further than `around` from a cube, where it is known; a baked mesh may
    /// be steep at its holes.
    pub fn slope(&self, centre: Vec3, half: f32, around: f32) -> Option<f32> {
        match &self.source {
            Source::Shape(_) => Some(1.0),
            Source::Volume(v) => {
                let c = self.to_local.transform_point3(centre);
                v.steepest(&Aabb::around(c, self.extent * half + self.reach * around))
            }
            Source::Canvas(p) => p.steepest(&self.block(centre, half, around)),
        }
    }

    /// Bounds of φ no further than `around` from the cube of half side `half` about `centre`, up to
    /// rounding.
    pub fn range(&self, centre: Vec3, half: f32, around: f32, step: f32) -> (f32, f32) {
        let c = self.to_local.transform_point3(centre);
        let r = half * self.diagonal + around / self.scale;
        match &self.source {
            Source::Shape(s) => {
                // |∇φ_local| ≤ 1.
                let v = s.at(c);
                (self.scale * (v - r), self.scale * (v + r))
            }
            Source::Volume(v) => {
                let local = Aabb::around(c, self.extent * half + self.reach * around);
                let (lo, hi) = v.bound(&local, r);
                (self.scale * lo, self.scale * hi)
            }
            Source::Canvas(p) => {
                let block = self.block(centre, half, around);
                let (lo, hi) = p.range(&block, step / self.scale);
                (self.scale * lo, self.scale * hi)
            }
        }
    }

    /// φ at the 8³ nodes `step·(first + (x, y, z))`, x fastest.
    pub fn brick(&self, first: IVec3, step: f32, points: &mut Points, out: &mut [f32; NODES]) {
        let m = self.to_local.matrix3;
        let (ax, ay, az) = (
            Vec3::from(m.x_axis),
            Vec3::from(m.y_axis),
            Vec3::from(m.z_axis),
        );
        let origin = Vec3::from(self.to_local.translation);
        let row = |y: i32, z: i32| {
            // From the node's own number, so that it has the same place whichever brick asks.
            let (y, z) = ((first.y + y) as f32 * step, (first.z + z) as f32 * step);
            ay * y + (az * z + origin)
        };
        match &self.source {
            Source::Volume(v) => {
                let start = ax * (first.x as f32 * step) + row(0, 0);
                v.sample_brick(start, [ax * step, ay * step, az * step], out);
            }
            Source::Shape(_) | Source::Canvas(_) => {
                let xs: [f32; 8] = std::array::from_fn(|i| (first.x + i as i32) as f32 * step);
                for i in 0..64 {
                    let r = row(i & 7, i >> 3);
                    let at = i as usize * 8;
                    for (k, x) in xs.iter().enumerate() {
                        points.x[at + k] = ax.x * x + r.x;
                        points.y[at + k] = ax.y * x + r.y;
                        points.z[at + k] = ax.z * x + r.z;
                    }
                }
                let centre = (first.as_vec3() + 3.5) * step;
                points.centre = self.to_local.transform_point3(centre);
                points.radius = 3.5 * step * self.diagonal;
                match &self.source {
                    Source::Shape(shape) => shape.brick(points, out),
                    Source::Canvas(painting) => {
                        let half = self.extent * (3.5 * step) * 1.000_01;
                        let place = Place {
                            within: Aabb::around(points.centre, half),
                            points,
                            first,
                            local_step: step / self.scale,
                        };
                        painting.brick(&place, out);
                    }
                    Source::Volume(_) => {}
                }
            }
        }
        if self.scale != 1.0 {
            for v in out {
                *v *= self.scale;
            }
        }
    }
}
