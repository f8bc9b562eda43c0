use glam::{IVec3, Vec3};
use midair_field::{BRICK, BrickCoord};

use crate::region::{Lattice, Window, corners};
use crate::signs::{Corners, Signs, State};
use crate::table::{MOST, Row, WIDTH};

/// The share of the surface that one brick owns: the vertices on the edges that start at its
/// nodes and the triangles of the cells that do.
///
/// Triangles name edges of the brick's lattice of 9³ nodes ([`crate::table::EDGE_IDS`]) and not
/// vertices: so they do not change when a neighbour's vertices are numbered anew.
#[derive(Clone, PartialEq)]
pub(crate) struct Piece {
    /// Crossed edges by axis. Vertices are numbered in the order of their bits.
    pub crossed: [Signs; 3],
    /// Crossed edges before each word of `crossed`.
    pub before: [[u16; BRICK]; 3],
    /// Positions, then as many normals.
    points: Box<[Vec3]>,
    pub triangles: Box<[[u16; 3]]>,
}

impl Piece {
    /// How many vertices.
    #[inline]
    pub fn vertices(&self) -> usize {
        self.points.len() / 2
    }

    pub fn positions(&self) -> &[Vec3] {
        &self.points[..self.vertices()]
    }

    pub fn normals(&self) -> &[Vec3] {
        &self.points[self.vertices()..]
    }

    /// Bytes held on the heap, the piece itself included.
    pub fn bytes(&self) -> usize {
        size_of::<Self>() + size_of_val(&*self.points) + size_of_val(&*self.triangles)
    }

    /// The vertex numbers of the crossed edges of one word.
    #[inline]
    pub fn rank(&self, axis: usize, z: usize, bit: u64) -> u32 {
        let below = self.crossed[axis][z] & (bit - 1);
        u32::from(self.before[axis][z]) + below.count_ones()
    }
}

/// Room to work in, one for each thread.
pub(crate) struct Scratch {
    /// Values of the brick's nodes and of those around it, −1..=9 along each axis.
    padded: Box<Padded>,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// Three corners to a triangle.
    corners: Vec<u16>,
}

const SIDE: usize = BRICK + 3;
const ROW: usize = 12;
const PLANE: usize = ROW * SIDE;
type Padded = [[f32; ROW]; SIDE * SIDE];

impl Scratch {
    pub fn new() -> Self {
        Self {
            padded: Box::new([[0.0; ROW]; SIDE * SIDE]),
            positions: Vec::new(),
            normals: Vec::new(),
            corners: vec![0; BRICK * BRICK * BRICK * 3 * MOST + WIDTH],
        }
    }

    /// The piece of the brick at `l` in the window; `at` is its coordinate in the field.
    pub fn extract(
        &mut self,
        table: &[Row; 256],
        window: &Window,
        l: IVec3,
        at: BrickCoord,
    ) -> Option<Box<Piece>> {
        let state = window.state(l);
        if state != State::Mixed && corners().skip(1).all(|d| window.state(l + d) == state) {
            return None;
        }
        let mut eight = [window.signs(l); 8];
        for (to, d) in eight.iter_mut().zip(corners()) {
            *to = window.signs(l + d);
        }
        let signs = Corners::new(eight);
        let crossed = signs.crossed();
        let mut before = [[0; BRICK]; 3];
        let mut count = 0;
        for (axis, words) in crossed.iter().enumerate() {
            for (z, w) in words.iter().enumerate() {
                before[axis][z] = count;
                count += w.count_ones() as u16;
            }
        }
        let corners = self.cells(table, &signs);
        let triangles = self.corners[..corners].as_chunks().0.into();
        let points = self.points(window, l, at, &crossed);
        Some(Box::new(Piece {
            crossed,
            before,
            points,
            triangles,
        }))
    }

    /// As [`Scratch::extract`] for a brick in which nothing but normals can have changed; `None`
    /// where they have not.
    pub fn refresh(
        &mut self,
        old: &Piece,
        window: &Window,
        l: IVec3,
        at: BrickCoord,
    ) -> Option<Box<Piece>> {
        let points = self.points(window, l, at, &old.crossed);
        (points != old.points).then(|| {
            Box::new(Piece {
                crossed: old.crossed,
                before: old.before,
                points,
                triangles: old.triangles.clone(),
            })
        })
    }

    /// Triangles of the brick's cells; how many corners they have.
    fn cells(&mut self, table: &[Row; 256], signs: &Corners) -> usize {
        let mut n = 0;
        for z in 0..BRICK {
            let mut active = signs.active(z);
            while active != 0 {
                let bit = active.trailing_zeros();
                active &= active - 1;
                let row = &table[signs.case(z, bit)];
                let base = (bit & 7) as u16 + 9 * (bit >> 3) as u16 + 81 * z as u16;
                // All that a row can hold is written, the next cell overwrites the surplus.
                if let Some(to) = self.corners[n..].first_chunk_mut::<WIDTH>() {
                    *to = row.corners.map(|id| id + base);
                }
                n += 3 * row.count;
            }
        }
        n
    }

    fn points(
        &mut self,
        window: &Window,
        l: IVec3,
        at: BrickCoord,
        crossed: &[Signs; 3],
    ) -> Box<[Vec3]> {
        if crossed.iter().all(|c| *c == [0; BRICK]) {
            return Box::default();
        }
        self.gather(window, l);
        self.positions.clear();
        self.normals.clear();
        let place = Place::new(window.lattice(), at);
        self.along::<0>(&place, &crossed[0]);
        self.along::<1>(&place, &crossed[1]);
        self.along::<2>(&place, &crossed[2]);
        let mut points = Vec::with_capacity(2 * self.positions.len());
        points.extend_from_slice(&self.positions);
        points.extend_from_slice(&self.normals);
        points.into_boxed_slice()
    }

    /// Copies the values around a brick.
    fn gather(&mut self, window: &Window, l: IVec3) {
        for dz in 0..3 {
            for dy in 0..3 {
                let row = |x: i32| window.rows(l + IVec3::new(x, dy - 1, dz - 1));
                let (low, own, high) = (row(-1), row(0), row(1));
                for (z, fz) in part(dz) {
                    for (y, fy) in part(dy) {
                        let from = (fy + BRICK * fz) % (BRICK * BRICK);
                        let to = &mut self.padded[y + SIDE * z];
                        to[0] = low[from][7];
                        to[1..9].copy_from_slice(&own[from]);
                        to[9] = high[from][0];
                        to[10] = high[from][1];
                    }
                }
            }
        }
    }

    /// Vertices on the crossed edges along an axis.
    fn along<const AXIS: usize>(&mut self, place: &Place, crossed: &Signs) {
        let padded: &[f32; ROW * SIDE * SIDE] = bytemuck::cast_ref(&*self.padded);
        let strides = [1, ROW, PLANE];
        let (s, u, v) = (
            strides[AXIS],
            strides[(AXIS + 1) % 3],
            strides[(AXIS + 2) % 3],
        );
        let (eps, far, step) = (place.lattice.eps, place.lattice.far, place.lattice.step);
        for (z, &word) in crossed.iter().enumerate() {
            let mut word = word;
            while word != 0 {
                let bit = word.trailing_zeros() as usize;
                word &= word - 1;
                let (x, y) = (bit & 7, bit >> 3);
                // A window of constant length, so that what is read in it needs no further checks.
                let start = (x + 1) + ROW * (y + 1) + PLANE * z;
                let Some(w) = padded[start..].first_chunk::<{ 3 * PLANE + 1 }>() else {
                    continue;
                };
                let o = PLANE;
                let magnitude = |value: f32| {
                    let m = value.abs();
                    let m = if m <= f32::MAX / 4.0 { m } else { far };
                    m.max(eps)
                };
                let (a, b) = (magnitude(w[o]), magnitude(w[o + s]));
                let t = (a / (a + b)).clamp(place.margin, 1.0 - place.margin);

                let mut p = place.low + Vec3::new(x as f32, y as f32, z as f32);
                p[AXIS] += t;
                self.positions.push(p * step);

                let lerp = |p: f32, q: f32| p + t * (q - p);
                let mut g = Vec3::ZERO;
                g[AXIS] = lerp(w[o + s] - w[o - s], w[o + 2 * s] - w[o]);
                g[(AXIS + 1) % 3] = lerp(w[o + u] - w[o - u], w[o + s + u] - w[o + s - u]);
                g[(AXIS + 2) % 3] = lerp(w[o + v] - w[o - v], w[o + s + v] - w[o + s - v]);
                let square = g.length_squared();
                let n = if square > eps * eps && square < f32::MAX {
                    g * (1.0 / square.sqrt())
                } else {
                    // No gradient to speak of: across the surface along the edge.
                    let mut n = Vec3::ZERO;
                    let inside = w[o] <= -eps && w[o] >= f32::MIN;
                    n[AXIS] = if inside { 1.0 } else { -1.0 };
                    n
                };
                self.normals.push(n);
            }
        }
    }
}

/// Planes of the padded values that come from the neighbour `d` − 1 along an axis, each with the
/// plane it has there.
fn part(d: i32) -> impl Iterator<Item = (usize, usize)> {
    match d {
        0 => (0..1).zip(7..8),
        1 => (1..9).zip(0..8),
        _ => (9..11).zip(0..2),
    }
}

/// Where a brick stands.
struct Place {
    lattice: Lattice,
    /// Its first node, in steps.
    low: Vec3,
    /// How near to a node a vertex may lie, in steps.
    margin: f32,
}

impl Place {
    fn new(lattice: Lattice, at: BrickCoord) -> Self {
        let low = at.as_vec3() * BRICK as f32;
        // A thousandth of a step moves nothing visibly, and leaves triangles near a node legs of
        // at least eight units in the last place; farther out the units are longer.
        let reach = low.abs().max_element() + BRICK as f32;
        Self {
            lattice,
            low,
            margin: (reach * 8.0 * f32::EPSILON).clamp(1e-3, 0.25),
        }
    }
}
