//! A program as words for the device.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec3;
use midair_field::bake::Volume;
use midair_field::{
    ConvexView, Form, LeafView, OutlineEdge, PaintingView, Program, SkeletonView, TapeStep,
};

use crate::GpuError;
use crate::layout::{DEEPEST, INK, LEAF, STROKE};

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

impl Flat {
    pub fn new(program: &Program) -> Result<Self, GpuError> {
        let mut tape = Vec::new();
        let (mut depth, mut deepest) = (0usize, 0);
        let forms: Vec<LeafView> = program.leaves().collect();
        for step in program.tape() {
            tape.push(match step {
                TapeStep::Load(leaf) => {
                    depth += 1;
                    if let Form::Painting(Some(painting)) = &forms[leaf as usize].form {
                        // Its chunks follow it, so that they are handed down as operands are.
                        tape.push(leaf);
                        tape.extend((0..painting.chunks.len() as u32).map(|c| INK << 29 | c));
                        continue;
                    }
                    leaf
                }
                TapeStep::Negate => 1 << 29,
                TapeStep::Min => 2 << 29,
                TapeStep::Max => 3 << 29,
                TapeStep::MaxNegated => 4 << 29,
            });
            if !matches!(step, TapeStep::Load(_) | TapeStep::Negate) {
                depth = depth.saturating_sub(1);
            }
            deepest = deepest.max(depth);
        }
        if deepest > DEEPEST {
            return Err(GpuError::Unsupported("a solid nested more than 32 deep"));
        }
        let (mut leaves, mut shapes) = (Vec::new(), Vec::new());
        let mut places: HashMap<*const Volume, u32> = HashMap::new();
        let (mut meshes, mut words, mut flattest) = (Vec::new(), 0usize, f32::INFINITY);
        let mut painted = false;
        for leaf in forms {
            flattest = flattest.min(leaf.flattest);
            let mut row = [0u32; LEAF];
            place(&leaf, &mut row);
            let data = match &leaf.form {
                Form::Volume(volume) => *places.entry(Arc::as_ptr(volume)).or_insert_with(|| {
                    let at = words as u32;
                    words += words_of(volume);
                    meshes.push((*volume).clone());
                    at
                }),
                Form::Painting(None) => {
                    return Err(GpuError::Unsupported("a painting with solids as brushes"));
                }
                Form::Painting(Some(view)) => {
                    (painted, flattest) = (true, 0.0);
                    let at = shapes.len() as u32;
                    painting(view, &mut shapes);
                    at
                }
                form => {
                    let at = shapes.len() as u32;
                    shape(form, &mut row, &mut shapes);
                    at
                }
            };
            row[1] = data;
            row[0] = kind(&leaf.form);
            leaves.extend(row);
        }
        let shapes_at = leaves.len() as u32;
        leaves.append(&mut shapes);
        Ok(Self {
            program: leaves,
            shapes: shapes_at,
            tape,
            meshes,
            flattest,
            painted,
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
            out.push(0);
            debug_assert_eq!(out.len() - before, HEAD);
            out.extend_from_slice(view.table);
            out.extend(view.ranges.as_flattened().iter().map(|x| x.to_bits()));
            out.extend(view.values.iter().map(|x| x.to_bits()));
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
    HEAD + view.table.len() + 3 * view.ranges.len() + view.values.len()
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

/// Family, blend, least scale, and where strokes, chunks and segments begin; then these, then what polygons have.
fn painting(view: &PaintingView, data: &mut Vec<u32>) {
    const HEAD: usize = 10;
    let strokes = HEAD;
    let chunks = strokes + STROKE * view.strokes.len();
    let segments = chunks + 9 * view.chunks.len();
    let mut more = segments + 8 * view.segments.len();
    let mut areas: Vec<u32> = Vec::new();
    data.extend(view.family.map(f32::to_bits));
    data.extend([view.blend, view.least].map(f32::to_bits));
    data.extend([strokes, chunks, segments].map(|n| n as u32));
    for s in &view.strokes {
        let mut row = [0u32; STROKE];
        row[1..5].copy_from_slice(
            &[s.weight, f32::from(u8::from(s.erase)), s.scale, s.slope].map(f32::to_bits),
        );
        row[5] = s.to_local.is_some().into();
        let m = s.to_local.unwrap_or(glam::Affine3A::IDENTITY);
        for (to, from) in row[6..18].iter_mut().zip(m.to_cols_array()) {
            *to = from.to_bits();
        }
        match &s.skeleton {
            SkeletonView::Points => {}
            SkeletonView::Line(numbers) => {
                row[0] = 1;
                row[18..26].copy_from_slice(&numbers.map(f32::to_bits));
            }
            SkeletonView::Polygon(frame, corners, edges) => {
                row[0] = 2;
                row[18..31].copy_from_slice(&frame.map(f32::to_bits));
                let (at, end) = (more, more + 2 * corners.len());
                row[31..35]
                    .copy_from_slice(&[corners.len(), at, edges.len(), end].map(|n| n as u32));
                areas.extend(corners.iter().flat_map(|c| c.to_array()).map(f32::to_bits));
                areas.extend(edges.as_flattened().iter().map(|x| x.to_bits()));
                more = end + 5 * edges.len();
            }
        }
        data.extend(row);
    }
    for c in &view.chunks {
        let ends = [c.bounds.min, c.bounds.max];
        data.extend(ends.iter().flat_map(Vec3::to_array).map(f32::to_bits));
        data.push(c.stroke);
        data.extend(c.segments);
    }
    data.extend(view.segments.as_flattened().iter().map(|x| x.to_bits()));
    data.append(&mut areas);
}
