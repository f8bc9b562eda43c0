use std::fmt;
use std::str::FromStr;

use glam::{Vec2, Vec3};
use midair_mesh::Aabb;
use midair_swept::{Profile, Rib};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{Canvas, Node, Op, Placement, Primitive, Skeleton};

/// The name of a recipe: BLAKE3 of its canonical bytes, written as 64 hexadecimal digits.
///
/// A tag, then every number as its little-endian bits (−0 counts as 0), children by their own
/// hashes: equal recipes have equal names on every machine.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RecipeHash(pub [u8; 32]);

impl RecipeHash {
    pub(crate) fn of(node: &Node) -> Self {
        let mut w = Writer(blake3::Hasher::new());
        w.node(node);
        Self(*w.0.finalize().as_bytes())
    }
}

impl fmt::Display for RecipeHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        blake3::Hash::from_bytes(self.0).to_hex().fmt(f)
    }
}

impl fmt::Debug for RecipeHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for RecipeHash {
    type Err = blake3::HexError;
    fn from_str(s: &str) -> Result<Self, Self::Err> {
        Ok(Self(*blake3::Hash::from_hex(s)?.as_bytes()))
    }
}

impl Serialize for RecipeHash {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for RecipeHash {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        let text = String::deserialize(d)?;
        text.parse().map_err(serde::de::Error::custom)
    }
}

struct Writer(blake3::Hasher);

impl Writer {
    fn tag(&mut self, tag: u8) {
        self.0.update(&[tag]);
    }

    fn count(&mut self, n: usize) {
        self.0.update(&(n as u64).to_le_bytes());
    }

    fn text(&mut self, s: &str) {
        self.count(s.len());
        self.0.update(s.as_bytes());
    }

    fn f32s(&mut self, xs: &[f32]) {
        for &x in xs {
            // Adding zero turns −0 into 0 and leaves every other value alone.
            self.0.update(&(x + 0.0).to_bits().to_le_bytes());
        }
    }

    fn vec3(&mut self, v: Vec3) {
        self.f32s(&v.to_array());
    }

    fn bounds(&mut self, b: &Aabb) {
        self.vec3(b.min);
        self.vec3(b.max);
    }

    fn placement(&mut self, p: &Placement) {
        self.vec3(p.translation);
        self.f32s(&p.rotation.to_array());
        self.vec3(p.scale);
    }

    fn contours(&mut self, contours: &[Vec<Vec2>]) {
        self.count(contours.len());
        for c in contours {
            self.count(c.len());
            for p in c {
                self.f32s(&p.to_array());
            }
        }
    }

    fn node(&mut self, node: &Node) {
        match node {
            Node::Primitive(p) => {
                self.tag(1);
                self.primitive(p);
            }
            Node::Mesh { mesh, bounds } => {
                self.tag(2);
                self.0.update(&mesh.0);
                self.bounds(bounds);
            }
            Node::Solid(operands) => {
                self.tag(3);
                self.count(operands.len());
                for (i, o) in operands.iter().enumerate() {
                    // The first operand's operator is ignored, so it has no say in the name.
                    let op = if i == 0 { Op::Union } else { o.op };
                    let heard = if o.muted { 16 } else { 0 };
                    self.tag(
                        heard
                            + match op {
                                Op::Union => 0,
                                Op::Intersect => 1,
                                Op::Subtract => 2,
                            },
                    );
                    self.placement(&o.placement);
                    self.0.update(&o.recipe.hash().0);
                }
            }
            Node::Component { id, recipe } => {
                self.tag(4);
                self.text(id);
                self.0.update(&recipe.hash().0);
            }
            Node::Foreign {
                tool,
                data,
                mesh,
                bounds,
            } => {
                self.tag(5);
                self.text(tool);
                self.text(data);
                self.0.update(&mesh.0);
                self.bounds(bounds);
            }
            Node::Canvas(canvas) => {
                self.tag(6);
                self.canvas(canvas);
            }
            Node::Sweep(sweep) => {
                self.tag(7);
                self.count(sweep.count as usize);
                self.tag(match sweep.profile {
                    Profile::Sheet => 0,
                    Profile::Tube => 1,
                });
                self.tag(u8::from(sweep.caps));
                self.f32s(&[sweep.thickness]);
                self.ribs(&sweep.ribs);
            }
            Node::Clones { row, recipe } => {
                self.tag(8);
                self.count(row.count as usize);
                self.tag(u8::from(row.paced));
                self.f32s(&[row.size]);
                self.ribs(&row.ribs);
                self.0.update(&recipe.hash().0);
            }
        }
    }

    fn ribs(&mut self, ribs: &[Rib]) {
        self.count(ribs.len());
        for rib in ribs {
            rib.points.into_iter().for_each(|p| self.vec3(p));
            rib.tangents.into_iter().for_each(|m| self.vec3(m));
            self.f32s(&rib.slopes);
            self.f32s(&rib.start.to_array());
            self.f32s(&[rib.twist]);
        }
    }

    fn canvas(&mut self, canvas: &Canvas) {
        self.f32s(&[canvas.blend, canvas.reach]);
        self.count(canvas.strokes.len());
        for stroke in &canvas.strokes {
            self.f32s(&[stroke.radius, stroke.weight]);
            self.tag(u8::from(stroke.erase) | u8::from(stroke.twin != 0) << 1);
            if stroke.twin != 0 {
                self.count(stroke.twin as usize);
            }
            self.placement(&stroke.placement);
            match &stroke.skeleton {
                Skeleton::Points(points) => {
                    self.tag(0);
                    self.count(points.len());
                    points.iter().for_each(|p| self.f32s(&p.to_array()));
                }
                Skeleton::Line(a, b) => {
                    self.tag(1);
                    self.vec3(*a);
                    self.vec3(*b);
                }
                Skeleton::Polygon(corners) => {
                    self.tag(2);
                    self.count(corners.len());
                    corners.iter().for_each(|&c| self.vec3(c));
                }
                Skeleton::Volume(recipe) => {
                    self.tag(3);
                    self.0.update(&recipe.hash().0);
                }
            }
        }
    }

    fn primitive(&mut self, p: &Primitive) {
        match p {
            Primitive::Sphere { radius } => {
                self.tag(0);
                self.f32s(&[*radius]);
            }
            Primitive::Cuboid { half, rounding } => {
                self.tag(1);
                self.vec3(*half);
                self.f32s(&[*rounding]);
            }
            Primitive::Cylinder {
                radius,
                half_height,
                rounding,
            } => {
                self.tag(2);
                self.f32s(&[*radius, *half_height, *rounding]);
            }
            Primitive::Frustum {
                bottom,
                top,
                half_height,
            } => {
                self.tag(3);
                self.f32s(&[*bottom, *top, *half_height]);
            }
            Primitive::Torus { major, minor } => {
                self.tag(4);
                self.f32s(&[*major, *minor]);
            }
            Primitive::Capsule {
                radius,
                half_height,
            } => {
                self.tag(5);
                self.f32s(&[*radius, *half_height]);
            }
            Primitive::Extrusion {
                contours,
                half_height,
                rounding,
            } => {
                self.tag(6);
                self.contours(contours);
                self.f32s(&[*half_height, *rounding]);
            }
            Primitive::Revolution { contours, rounding } => {
                self.tag(7);
                self.contours(contours);
                self.f32s(&[*rounding]);
            }
            Primitive::Convex { points } => {
                self.tag(8);
                self.count(points.len());
                points.iter().for_each(|&p| self.vec3(p));
            }
            Primitive::Helix {
                major,
                minor,
                pitch,
                turns,
            } => {
                self.tag(9);
                self.f32s(&[*major, *minor, *pitch, *turns]);
            }
            Primitive::Ellipsoid { half } => {
                self.tag(10);
                self.vec3(*half);
            }
        }
    }
}
