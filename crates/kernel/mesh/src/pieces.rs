use rayon::prelude::*;

use crate::TriMesh;

/// One use of an edge by a triangle, in the order the edges are sorted by.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct EdgeUse {
    /// The smaller vertex above, the larger below.
    edge: u64,
    /// Three times the triangle, plus the corner the edge starts at.
    pub corner: u32,
    /// Whether the triangle runs from the smaller vertex to the larger.
    pub forward: bool,
}

impl EdgeUse {
    pub fn triangle(self) -> usize {
        self.corner as usize / 3
    }

    /// The corners at the smaller and at the larger vertex.
    pub fn ends(self) -> [u32; 2] {
        let next = self.corner - self.corner % 3 + (self.corner + 1) % 3;
        match self.forward {
            true => [self.corner, next],
            false => [next, self.corner],
        }
    }
}

/// Every use of every edge, those of one edge side by side, in the order of the triangles.
pub(crate) fn edge_uses(triangles: &[[u32; 3]]) -> Vec<EdgeUse> {
    let mut uses: Vec<EdgeUse> = triangles
        .par_iter()
        .enumerate()
        .flat_map_iter(|(t, &[a, b, c])| {
            [(a, b), (b, c), (c, a)]
                .into_iter()
                .enumerate()
                .map(move |(k, (from, to))| EdgeUse {
                    edge: u64::from(from.min(to)) << 32 | u64::from(from.max(to)),
                    corner: (3 * t + k) as u32,
                    forward: from < to,
                })
        })
        .collect();
    uses.par_sort_unstable();
    uses
}

/// The uses of one edge after another.
pub(crate) fn by_edge(uses: &[EdgeUse]) -> impl Iterator<Item = &[EdgeUse]> {
    uses.chunk_by(|a, b| a.edge == b.edge)
}

/// Sets that can be joined.
pub(crate) struct Joined(Vec<u32>);

impl Joined {
    pub fn new(n: usize) -> Self {
        Self((0..n as u32).collect())
    }

    pub fn find(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            self.0[i as usize] = self.0[self.0[i as usize] as usize];
            i = self.0[i as usize];
        }
        i
    }

    /// Joins the sets of `i` and `j`; the smaller root stays, so that the result does not depend on the order.
    pub fn join(&mut self, i: u32, j: u32) {
        let (i, j) = (self.find(i), self.find(j));
        self.0[i.max(j) as usize] = i.min(j);
    }

    /// The number of each element's set, counted in the order of their first elements, and how many there are.
    pub fn numbered(mut self) -> (Vec<u32>, usize) {
        let mut number = vec![0; self.0.len()];
        let mut sets = 0;
        for i in 0..self.0.len() {
            let root = self.find(i as u32) as usize;
            if root == i {
                number[i] = sets;
                sets += 1;
            } else {
                number[i] = number[root];
            }
        }
        (number, sets as usize)
    }
}

impl TriMesh {
    /// The connected pieces, in the order of their first triangles. Triangles hang together where
    /// they share an edge; pieces that meet in one vertex only come apart.
    pub fn pieces(&self) -> Vec<Self> {
        let uses = edge_uses(&self.triangles);
        let mut joined = Joined::new(self.triangles.len());
        for edge in by_edge(&uses) {
            for pair in edge.windows(2) {
                joined.join(pair[0].triangle() as u32, pair[1].triangle() as u32);
            }
        }
        let (piece, count) = joined.numbered();
        let mut sorted: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (t, &p) in piece.iter().enumerate() {
            sorted[p as usize].push(t);
        }
        let mut renamed = vec![u32::MAX; self.positions.len()];
        sorted
            .iter()
            .map(|triangles| self.extract(triangles, &mut renamed))
            .collect()
    }

    /// The mesh of some triangles alone. `renamed` holds `u32::MAX` throughout, before and after.
    fn extract(&self, triangles: &[usize], renamed: &mut [u32]) -> Self {
        let mut used: Vec<u32> = triangles.iter().flat_map(|&t| self.triangles[t]).collect();
        used.sort_unstable();
        used.dedup();
        for (new, &old) in used.iter().enumerate() {
            renamed[old as usize] = new as u32;
        }
        let pick = |from: &[glam::Vec3]| match from.len() == self.positions.len() {
            true => used.iter().map(|&v| from[v as usize]).collect(),
            false => Vec::new(),
        };
        let mesh = Self {
            positions: pick(&self.positions),
            normals: pick(&self.normals),
            triangles: triangles
                .iter()
                .map(|&t| self.triangles[t].map(|v| renamed[v as usize]))
                .collect(),
        };
        for &old in &used {
            renamed[old as usize] = u32::MAX;
        }
        mesh
    }
}
