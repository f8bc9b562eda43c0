use glam::Vec3;

use crate::TriMesh;

impl TriMesh {
    /// Sets one unit normal per vertex: the mean of the normals of its triangles, weighted by
    /// their angle at the vertex, which does not depend on how a flat face is cut into triangles
    /// (Thürmer and Wüthrich 1998). A vertex without a triangle that has an area gets +Y.
    pub fn compute_normals(&mut self) {
        let mut sums = vec![Vec3::ZERO; self.positions.len()];
        for &triangle in &self.triangles {
            let [a, b, c] = triangle.map(|v| self.positions[v as usize]);
            let normal = unit(unit(b - a).cross(unit(c - a)));
            let corners = [(a, b, c), (b, c, a), (c, a, b)];
            for (v, (at, next, last)) in triangle.into_iter().zip(corners) {
                let cosine = unit(next - at).dot(unit(last - at)).clamp(-1.0, 1.0);
                sums[v as usize] += normal * cosine.acos();
            }
        }
        self.normals = sums
            .into_iter()
            .map(|sum| sum.try_normalize().unwrap_or(Vec3::Y))
            .collect();
    }
}

/// `v` at length one, or zero. Scaled first: the square of a tiny length is zero in f32.
fn unit(v: Vec3) -> Vec3 {
    let largest = v.abs().max_element();
    match largest > 0.0 && largest.is_finite() {
        true => (v / largest).normalize_or_zero(),
        false => Vec3::ZERO,
    }
}
