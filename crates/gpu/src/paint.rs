//! A painting as words for the device.

use glam::{Affine3A, Vec3};
use midair_field::{ChunkView, PaintingView, SkeletonView, StrokeView};
use midair_mesh::Aabb;

use crate::GpuError;
use crate::flatten::Words;
use crate::layout::{NESTED, STROKE};

/// Words before anything else: family, blend, least scale, and where strokes, chunks and segments begin.
const HEAD: usize = 10;
/// Words of a family and its blend.
const FAMILY: usize = 6;
/// Kinds of strokes, as `paint.wgsl` has them.
const LINE: u32 = 1;
const POLYGON: u32 = 2;
const SOLID: u32 = 3;
const BEGIN: u32 = 4;
const END: u32 = 5;

/// How many chunks it has on the device: those of paintings in it, and two about each of these.
pub(crate) fn chunks(view: &PaintingView) -> u32 {
    let inner = |s: &StrokeView| match &s.skeleton {
        SkeletonView::Painting(inner) => chunks(inner) + 1,
        _ => 0,
    };
    view.chunks.len() as u32 + view.strokes.iter().map(inner).sum::<u32>()
}

/// Appends a painting to the shapes; where it begins.
pub(crate) fn paint(view: &PaintingView, words: &mut Words) -> Result<u32, GpuError> {
    let mut sheet = Sheet::default();
    let canvas = Frame {
        family: 0,
        to_local: None,
        stretch: 1.0,
        depth: 0,
        within: None,
    };
    sheet.add(view, &canvas, words)?;
    let at = words.shapes.len() as u32;
    let out = &mut words.shapes;
    out.extend(family(view));
    out.push(view.least.to_bits());
    let strokes = HEAD + sheet.more.len();
    let chunks = strokes + STROKE * sheet.strokes.len();
    let segments = chunks + 9 * sheet.chunks.len();
    out.extend([strokes, chunks, segments].map(|n| n as u32));
    out.append(&mut sheet.more);
    out.extend(sheet.strokes.as_flattened());
    out.extend(sheet.chunks.as_flattened());
    out.extend(sheet.segments.as_flattened().iter().map(|x| x.to_bits()));
    Ok(at)
}

fn family(view: &PaintingView) -> [u32; FAMILY] {
    let [a, b, c, d, e] = view.family;
    [a, b, c, d, e, view.blend].map(f32::to_bits)
}

/// Where a painting stands in the outermost one.
struct Frame {
    /// Where its family lies in the words.
    family: u32,
    /// From the outermost canvas to its own.
    to_local: Option<Affine3A>,
    /// By how much that stretches at most.
    stretch: f32,
    depth: usize,
    /// Where it is felt, in the outermost canvas.
    within: Option<Aabb>,
}

/// A painting with all that are in it, one stroke after the other.
#[derive(Default)]
struct Sheet {
    strokes: Vec<[u32; STROKE]>,
    chunks: Vec<[u32; 9]>,
    segments: Vec<[f32; 8]>,
    /// Families, polygons and tapes, from [`HEAD`] on.
    more: Vec<u32>,
    /// Numbers of strokes that are one, given so far.
    twins: u32,
}

impl Sheet {
    fn add(
        &mut self,
        view: &PaintingView,
        frame: &Frame,
        words: &mut Words,
    ) -> Result<(), GpuError> {
        let first = self.segments.len() as u32;
        self.segments.extend(&view.segments);
        let mut chunks = &view.chunks[..];
        // Numbers of twins are a painting's own.
        let (mut twins, mut told) = (0, 0);
        for (i, stroke) in view.strokes.iter().enumerate() {
            let own = chunks.iter().take_while(|c| c.stroke == i as u32).count();
            let (here, rest) = chunks.split_at(own);
            chunks = rest;
            if stroke.twins != twins {
                twins = stroke.twins;
                self.twins += u32::from(twins != 0);
                told = if twins == 0 { 0 } else { self.twins };
            }
            let mut row = row(stroke, frame, told);
            if let SkeletonView::Painting(inner) = &stroke.skeleton {
                self.nested(stroke, inner, row, here, frame, words)?;
                continue;
            }
            self.skeleton(&stroke.skeleton, &mut row, words)?;
            self.push(row, here, first, frame);
        }
        Ok(())
    }

    /// A painting that is a stroke: one that begins it, its own strokes, and one that ends it.
    fn nested(
        &mut self,
        stroke: &StrokeView,
        inner: &PaintingView,
        mut row: [u32; STROKE],
        chunks: &[ChunkView],
        frame: &Frame,
        words: &mut Words,
    ) -> Result<(), GpuError> {
        if frame.depth == NESTED {
            return Err(GpuError::Unsupported(
                "paintings as brushes of each other, more than three deep",
            ));
        }
        let own = stroke.to_local.unwrap_or(Affine3A::IDENTITY);
        let to_local = own * frame.to_local.unwrap_or(Affine3A::IDENTITY);
        let within = chunks
            .iter()
            .fold(Aabb::EMPTY, |all, c| all.union(&placed(&c.bounds, frame)));
        let inside = Frame {
            family: (HEAD + self.more.len()) as u32,
            to_local: Some(to_local),
            stretch: frame.stretch * stretch(&own),
            depth: frame.depth + 1,
            within: Some(within),
        };
        self.more.extend(family(inner));
        row[0] = BEGIN;
        self.push(row, chunks, 0, frame);
        self.add(inner, &inside, words)?;
        row[0] = END;
        row[38] = inside.family;
        self.push(row, chunks, 0, frame);
        Ok(())
    }

    fn skeleton(
        &mut self,
        skeleton: &SkeletonView,
        row: &mut [u32; STROKE],
        words: &mut Words,
    ) -> Result<(), GpuError> {
        let at = HEAD + self.more.len();
        match skeleton {
            SkeletonView::Points | SkeletonView::Painting(_) => {}
            SkeletonView::Line(numbers) => {
                row[0] = LINE;
                row[18..26].copy_from_slice(&numbers.map(f32::to_bits));
            }
            SkeletonView::Polygon(frame, corners, edges) => {
                row[0] = POLYGON;
                row[18..31].copy_from_slice(&frame.map(f32::to_bits));
                row[33..35]
                    .copy_from_slice(&[edges.len(), at + 2 * corners.len()].map(|n| n as u32));
                let corners = corners.iter().flat_map(|c| c.to_array());
                self.more.extend(corners.map(f32::to_bits));
                let edges = edges.as_flattened().iter();
                self.more.extend(edges.map(|x| x.to_bits()));
            }
            SkeletonView::Solid(program, radius) => {
                row[0] = SOLID;
                let tape = words.solid(program)?;
                row[18..21].copy_from_slice(&[radius.to_bits(), at as u32, tape.len() as u32]);
                self.more.extend(tape);
            }
        }
        Ok(())
    }

    fn push(
        &mut self,
        row: [u32; STROKE],
        chunks: &[ChunkView],
        first_segment: u32,
        frame: &Frame,
    ) {
        let stroke = self.strokes.len() as u32;
        self.strokes.push(row);
        for chunk in chunks {
            let b = placed(&chunk.bounds, frame);
            let mut row = [0; 9];
            let ends = b.min.to_array().into_iter().chain(b.max.to_array());
            for (to, from) in row.iter_mut().zip(ends) {
                *to = from.to_bits();
            }
            let [from, to] = chunk.segments.map(|s| s + first_segment);
            row[6..].copy_from_slice(&[stroke, from, to]);
            self.chunks.push(row);
        }
    }
}

/// What every stroke has, of a led point.
fn row(s: &StrokeView, frame: &Frame, twins: u32) -> [u32; STROKE] {
    let mut row = [0u32; STROKE];
    // |∇F| as the outermost canvas has it.
    let slope = s.slope * frame.stretch;
    row[1..5].copy_from_slice(
        &[s.weight, f32::from(u8::from(s.erase)), s.scale, slope].map(f32::to_bits),
    );
    let to_local = match (s.to_local, frame.to_local) {
        (Some(own), Some(outer)) => Some(own * outer),
        (own, outer) => own.or(outer),
    };
    row[5] = to_local.is_some().into();
    let m = to_local.unwrap_or(Affine3A::IDENTITY);
    for (to, from) in row[6..18].iter_mut().zip(m.to_cols_array()) {
        *to = from.to_bits();
    }
    row[35] = twins;
    row[36] = frame.family;
    // The distance to it counts where nothing is felt.
    row[37] = (frame.depth == 0 && !s.erase).into();
    row
}

/// By how much a transform stretches at most, and no less.
fn stretch(m: &Affine3A) -> f32 {
    let m = m.matrix3;
    let columns = [m.x_axis, m.y_axis, m.z_axis];
    columns
        .map(|c| c.length_squared())
        .iter()
        .sum::<f32>()
        .sqrt()
}

/// The box of a chunk in the outermost canvas, no larger than where its painting is felt.
fn placed(b: &Aabb, frame: &Frame) -> Aabb {
    let (Some(to_local), Some(within)) = (frame.to_local, frame.within) else {
        return *b;
    };
    let out = to_local.inverse();
    let (centre, half) = (b.centre(), 0.5 * b.size());
    let m = out.matrix3;
    let half =
        Vec3::from(m.x_axis.abs() * half.x + m.y_axis.abs() * half.y + m.z_axis.abs() * half.z);
    Aabb::around(out.transform_point3(centre), half * 1.000_01).intersection(&within)
}
