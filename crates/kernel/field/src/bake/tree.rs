use std::sync::OnceLock;

use glam::{Mat3, Vec3};
use midair_mesh::Aabb;
use rayon::prelude::*;

use super::eight::offsets;
use super::lanes::{EIGHT, F8, Lanes, Simd, lanes};
use super::triangle::Triangle;

/// Triangles in a leaf, and children of a node where moments are summed.
const LEAF: usize = EIGHT;
const FAN: usize = 4;
/// A node is taken as one far source when the point is this many radii away
/// (Barill et al. 2018, §4: 2 keeps the error under a hundredth).
const BETA: f32 = 2.0;

/// The triangles of a mesh along a Morton curve, with packed trees over them. It answers the two
/// questions a bake asks of a whole mesh: the closest triangle, and the winding number.
pub(super) struct Tree<'a> {
    triangles: &'a [Triangle],
    order: Vec<u32>,
    /// By leaf, the boxes of its triangles.
    own: Vec<Boxes>,
    /// By level, leaves first: the boxes of eight at a time.
    boxes: Vec<Vec<Boxes>>,
    moments: OnceLock<Moments>,
}

/// Eight boxes side by side, by axis; those that are missing are beyond all measure.
#[derive(Clone)]
struct Boxes {
    min: [Lanes; 3],
    max: [Lanes; 3],
}

/// What the winding number is summed from.
struct Moments {
    /// Leaves first, then each level of parents, the root last.
    nodes: Vec<Node>,
    /// Where each level begins in `nodes`, leaves first.
    levels: Vec<usize>,
}

#[derive(Clone, Copy)]
struct Node {
    bounds: Aabb,
    /// Taylor expansion of the winding number (Barill et al. 2018, Eq. 16–18): centre, Σ A·n, and
    /// Σ A·n ⊗ (centroid − centre) by columns.
    centre: Vec3,
    dipole: Vec3,
    moment: Mat3,
    area: f32,
    radius: f32,
}

impl<'a> Tree<'a> {
    /// `triangles` must not be empty.
    pub fn new(triangles: &'a [Triangle]) -> Self {
        let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for p in triangles.iter().flat_map(|t| &t.v) {
            (min, max) = (min.min(*p), max.max(*p));
        }
        let bounds = Aabb { min, max };
        let scale = 1023.0 / bounds.size().max_element().max(f32::MIN_POSITIVE);
        let mut keyed: Vec<(u32, u32)> = triangles
            .par_iter()
            .enumerate()
            .map(|(i, t)| {
                let c = ((t.v[0] + t.v[1] + t.v[2]) / 3.0 - bounds.min) * scale;
                let key = spread(c.x as u32) | spread(c.y as u32) << 1 | spread(c.z as u32) << 2;
                (key, i as u32)
            })
            .collect();
        keyed.par_sort_unstable();
        let order: Vec<u32> = keyed.into_iter().map(|(_, i)| i).collect();

        let of_one = |t: &u32| {
            let [a, b, c] = triangles[*t as usize].v;
            Aabb {
                min: a.min(b).min(c),
                max: a.max(b).max(c),
            }
        };
        let leaf = |l: &[u32]| {
            let mut all = [Aabb::EMPTY; LEAF];
            let mut whole = Aabb::EMPTY;
            for (own, t) in all.iter_mut().zip(l) {
                *own = of_one(t);
                whole.min = whole.min.min(own.min);
                whole.max = whole.max.max(own.max);
            }
            (Boxes::new(&all[..l.len()]), whole)
        };
        let (own, mut bounds): (Vec<Boxes>, Vec<Aabb>) =
            order.par_chunks(LEAF).with_min_len(64).map(leaf).unzip();
        let mut boxes = Vec::new();
        loop {
            boxes.push(bounds.chunks(EIGHT).map(Boxes::new).collect::<Vec<_>>());
            if bounds.len() <= EIGHT {
                break;
            }
            let union = |b: &[Aabb]| b.iter().fold(Aabb::EMPTY, |all, b| all.union(b));
            bounds = bounds.chunks(EIGHT).map(union).collect();
        }
        Self {
            triangles,
            order,
            own,
            boxes,
            moments: OnceLock::new(),
        }
    }

    pub fn triangles(&self) -> &'a [Triangle] {
        self.triangles
    }

    fn leaf(&self, node: usize) -> &[u32] {
        &self.order[node * LEAF..((node + 1) * LEAF).min(self.order.len())]
    }

    /// The squared distance to, and the index of, the triangle closest to `p`, none closer than
    /// `guess` known. Among equals the lowest index, so that the answer does not hang on the guess.
    pub fn closest(&self, p: Vec3, guess: Option<u32>) -> (f32, u32) {
        let mut best = (f32::INFINITY, u32::MAX);
        if let Some(t) = guess {
            // It is met again among the others, and there perhaps differs by rounding.
            let d = self.triangles[t as usize].distance_squared(p);
            best.0 = d * 1.000_1 + f32::MIN_POSITIVE;
        }
        search(self, p, &mut best);
        match guess {
            Some(t) if best.1 == u32::MAX => (self.triangles[t as usize].distance_squared(p), t),
            _ => best,
        }
    }

    /// By whoever asks first, alone: were others to help, that thread would take up another place meanwhile, which asks too
    /// and waits for what waits for it.
    fn moments(&self) -> &Moments {
        self.moments.get_or_init(|| {
            let leaf = |leaf: &[u32]| Node::leaf(leaf, self.triangles);
            let mut nodes: Vec<Node> = self.order.chunks(LEAF).map(leaf).collect();
            let mut levels = vec![0];
            let mut begin = 0;
            while nodes.len() - begin > 1 {
                let above: Vec<Node> = nodes[begin..].chunks(FAN).map(Node::parent).collect();
                begin = nodes.len();
                levels.push(begin);
                nodes.extend(above);
            }
            Moments { nodes, levels }
        })
    }

    /// The generalised winding number of the triangles around `p`.
    pub fn winding(&self, p: Vec3) -> f32 {
        let (mut sum, mut turns) = (0.0, Turns::NONE);
        let far = |n: &Node, r, d2| sum += n.seen(r, d2);
        self.visit(p, 0.0, far, |_, leaf| {
            for &t in leaf {
                turns.add(self.triangles[t as usize].angle(p));
            }
        });
        (sum + turns.count()) as f32
    }

    /// The winding numbers at `p + off` and `p - off`, which lie on the two sides of a surface: what is
    /// further away than a hundred times that is looked at once, from `p`. Right to about 0.05.
    pub fn winding_beside(&self, p: Vec3, off: Vec3) -> [f32; 2] {
        let near = 128.0 * 128.0 * off.length_squared();
        let (mut sum, mut common) = (0.0, Turns::NONE);
        let mut sides = [Turns::NONE; 2];
        let far = |n: &Node, r, d2| sum += n.seen(r, d2);
        // A node that is far for its size may still be near for the two points.
        let least = 32.0 * 32.0 * off.length_squared();
        self.visit(p, least, far, |n, leaf| {
            let b = &n.bounds;
            let d2 = (b.min - p).max(p - b.max).max(Vec3::ZERO).length_squared();
            for &t in leaf {
                let t = &self.triangles[t as usize];
                if d2 > near {
                    common.add(t.angle(p));
                } else {
                    sides[0].add(t.angle(p + off));
                    sides[1].add(t.angle(p - off));
                }
            }
        });
        let all = sum + common.count();
        sides.map(|side| (all + side.count()) as f32)
    }

    /// Every triangle once: in nodes that are `far`, with the way to their centre and its squared length,
    /// which is above `least`, or in leaves that are `near`.
    #[inline]
    fn visit(
        &self,
        p: Vec3,
        least: f32,
        mut far: impl FnMut(&Node, Vec3, f32),
        mut near: impl FnMut(&Node, &[u32]),
    ) {
        let moments = self.moments();
        let mut stack = [(0u32, 0u32); 64];
        let mut top = 1;
        stack[0] = (
            moments.levels.len() as u32 - 1,
            moments.nodes.len() as u32 - 1,
        );
        while top > 0 {
            top -= 1;
            let (level, node) = stack[top];
            let n = &moments.nodes[node as usize];
            let r = n.centre - p;
            let d2 = r.length_squared();
            if d2 > (BETA * BETA * n.radius * n.radius).max(least) {
                far(n, r, d2);
            } else if level == 0 {
                near(n, self.leaf(node as usize));
            } else {
                for child in moments.children(level as usize, node as usize) {
                    stack[top] = (level - 1, child as u32);
                    top += 1;
                }
            }
        }
    }
}

impl Moments {
    fn children(&self, level: usize, node: usize) -> std::ops::Range<usize> {
        let first = self.levels[level - 1];
        let i = (node - self.levels[level]) * FAN;
        first + i..(first + i + FAN).min(self.levels[level])
    }
}

impl Boxes {
    /// Of up to eight.
    fn new(bounds: &[Aabb]) -> Self {
        let mut all = Self {
            min: [[f32::INFINITY; EIGHT]; 3],
            max: [[f32::INFINITY; EIGHT]; 3],
        };
        for (i, b) in bounds.iter().enumerate() {
            for k in 0..3 {
                (all.min[k][i], all.max[k][i]) = (b.min[k], b.max[k]);
            }
        }
        all
    }

    /// The squared distance of each from `p`.
    #[inline(always)]
    fn squares<S: Simd>(&self, s: S, p: &[F8<S>; 3]) -> F8<S> {
        let mut all = F8::splat(s, 0.0);
        for (k, p) in p.iter().enumerate() {
            let below = F8::load(s, &self.min[k], 0) - *p;
            let above = *p - F8::load(s, &self.max[k], 0);
            let gap = below.max(above).max(F8::splat(s, 0.0));
            all = all + gap * gap;
        }
        all
    }
}

lanes!(search, search_avx2, search_any, (tree: &Tree, p: Vec3, best: &mut (f32, u32)));

/// Takes over the closest triangle if it is closer than the best.
#[inline(always)]
fn search_any<S: Simd>(s: S, tree: &Tree, p: Vec3, best: &mut (f32, u32)) {
    let places = [F8::splat(s, p.x), F8::splat(s, p.y), F8::splat(s, p.z)];
    // Of each level no more than eight wait.
    let mut stack = [(0.0f32, 0u32, 0u32); 96];
    let mut top = 1;
    stack[0] = (0.0, tree.boxes.len() as u32, 0);
    while top > 0 {
        top -= 1;
        let (near, level, node) = stack[top];
        if near > best.0 {
            continue;
        }
        // Those that are missing are infinitely far.
        let most = F8::splat(s, best.0.min(f32::MAX) * (1.0 + f32::EPSILON));
        if level == 0 {
            if tree.own[node as usize]
                .squares(s, &places)
                .less(most)
                .bits()
                == 0
            {
                continue;
            }
            let leaf = tree.leaf(node as usize);
            let ids = std::array::from_fn(|i| leaf[i.min(leaf.len() - 1)]);
            let squares = offsets(s, tree.triangles, &ids, places).square;
            // Few of the leaves that are near enough hold the closest.
            if squares.less(most).bits() == 0 {
                continue;
            }
            for (&t, d) in ids.iter().zip(squares.lanes()) {
                if (d, t) < *best {
                    *best = (d, t);
                }
            }
            continue;
        }
        let group = &tree.boxes[level as usize - 1][node as usize];
        let squares = group.squares(s, &places);
        let mut open = squares.less(most).bits();
        let squares = squares.lanes();
        let begin = top;
        while open != 0 {
            let i = open.trailing_zeros();
            open &= open - 1;
            // The nearest child is opened first.
            let d = squares[i as usize];
            let mut at = top;
            while at > begin && stack[at - 1].0 < d {
                stack[at] = stack[at - 1];
                at -= 1;
            }
            stack[at] = (d, level - 1, node * EIGHT as u32 + i);
            top += 1;
        }
    }
}

/// Angles between −π and π added up as a product of complex numbers, so that one arc tangent does for
/// all of them; the whole turns that a product forgets are counted.
#[derive(Clone, Copy)]
struct Turns {
    re: f64,
    im: f64,
    whole: i32,
}

impl Turns {
    const NONE: Self = Self {
        re: 1.0,
        im: 0.0,
        whole: 0,
    };

    /// Adds the angle of (re, im).
    #[inline]
    fn add(&mut self, (re, im): (f64, f64)) {
        // Above the real axis or on its negative half, where the angle is π.
        let up = |re: f64, im: f64| im > 0.0 || (im == 0.0 && re < 0.0);
        let next = (self.re * re - self.im * im, self.re * im + self.im * re);
        let size = next.0.abs() + next.1.abs();
        if size == 0.0 {
            // A corner of the triangle: it has no angle there.
            return;
        }
        let above = up(next.0, next.1);
        if up(self.re, self.im) && up(re, im) {
            self.whole += i32::from(!above);
        } else if self.im < 0.0 && im < 0.0 {
            self.whole -= i32::from(above);
        }
        (self.re, self.im) = next;
        if !(1e-90..1e90).contains(&size) {
            self.re /= size;
            self.im /= size;
        }
    }

    /// All of them, in turns.
    fn count(&self) -> f64 {
        f64::from(self.whole) + self.im.atan2(self.re) * (1.0 / std::f64::consts::TAU)
    }
}

impl Node {
    /// Its winding number from `r` before its centre, expanded to the second order.
    #[inline]
    fn seen(&self, r: Vec3, d2: f32) -> f64 {
        let inverse = 1.0 / d2.sqrt();
        let cubed = inverse * inverse * inverse;
        let trace = self.moment.x_axis.x + self.moment.y_axis.y + self.moment.z_axis.z;
        let second = trace - 3.0 * r.dot(self.moment * r) * inverse * inverse;
        f64::from((r.dot(self.dipole) + second) * cubed) * (0.25 * std::f64::consts::FRAC_1_PI)
    }

    fn leaf(leaf: &[u32], triangles: &[Triangle]) -> Self {
        let parts = leaf.iter().map(|&t| {
            let v = triangles[t as usize].v;
            let normal = 0.5 * (v[1] - v[0]).cross(v[2] - v[0]);
            (v, (v[0] + v[1] + v[2]) / 3.0, normal)
        });
        let mut bounds = Aabb::EMPTY;
        let (mut area, mut centre, mut dipole) = (0.0, Vec3::ZERO, Vec3::ZERO);
        for (v, c, n) in parts.clone() {
            bounds = v.iter().fold(bounds, |b, &p| b.including(p));
            area += n.length();
            centre += n.length() * c;
            dipole += n;
        }
        centre = if area > 0.0 {
            centre / area
        } else {
            bounds.centre()
        };
        let moment = parts.fold(Mat3::ZERO, |m, (_, c, n)| m + outer(n, c - centre));
        Self::with(bounds, centre, dipole, moment, area)
    }

    fn parent(children: &[Self]) -> Self {
        let mut bounds = Aabb::EMPTY;
        let (mut area, mut centre, mut dipole) = (0.0, Vec3::ZERO, Vec3::ZERO);
        for c in children {
            bounds = bounds.union(&c.bounds);
            area += c.area;
            centre += c.area * c.centre;
            dipole += c.dipole;
        }
        centre = if area > 0.0 {
            centre / area
        } else {
            bounds.centre()
        };
        let moment = children.iter().fold(Mat3::ZERO, |m, c| {
            m + c.moment + outer(c.dipole, c.centre - centre)
        });
        Self::with(bounds, centre, dipole, moment, area)
    }

    fn with(bounds: Aabb, centre: Vec3, dipole: Vec3, moment: Mat3, area: f32) -> Self {
        let radius = (bounds.max - centre).max(centre - bounds.min).length();
        Self {
            bounds,
            centre,
            dipole,
            moment,
            area,
            radius,
        }
    }
}

/// n ⊗ d.
fn outer(n: Vec3, d: Vec3) -> Mat3 {
    Mat3::from_cols(n * d.x, n * d.y, n * d.z)
}

/// Ten bits, each followed by two zeroes.
fn spread(x: u32) -> u32 {
    let x = x.min(1023);
    let x = (x | x << 16) & 0x0300_00ff;
    let x = (x | x << 8) & 0x0300_f00f;
    let x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}

#[cfg(test)]
mod tests;
