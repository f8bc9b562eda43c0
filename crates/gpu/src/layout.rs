//! Structs and numbers that `shaders/common.wgsl` has as well; a test holds them together.

use bytemuck::{Pod, Zeroable};

/// `Globals`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct Globals {
    pub step: f32,
    pub slack: f32,
    pub around: f32,
    pub eps: f32,
    pub low: [i32; 3],
    pub shapes: u32,
    pub high: [i32; 3],
    pub top: u32,
    pub mesh_low: [i32; 3],
    pub update: u32,
    pub mesh_high: [i32; 3],
    pub slots: u32,
    pub hash_mask: u32,
    pub info_base: u32,
    pub table_base: u32,
    pub chunks: u32,
    pub tables: u32,
    pub blocks: u32,
    pub tape: u32,
    pub vertices: u32,
    pub triangles: u32,
    pub spare: [u32; 3],
}

/// `Stage`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct Stage {
    pub level: u32,
    pub split: u32,
    pub from_block: u32,
    pub to_block: u32,
    pub count_in: u32,
    pub count_out: u32,
    pub group: u32,
    pub most: u32,
    pub target_args: u32,
    pub spare: [u32; 3],
}

/// `Block`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct Block {
    pub at: [i32; 3],
    pub off: u32,
    pub len: u32,
    pub table: u32,
}

/// Words of a leaf in `program`.
pub(crate) const LEAF: usize = 32;
/// Words of a painting's stroke.
pub(crate) const STROKE: usize = 40;
/// The instruction that names a chunk of the painting that was loaded last.
pub(crate) const INK: u32 = 5;
/// Words of a brick's record.
pub(crate) const STRIDE: usize = 104;
pub(crate) const ALIVE: usize = 8;
pub(crate) const TABLE: usize = 9;
/// Paintings within a painting, one in the other, at most.
pub(crate) const NESTED: usize = 3;
/// Values on the stack of the tape of a painting's solid at most, less one for safety.
pub(crate) const INNER: usize = 17;
/// Values on the stack of a tape at most, less one for safety.
pub(crate) const DEEPEST: usize = 33;
/// No table, no slot.
pub(crate) const NONE: u32 = u32::MAX;
/// A brick that is inside as a whole; entries beyond it are slots.
pub(crate) const INSIDE: u32 = 1;
pub(crate) const NEAR: u32 = 2;
/// Groups along x of a dispatch; more go along y.
pub(crate) const ROW: u32 = 32768;

/// Numbers of counters.
pub(crate) mod counter {
    pub const SLOTS: usize = 0;
    pub const FREE: usize = 1;
    pub const CHUNKS: usize = 2;
    pub const TABLES: usize = 3;
    pub const TAPE: usize = 4;
    pub const WORK: usize = 5;
    pub const VERTICES: usize = 6;
    pub const TRIANGLES: usize = 7;
    pub const OVERFLOW: usize = 8;
    pub const ALL_VERTICES: usize = 9;
    pub const ALL_TRIANGLES: usize = 10;
    /// Lists of blocks, one for each level.
    pub const LEVELS: usize = 16;
    pub const VERTEX_HEADS: usize = 48;
    /// How many there are.
    pub const COUNT: usize = 64;
}

/// Bits of `counter::OVERFLOW`.
pub(crate) mod overflow {
    pub const SLOTS: u32 = 1;
    pub const CHUNKS: u32 = 2;
    pub const BLOCKS: u32 = 4;
    pub const TAPE: u32 = 8;
    pub const VERTICES: u32 = 16;
    pub const TRIANGLES: u32 = 32;
}

/// The triangles of the 256 cases, four bits to an edge: two words of edges, then how many triangles.
pub(crate) fn case_rows() -> Vec<[u32; 4]> {
    let row = |triangles: &Vec<[u8; 3]>| {
        let mut row = [0u32; 4];
        for (k, &edge) in triangles.as_flattened().iter().enumerate() {
            row[k / 8] |= u32::from(edge) << (4 * (k % 8));
        }
        row[2] = triangles.len() as u32;
        row
    };
    midair_surface::cases().iter().map(row).collect()
}
