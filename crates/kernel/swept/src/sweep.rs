use std::sync::Arc;

use glam::{Vec2, Vec3};
use midair_mesh::{Aabb, TriMesh};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::lattice::{Lattice, Skin};
use crate::{MAX_CLONES, Rib};

/// The most points along one rib.
pub const MAX_COUNT: u32 = 1024;
/// The most ribs of one sweep.
pub const MAX_RIBS: usize = 65_536;
/// The most points of one sweep.
const MAX_POINTS: usize = 8_000_000;

/// What a rib is drawn as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Profile {
    /// The curve itself: an open surface, or with thickness a plate (§3.2.1).
    #[default]
    Sheet,
    /// The curve and its closing one: a tube (§3.2.2).
    Tube,
}

/// Ribs in the order they were swept, and the surface between them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// From the first to the last.
    pub ribs: Arc<[Rib]>,
    /// n: points along each rib.
    pub count: u32,
    /// A sheet or a tube.
    #[serde(default)]
    pub profile: Profile,
    /// Metres: of a sheet, or of the wall of a tube without caps. 0 leaves it a surface.
    #[serde(default)]
    pub thickness: f32,
    /// A tube is closed at its ends and full.
    #[serde(default)]
    pub caps: bool,
}

/// Why a sweep cannot be.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SweepError {
    /// Fewer than two ribs.
    #[error("one curve makes no surface; move the hands while the trigger is held")]
    TooFew,
    /// More than can be.
    #[error("a sweep of {0} curves; at most {MAX_RIBS} are possible, so begin another one")]
    TooMany(usize),
    /// A number that is none.
    #[error("curve {0} of the sweep has a number that is not finite, or out of reach")]
    Rib(usize),
    /// Too few or too many points along a rib.
    #[error("a curve has between 2 and {MAX_COUNT} points, not {0}")]
    Count(u32),
    /// A thickness that means nothing.
    #[error("the thickness must be a number of metres between 0 and 10")]
    Thickness,
    /// A surface where a solid is asked for.
    #[error("it is open: give it a thickness, or caps if it is a tube")]
    Open,
    /// Everything lies in one line, or the tube in one plane.
    #[error("it encloses nothing; bend the curve, or move it another way than along itself")]
    Flat,
    /// Both ends of every curve are in one place.
    #[error("both ends of the curve are at one point; move the hands apart")]
    OnePoint,
    /// No place for a clone.
    #[error("a row of clones needs a curve and at least one clone")]
    NoClones,
    /// More than can be.
    #[error("{0} clones; at most {MAX_CLONES} are possible, so take fewer on each curve")]
    TooManyClones(usize),
    /// A size that means nothing.
    #[error("the size of the clones must be a positive number")]
    Size,
}

/// An open surface, and where it lies on a picture.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// With normals; triangles face where the sweep's direction crosses the curve's.
    pub mesh: TriMesh,
    /// (u, metres swept) for each vertex.
    pub uv: Vec<Vec2>,
}

impl Sweep {
    /// Whether it is a solid.
    pub fn is_closed(&self) -> bool {
        self.thickness > 0.0 || (self.profile == Profile::Tube && self.caps)
    }

    /// Whether its numbers are sound.
    ///
    /// # Errors
    /// [`SweepError`]; an open one is sound.
    pub fn validate(&self) -> Result<(), SweepError> {
        if self.ribs.len() < 2 {
            return Err(SweepError::TooFew);
        }
        if self.ribs.len() > MAX_RIBS || self.ribs.len() * self.columns() > MAX_POINTS {
            return Err(SweepError::TooMany(self.ribs.len()));
        }
        if !(2..=MAX_COUNT).contains(&self.count) {
            return Err(SweepError::Count(self.count));
        }
        if !(0.0..=10.0).contains(&self.thickness) {
            return Err(SweepError::Thickness);
        }
        match self.ribs.iter().position(|r| !r.is_sound()) {
            Some(at) => Err(SweepError::Rib(at + 1)),
            None => Ok(()),
        }
    }

    /// Points in one row.
    pub(crate) fn columns(&self) -> usize {
        let count = self.count.clamp(2, MAX_COUNT) as usize;
        match self.profile {
            Profile::Sheet => count,
            Profile::Tube => 2 * count - 2,
        }
    }

    /// Every point, rib by rib.
    pub fn points(&self) -> Vec<Vec3> {
        let count = self.count.clamp(2, MAX_COUNT) as usize;
        let mut points = Vec::with_capacity(self.ribs.len() * self.columns());
        for rib in self.ribs.iter() {
            match self.profile {
                Profile::Sheet => rib.points_into(count, &mut points),
                Profile::Tube => rib.ring_into(count, &mut points),
            }
        }
        points
    }

    /// A box around it.
    pub fn bounds(&self) -> Aabb {
        let points = self.points().into_iter().filter(|p| p.is_finite());
        let within = points.fold(Aabb::EMPTY, |b, p| b.including(p));
        if within.is_empty() {
            return Aabb::EMPTY;
        }
        let walled = self.profile == Profile::Sheet || !self.caps;
        within.grown(if walled {
            0.5 * self.thickness.max(0.0)
        } else {
            0.0
        })
    }

    pub(crate) fn skin(&self, points: &[Vec3]) -> Skin {
        Lattice {
            points,
            columns: self.columns(),
            ring: self.profile == Profile::Tube && self.columns() > 2,
        }
        .skin()
    }

    /// (u, metres swept) for each vertex of the skin. u runs from 0 to 1 along a curve, and back along
    /// the one that closes a tube, so that its picture has no seam.
    pub(crate) fn uv(&self, points: &[Vec3], skin: &Skin) -> Vec<Vec2> {
        let mut uv = vec![Vec2::ZERO; skin.positions.len()];
        let columns = self.columns();
        let last = (self.count.clamp(2, MAX_COUNT) - 1) as usize;
        let mut along = 0.0;
        for (j, row) in points.chunks(columns).enumerate() {
            if j > 0 {
                let before = &points[(j - 1) * columns..j * columns];
                let moved = row.iter().zip(before).map(|(a, b)| a.distance(*b));
                along += moved.sum::<f32>() / columns as f32;
            }
            for i in 0..columns {
                let there = if i > last { columns - i } else { i };
                let u = there as f32 / last as f32;
                uv[skin.vertex[j * columns + i] as usize] = Vec2::new(u, along);
            }
        }
        uv
    }

    /// The surface itself, without thickness and caps.
    ///
    /// # Errors
    /// [`SweepError`].
    pub fn surface(&self) -> Result<Surface, SweepError> {
        self.validate()?;
        let points = self.points();
        let skin = self.skin(&points);
        if skin.triangles.is_empty() {
            return Err(SweepError::Flat);
        }
        let normals = skin.normals();
        let uv = self.uv(&points, &skin);
        Ok(Surface {
            mesh: TriMesh {
                positions: skin.positions,
                normals: normals
                    .into_iter()
                    .map(|n| n.normalize_or(Vec3::Y))
                    .collect(),
                triangles: skin.triangles,
            },
            uv,
        })
    }
}
