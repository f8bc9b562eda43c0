//! Where strokes are felt: what an edit of a painting leaves as it was.

use std::ops::Range;

use super::kernel::T;
use super::nodes::axis;
use super::paint::{Block, FAR, Inked, Inking, Painting, touch};
use super::stroke::HARD;

impl Painting {
    /// How many chunks it has.
    pub fn chunks(&self) -> usize {
        self.chunks.len()
    }

    /// Whether any of these chunks may change φ in a block, but for what lies three steps outside or more;
    /// `local_step` as in [`Place`](super::Place).
    pub fn reaches(&self, chunks: Range<usize>, block: &Block, local_step: f32) -> bool {
        self.chunks[chunks].iter().any(|chunk| {
            let stroke = &self.strokes[chunk.stroke as usize];
            touch(&chunk.bounds, &block.within)
                && (self.matters(stroke, local_step)
                    || self.felt_at(stroke, chunk.from..chunk.to, block))
        })
    }

    /// Whether a stroke can change bits where it is not felt itself.
    fn matters(&self, stroke: &Inked, local_step: f32) -> bool {
        if stroke.erase {
            // What was raised is lowered for it and raised again.
            self.blend != 1.0 && self.blend < HARD
        } else {
            // Its box ends nearer than what is told apart.
            T * stroke.scale < FAR * local_step
        }
    }

    fn felt_at(&self, stroke: &Inked, segments: Range<u32>, block: &Block) -> bool {
        if stroke.to_local.is_some() {
            return true;
        }
        let (c, radius) = (block.centre, block.radius);
        match &stroke.kind {
            Inking::Points => self.segments[segments.start as usize..segments.end as usize]
                .iter()
                .any(|s| {
                    s.at(c.x, c.y, c.z).sqrt() - radius / s.thinnest() < self.family.reach * 1.001
                }),
            Inking::Line(from, along, length, inverse) => {
                let (d2, s0) = axis(*from, *along, *inverse, c.x, c.y, c.z);
                let s = (-s0).clamp(0.0, length * inverse);
                (d2 + (s0 + s) * (s0 + s)).sqrt() - radius * inverse < 1.001
            }
            Inking::Polygon(area) => area.seen(c, radius, &block.within, None).is_some(),
            Inking::Field(program, wide) => {
                let (low, _) = program.bounds_of(block.world, block.half, block.around);
                low < wide * 1.001
            }
            Inking::Canvas(_) => true,
        }
    }
}
