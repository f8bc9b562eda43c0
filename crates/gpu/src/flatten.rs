//! A program as words for the device.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{UVec3, Vec3};
use midair_field::bake::Volume;
use midair_field::{
    Canvas, ConvexView, Form, LeafView, Node, OutlineEdge, Program, Recipe, TapeStep, VolumeView,
};

use crate::GpuError;
use crate::layout::{DEEPEST, INK, INNER, LEAF};
use crate::paint::{chunks, paint};

/// Leaves, shapes, meshes and tape.
pub(crate) struct Flat {
    /// Leaves of [`LEAF`] words each, then what shapes are made of.
    pub program: Vec<u32>,
    /// Where shapes begin.
    pub shapes: u32,
    pub tape: Vec<u32>,
    /// The meshes, each once, in the order in which [`Flat::volumes`] has them.
    pub meshes: Vec<Arc<Volume>>,
    /// The least |∇φ| of any leaf, where the form's own is 1; 0 of a painting, whose slope nobody knows.
    pub flattest: f32,
    /// There is a painting among them.
    pub painted: bool,
}

/// Words before a volume's table.
const HEAD: usize = 8;

/// Words that are being put together.
pub(crate) struct Words {
    leaves: Vec<[u32; LEAF]>,
    pub shapes: Vec<u32>,
    meshes: Vec<Arc<Volume>>,
    /// Where each mesh begins, and where the next one would.
    places: HashMap<*const Volume, u32>,
    volumes: usize,
    flattest: f32,
    painted: bool,
}

impl Words {
    fn leaf(&mut self, at: usize, leaf: &LeafView) -> Result<(), GpuError> {
        self.flattest = self.flattest.min(leaf.flattest);
        let mut row = [0u32; LEAF];
        place(leaf, &mut row);
        row[0] = kind(&leaf.form);
        row[1] = match &leaf.form {
            Form::Volume(volume) => *self.places.entry(Arc::as_ptr(volume)).or_insert_with(|| {
                let at = self.volumes as u32;
                self.volumes += words_of(volume);
                self.meshes.push((*volume).clone());
                at
            }),
            Form::Painting(view) => {
                (self.painted, self.flattest) = (true, 0.0);
                paint(view, self)?
            }
            form => {
                let at = self.shapes.len() as u32;
                shape(form, &mut row, &mut self.shapes);
                at
            }
        };
        self.leaves[at] = row;
        Ok(())
    }

    /// The tape of a solid that a painting's stroke is made of; its parts become leaves like any other.
    pub fn solid(&mut self, program: &Program) -> Result<Vec<u32>, GpuError> {
        let first = self.leaves.len();
        let parts: Vec<LeafView> = program.leaves().collect();
        self.leaves.resize(first + parts.len(), [0; LEAF]);
        for (i, leaf) in parts.iter().enumerate() {
            if let Form::Painting(_) = leaf.form {
                return Err(GpuError::Unsupported(PAINTED_BRUSH));
            }
            self.leaf(first + i, leaf)?;
        }
        let words = program.tape().map(|step| word(step, first as u32));
        if deepest(program) > INNER {
            return Err(GpuError::Unsupported(
                "a painting with a deeply nested solid as brush",
            ));
        }
        Ok(words.collect())
    }
}

/// What no shader knows: these call nothing that calls them.
const PAINTED_BRUSH: &str = "a painting with a solid as brush that has a painting in it";

/// Whether the passes know what a recipe is made of: told from the recipe alone, before anything is compiled for them.
pub fn can_make(recipe: &Recipe) -> bool {
    !holds(recipe, &|canvas| !canvas.recipes().all(can_brush))
}

/// A painting as a brush keeps its strokes; in any other solid none may be.
fn can_brush(brush: &Recipe) -> bool {
    match brush.node() {
        Node::Component { recipe, .. } => can_brush(recipe),
        Node::Canvas(_) => can_make(brush),
        _ => !holds(brush, &|_| true),
    }
}

/// Whether a recipe has a painting in it of which something is true.
fn holds(recipe: &Recipe, is: &dyn Fn(&Canvas) -> bool) -> bool {
    match recipe.node() {
        Node::Canvas(canvas) => is(canvas),
        Node::Component { recipe, .. } | Node::Clones { recipe, .. } => holds(recipe, is),
        Node::Solid(operands) => operands
            .iter()
            .any(|operand| !operand.muted && holds(&operand.recipe, is)),
        Node::Primitive(_) | Node::Mesh { .. } | Node::Foreign { .. } | Node::Sweep(_) => false,
    }
}

fn word(step: TapeStep, first: u32) -> u32 {
    match step {
        TapeStep::Load(leaf) => first + leaf,
        TapeStep::Negate => 1 << 29,
        TapeStep::Min => 2 << 29,
        TapeStep::Max => 3 << 29,
        TapeStep::MaxNegated => 4 << 29,
    }
}

/// Values on the stack at most.
fn deepest(program: &Program) -> usize {
    let (mut depth, mut most) = (0usize, 0);
    for step in program.tape() {
        match step {
            TapeStep::Load(_) => depth += 1,
            TapeStep::Negate => {}
            _ => depth = depth.saturating_sub(1),
        }
        most = most.max(depth);
    }
    most
}

impl Flat {
    pub fn new(program: &Program) -> Result<Self, GpuError> {
        if deepest(program) > DEEPEST {
            return Err(GpuError::Unsupported("a solid nested more than 32 deep"));
        }
        let forms: Vec<LeafView> = program.leaves().collect();
        let mut tape = Vec::new();
        for step in program.tape() {
            tape.push(word(step, 0));
            if let TapeStep::Load(leaf) = step
                && let Form::Painting(view) = &forms[leaf as usize].form
            {
                // Its chunks follow it, so that they are handed down as operands are.
                tape.extend((0..chunks(view)).map(|c| INK << 29 | c));
            }
        }
        let mut words = Words {
            leaves: vec![[0; LEAF]; forms.len()],
            shapes: Vec::new(),
            meshes: Vec::new(),
            places: HashMap::new(),
            volumes: 0,
            flattest: f32::INFINITY,
            painted: false,
        };
        for (i, leaf) in forms.iter().enumerate() {
            words.leaf(i, leaf)?;
        }
        let mut program: Vec<u32> = words.leaves.into_flattened();
        let shapes = program.len() as u32;
        program.append(&mut words.shapes);
        Ok(Self {
            program,
            shapes,
            tape,
            meshes: words.meshes,
            flattest: words.flattest,
            painted: words.painted,
        })
    }

    /// The meshes as words.
    pub fn volumes(&self) -> Vec<u32> {
        let mut out = Vec::new();
        for volume in &self.meshes {
            let view = volume.view();
            let before = out.len();
            out.extend(view.origin.to_array().map(f32::to_bits));
            out.push(view.step.to_bits());
            out.extend(view.cells.to_array());
            let summaries = HEAD + view.table.len() + 3 * view.ranges.len() + view.values.len();
            out.push(summaries as u32);
            debug_assert_eq!(out.len() - before, HEAD);
            out.extend_from_slice(view.table);
            out.extend(view.ranges.as_flattened().iter().map(|x| x.to_bits()));
            out.extend(view.values.iter().map(|x| x.to_bits()));
            for level in summaries_of(&view) {
                out.extend(level.as_flattened().iter().map(|x| x.to_bits()));
            }
        }
        out
    }

    /// Bytes that the meshes take.
    pub fn volume_bytes(&self) -> u64 {
        self.meshes.iter().map(|v| 4 * words_of(v) as u64).sum()
    }
}

fn words_of(volume: &Volume) -> usize {
    let view = volume.view();
    let summaries: usize = coarser(view.cells.map(|c| c.div_ceil(8))).map(count).sum();
    HEAD + view.table.len() + 3 * (view.ranges.len() + summaries) + view.values.len()
}

fn count(n: UVec3) -> usize {
    n.as_usizevec3().element_product()
}

/// Half as many along each side, and so on, down to one.
fn coarser(bricks: UVec3) -> impl Iterator<Item = UVec3> {
    let halved = |n: &UVec3| (n.max_element() > 1).then(|| (n + 1) / 2);
    std::iter::successors(halved(&bricks), halved)
}

/// What is known of bricks together, eight by eight: the least and the greatest value, the greatest slope. A large block
/// looks at a few of these instead of at every brick.
fn summaries_of(view: &VolumeView) -> Vec<Vec<[f32; 3]>> {
    let mut size = view.cells.map(|c| c.div_ceil(8));
    let mut levels: Vec<Vec<[f32; 3]>> = Vec::new();
    for n in coarser(size) {
        let below = levels.last().map_or(view.ranges, Vec::as_slice);
        let mut level = vec![[f32::INFINITY, f32::NEG_INFINITY, 0.0]; count(n)];
        for (i, [low, high, slope]) in below.iter().enumerate() {
            let i = i as u32;
            let at = UVec3::new(i % size.x, i / size.x % size.y, i / (size.x * size.y)) / 2;
            let to = &mut level[(at.x + n.x * (at.y + n.y * at.z)) as usize];
            *to = [to[0].min(*low), to[1].max(*high), to[2].max(*slope)];
        }
        levels.push(level);
        size = n;
    }
    levels
}

fn kind(form: &Form) -> u32 {
    match form {
        Form::Sphere(_) => 0,
        Form::Cuboid(..) => 1,
        Form::Cylinder(..) => 2,
        Form::Frustum(..) => 3,
        Form::Torus(..) => 4,
        Form::Capsule(..) => 5,
        Form::Ellipsoid(..) => 6,
        Form::Extrusion(..) => 7,
        Form::Revolution(_) => 8,
        Form::Convex(_) => 9,
        Form::Helix(_) => 10,
        Form::Volume(_) => 11,
        Form::Painting(_) => 12,
    }
}

fn place(leaf: &LeafView, row: &mut [u32; LEAF]) {
    row[2] = leaf.scale.to_bits();
    row[3] = leaf.diagonal.to_bits();
    let m = leaf.to_local;
    let columns = [
        Vec3::from(m.matrix3.x_axis),
        Vec3::from(m.matrix3.y_axis),
        Vec3::from(m.matrix3.z_axis),
        Vec3::from(m.translation),
        leaf.extent,
        leaf.reach,
    ];
    for (to, from) in row[4..]
        .iter_mut()
        .zip(columns.iter().flat_map(Vec3::to_array))
    {
        *to = from.to_bits();
    }
}

/// The numbers of a form, in the row from word 24 on, and in `data` where there are more.
fn shape(form: &Form, row: &mut [u32; LEAF], data: &mut Vec<u32>) {
    let mut put = |numbers: &[f32]| {
        for (to, from) in row[24..].iter_mut().zip(numbers) {
            *to = from.to_bits();
        }
    };
    match form {
        Form::Sphere(r) => put(&[*r]),
        Form::Cuboid(h, r) => put(&[h.x, h.y, h.z, *r]),
        Form::Cylinder(a, b, c) | Form::Frustum(a, b, c) => put(&[*a, *b, *c]),
        Form::Torus(a, b) | Form::Capsule(a, b) => put(&[*a, *b]),
        Form::Ellipsoid(unit, e, s) => put(&[*unit, e.x, e.y, e.z, s.x, s.y, s.z]),
        Form::Helix(numbers) => put(numbers),
        Form::Extrusion(edges, half, rounding) => {
            put(&[*half, *rounding]);
            outline(edges, data);
        }
        Form::Revolution(edges) => outline(edges, data),
        Form::Convex(hull) => convex(hull, data),
        Form::Volume(_) | Form::Painting(_) => {}
    }
}

fn outline(edges: &[OutlineEdge], data: &mut Vec<u32>) {
    data.push(edges.len() as u32);
    data.extend(edges.as_flattened().iter().map(|x| x.to_bits()));
    for group in edges.chunks(8) {
        let (mut low, mut high) = (glam::Vec2::INFINITY, glam::Vec2::NEG_INFINITY);
        for e in group {
            let a = glam::Vec2::new(e[0], e[1]);
            for p in [a, a + glam::Vec2::new(e[2], e[3]), a.with_y(e[5])] {
                (low, high) = (low.min(p), high.max(p));
            }
        }
        // Rounding of a + d must not leave the box.
        let slack = 1.0e-6 * low.abs().max(high.abs()).max_element();
        let (low, high) = (low - slack, high + slack);
        data.extend([low.x, low.y, high.x, high.y].map(f32::to_bits));
    }
}

fn convex(hull: &ConvexView, data: &mut Vec<u32>) {
    data.push(hull.planes.len() as u32);
    data.push(hull.edges.len() as u32);
    let mut wall = 0;
    for (plane, walls) in hull.planes.iter().zip(&hull.walls) {
        data.extend(plane.map(f32::to_bits));
        data.extend([wall, walls.len() as u32]);
        wall += walls.len() as u32;
    }
    data.extend(hull.edges.as_flattened().iter().map(|x| x.to_bits()));
    data.extend(hull.walls.iter().flatten().flatten().map(|x| x.to_bits()));
}
