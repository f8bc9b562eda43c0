//! Points in rows, and the triangles between them.

use glam::{DVec3, Vec2, Vec3};

/// A surface with shared vertices, not necessarily closed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Skin {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// For each point of the rows, its vertex.
    pub vertex: Vec<u32>,
}

/// `columns` points in each row; the last joins the first where it is a `ring`.
pub(crate) struct Lattice<'a> {
    pub points: &'a [Vec3],
    pub columns: usize,
    pub ring: bool,
}

impl Lattice<'_> {
    fn rows(&self) -> usize {
        self.points.len() / self.columns.max(1)
    }

    /// The triangles between the rows. Neighbours that coincide are one vertex, so that a pinned end
    /// is the middle of a fan; what collapses is left out.
    pub fn skin(&self) -> Skin {
        let (rows, columns) = (self.rows(), self.columns);
        let mut skin = self.welded();
        let across = if self.ring { columns } else { columns - 1 };
        for j in 0..rows.saturating_sub(1) {
            for i in 0..across {
                let next = (i + 1) % columns;
                let [a, b, c, d] = [
                    j * columns + i,
                    j * columns + next,
                    (j + 1) * columns + next,
                    (j + 1) * columns + i,
                ]
                .map(|k| skin.vertex[k]);
                skin.quad(a, b, c, d);
            }
        }
        skin
    }

    fn welded(&self) -> Skin {
        let (rows, columns) = (self.rows(), self.columns);
        let mut root: Vec<u32> = (0..self.points.len() as u32).collect();
        fn find(root: &mut [u32], mut i: u32) -> u32 {
            while root[i as usize] != i {
                root[i as usize] = root[root[i as usize] as usize];
                i = root[i as usize];
            }
            i
        }
        let reach = self
            .points
            .iter()
            .fold(0.0f32, |m, p| m.max(p.abs().max_element()));
        let near = (1.0e-6 * reach).max(1.0e-7);
        let mut join = |a: usize, b: usize| {
            if self.points[a].distance_squared(self.points[b]) <= near * near {
                let (x, y) = (find(&mut root, a as u32), find(&mut root, b as u32));
                root[x.max(y) as usize] = x.min(y);
            }
        };
        for j in 0..rows {
            for i in 0..columns {
                let here = j * columns + i;
                if i + 1 < columns {
                    join(here, here + 1);
                } else if self.ring {
                    join(here, j * columns);
                }
                if j + 1 < rows {
                    join(here, here + columns);
                }
            }
        }
        let mut skin = Skin {
            vertex: vec![u32::MAX; self.points.len()],
            ..Skin::default()
        };
        for i in 0..self.points.len() {
            let r = find(&mut root, i as u32) as usize;
            if skin.vertex[r] == u32::MAX {
                skin.vertex[r] = skin.positions.len() as u32;
                skin.positions.push(self.points[r]);
            }
            skin.vertex[i] = skin.vertex[r];
        }
        skin
    }
}

impl Skin {
    /// Two triangles, divided along the shorter diagonal.
    pub fn quad(&mut self, a: u32, b: u32, c: u32, d: u32) {
        let apart = |x: u32, y: u32| {
            self.positions[x as usize].distance_squared(self.positions[y as usize])
        };
        let one_way = apart(a, c) <= apart(b, d);
        if one_way {
            self.triangle(a, b, c);
            self.triangle(a, c, d);
        } else {
            self.triangle(a, b, d);
            self.triangle(b, c, d);
        }
    }

    fn triangle(&mut self, a: u32, b: u32, c: u32) {
        if a != b && b != c && c != a {
            self.triangles.push([a, b, c]);
        }
    }

    /// A vertex where several fans of triangles meet becomes one for each of them: a wall drawn up
    /// from it would otherwise have four sides. [`Skin::vertex`] then names one of them; each has the same
    /// place on a picture.
    pub fn split(&mut self, uv: &mut Vec<Vec2>) {
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); self.positions.len()];
        for (t, corners) in self.triangles.iter().enumerate() {
            for &v in corners {
                around[v as usize].push(t as u32);
            }
        }
        for (v, all) in around.into_iter().enumerate() {
            let v = v as u32;
            let mut rest = all;
            let mut first = true;
            while let Some(start) = rest.pop() {
                let mut fan = vec![start];
                let mut at = 0;
                while at < fan.len() {
                    let here = self.triangles[fan[at] as usize];
                    at += 1;
                    let others: Vec<u32> = here.into_iter().filter(|&x| x != v).collect();
                    rest.retain(|&t| {
                        let joins = self.triangles[t as usize]
                            .iter()
                            .any(|x| others.contains(x));
                        if joins {
                            fan.push(t);
                        }
                        !joins
                    });
                }
                if !std::mem::replace(&mut first, false) {
                    let own = self.positions.len() as u32;
                    self.positions.push(self.positions[v as usize]);
                    uv.push(uv[v as usize]);
                    for t in fan {
                        for x in &mut self.triangles[t as usize] {
                            if *x == v {
                                *x = own;
                            }
                        }
                    }
                }
            }
        }
    }

    /// Twice a triangle's area along its normal.
    pub fn area(&self, t: &[u32; 3]) -> DVec3 {
        let [a, b, c] = t.map(|v| self.positions[v as usize].as_dvec3());
        (b - a).cross(c - a)
    }

    /// Unit normals by the areas around each vertex; zero where they cancel.
    pub fn normals(&self) -> Vec<Vec3> {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for t in &self.triangles {
            let area = self.area(t);
            for &v in t {
                sums[v as usize] += area;
            }
        }
        sums.into_iter()
            .map(|n| n.normalize_or_zero().as_vec3())
            .collect()
    }

    /// Six times the volume it encloses, where it is closed.
    pub fn volume(&self) -> f64 {
        let volume = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| self.positions[v as usize].as_dvec3());
            a.dot(b.cross(c))
        };
        self.triangles.iter().map(volume).sum()
    }
}
