use glam::Vec3;

use crate::TriMesh;

impl TriMesh {
    /// The same surface for drawing: where faces around a vertex meet at more than `angle` radians it
    /// becomes one vertex for each smooth side, with that side's own normal, so that what is sharp is
    /// drawn sharp and the rest smooth. What comes out is not closed: it shares no vertices across an
    /// edge that is sharp.
    ///
    /// The first of a vertex keeps its place, so that what belongs to vertices still fits; the second
    /// value names for each vertex beyond those the one that it stands for.
    #[must_use]
    pub fn creased(&self, angle: f32) -> (Self, Vec<u32>) {
        let limit = angle.cos();
        let faces: Vec<Vec3> = (0..self.triangles.len())
            .map(|t| {
                let [a, b, c] = self.corners(t);
                (b - a).cross(c - a)
            })
            .collect();
        let unit: Vec<Vec3> = faces.iter().map(|n| n.normalize_or_zero()).collect();
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); self.positions.len()];
        for (t, corners) in self.triangles.iter().enumerate() {
            for &v in corners {
                around[v as usize].push(t as u32);
            }
        }
        let mut out = Self {
            normals: vec![Vec3::Y; self.positions.len()],
            ..self.clone()
        };
        let mut more = Vec::new();
        for (v, mut rest) in around.into_iter().enumerate() {
            let mut first = true;
            while let Some(start) = rest.pop() {
                // A side grows over faces that share an edge and hardly turn.
                let mut side = vec![start];
                let mut at = 0;
                while at < side.len() {
                    let here = side[at] as usize;
                    at += 1;
                    rest.retain(|&t| {
                        let other = &self.triangles[t as usize];
                        let shared = self.triangles[here]
                            .iter()
                            .filter(|&&x| x != v as u32 && other.contains(&x));
                        let flat = unit[here].dot(unit[t as usize]) >= limit
                            || unit[here] == Vec3::ZERO
                            || unit[t as usize] == Vec3::ZERO;
                        let joins = flat && shared.count() > 0;
                        if joins {
                            side.push(t);
                        }
                        !joins
                    });
                }
                let sum: Vec3 = side.iter().map(|&t| faces[t as usize]).sum();
                let normal = sum.try_normalize().unwrap_or(Vec3::Y);
                if std::mem::take(&mut first) {
                    out.normals[v] = normal;
                    continue;
                }
                let own = out.positions.len() as u32;
                out.positions.push(self.positions[v]);
                out.normals.push(normal);
                more.push(v as u32);
                for t in side {
                    for x in &mut out.triangles[t as usize] {
                        if *x == v as u32 {
                            *x = own;
                        }
                    }
                }
            }
        }
        (out, more)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_three_normals_at_each_corner_and_a_slab_of_it_one() {
        let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32);
        let quads = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let cube = TriMesh {
            positions: (0..8).map(corner).collect(),
            normals: Vec::new(),
            triangles: quads
                .iter()
                .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
                .collect(),
        };
        let (sharp, more) = cube.creased(0.7);
        assert_eq!((sharp.positions.len(), more.len()), (24, 16));
        let along_an_axis = |n: &Vec3| (n.abs().max_element() - 1.0).abs() < 1e-6;
        assert!(sharp.normals.iter().all(along_an_axis));
        for (t, before) in sharp.triangles.iter().zip(&cube.triangles) {
            let place = |v: u32| sharp.positions[v as usize];
            assert_eq!(t.map(place), before.map(|v| cube.positions[v as usize]));
        }
        let (smooth, more) = cube.creased(2.0);
        assert_eq!((smooth.positions.len(), more.len()), (8, 0));
    }
}
