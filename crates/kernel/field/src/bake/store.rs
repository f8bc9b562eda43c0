//! A volume as bytes.

use glam::{UVec3, Vec3};
use midair_mesh::Aabb;

use super::frame::Frame;
use super::volume::{FAR_LEN, MOST_VALUES, NEAR, NEAR_LEN, Volume, groups_of, summary_of};

/// What every stored volume begins with. The last byte is the version of the layout.
const MAGIC: [u8; 8] = *b"mdrvol\0\x03";
const CHECKSUM: usize = 32;

/// The version of the layout and of what a bake gives: a volume of another one is baked anew.
pub(super) const VERSION: u8 = MAGIC[7];

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Header {
    origin: [f32; 3],
    step: f32,
    cells: [u32; 3],
    solid: [[f32; 3]; 2],
    values: u32,
}

impl Volume {
    /// The volume as bytes, packed and with a checksum; little-endian.
    pub fn to_bytes(&self) -> Vec<u8> {
        let near = self.table.iter().map(|e| u8::from(e & NEAR != 0));
        let header = Header {
            origin: self.frame.origin.to_array(),
            step: self.frame.step,
            cells: self.frame.cells.to_array(),
            solid: [self.solid.min.to_array(), self.solid.max.to_array()],
            values: self.values.len() as u32,
        };
        let mut plain = bytemuck::bytes_of(&header).to_vec();
        plain.extend(near);
        plain.extend_from_slice(bytemuck::cast_slice(&self.values));
        let packed = lz4_flex::block::compress(&plain);
        let mut out = MAGIC.to_vec();
        out.extend_from_slice(&[0; CHECKSUM]);
        out.extend_from_slice(&(plain.len() as u64).to_le_bytes());
        out.extend_from_slice(&packed);
        let sum = blake3::hash(&out[MAGIC.len() + CHECKSUM..]);
        out[MAGIC.len()..][..CHECKSUM].copy_from_slice(sum.as_bytes());
        out
    }

    /// The volume [`Volume::to_bytes`] gave; `None` for anything else, whatever it is.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let rest = bytes.strip_prefix(&MAGIC)?;
        let (sum, rest) = rest.split_at_checked(CHECKSUM)?;
        if blake3::hash(rest).as_bytes() != sum {
            return None;
        }
        let (length, packed) = rest.split_first_chunk::<8>()?;
        let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
        // LZ4 packs at most 255 to 1, which bounds what a forged length can ask for.
        if length > packed.len().saturating_mul(255).saturating_add(64) {
            return None;
        }
        let plain = lz4_flex::block::decompress(packed, length).ok()?;
        Self::from_plain(&plain)
    }

    fn from_plain(plain: &[u8]) -> Option<Self> {
        let (head, rest) = plain.split_at_checked(size_of::<Header>())?;
        let h: Header = bytemuck::pod_read_unaligned(head);
        let frame = Frame {
            origin: Vec3::from_array(h.origin),
            step: h.step,
            cells: UVec3::from_array(h.cells),
        };
        let solid = Aabb::new(Vec3::from_array(h.solid[0]), Vec3::from_array(h.solid[1]));
        let sound = frame.origin.is_finite()
            && frame.step.is_finite()
            && frame.step > 0.0
            && frame.cells.min_element() > 0
            && frame.cells.max_element() < 1 << 24
            && solid.min.is_finite()
            && solid.max.is_finite();
        if !sound {
            return None;
        }
        let b = frame.bricks();
        let bricks = u64::from(b.x)
            .checked_mul(u64::from(b.y))?
            .checked_mul(u64::from(b.z))?;
        let (near, values) = rest.split_at_checked(usize::try_from(bricks).ok()?)?;
        let mut table = Vec::with_capacity(near.len());
        let mut offset = 0usize;
        for &n in near {
            if n > 1 || offset > MOST_VALUES {
                return None;
            }
            table.push(offset as u32 | if n == 1 { NEAR } else { 0 });
            offset += if n == 1 { NEAR_LEN } else { FAR_LEN };
        }
        if offset != h.values as usize || values.len() != 4 * offset {
            return None;
        }
        let values: Vec<f32> = values
            .chunks_exact(4)
            .map(|v| f32::from_le_bytes([v[0], v[1], v[2], v[3]]))
            .collect();
        let mut ranges = Vec::with_capacity(table.len());
        let mut rest = &values[..];
        for &n in near {
            let (part, after) = rest.split_at(if n == 1 { NEAR_LEN } else { FAR_LEN });
            ranges.push(summary_of(part));
            rest = after;
        }
        Some(Self {
            frame,
            solid,
            table,
            groups: groups_of(b, &ranges),
            ranges,
            values,
        })
    }
}
