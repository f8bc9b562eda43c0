//! Triangle meshes: one indexed type, checks, and formats in and out.
//!
//! Lengths are metres, coordinates right-handed with +Y up, triangles wind counter-clockwise seen
//! from outside.
//!
//! - [`read`] takes GLB, glTF, OBJ, STL and PLY files; positions come out welded, so that the
//!   connectivity is known.
//! - [`write()`] gives GLB, OBJ, STL, PLY and 3MF files, the same bytes every time.
//! - [`check`](check()) says whether a mesh is the boundary of a solid, and what is wrong where it is not.
//! - [`to_bytes`] and [`from_bytes`] keep a mesh bit for bit.
//!
//! What is *not* promised: materials, colours, texture coordinates, skins and animations are not
//! read, and a mesh is never repaired beyond dropping repeated and collapsed triangles.
//!
//! ```
//! use glam::Vec3;
//! use midair_mesh::{Named, TriMesh, WriteOptions, check, read, write};
//!
//! let tetrahedron = TriMesh {
//!     positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
//!     normals: vec![],
//!     triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
//! };
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("tetrahedron.stl");
//! write(&path, &[Named::new("tetrahedron", &tetrahedron)], &WriteOptions::default())?;
//! let back = read(&path)?.mesh;
//! assert!(check(&back).is_faultless());
//! assert!((back.volume() - 1.0 / 6.0).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bytes;
mod check;
mod crease;
mod finish;
mod format;
mod measure;
mod normals;
mod pieces;
mod read;
mod rescale;
mod transform;
mod tri_mesh;
mod unit;
mod up;
mod weld;
mod write;

pub use bytes::{BytesError, from_bytes, to_bytes};
pub use check::{Report, check};
pub use finish::Finish;
pub use format::Format;
pub use read::{Read, ReadError, ReadReason, read, read_as, read_bytes, read_bytes_as};
pub use tri_mesh::{Aabb, MeshHash, TriMesh};
pub use unit::{Unit, UnknownUnit};
pub use up::{UnknownUp, Up};
pub use write::{
    Curve, Named, WriteError, WriteOptions, WriteReason, encode, encode_drawing, writable, write,
    write_drawing,
};
