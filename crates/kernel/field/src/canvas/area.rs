//! A polygon as a skeleton.

use glam::{Affine3A, Vec2, Vec3, Vec3A};
use midair_mesh::Aabb;

use super::kernel::{Edge, Family, clearance, turns};

/// A polygon in its frame. In supports, it is felt no further away than 1.
#[derive(Clone, Debug)]
pub(super) struct Area {
    pub origin: Vec3,
    /// Two axes of its plane, and its normal.
    pub axes: [Vec3; 3],
    /// In supports.
    pub corners: Vec<Vec2>,
    pub edges: Vec<Edge>,
    /// 1 / support.
    pub inverse: f32,
}

/// A block near a polygon, in supports.
pub(super) struct Seen {
    /// Where its middle is in the polygon's plane.
    pub flat: Vec2,
    /// The least and the greatest distance of its places from that plane.
    pub heights: [f32; 2],
    /// How far its middle lies from the outline, positive inside.
    clear: f32,
    /// How far its places lie from the middle at most.
    pub radius: f32,
}

impl Seen {
    /// Whether no edge is felt anywhere in it: there the polygon is a plane without end.
    pub fn is_within(&self) -> bool {
        self.clear - self.radius > 1.0
    }
}

impl Area {
    #[inline(always)]
    pub(super) fn at(&self, family: &Family, p: Vec3) -> f32 {
        let (flat, height) = self.flat(p);
        family.at_polygon(&self.edges, flat, height)
    }

    /// The edge that alone is felt, and neither of its ends, around a place of its plane, with the angle
    /// of the turns that the polygon makes right of it; all in supports.
    pub(super) fn only_edge(&self, flat: Vec2, radius: f32) -> Option<(&Edge, f32)> {
        let reach = 1.001 * (1.0 + radius);
        let mut near = self.edges.iter().filter(|e| e.distance(flat) < reach);
        let only = near.next()?;
        if near.next().is_some() {
            return None;
        }
        // Where it is nearly passed, a place beside it, still far from all other edges.
        let left = only.left(flat.x, flat.y);
        let right = match left {
            0.5.. => turns(&self.corners, flat) - 1,
            ..-0.5 => turns(&self.corners, flat),
            _ => turns(&self.corners, only.beside(flat, -0.5)),
        };
        Some((only, std::f32::consts::TAU * right as f32))
    }

    /// The block of places no further than `radius` from `centre` in the polygon's frame and within a
    /// box about the same middle in the canvas's; `None` where the polygon is not felt in it.
    pub(super) fn seen(
        &self,
        centre: Vec3,
        radius: f32,
        within: &Aabb,
        to_local: Option<&Affine3A>,
    ) -> Option<Seen> {
        let n = self.axes[2];
        let n = to_local.map_or(n, |m| Vec3::from(m.matrix3.transpose() * Vec3A::from(n)));
        // A box reaches less far across most planes than the ball around it.
        let deep = (0.5 * within.size()).dot(n.abs()).min(radius) * 1.000_01 * self.inverse;
        let radius = radius * self.inverse;
        let (flat, height) = self.flat(centre);
        let heights = [height.abs() - deep, height.abs() + deep];
        if heights[0] > 1.0 {
            return None;
        }
        let clear = clearance(&self.corners, flat);
        let seen = Seen {
            flat,
            heights: [heights[0].max(0.0), heights[1]],
            clear,
            radius,
        };
        (clear + radius >= -1.0).then_some(seen)
    }

    /// A place in the polygon's plane and above it, in supports.
    #[inline(always)]
    pub(super) fn flat(&self, p: Vec3) -> (Vec2, f32) {
        let q = (p - self.origin) * self.inverse;
        let flat = Vec2::new(q.dot(self.axes[0]), q.dot(self.axes[1]));
        (flat, q.dot(self.axes[2]))
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec2};
    use proptest::prelude::*;

    use super::*;

    fn area(origin: Vec3, turn: Quat, support: f32) -> Area {
        let corners = [
            [-0.3, -0.2],
            [0.3, -0.2],
            [0.25, 0.2],
            [0.0, 0.05],
            [-0.3, 0.2],
        ];
        let corners = corners.map(|c| Vec2::from(c) / support).to_vec();
        Area {
            origin,
            axes: [Vec3::X, Vec3::Y, Vec3::Z].map(|a| turn * a),
            edges: Edge::all(&corners),
            corners,
            inverse: 1.0 / support,
        }
    }

    fn vector(by: f32) -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-by..by).prop_map(Vec3::from)
    }

    proptest! {
        #[test]
        fn what_is_said_of_a_block_holds_everywhere_in_it(
            origin in vector(0.1),
            turn in vector(3.0),
            support in 0.03f32..0.15,
            centre in vector(0.45),
            half in 0.005f32..0.06,
            stretch in prop::array::uniform3(0.5f32..2.0),
            tilt in vector(3.0),
            at in prop::collection::vec(vector(1.0), 20),
        ) {
            let area = area(origin, Quat::from_scaled_axis(turn), support);
            let family = Family::new(1.75);
            let frame = glam::Mat3::from_quat(Quat::from_scaled_axis(tilt))
                * glam::Mat3::from_diagonal(stretch.into());
            let to_local = Affine3A::from_mat3(frame);
            let within = Aabb::around(to_local.inverse().transform_point3(centre), Vec3::splat(half));
            let radius = 3.0f32.sqrt() * half * stretch.iter().copied().fold(0.0, f32::max) * 1.001;
            let seen = area.seen(centre, radius, &within, Some(&to_local));
            for p in at {
                let p = to_local.transform_point3(0.5 * (within.min + within.max) + half * p);
                let here = area.at(&family, p);
                let Some(seen) = &seen else {
                    prop_assert!(here.abs() < 4e-5, "{here}");
                    continue;
                };
                let [near, far] = seen.heights.map(|h| family.at_plane(h));
                prop_assert!(here <= near + 4e-5, "{here} {near}");
                if seen.is_within() {
                    prop_assert!(here >= far - 4e-5, "{here} {far}");
                }
            }
        }
    }
}
