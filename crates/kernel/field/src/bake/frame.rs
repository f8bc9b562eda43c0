use glam::{UVec3, Vec3};
use midair_mesh::Aabb;

use super::BakeError;

/// Cells along the side of a brick, and nodes along it with the shared last layer.
pub(super) const SIDE: usize = 8;
pub(super) const NODES: usize = SIDE + 1;
/// Most bricks a table may have: 16 million, or about two thousand nodes along each side.
const MOST_BRICKS: u64 = 1 << 24;

/// Where the nodes of a volume lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub origin: Vec3,
    pub step: f32,
    pub cells: UVec3,
}

impl Frame {
    /// The smallest frame of whole cells that holds `bounds`, its first node at `bounds.min`.
    pub fn around(bounds: Aabb, step: f32) -> Result<Self, BakeError> {
        if !(step.is_finite() && step > 0.0) {
            return Err(BakeError::Step(step));
        }
        let size = bounds.size();
        if bounds.is_empty() || !bounds.min.is_finite() || !size.is_finite() {
            return Err(BakeError::NotFinite);
        }
        // A length that is whole but for rounding gets no further cell.
        let cells = (size.as_dvec3() / f64::from(step) - 1e-4)
            .ceil()
            .max(glam::DVec3::ONE);
        let bricks = (cells / SIDE as f64).ceil();
        let count = bricks.x * bricks.y * bricks.z;
        if count > MOST_BRICKS as f64 {
            let fits = f64::from(step) * (count / MOST_BRICKS as f64).cbrt() * 1.02;
            return Err(BakeError::TooLarge {
                step,
                fits: fits as f32,
            });
        }
        // Two neighbouring nodes must not round to one.
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        if step < reach * 4.0 * f32::EPSILON {
            return Err(BakeError::TooLarge {
                step,
                fits: reach * 1e-5,
            });
        }
        Ok(Self {
            origin: bounds.min,
            step,
            cells: cells.as_uvec3(),
        })
    }

    pub fn bounds(&self) -> Aabb {
        Aabb::new(self.origin, self.node(self.cells))
    }

    pub fn bricks(&self) -> UVec3 {
        (self.cells + (SIDE as u32 - 1)) / SIDE as u32
    }

    pub fn brick_count(&self) -> usize {
        let b = self.bricks();
        b.x as usize * b.y as usize * b.z as usize
    }

    /// The place of node `i`; nodes are numbered over the whole grid.
    #[inline]
    pub fn node(&self, i: UVec3) -> Vec3 {
        self.origin + i.as_vec3() * self.step
    }

    pub fn brick_index(&self, b: UVec3) -> usize {
        let n = self.bricks();
        (b.x + n.x * (b.y + n.y * b.z)) as usize
    }

    pub fn brick_at(&self, index: usize) -> UVec3 {
        at(self.bricks(), index)
    }
}

/// The coordinates of entry `index` in a table of `size`, x fastest.
pub(super) fn at(size: UVec3, index: usize) -> UVec3 {
    let i = index as u32;
    UVec3::new(i % size.x, i / size.x % size.y, i / (size.x * size.y))
}
