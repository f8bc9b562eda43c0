use std::fmt;
use std::str::FromStr;

use glam::Vec3;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An indexed triangle mesh. Vertices are shared: an edge used by two triangles names the same two
/// indices in both.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriMesh {
    /// Vertex positions in metres.
    pub positions: Vec<Vec3>,
    /// One unit normal per vertex, or empty where none are known.
    pub normals: Vec<Vec3>,
    /// Three vertex indices per triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl TriMesh {
    /// The three corners of triangle `t`.
    #[inline]
    pub fn corners(&self, t: usize) -> [Vec3; 3] {
        self.triangles[t].map(|v| self.positions[v as usize])
    }

    /// The box around all positions; [`Aabb::EMPTY`] for a mesh without vertices.
    pub fn bounds(&self) -> Aabb {
        self.positions
            .iter()
            .fold(Aabb::EMPTY, |b, &p| b.including(p))
    }

    /// A name for this geometry: BLAKE3 of positions and triangles as little-endian bytes.
    /// Normals do not take part, since they follow from the rest.
    pub fn hash(&self) -> MeshHash {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&(self.positions.len() as u64).to_le_bytes());
        hasher.update(bytemuck::cast_slice(&self.positions));
        hasher.update(bytemuck::cast_slice(&self.triangles));
        MeshHash(*hasher.finalize().as_bytes())
    }
}

/// An axis-aligned box, `min` to `max`, in metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Aabb {
    /// The smallest corner.
    pub min: Vec3,
    /// The largest corner.
    pub max: Vec3,
}

impl Aabb {
    /// The box that holds nothing: neutral for [`Aabb::union`] and [`Aabb::including`].
    pub const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// The box between two corners.
    pub const fn new(min: Vec3, max: Vec3) -> Self {
        Self { min, max }
    }

    /// The box of half extents `half` around `centre`.
    pub fn around(centre: Vec3, half: Vec3) -> Self {
        Self::new(centre - half, centre + half)
    }

    /// Whether no point lies inside.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The midpoint.
    pub fn centre(&self) -> Vec3 {
        0.5 * (self.min + self.max)
    }

    /// The side lengths.
    pub fn size(&self) -> Vec3 {
        self.max - self.min
    }

    /// The smallest box that holds this one and `p`.
    #[must_use]
    pub fn including(&self, p: Vec3) -> Self {
        Self::new(self.min.min(p), self.max.max(p))
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self::new(self.min.min(other.min), self.max.max(other.max))
    }

    /// What both boxes share; may be empty.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        Self::new(self.min.max(other.min), self.max.min(other.max))
    }

    /// Grown by `by` metres on every side.
    #[must_use]
    pub fn grown(&self, by: f32) -> Self {
        Self::new(self.min - by, self.max + by)
    }

    /// Distance from `p` to the box; 0 inside.
    pub fn distance(&self, p: Vec3) -> f32 {
        (self.min - p).max(p - self.max).max(Vec3::ZERO).length()
    }
}

/// The name of a mesh: the hash of its content, written as 64 hexadecimal digits.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MeshHash(pub [u8; 32]);

impl fmt::Display for MeshHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        blake3::Hash::from_bytes(self.0).to_hex().fmt(f)
    }
}

impl fmt::Debug for MeshHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for MeshHash {
    type Err = blake3::HexError;
    fn from_str(s: &str) -> Result<Self, Self::Err> {
        Ok(Self(*blake3::Hash::from_hex(s)?.as_bytes()))
    }
}

impl Serialize for MeshHash {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for MeshHash {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        let text = String::deserialize(d)?;
        text.parse().map_err(serde::de::Error::custom)
    }
}
