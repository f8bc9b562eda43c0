use glam::Vec3;
use midair_mesh::TriMesh;

use super::Feet;
use super::cut::Split;

/// Vertices beside an edge, on the surface itself.
pub(super) struct Moved {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    /// The triangles of which an edge that is split ends at a corner, in order.
    pub touched: Vec<u32>,
}

impl Moved {
    pub fn new(mesh: &TriMesh, splits: &[Split], feet: &Feet) -> Self {
        let mut moved = Self {
            positions: mesh.positions.clone(),
            normals: mesh.normals.clone(),
            touched: Vec::new(),
        };
        // The lattice blurs normals beside an edge.
        for (v, foot) in feet.all().filter(|(_, f)| !f.edge) {
            moved.normals[v as usize] = foot.normal;
        }
        let mut beside = vec![false; mesh.positions.len()];
        for v in splits.iter().flat_map(|s| s.ends) {
            if let Some(foot) = feet.of(v) {
                moved.positions[v as usize] = foot.at;
                beside[v as usize] = true;
            }
        }
        let list = (0..).zip(&mesh.triangles);
        moved.touched = list
            .filter(|(_, t)| t.iter().any(|&v| beside[v as usize]))
            .map(|(i, _)| i)
            .collect();
        moved
    }

    /// Takes back what would turn a triangle over.
    pub fn settle(&mut self, mesh: &TriMesh) {
        loop {
            let turned: Vec<u32> = self
                .touched
                .iter()
                .copied()
                .filter(|&t| {
                    let [a, b, c] = mesh.triangles[t as usize].map(|v| v as usize);
                    let face = |p: &[Vec3]| (p[b] - p[a]).cross(p[c] - p[a]);
                    let (now, before) = (face(&self.positions), face(&mesh.positions));
                    now != before && now.dot(before) < 0.2 * before.length_squared()
                })
                .collect();
            if turned.is_empty() {
                return;
            }
            for t in turned {
                self.take_back(mesh, t);
            }
        }
    }

    /// The corners of a triangle, where they were.
    pub fn take_back(&mut self, mesh: &TriMesh, t: u32) {
        for v in mesh.triangles[t as usize] {
            self.positions[v as usize] = mesh.positions[v as usize];
        }
    }
}
