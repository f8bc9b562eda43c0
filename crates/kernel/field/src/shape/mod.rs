//! Primitives made ready for evaluation: everything that does not depend on the sample is worked
//! out once.

mod convex;
mod helix;
mod outline;
mod polygon;
mod round;

use glam::Vec3;

use crate::program::TOGETHER;
use crate::{Primitive, PrimitiveError};
use convex::Convex;
use helix::Helix;
use polygon::Polygon;

/// Nodes of a brick.
pub(crate) const NODES: usize = 512;

/// The nodes of a brick in a shape's own frame, x fastest.
pub(crate) struct Points {
    pub x: [f32; NODES],
    pub y: [f32; NODES],
    pub z: [f32; NODES],
    /// Their middle.
    pub centre: Vec3,
    /// How far the nodes lie from it at most.
    pub radius: f32,
}

/// A compiled primitive.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Sphere(f32),
    /// Inner half extents, rounding.
    Cuboid(Vec3, f32),
    /// Inner radius, inner half height, rounding.
    Cylinder(f32, f32, f32),
    Frustum(round::Frustum),
    Torus(f32, f32),
    Capsule(f32, f32),
    Ellipsoid(round::Ellipsoid),
    /// Outline, inner half height, rounding.
    Extrusion(Box<Polygon>, f32, f32),
    Revolution(Box<Polygon>),
    Convex(Box<Convex>),
    Helix(Helix),
}

impl Shape {
    /// Checks and prepares.
    pub fn new(primitive: &Primitive) -> Result<Self, PrimitiveError> {
        primitive.validate()?;
        Ok(match primitive {
            Primitive::Sphere { radius } => Self::Sphere(*radius),
            Primitive::Cuboid { half, rounding } => {
                Self::Cuboid((half - rounding).max(Vec3::ZERO), *rounding)
            }
            Primitive::Cylinder {
                radius,
                half_height,
                rounding,
            } => Self::Cylinder(
                (radius - rounding).max(0.0),
                (half_height - rounding).max(0.0),
                *rounding,
            ),
            Primitive::Frustum {
                bottom,
                top,
                half_height,
            } => Self::Frustum(round::Frustum::new(*bottom, *top, *half_height)),
            Primitive::Torus { major, minor } => Self::Torus(*major, *minor),
            Primitive::Capsule {
                radius,
                half_height,
            } => Self::Capsule(*radius, *half_height),
            Primitive::Ellipsoid { half } => Self::Ellipsoid(round::Ellipsoid::new(*half)),
            Primitive::Extrusion {
                contours,
                half_height,
                rounding,
            } => {
                let rounded = outline::fillet(contours, *rounding, |_| true);
                let polygon = Polygon::new(&rounded, |_, _| true);
                let inner = (half_height - rounding).max(0.0);
                Self::Extrusion(Box::new(polygon), inner, *rounding)
            }
            Primitive::Revolution { contours, rounding } => {
                let rounded = outline::fillet(contours, *rounding, |p| p.x > 0.0);
                // Edges along the axis bound nothing once turned.
                let polygon = Polygon::new(&rounded, |a, b| a.x > 0.0 || b.x > 0.0);
                Self::Revolution(Box::new(polygon))
            }
            Primitive::Convex { points } => Self::Convex(Box::new(Convex::new(points)?)),
            Primitive::Helix {
                major,
                minor,
                pitch,
                turns,
            } => Self::Helix(Helix::new(*major, *minor, *pitch, *turns)),
        })
    }

    /// φ at one point of the shape's own frame.
    pub fn at(&self, p: Vec3) -> f32 {
        let (x, y, z) = (p.x, p.y, p.z);
        match self {
            Self::Sphere(r) => round::sphere(*r, x, y, z),
            Self::Cuboid(h, r) => round::cuboid(*h, *r, x, y, z),
            Self::Cylinder(a, h, r) => round::cylinder(*a, *h, *r, x, y, z),
            Self::Frustum(f) => f.at(x, y, z),
            Self::Torus(a, b) => round::torus(*a, *b, x, y, z),
            Self::Capsule(r, h) => round::capsule(*r, *h, x, y, z),
            Self::Ellipsoid(e) => e.at(x, y, z),
            Self::Extrusion(o, h, r) => round::slab(o.at(x, y), *h, *r, z),
            Self::Revolution(o) => o.at(round::hypot(x, z), y),
            Self::Convex(c) => c.at(p),
            Self::Helix(h) => h.at(x, y, z),
        }
    }

    /// φ at some points, to the bit what [`Self::at`] gives.
    pub fn at_all(&self, points: &[Vec3; TOGETHER]) -> [f32; TOGETHER] {
        match self {
            Self::Sphere(r) => together(points, |x, y, z| round::sphere(*r, x, y, z)),
            Self::Cuboid(h, r) => together(points, |x, y, z| round::cuboid(*h, *r, x, y, z)),
            Self::Cylinder(a, h, r) => {
                together(points, |x, y, z| round::cylinder(*a, *h, *r, x, y, z))
            }
            Self::Frustum(f) => together(points, |x, y, z| f.at(x, y, z)),
            Self::Torus(a, b) => together(points, |x, y, z| round::torus(*a, *b, x, y, z)),
            Self::Capsule(r, h) => together(points, |x, y, z| round::capsule(*r, *h, x, y, z)),
            Self::Ellipsoid(e) => together(points, |x, y, z| e.at(x, y, z)),
            Self::Helix(h) => together(points, |x, y, z| h.at(x, y, z)),
            // What has many sides looks at those near each.
            Self::Extrusion(..) | Self::Revolution(_) | Self::Convex(_) => {
                points.map(|p| self.at(p))
            }
        }
    }

    /// φ at all nodes of a brick. The same bits on every machine: wider registers change how many
    /// nodes go at once, not what is computed for one.
    pub fn brick(&self, points: &Points, out: &mut [f32; NODES]) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has AVX2, as just asked.
            return unsafe { self.brick_avx2(points, out) };
        }
        self.brick_any(points, out);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn brick_avx2(&self, points: &Points, out: &mut [f32; NODES]) {
        self.brick_any(points, out);
    }

    #[inline(always)]
    fn brick_any(&self, p: &Points, out: &mut [f32; NODES]) {
        match self {
            Self::Sphere(r) => each(p, out, |x, y, z| round::sphere(*r, x, y, z)),
            Self::Cuboid(h, r) => each(p, out, |x, y, z| round::cuboid(*h, *r, x, y, z)),
            Self::Cylinder(a, h, r) => {
                each(p, out, |x, y, z| round::cylinder(*a, *h, *r, x, y, z));
            }
            Self::Frustum(f) => each(p, out, |x, y, z| f.at(x, y, z)),
            Self::Torus(a, b) => each(p, out, |x, y, z| round::torus(*a, *b, x, y, z)),
            Self::Capsule(r, h) => each(p, out, |x, y, z| round::capsule(*r, *h, x, y, z)),
            Self::Ellipsoid(e) => each(p, out, |x, y, z| e.at(x, y, z)),
            Self::Extrusion(o, h, r) => {
                o.brick(&p.x, &p.y, p.centre.x, p.centre.y, p.radius, out);
                for (d, z) in out.iter_mut().zip(&p.z) {
                    *d = round::slab(*d, *h, *r, *z);
                }
            }
            Self::Revolution(o) => {
                let mut away = [0.0; NODES];
                for (a, (x, z)) in away.iter_mut().zip(p.x.iter().zip(&p.z)) {
                    *a = round::hypot(*x, *z);
                }
                let c = round::hypot(p.centre.x, p.centre.z);
                o.brick(&away, &p.y, c, p.centre.y, p.radius, out);
            }
            Self::Convex(c) => c.brick(p, out),
            Self::Helix(h) => each(p, out, |x, y, z| h.at(x, y, z)),
        }
    }
}

/// One formula over some points; inlined so that it is compiled to vector code.
#[inline(always)]
fn together(points: &[Vec3; TOGETHER], f: impl Fn(f32, f32, f32) -> f32) -> [f32; TOGETHER] {
    let [x, y, z] = [0, 1, 2].map(|axis| points.map(|p| p[axis]));
    std::array::from_fn(|i| f(x[i], y[i], z[i]))
}

/// One formula over all nodes; inlined so that the loop is compiled to vector code.
#[inline(always)]
fn each(p: &Points, out: &mut [f32; NODES], f: impl Fn(f32, f32, f32) -> f32) {
    for (i, o) in out.iter_mut().enumerate() {
        *o = f(p.x[i], p.y[i], p.z[i]);
    }
}
