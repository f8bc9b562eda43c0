//! From a recipe to the leaves and instructions of a program.

use std::sync::Arc;

use glam::{Affine3A, DMat3, Mat3A, Vec3};
use midair_mesh::{Aabb, MeshHash};
use midair_swept::Sweep;
use rustc_hash::FxHashMap;

use super::{CompileError, Instr, MeshSource, Outline, Program, local_step};
use crate::bake::Volume;
use crate::canvas::{Bench, Canvas, Painting};
use crate::leaf::{Leaf, Source};
use crate::recipe::{restricted, transformed};
use crate::shape::Shape;
use crate::stretch::stretched;
use crate::{Node, Op, Operand, Primitive, Recipe};

/// What becomes a program, part by part.
pub(super) struct Compiler<'a> {
    leaves: Vec<Leaf>,
    tape: Vec<Instr>,
    /// Equal primitives at equal scales are prepared once.
    shapes: FxHashMap<([u8; 32], [u32; 3]), Arc<Shape>>,
    step: f32,
    meshes: &'a dyn MeshSource,
}

impl<'a> Compiler<'a> {
    /// With nothing compiled yet.
    pub fn new(step: f32, meshes: &'a dyn MeshSource) -> Self {
        Self {
            leaves: Vec::new(),
            tape: Vec::new(),
            shapes: FxHashMap::default(),
            step,
            meshes,
        }
    }

    /// The program of `recipe` at its place.
    pub fn program(mut self, recipe: &Recipe, to_world: Affine3A) -> Result<Program, CompileError> {
        let outline = self.emit(recipe, to_world)?;
        Ok(Program {
            leaves: self.leaves,
            tape: self.tape,
            outline,
            step: self.step,
        })
    }

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
        self.volume(recipe, volume, to_world)
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
        self.volume(recipe, volume, to_world)
    }

    fn volume(
        &mut self,
        recipe: &Recipe,
        volume: Arc<Volume>,
        to_world: Affine3A,
    ) -> Result<Outline, CompileError> {
        let bounds = transformed(&volume.bounds(), &to_world);
        // The volume found may be coarser than the one found later.
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
        let inner = Compiler::new(self.step, self.meshes).program(recipe, to_world)?;
        Ok(inner.outline.is_some().then_some(inner))
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
