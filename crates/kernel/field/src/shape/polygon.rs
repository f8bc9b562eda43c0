use glam::Vec2;

use super::NODES;
use super::round::{greater, lesser};

/// Edges in one box of the index.
const GROUP: usize = 8;

/// Closed contours with the even-odd rule: exact distance to the edges, sign by crossings.
///
/// Edges that follow each other along a contour lie close together, so boxes around every eight of
/// them are index enough. A brick first picks the edges that can be closest to any of its nodes.
#[derive(Clone, Debug)]
pub(crate) struct Polygon {
    edges: Vec<Edge>,
    groups: Vec<Group>,
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    a: Vec2,
    d: Vec2,
    /// 1 / |d|², 0 for a point.
    inverse: f32,
    /// The y of the far end, exactly as the next edge starts.
    end: f32,
    /// dx / dy, 0 for level edges, which nothing crosses.
    slope: f32,
}

#[derive(Clone, Copy, Debug)]
struct Group {
    low: Vec2,
    high: Vec2,
}

impl Edge {
    fn new(a: Vec2, b: Vec2) -> Self {
        let d = b - a;
        let square = d.length_squared();
        Self {
            a,
            d,
            inverse: if square > 0.0 { 1.0 / square } else { 0.0 },
            end: b.y,
            slope: if d.y != 0.0 { d.x / d.y } else { 0.0 },
        }
    }

    #[inline(always)]
    fn square(&self, x: f32, y: f32) -> f32 {
        let (px, py) = (x - self.a.x, y - self.a.y);
        let t = (px * self.d.x + py * self.d.y) * self.inverse;
        let t = lesser(greater(t, 0.0), 1.0);
        let (dx, dy) = (px - t * self.d.x, py - t * self.d.y);
        dx * dx + dy * dy
    }

    /// Whether the ray from (x, y) along +x crosses; half open in y, so that a corner counts once.
    #[inline(always)]
    fn crosses(&self, x: f32, y: f32) -> bool {
        let spans = (self.a.y > y) != (self.end > y);
        spans & (x < self.a.x + (y - self.a.y) * self.slope)
    }

    fn low_y(&self) -> f32 {
        self.a.y.min(self.end)
    }

    fn high_y(&self) -> f32 {
        self.a.y.max(self.end)
    }

    fn high_x(&self) -> f32 {
        self.a.x.max(self.a.x + self.d.x)
    }
}

impl Polygon {
    /// Takes the edges for which `keep(from, to)` holds.
    pub fn new(contours: &[Vec<Vec2>], keep: impl Fn(Vec2, Vec2) -> bool) -> Self {
        let mut edges = Vec::new();
        for ring in contours {
            for (i, &a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                if a != b && keep(a, b) {
                    edges.push(Edge::new(a, b));
                }
            }
        }
        let groups = edges
            .chunks(GROUP)
            .map(|g| {
                let ends = g.iter().flat_map(|e| [e.a, e.a + e.d]);
                let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
                ends.for_each(|p| (low, high) = (low.min(p), high.max(p)));
                // Rounding of a + d must not leave the box.
                let slack = 1.0e-6 * (low.abs().max(high.abs())).max_element();
                Group {
                    low: low - slack,
                    high: high + slack,
                }
            })
            .collect();
        Self { edges, groups }
    }

    /// Each edge's start, direction, 1/|d|², y of the end, dx/dy.
    pub fn numbers(&self) -> Vec<[f32; 7]> {
        let all = |e: &Edge| [e.a.x, e.a.y, e.d.x, e.d.y, e.inverse, e.end, e.slope];
        self.edges.iter().map(all).collect()
    }

    /// Signed distance in the plane, negative inside.
    pub fn at(&self, x: f32, y: f32) -> f32 {
        let p = Vec2::new(x, y);
        let (mut best, mut inside) = (f32::INFINITY, false);
        for (g, edges) in self.groups.iter().zip(self.edges.chunks(GROUP)) {
            let gap = (g.low - p).max(p - g.high).max(Vec2::ZERO);
            if gap.length_squared() <= best {
                best = edges.iter().fold(best, |b, e| lesser(b, e.square(x, y)));
            }
            if g.high.x >= x && g.low.y <= y && g.high.y >= y {
                inside ^= edges.iter().filter(|e| e.crosses(x, y)).count() % 2 == 1;
            }
        }
        if inside { -best.sqrt() } else { best.sqrt() }
    }

    /// Signed distance at points no further than `radius` from the centre.
    #[inline(always)]
    pub fn brick(
        &self,
        xs: &[f32; NODES],
        ys: &[f32; NODES],
        centre_x: f32,
        centre_y: f32,
        radius: f32,
        out: &mut [f32; NODES],
    ) {
        let middle = self.at(centre_x, centre_y);
        // A hair more, since both ends of the comparison are rounded.
        let slack = 1.0e-5 * (radius + middle.abs() + centre_x.abs() + centre_y.abs());
        let reach = middle.abs() + 2.0 * radius + slack;
        out.fill(f32::INFINITY);
        for (g, edges) in self.groups.iter().zip(self.edges.chunks(GROUP)) {
            let c = Vec2::new(centre_x, centre_y);
            let gap = (g.low - c).max(c - g.high).max(Vec2::ZERO);
            if gap.length_squared() > reach * reach {
                continue;
            }
            for e in edges {
                if e.square(centre_x, centre_y) <= reach * reach {
                    for i in 0..NODES {
                        out[i] = lesser(out[i], e.square(xs[i], ys[i]));
                    }
                }
            }
        }
        let radius = radius + slack;
        if middle.abs() > radius {
            for o in out.iter_mut() {
                *o = o.sqrt().copysign(middle);
            }
            return;
        }
        let mut odd = [0u32; NODES];
        let mut all = 0u32;
        for e in &self.edges {
            if e.high_y() < centre_y - radius
                || e.low_y() > centre_y + radius
                || e.high_x() < centre_x - radius
            {
                continue;
            }
            let beyond = e.a.x.min(e.a.x + e.d.x) > centre_x + radius;
            if beyond && e.low_y() < centre_y - radius && e.high_y() > centre_y + radius {
                // Every ray from the brick crosses it.
                all ^= 1;
                continue;
            }
            for i in 0..NODES {
                odd[i] ^= u32::from(e.crosses(xs[i], ys[i]));
            }
        }
        for (o, odd) in out.iter_mut().zip(&odd) {
            let sign = (odd ^ all) << 31;
            *o = f32::from_bits(o.sqrt().to_bits() | sign);
        }
    }
}
