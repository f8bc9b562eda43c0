use glam::DVec3;
use rayon::prelude::*;

use crate::TriMesh;

/// Triangles per partial sum. Fixed, so that sums do not depend on the number of threads.
const CHUNK: usize = 8192;

impl TriMesh {
    /// The enclosed volume in m³ by the divergence theorem, in f64; negative where the triangles
    /// wind inwards. Only a closed mesh has one: of an open mesh this is a sum without meaning.
    pub fn volume(&self) -> f64 {
        // About the centre of the box, so that a small mesh far from the origin loses no digits.
        let centre = match self.positions.is_empty() {
            true => DVec3::ZERO,
            false => self.bounds().centre().as_dvec3(),
        };
        self.sum(|[a, b, c]| (a - centre).dot((b - centre).cross(c - centre)) / 6.0)
    }

    /// The area of all triangles in m².
    pub fn area(&self) -> f64 {
        self.sum(|[a, b, c]| 0.5 * (b - a).cross(c - a).length())
    }

    fn sum(&self, term: impl Fn([DVec3; 3]) -> f64 + Sync) -> f64 {
        let parts: Vec<f64> = self
            .triangles
            .par_chunks(CHUNK)
            .map(|chunk| {
                let corner = |v: u32| self.positions[v as usize].as_dvec3();
                chunk.iter().map(|t| term(t.map(corner))).sum()
            })
            .collect();
        parts.iter().sum()
    }
}
