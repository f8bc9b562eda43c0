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

/// The cosine of the angle between the normals of one side at one vertex, at most: 25°.
const ONE_SIDE: f32 = 0.906;

impl TriMesh {
    /// The same surface for drawing: each vertex from number `first` on lies on a sharp edge, and becomes one vertex for
    /// each side that meets there, with the normal that the other corners of its triangles have. What comes out is not
    /// closed, as with [`TriMesh::creased`].
    #[must_use]
    pub fn parted(&self, first: usize) -> Self {
        let mut out = self.clone();
        // Of each such vertex, the normals it has and the vertices that have them.
        let mut sides: Vec<Vec<(Vec3, u32)>> =
            vec![Vec::new(); self.positions.len().saturating_sub(first)];
        for (t, corners) in self.triangles.iter().enumerate() {
            if corners.iter().all(|&v| (v as usize) < first) {
                continue;
            }
            let beside = corners.iter().filter(|&&v| (v as usize) < first);
            let sum: Vec3 = beside.map(|&v| self.normals[v as usize]).sum();
            let [a, b, c] = self.corners(t);
            let normal = sum
                .try_normalize()
                .or_else(|| (b - a).cross(c - a).try_normalize())
                .unwrap_or(Vec3::Y);
            for (k, &v) in corners.iter().enumerate() {
                let Some(known) = (v as usize)
                    .checked_sub(first)
                    .and_then(|i| sides.get_mut(i))
                else {
                    continue;
                };
                let same = known.iter().find(|(n, _)| n.dot(normal) > ONE_SIDE);
                let own = same.map(|&(_, own)| own).unwrap_or_else(|| {
                    let own = if known.is_empty() {
                        out.normals[v as usize] = normal;
                        v
                    } else {
                        out.positions.push(self.positions[v as usize]);
                        out.normals.push(normal);
                        out.positions.len() as u32 - 1
                    };
                    known.push((normal, own));
                    own
                });
                out.triangles[t][k] = own;
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ridge_is_parted_into_its_two_sides() {
        // A roof: four vertices of its eaves, two of its ridge.
        let roof = TriMesh {
            positions: [
                [-1.0, 0.0, 0.0],
                [-1.0, 0.0, 1.0],
                [1.0, 0.0, 0.0],
                [1.0, 0.0, 1.0],
                [0.0, 1.0, 0.0],
                [0.0, 1.0, 1.0],
            ]
            .map(Vec3::from_array)
            .to_vec(),
            normals: [[-1.0, 1.0, 0.0]; 2]
                .into_iter()
                .chain([[1.0, 1.0, 0.0]; 2])
                .chain([[0.0, 1.0, 0.0]; 2])
                .map(|n| Vec3::from_array(n).normalize())
                .collect(),
            triangles: vec![[0, 1, 5], [0, 5, 4], [3, 2, 4], [3, 4, 5]],
        };
        let drawn = roof.parted(4);
        assert_eq!(drawn.positions.len(), 8);
        for (t, corners) in drawn.triangles.iter().enumerate() {
            let flat = |&v: &u32| {
                drawn.normals[v as usize].distance(drawn.normals[corners[0] as usize]) < 1e-6
            };
            assert!(corners.iter().all(flat));
            assert_eq!(drawn.corners(t), roof.corners(t));
        }
        assert_eq!(roof.parted(6), roof);
    }

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
