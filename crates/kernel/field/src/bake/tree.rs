use glam::{Mat3, Vec3};
use midair_mesh::Aabb;
use rayon::prelude::*;

use super::triangle::Triangle;

/// Triangles in a leaf, and children of a node.
const LEAF: usize = 8;
const FAN: usize = 4;
/// A node is taken as one far source when the point is this many radii away
/// (Barill et al. 2018, §4: 2 keeps the error under a hundredth).
const BETA: f32 = 2.0;

/// The triangles of a mesh along a Morton curve, with a packed tree of boxes over them. It answers
/// the two questions a bake asks of a whole mesh: the closest triangle, and the winding number.
pub(super) struct Tree<'a> {
    triangles: &'a [Triangle],
    order: Vec<u32>,
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
        let bounds = triangles.iter().fold(Aabb::EMPTY, |b, t| {
            b.including(t.v[0]).including(t.v[1]).including(t.v[2])
        });
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

        let mut nodes: Vec<Node> = order
            .par_chunks(LEAF)
            .map(|leaf| Node::leaf(leaf, triangles))
            .collect();
        let mut levels = vec![0];
        let mut begin = 0;
        while nodes.len() - begin > 1 {
            let above: Vec<Node> = nodes[begin..].par_chunks(FAN).map(Node::parent).collect();
            begin = nodes.len();
            levels.push(begin);
            nodes.extend(above);
        }
        Self {
            triangles,
            order,
            nodes,
            levels,
        }
    }

    pub fn triangles(&self) -> &'a [Triangle] {
        self.triangles
    }

    fn children(&self, level: usize, node: usize) -> std::ops::Range<usize> {
        let first = self.levels[level - 1];
        let i = (node - self.levels[level]) * FAN;
        first + i..(first + i + FAN).min(self.levels[level])
    }

    fn leaf(&self, node: usize) -> &[u32] {
        &self.order[node * LEAF..((node + 1) * LEAF).min(self.order.len())]
    }

    /// The squared distance to, and the index of, the triangle closest to `p`, none closer than
    /// `guess` known. Among equals the lowest index, so that the answer does not hang on the guess.
    pub fn closest(&self, p: Vec3, guess: Option<u32>) -> (f32, u32) {
        let mut best = (f32::INFINITY, u32::MAX);
        if let Some(t) = guess {
            best = (self.triangles[t as usize].distance_squared(p), t);
        }
        let mut stack = [(0.0f32, 0u32, 0u32); 64];
        let mut top = 1;
        stack[0] = (
            0.0,
            self.levels.len() as u32 - 1,
            self.nodes.len() as u32 - 1,
        );
        while top > 0 {
            top -= 1;
            let (near, level, node) = stack[top];
            if near > best.0 {
                continue;
            }
            if level == 0 {
                for &t in self.leaf(node as usize) {
                    let d = self.triangles[t as usize].distance_squared(p);
                    if (d, t) < best {
                        best = (d, t);
                    }
                }
                continue;
            }
            let begin = top;
            for child in self.children(level as usize, node as usize) {
                let b = &self.nodes[child].bounds;
                let d = (b.min - p).max(p - b.max).max(Vec3::ZERO).length_squared();
                if d <= best.0 {
                    stack[top] = (d, level - 1, child as u32);
                    top += 1;
                }
            }
            // The nearest child is opened first.
            stack[begin..top].sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        }
        best
    }

    /// The generalised winding number of the triangles around `p`.
    pub fn winding(&self, p: Vec3) -> f32 {
        let mut sum = 0.0f64;
        let mut stack = [(0u32, 0u32); 64];
        let mut top = 1;
        stack[0] = (self.levels.len() as u32 - 1, self.nodes.len() as u32 - 1);
        while top > 0 {
            top -= 1;
            let (level, node) = stack[top];
            let n = &self.nodes[node as usize];
            let r = n.centre - p;
            let d2 = r.length_squared();
            if d2 > BETA * BETA * n.radius * n.radius {
                let inverse = 1.0 / d2.sqrt();
                let cubed = inverse * inverse * inverse;
                let trace = n.moment.x_axis.x + n.moment.y_axis.y + n.moment.z_axis.z;
                let second = trace - 3.0 * r.dot(n.moment * r) * inverse * inverse;
                sum += f64::from((r.dot(n.dipole) + second) * cubed)
                    * (0.25 * std::f64::consts::FRAC_1_PI);
            } else if level == 0 {
                for &t in self.leaf(node as usize) {
                    sum += self.triangles[t as usize].winding(p);
                }
            } else {
                for child in self.children(level as usize, node as usize) {
                    stack[top] = (level - 1, child as u32);
                    top += 1;
                }
            }
        }
        sum as f32
    }
}

impl Node {
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
