//! Bounds of a painting in a block: what is settled there without looking at its nodes.

use glam::Affine3A;

use super::kernel::{HALF_SPACE_SLOPE, T, half_space};
use super::nodes::{axis, blended, erased};
use super::paint::{Block, FAR, Inking, Painting};

/// Chunks in one block beyond which bounds are not worth their time.
const MANY: usize = 200;

impl Painting {
    /// Bounds of F, and of the strokes' scales, in a block.
    fn felt(&self, block: &Block) -> Option<Felt> {
        let chunks = self.within(&block.within);
        if chunks.len() > MANY {
            return None;
        }
        let mut felt = Felt::default();
        let mut runs = self.runs(&chunks).peekable();
        // What the twins before it come to.
        let mut twins = (0.0f32, 0.0f32);
        while let Some((stroke, own)) = runs.next() {
            let (c, radius) = match &stroke.to_local {
                None => (block.centre, block.radius),
                Some(m) => {
                    let columns = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis];
                    let most = columns
                        .iter()
                        .map(|c| c.length_squared())
                        .sum::<f32>()
                        .sqrt();
                    (m.transform_point3(block.centre), block.radius * most)
                }
            };
            let family = &self.family;
            let mut scales = (stroke.scale, stroke.scale);
            let mut slope = stroke.slope;
            let (low, high) = match &stroke.kind {
                Inking::Points => {
                    let (mut near, mut far) = (f32::INFINITY, f32::INFINITY);
                    for i in own {
                        let chunk = &self.chunks[*i as usize];
                        for s in &self.segments[chunk.from as usize..chunk.to as usize] {
                            let (u, r) = (s.at(c.x, c.y, c.z).sqrt(), radius / s.thinnest());
                            near = near.min(u - r);
                            far = far.min(u + r);
                        }
                    }
                    let near = near.max(0.0);
                    (family.at_point(far * far), family.at_point(near * near))
                }
                Inking::Line(from, along, length, inverse) => {
                    let (d2, s0) = axis(*from, *along, *inverse, c.x, c.y, c.z);
                    let here = family.at_line(d2, s0, s0 + length * inverse);
                    let slope = stroke.slope / stroke.weight * block.radius;
                    let s = (-s0).clamp(0.0, length * inverse);
                    let d = (d2 + (s0 + s) * (s0 + s)).sqrt() - radius * inverse;
                    (here - slope, (here + slope).min(family.at_axis(d.max(0.0))))
                }
                Inking::Polygon(area) => {
                    let to_local = stroke.to_local.as_ref();
                    match area.seen(c, radius, &block.within, to_local) {
                        None => {
                            slope = 0.0;
                            (0.0, 0.0)
                        }
                        Some(seen) => {
                            let [near, far] = seen.heights.map(|h| family.at_plane(h));
                            if seen.is_within() {
                                (far, near)
                            } else {
                                let here = area.at(family, c);
                                let slope = stroke.slope / stroke.weight * block.radius;
                                (here - slope, (here + slope).min(near))
                            }
                        }
                    }
                }
                Inking::Field(program, radius) => {
                    let (low, high) = program.bounds_of(block.world, block.half, block.around);
                    slope = if low >= *radius || high <= -radius {
                        // Wholly outside or inside of where it falls off.
                        0.0
                    } else {
                        let steep = program.steepest(block.world, block.half, block.around);
                        let steep = steep.unwrap_or(f32::INFINITY);
                        slope * stroke.weight * HALF_SPACE_SLOPE / radius * steep
                    };
                    (half_space(high / radius), half_space(low / radius))
                }
                Inking::Canvas(painting) => {
                    let m = stroke.to_local.unwrap_or(Affine3A::IDENTITY);
                    let inside = Block {
                        within: crate::recipe::transformed(&block.within, &m),
                        centre: c,
                        radius,
                        ..*block
                    };
                    let inner = painting.felt(&inside)?;
                    slope = stroke.weight * inner.slope / stroke.scale;
                    if inner.widest > 0.0 {
                        scales = (inner.finest * stroke.scale, inner.widest * stroke.scale);
                    }
                    (inner.low, inner.high)
                }
            };
            // Rounding, here and in the closed forms.
            let low = stroke.weight * (low - 4.0e-5).max(0.0);
            let high = stroke.weight * (high + 4.0e-5).max(0.0);
            felt.slope += slope;
            if !stroke.erase {
                felt.finest = felt.finest.min(scales.0);
                felt.widest = felt.widest.max(scales.1);
            }
            let (low, high) = (low.max(twins.0), high.max(twins.1));
            if runs.peek().is_some_and(|(next, _)| stroke.is_twin(next)) {
                twins = (low, high);
                continue;
            }
            twins = (0.0, 0.0);
            if stroke.erase {
                (felt.low, felt.high) = (erased(felt.low, high), erased(felt.high, low));
                continue;
            }
            felt.low = blended(felt.low, low, self.blend);
            felt.high = blended(felt.high, high, self.blend);
        }
        felt.low -= 1.0e-4 * felt.low.abs();
        felt.high += 1.0e-4 * felt.high.abs();
        Some(felt)
    }

    /// Bounds of φ in a block, metres of the canvas; `local_step` as in [`Place`].
    pub fn range(&self, block: &Block, local_step: f32) -> (f32, f32) {
        let Some(felt) = self.felt(block) else {
            return (f32::MIN, f32::MAX);
        };
        let none = (self.least * T).min((FAR + 1.0) * local_step);
        if felt.widest <= 0.0 || felt.high <= 0.0 {
            return (none, f32::MAX);
        }
        let at = |f: f32| {
            let d = T - f;
            let (a, b) = (d * felt.finest, d * felt.widest);
            (a.min(b), a.max(b))
        };
        let low = at(felt.high).0;
        if felt.low > 0.0 {
            (low, at(felt.low).1)
        } else {
            (low.min(none), f32::MAX)
        }
    }

    /// What a zero of φ within one metre of a node would make of |φ| there at most; `None` where
    /// that is not known.
    pub fn steepest(&self, block: &Block) -> Option<f32> {
        let felt = self.felt(block)?;
        let steepest = (felt.slope * felt.widest).max(1.0);
        steepest.is_finite().then_some(steepest)
    }
}

/// Bounds in a block.
struct Felt {
    low: f32,
    high: f32,
    /// Of the scales of what was painted.
    finest: f32,
    widest: f32,
    slope: f32,
}

impl Default for Felt {
    fn default() -> Self {
        Self {
            low: 0.0,
            high: 0.0,
            finest: f32::INFINITY,
            widest: 0.0,
            slope: 0.0,
        }
    }
}
