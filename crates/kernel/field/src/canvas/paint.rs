use glam::{Affine3A, IVec3, Vec3};
use midair_mesh::Aabb;

use super::area::Area;
use super::kernel::{Family, T, half_space};
use super::nodes::{
    Layers, away, axis, beside, blended, edge, erase_from, erased, join, join_inner, level, line,
    moved, nearest, polygon, profile, raise,
};
use super::stroke::HARD;
use crate::Program;
use crate::scratch::Scratch;
use crate::shape::{NODES, Points};

/// Segments of a led point that are looked up together.
pub(super) const CHUNK: usize = 8;
/// Chunks that are looked up together.
pub(super) const GROUP: usize = 32;
/// Steps from the surface within which the distance to what is felt nowhere is told apart.
pub(super) const FAR: f32 = 3.0;

/// A canvas made ready for evaluation, in its own frame.
#[derive(Clone, Debug)]
pub(crate) struct Painting {
    pub(super) family: Family,
    pub(super) blend: f32,
    pub(super) strokes: Vec<Inked>,
    pub(super) segments: Vec<Segment>,
    /// By stroke.
    pub(super) chunks: Vec<Chunk>,
    pub(super) groups: Vec<Aabb>,
    /// The least of what strokes make of one unit of potential, metres.
    pub(super) least: f32,
}

/// One stroke.
#[derive(Clone, Debug)]
pub(super) struct Inked {
    pub kind: Inking,
    pub weight: f32,
    pub erase: bool,
    /// The same for strokes that are one; 0 for one by itself.
    pub twins: u32,
    /// Metres for one unit of potential at its surface; for a canvas, the factor on its own.
    pub scale: f32,
    /// A bound of |∇F|, per metre; for a field, metres of the world in one of the canvas.
    pub slope: f32,
    /// To its own frame, where that is not the canvas's.
    pub to_local: Option<Affine3A>,
}

impl Inked {
    /// Whether the next stroke is one with this one.
    pub fn is_twin(&self, next: &Self) -> bool {
        self.twins != 0 && self.twins == next.twins
    }
}

#[derive(Clone, Debug)]
pub(super) enum Inking {
    Points,
    /// Start, unit direction, length, 1 / support.
    Line(Vec3, Vec3, f32, f32),
    Polygon(Box<Area>),
    /// The solid, and how many metres of its φ the kernel's radius is.
    Field(Box<Program>, f32),
    Canvas(Box<Painting>),
}

/// A led point between two places: it moves by `along` while its radius goes from `radius` to
/// `radius + wider`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub from: Vec3,
    pub along: Vec3,
    pub radius: f32,
    pub wider: f32,
}

#[derive(Clone, Debug)]
pub(super) struct Chunk {
    /// Where it is felt.
    pub bounds: Aabb,
    pub stroke: u32,
    /// Its segments.
    pub from: u32,
    pub to: u32,
}

impl Segment {
    /// The squared distance to it in its own radii: the least of |p − c(t)|² / r(t)² along the way.
    #[inline(always)]
    pub(super) fn at(&self, x: f32, y: f32, z: f32) -> f32 {
        let (b, r, w) = (self.along, self.radius, self.wider);
        let (qx, qy, qz) = (x - self.from.x, y - self.from.y, z - self.from.z);
        let qq = qx * qx + qy * qy + qz * qz;
        let qb = qx * b.x + qy * b.y + qz * b.z;
        let bb = b.x * b.x + b.y * b.y + b.z * b.z;
        // Where the derivative is zero: linear in t.
        let up = w * qq + r * qb;
        let down = bb * r + w * qb;
        let end = if up > 0.0 { 1.0 } else { 0.0 };
        let t = if down > 1.0e-12 { up / down } else { end };
        let t = if t > 0.0 { t } else { 0.0 };
        let t = if t < 1.0 { t } else { 1.0 };
        let (dx, dy, dz) = (qx - t * b.x, qy - t * b.y, qz - t * b.z);
        let wide = r + t * w;
        (dx * dx + dy * dy + dz * dz) / (wide * wide)
    }

    pub(super) fn thinnest(&self) -> f32 {
        self.radius.min(self.radius + self.wider)
    }
}

/// The nodes of a brick, in the canvas's frame and on the lattice of the world.
pub(crate) struct Place<'a> {
    pub points: &'a Points,
    /// Their box in the canvas's frame.
    pub within: Aabb,
    pub first: IVec3,
    /// Steps of the world in metres of the canvas, at least.
    pub local_step: f32,
}

/// A cube of space and what is no further than `around` from it, in the canvas's frame and in the
/// world.
pub(crate) struct Block {
    pub within: Aabb,
    pub centre: Vec3,
    pub radius: f32,
    /// The cube of the world: its middle and half its side.
    pub world: Vec3,
    pub half: f32,
    pub around: f32,
}

impl Painting {
    /// The chunks felt in a box, by stroke.
    pub(super) fn within(&self, b: &Aabb) -> Vec<u32> {
        let mut found = Vec::new();
        for (g, group) in self.groups.iter().enumerate() {
            if !touch(group, b) {
                continue;
            }
            let first = g * GROUP;
            let last = (first + GROUP).min(self.chunks.len());
            for i in first..last {
                if touch(&self.chunks[i].bounds, b) {
                    found.push(i as u32);
                }
            }
        }
        found
    }

    /// The strokes of chunks that stand by stroke, each with its own.
    pub(super) fn runs<'a>(
        &'a self,
        chunks: &'a [u32],
    ) -> impl Iterator<Item = (&'a Inked, &'a [u32])> {
        let of = |c: u32| self.chunks[c as usize].stroke;
        chunks
            .chunk_by(move |a, b| of(*a) == of(*b))
            .map(move |own| (&self.strokes[of(own[0]) as usize], own))
    }

    /// φ at the nodes of a brick, metres of the canvas: (T − F) at the scale of the strokes that
    /// are felt there, so that |∇φ| is near 1 at the surface.
    pub fn brick(&self, place: &Place, out: &mut [f32; NODES]) {
        let mut layers = Layers::spare();
        self.potential(place, &mut layers);
        let reach = FAR * place.local_step;
        level(&layers, out);
        if layers.fine.iter().all(|f| *f > 0.0) {
            layers.give_back();
            return;
        }
        // Felt nowhere: no nearer than the nearest thing's own field ends.
        let near = self.within(&place.within.grown(reach));
        let mut least = [(FAR + 1.0) * place.local_step; NODES];
        for &c in &near {
            let chunk = &self.chunks[c as usize];
            let stroke = &self.strokes[chunk.stroke as usize];
            if stroke.erase {
                continue;
            }
            let rim = T * stroke.scale;
            away(&chunk.bounds, rim, place.points, &mut least);
        }
        for (i, o) in out.iter_mut().enumerate() {
            if layers.fine[i] <= 0.0 {
                *o = least[i];
            }
        }
        layers.give_back();
    }

    fn potential(&self, place: &Place, layers: &mut Layers) {
        let chunks = self.within(&place.within);
        let mut runs = self.runs(&chunks).peekable();
        let mut raised = false;
        // The most that the twins before it are felt.
        let mut twins: Option<Box<[f32; NODES]>> = None;
        while let Some((stroke, own)) = runs.next() {
            // A volume's own scale changes from place to place, and it fills this in by itself.
            let mut inner = None;
            let felt = self.ink(stroke, own, place, layers, &mut inner);
            if felt && !stroke.erase {
                match &inner {
                    Some(fine) => join_inner(layers, fine, stroke),
                    None => join(layers, 1.0 / stroke.scale),
                }
            }
            if let Some(before) = &twins {
                if !felt {
                    layers.one.copy_from_slice(&before[..]);
                } else {
                    let pairs = layers.one.iter_mut().zip(&before[..]);
                    pairs.for_each(|(a, b)| *a = if *b > *a { *b } else { *a });
                }
            } else if !felt {
                continue;
            }
            if runs.peek().is_some_and(|(next, _)| stroke.is_twin(next)) {
                twins = Some(Box::new(layers.one));
                continue;
            }
            twins = None;
            if stroke.erase {
                self.lower(layers, &mut raised);
                erase_from(&mut layers.all, &layers.one);
                continue;
            }
            if self.blend >= HARD {
                layers
                    .all
                    .iter_mut()
                    .zip(&layers.one)
                    .for_each(|(a, f)| *a = if *f > *a { *f } else { *a });
            } else if self.blend == 1.0 {
                layers
                    .all
                    .iter_mut()
                    .zip(&layers.one)
                    .for_each(|(a, f)| *a += *f);
            } else {
                if !raised {
                    raise(&mut layers.all, self.blend);
                    raised = true;
                }
                raise(&mut layers.one, self.blend);
                layers
                    .all
                    .iter_mut()
                    .zip(&layers.one)
                    .for_each(|(a, f)| *a += *f);
            }
        }
        self.lower(layers, &mut raised);
    }

    fn lower(&self, layers: &mut Layers, raised: &mut bool) {
        if std::mem::take(raised) {
            raise(&mut layers.all, 1.0 / self.blend);
        }
    }

    /// The potential of one stroke, in `layers.one`; false where it is zero everywhere.
    fn ink(
        &self,
        stroke: &Inked,
        chunks: &[u32],
        place: &Place,
        layers: &mut Layers,
        inner: &mut Option<Box<[f32; NODES]>>,
    ) -> bool {
        let moved = stroke.to_local.map(|m| Box::new(moved(place.points, &m)));
        let points = moved.as_deref().unwrap_or(place.points);
        let out = &mut layers.one;
        match &stroke.kind {
            Inking::Points => {
                let widest = self.family.reach;
                out.fill(widest * widest);
                let mut any = false;
                for &c in chunks {
                    let chunk = &self.chunks[c as usize];
                    for s in &self.segments[chunk.from as usize..chunk.to as usize] {
                        let c = points.centre;
                        let near = s.at(c.x, c.y, c.z).sqrt() - points.radius / s.thinnest();
                        if near < widest * 1.0001 {
                            any = true;
                            nearest(s, points, out);
                        }
                    }
                }
                if any {
                    profile(&self.family, stroke.weight, out);
                }
                any
            }
            Inking::Line(from, along, length, inverse) => {
                line(
                    &self.family,
                    *from,
                    *along,
                    *length,
                    *inverse,
                    stroke.weight,
                    points,
                    out,
                );
                true
            }
            Inking::Polygon(area) => {
                let to_local = stroke.to_local.as_ref();
                let view = area.seen(points.centre, points.radius, &place.within, to_local);
                let Some(view) = view else {
                    return false;
                };
                if view.is_within() {
                    // No edge is felt: it is a plane without end.
                    let [nx, ny, nz] = (area.axes[2] * area.inverse).to_array();
                    let from = area.origin.dot(area.axes[2]) * area.inverse;
                    for (i, o) in out.iter_mut().enumerate() {
                        let h = points.x[i] * nx + points.y[i] * ny + points.z[i] * nz - from;
                        *o = stroke.weight * self.family.at_plane(h);
                    }
                    return true;
                }
                match area.only_edge(view.flat, view.radius) {
                    Some((only, right)) => {
                        edge(&self.family, area, only, right, stroke.weight, points, out)
                    }
                    None => polygon(&self.family, area, stroke.weight, points, out),
                }
                true
            }
            Inking::Field(program, radius) => {
                let half = 3.5 * program.step();
                let centre = (place.first.as_vec3() + 3.5) * program.step();
                let (low, high) = program.bounds_of(centre, half, 0.0);
                if low >= *radius {
                    return false;
                }
                if high <= -radius {
                    out.fill(stroke.weight * half_space(-1.0));
                    return true;
                }
                let mut scratch = Scratch::spare();
                let values = program.values(place.first >> 3, &mut scratch);
                let felt = values.is_some();
                if let Some(values) = values {
                    beside(stroke.weight, 1.0 / radius, values, out);
                }
                scratch.give_back();
                felt
            }
            Inking::Canvas(painting) => {
                let m = stroke.to_local.unwrap_or(Affine3A::IDENTITY);
                let inside = Place {
                    points,
                    within: crate::recipe::transformed(&place.within, &m),
                    ..*place
                };
                let mut own = Layers::spare();
                painting.potential(&inside, &mut own);
                for (o, a) in out.iter_mut().zip(&own.all) {
                    *o = stroke.weight * a;
                }
                // Scale 1/s of the whole, as the nested strokes have it.
                let mut fine = Box::new([0.0; NODES]);
                for (i, f) in fine.iter_mut().enumerate() {
                    *f = if own.felt[i] > 0.0 {
                        own.fine[i] / own.felt[i]
                    } else {
                        0.0
                    };
                }
                own.give_back();
                *inner = Some(fine);
                true
            }
        }
    }

    /// F and its scale at one place.
    fn point(&self, p: Vec3, world: Vec3) -> (f32, f32, f32) {
        let (mut all, mut felt, mut fine) = (0.0f32, 0.0f32, 0.0f32);
        let chunks = self.within(&Aabb::new(p, p));
        let mut runs = self.runs(&chunks).peekable();
        let mut twins = 0.0f32;
        while let Some((stroke, own)) = runs.next() {
            let q = stroke.to_local.map_or(p, |m| m.transform_point3(p));
            let mut scale = 1.0 / stroke.scale;
            let one = match &stroke.kind {
                Inking::Points => {
                    let u2 = own
                        .iter()
                        .flat_map(|c| {
                            let c = &self.chunks[*c as usize];
                            &self.segments[c.from as usize..c.to as usize]
                        })
                        .map(|s| s.at(q.x, q.y, q.z))
                        .fold(f32::INFINITY, f32::min);
                    self.family.at_point(u2)
                }
                Inking::Line(from, along, length, inverse) => {
                    let (d2, s0) = axis(*from, *along, *inverse, q.x, q.y, q.z);
                    self.family.at_line(d2, s0, s0 + length * inverse)
                }
                Inking::Polygon(area) => area.at(&self.family, q),
                Inking::Field(program, radius) => half_space(program.at(world) / radius),
                Inking::Canvas(painting) => {
                    let (f, own, fine) = painting.point(q, world);
                    scale = if own > 0.0 {
                        fine / own / stroke.scale
                    } else {
                        0.0
                    };
                    f
                }
            } * stroke.weight;
            if !stroke.erase {
                felt += one;
                fine += one * scale;
            }
            let one = one.max(twins);
            if runs.peek().is_some_and(|(next, _)| stroke.is_twin(next)) {
                twins = one;
                continue;
            }
            twins = 0.0;
            all = if stroke.erase {
                erased(all, one)
            } else {
                blended(all, one, self.blend)
            };
        }
        (all, felt, fine)
    }

    /// φ at one place of the canvas, metres.
    pub fn at(&self, p: Vec3, world: Vec3) -> f32 {
        let (all, felt, fine) = self.point(p, world);
        if fine > 0.0 {
            return (T - all) * felt / fine;
        }
        let away = |c: &Chunk| {
            let gap = (c.bounds.min - p).max(p - c.bounds.max).max(Vec3::ZERO);
            gap.length().max(T * self.strokes[c.stroke as usize].scale)
        };
        self.chunks
            .iter()
            .filter(|c| !self.strokes[c.stroke as usize].erase)
            .map(away)
            .fold(f32::INFINITY, f32::min)
    }
}

pub(super) fn touch(a: &Aabb, b: &Aabb) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}
