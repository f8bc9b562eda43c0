use glam::{Affine3A, Vec3};

use crate::TriMesh;

impl TriMesh {
    /// This mesh moved by `by`. Normals turn with it, and a mirroring turns the triangles round,
    /// so that outside stays outside.
    #[must_use]
    pub fn transformed(&self, by: &Affine3A) -> Self {
        let mirrors = by.matrix3.determinant() < 0.0;
        // The cofactor matrix turns normals, and exists where the inverse does not.
        let [x, y, z] = [by.matrix3.x_axis, by.matrix3.y_axis, by.matrix3.z_axis];
        let sign = if mirrors { -1.0 } else { 1.0 };
        let turn = |n: Vec3| {
            let turned = y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z;
            Vec3::from(turned * sign).try_normalize().unwrap_or(n)
        };
        Self {
            positions: self
                .positions
                .iter()
                .map(|&p| by.transform_point3(p))
                .collect(),
            normals: self.normals.iter().map(|&n| turn(n)).collect(),
            triangles: match mirrors {
                true => self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
                false => self.triangles.clone(),
            },
        }
    }

    /// This mesh centred on the centre of its box, its longest side `longest` metres
    /// (EasyVRModeling §5.2, steps 2 and 3). Returns the mesh, the scale and the centre, so that
    /// `original = normalised / scale + centre`. A mesh without extent keeps its scale.
    #[must_use]
    pub fn normalised(&self, longest: f32) -> (Self, f32, Vec3) {
        if self.positions.is_empty() {
            return (self.clone(), 1.0, Vec3::ZERO);
        }
        let bounds = self.bounds();
        let centre = 0.5 * bounds.min + 0.5 * bounds.max;
        let side = f64::from(
            bounds
                .max
                .max_element()
                .abs()
                .max(bounds.min.min_element().abs()),
        );
        let size = (bounds.max.as_dvec3() - bounds.min.as_dvec3()).max_element();
        let scale = match size > side * f64::from(f32::MIN_POSITIVE) && size > 0.0 {
            true => f64::from(longest) / size,
            false => 1.0,
        };
        let scale = if (scale as f32).is_normal() {
            scale as f32
        } else {
            1.0
        };
        let mesh = Self {
            positions: self
                .positions
                .iter()
                .map(|&p| (p - centre) * scale)
                .collect(),
            normals: self.normals.clone(),
            triangles: self.triangles.clone(),
        };
        (mesh, scale, centre)
    }
}
