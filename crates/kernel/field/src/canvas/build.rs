use glam::{Affine3A, Vec3};
use midair_mesh::Aabb;

use super::area::Area;
use super::kernel::{Edge, Family, HALF_SPACE_SLOPE};
use super::paint::{CHUNK, Chunk, GROUP, Inked, Inking, Painting, Segment};
use super::stroke::{Canvas, Flat, Skeleton, Stroke, unnamed};
use crate::recipe::transformed;
use crate::{CompileError, Node, Program, Recipe};

/// What building a painting needs from the compiler around it.
pub(crate) trait Bench {
    /// A solid of its own, standing at a place of the world; `None` where it is empty.
    fn solid(
        &mut self,
        recipe: &Recipe,
        to_world: Affine3A,
    ) -> Result<Option<Program>, CompileError>;
    /// The smallest singular value of a transform's linear part.
    fn smallest(&self, m: &Affine3A) -> f32;
}

/// A part of a painting that can change by itself.
pub(crate) struct Part {
    pub key: [u8; 32],
    /// Where it is felt, in the canvas's frame.
    pub bounds: Aabb,
}

impl Painting {
    /// Makes a canvas ready that stands at `to_world`. The parts name what each chunk is made of.
    pub fn new(
        canvas: &Canvas,
        to_world: Affine3A,
        bench: &mut dyn Bench,
    ) -> Result<(Self, Vec<Part>), CompileError> {
        let mut painting = Self {
            family: Family::new(canvas.reach),
            blend: canvas.blend,
            strokes: Vec::with_capacity(canvas.strokes.len()),
            segments: Vec::new(),
            chunks: Vec::new(),
            groups: Vec::new(),
            least: f32::INFINITY,
        };
        let mut parts = Vec::new();
        let mut twins = 0;
        for (i, stroke) in canvas.strokes.iter().enumerate() {
            let before = i.checked_sub(1).and_then(|i| canvas.strokes.get(i));
            let joins = before.is_some_and(|b| stroke.is_twin(b));
            if !joins {
                twins = if stroke.twin == 0 { 0 } else { i as u32 + 1 };
            }
            painting.add(canvas, stroke, (twins, joins), to_world, bench, &mut parts)?;
        }
        painting.groups = painting
            .chunks
            .chunks(GROUP)
            .map(|g| g.iter().fold(Aabb::EMPTY, |all, c| all.union(&c.bounds)))
            .collect();
        Ok((painting, parts))
    }

    /// Where it is felt.
    pub fn bounds(&self) -> Aabb {
        self.chunks
            .iter()
            .filter(|c| !self.strokes[c.stroke as usize].erase)
            .fold(Aabb::EMPTY, |all, c| all.union(&c.bounds))
    }

    fn add(
        &mut self,
        canvas: &Canvas,
        stroke: &Stroke,
        (twins, joins): (u32, bool),
        to_world: Affine3A,
        bench: &mut dyn Bench,
        parts: &mut Vec<Part>,
    ) -> Result<(), CompileError> {
        let placed = stroke.placement.affine();
        let smallest = bench.smallest(&placed);
        let scale = stroke.placement.scale;
        let volume = matches!(stroke.skeleton, Skeleton::Volume(_));
        // What is scaled evenly is brought into the canvas's frame; the rest keeps its own.
        let even = (scale.abs() - scale.x.abs()).abs().max_element() <= 1.0e-6 * scale.x.abs();
        let fold = even && !volume;
        let (by, radius) = if fold {
            (placed, stroke.radius * smallest)
        } else {
            (Affine3A::IDENTITY, stroke.radius)
        };
        let outer = if fold { Affine3A::IDENTITY } else { placed };
        let shrink = if fold { 1.0 } else { smallest };
        let family = self.family;
        let support = family.reach * radius;
        let [_, line, polygon] = family
            .slopes()
            .map(|s| s * stroke.weight / (support * shrink));
        let mut name = Name::of(canvas, stroke, joins, &to_world);
        let index = self.strokes.len() as u32;
        let first = self.segments.len();
        let mut inked = Inked {
            kind: Inking::Points,
            weight: stroke.weight,
            erase: stroke.erase,
            twins,
            scale: family.scale(radius) * shrink,
            slope: 0.0,
            to_local: (!fold).then(|| placed.inverse()),
        };
        let felt = |points: &[Vec3], by: f32| {
            let b = points
                .iter()
                .fold(Aabb::EMPTY, |all, p| all.union(&Aabb::new(*p, *p)));
            transformed(&b.grown(by), &outer)
        };
        let mut chunks: Vec<(Aabb, usize, usize, [u8; 32])> = Vec::new();
        match &stroke.skeleton {
            Skeleton::Points(points) => {
                let at = |i: usize| {
                    let p = points[i];
                    (by.transform_point3(p.truncate()), p.w * radius)
                };
                let mut thinnest = f32::INFINITY;
                for i in 0..points.len().saturating_sub(1).max(1) {
                    let (from, r) = at(i);
                    let (to, s) = at((i + 1).min(points.len() - 1));
                    thinnest = thinnest.min(r.min(s));
                    self.segments.push(Segment {
                        from,
                        along: to - from,
                        radius: r,
                        wider: s - r,
                    });
                }
                inked.slope =
                    family.slopes()[0] * stroke.weight / (family.reach * thinnest * shrink);
                // A led point has very many: each is named after the stroke's name and its own points.
                let mut bytes = Vec::with_capacity(32 + 16 * (CHUNK + 1));
                bytes.extend(name.so_far());
                let mut from = first;
                while from < self.segments.len() {
                    let to = (from + CHUNK).min(self.segments.len());
                    let mut all = Aabb::EMPTY;
                    for s in &self.segments[from..to] {
                        for (p, r) in [(s.from, s.radius), (s.from + s.along, s.radius + s.wider)] {
                            let reach = family.reach * r * 1.000_01;
                            all = all.union(&Aabb::around(p, Vec3::splat(reach)));
                        }
                    }
                    let own = &points[from - first..(to - first + 1).min(points.len())];
                    bytes.truncate(32);
                    for x in own.iter().flat_map(|p| p.to_array()) {
                        bytes.extend((x + 0.0).to_bits().to_le_bytes());
                    }
                    let key = *blake3::hash(&bytes).as_bytes();
                    chunks.push((transformed(&all, &outer), from, to, key));
                    from = to;
                }
            }
            Skeleton::Line(a, b) => {
                let ends = [by.transform_point3(*a), by.transform_point3(*b)];
                let length = ends[0].distance(ends[1]);
                let along = (ends[1] - ends[0]) / length.max(f32::MIN_POSITIVE);
                inked.kind = Inking::Line(ends[0], along, length, 1.0 / support);
                inked.slope = line;
                let key = name.with(a.to_array().into_iter().chain(b.to_array()));
                chunks.push((felt(&ends, support * 1.000_01), 0, 0, key));
            }
            Skeleton::Polygon(corners) => {
                let moved: Vec<Vec3> = corners.iter().map(|c| by.transform_point3(*c)).collect();
                let Some(flat) = Flat::new(&moved) else {
                    return Ok(());
                };
                let place = |c: &glam::Vec2| flat.origin + flat.x * c.x + flat.y * c.y;
                let ends: Vec<Vec3> = flat.corners.iter().map(place).collect();
                let corners_in: Vec<glam::Vec2> =
                    flat.corners.iter().map(|c| c / support).collect();
                inked.kind = Inking::Polygon(Box::new(Area {
                    edges: Edge::all(&corners_in),
                    origin: flat.origin,
                    axes: [flat.x, flat.y, flat.normal],
                    corners: corners_in,
                    inverse: 1.0 / support,
                }));
                inked.slope = polygon;
                let key = name.with(corners.iter().flat_map(|c| c.to_array()));
                chunks.push((felt(&ends, support * 1.000_01), 0, 0, key));
            }
            Skeleton::Volume(recipe) => {
                name.bytes(&recipe.hash().0);
                let inner = unnamed(recipe);
                if let Node::Canvas(canvas) = inner.node() {
                    let (inside, own) = Self::new(canvas, to_world * placed, bench)?;
                    let felt = transformed(&inside.bounds(), &placed);
                    if felt.is_empty() {
                        return Ok(());
                    }
                    own.iter().for_each(|p| name.bytes(&p.key));
                    let key = name.with([]);
                    inked.scale = smallest;
                    self.least = self.least.min(inside.least * smallest);
                    inked.kind = Inking::Canvas(Box::new(inside));
                    chunks.push((felt, 0, 0, key));
                } else {
                    let Some(program) = bench.solid(recipe, to_world * placed)? else {
                        return Ok(());
                    };
                    let world = bench.smallest(&(to_world * placed));
                    if let Some(outline) = &program.outline {
                        name.bytes(&outline.key);
                    }
                    let key = name.with([]);
                    inked.scale = stroke.radius * smallest / HALF_SPACE_SLOPE;
                    // Metres of the world in one of the canvas.
                    let m = to_world.matrix3;
                    let most = m.x_axis.length().max(m.y_axis.length());
                    inked.slope = most.max(m.z_axis.length());
                    let b = program.bounds();
                    if b.is_empty() {
                        return Ok(());
                    }
                    let radius = stroke.radius * world;
                    let felt = transformed(&b.grown(radius * 1.001), &to_world.inverse());
                    inked.kind = Inking::Field(Box::new(program), radius);
                    inked.to_local = None;
                    chunks.push((felt, 0, 0, key));
                }
            }
        }
        if !stroke.erase && !matches!(inked.kind, Inking::Canvas(_)) {
            self.least = self.least.min(inked.scale);
        }
        self.strokes.push(inked);
        for (bounds, from, to, key) in chunks {
            parts.push(Part { key, bounds });
            self.chunks.push(Chunk {
                bounds,
                stroke: index,
                from: from as u32,
                to: to as u32,
            });
        }
        Ok(())
    }
}

/// What names a chunk: everything about its stroke but its points.
struct Name(blake3::Hasher);

impl Name {
    fn of(canvas: &Canvas, stroke: &Stroke, joins: bool, to_world: &Affine3A) -> Self {
        let mut name = Self(blake3::Hasher::new());
        let p = &stroke.placement;
        name.numbers(
            [canvas.blend, canvas.reach, stroke.radius, stroke.weight]
                .into_iter()
                .chain(p.translation.to_array())
                .chain(p.rotation.to_array())
                .chain(p.scale.to_array())
                .chain(to_world.to_cols_array()),
        );
        let kind = match stroke.skeleton {
            Skeleton::Points(_) => 0,
            Skeleton::Line(..) => 1,
            Skeleton::Polygon(_) => 2,
            Skeleton::Volume(_) => 3,
        };
        name.0
            .update(&[kind, u8::from(stroke.erase), u8::from(joins)]);
        name
    }

    fn numbers(&mut self, xs: impl IntoIterator<Item = f32>) {
        for x in xs {
            self.0.update(&(x + 0.0).to_bits().to_le_bytes());
        }
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    fn with(mut self, xs: impl IntoIterator<Item = f32>) -> [u8; 32] {
        self.numbers(xs);
        *self.0.finalize().as_bytes()
    }

    /// What it comes to so far.
    fn so_far(&self) -> [u8; 32] {
        *self.0.finalize().as_bytes()
    }
}
