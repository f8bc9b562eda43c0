//! From a sparse field to a closed, manifold triangle mesh, by marching cubes.
//!
//! - `table`: the 256 cases, made by one rule for ambiguous faces.
//! - `signs`: which nodes lie inside, eight cells to a byte.
//! - `mask`: sets of bricks, 64 to a word.
//! - `region`: the bricks an extraction reads, found by block.
//! - `piece`: the vertices and triangles that one brick owns.
//! - `surface`: pieces kept and updated.
//! - `weld`: pieces put together, as a whole or by chunk.
//! - `crisp`: sharp edges, put back.
//! - `dense`: fields from functions.

mod crisp;
mod dense;
mod mask;
mod piece;
mod region;
mod signs;
mod surface;
mod table;
mod weld;

pub use crisp::{crisp, crisp_unless};
pub use dense::grid_from_fn;
pub use surface::{Cancelled, Chunk, ChunkKey, Surface};
pub use table::{MOST_TRIANGLES, cases};
