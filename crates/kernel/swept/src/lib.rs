//! One curve between two hands, dragged through space (Hermite motion controller, §3.2).
//!
//! - [`Rib`]: the curve at one moment, as the hands held it.
//! - [`Sweep`]: ribs in the order they were swept, a sheet or a tube; with thickness or caps a solid.
//! - [`Row`]: where clones stand along a rib, or over all of them.
//! - [`Net`]: a sweep as lines, as it is shown while it is made.
//! - [`smoothed`], [`bent`], [`cut`]: what can be done with ribs afterwards.
//!
//! Lengths are metres. A solid's mesh is closed, manifold and consistently wound whatever the ribs
//! do; where the surface runs through itself, [`touches`] finds it.
//!
//! What is *not* promised: that a mesh which runs through itself is the boundary of anything. A field
//! baked from it is, since it goes by the winding number.
//!
//! ```
//! use glam::{DQuat, DVec3};
//! use midair_curve::{End, Lengths};
//! use midair_swept::{Profile, Rib, Sweep};
//!
//! let rib = |z: f64| {
//!     let at = |x: f64| End { position: DVec3::new(x, 0.0, z), rotation: DQuat::IDENTITY };
//!     let mut lengths = Lengths::default();
//!     lengths.settle(&at(-0.1), &at(0.1));
//!     Rib::held(&at(-0.1), &at(0.1), lengths, [1.0; 2], 0.0)
//! };
//! let plate = Sweep {
//!     ribs: (0..=20).map(|i| rib(f64::from(i) * 0.01)).collect(),
//!     count: 48,
//!     profile: Profile::Sheet,
//!     thickness: 0.01,
//!     caps: false,
//! };
//! let solid = plate.solid()?;
//! assert!((solid.mesh.volume() - 0.2 * 0.2 * 0.01).abs() < 1e-6);
//! assert!(midair_mesh::check(&solid.mesh).is_faultless());
//! # Ok::<(), midair_swept::SweepError>(())
//! ```

mod edit;
mod lattice;
mod net;
mod rib;
mod row;
mod solid;
mod sweep;

pub use edit::{bent, cut, moved, smoothed};
pub use net::Net;
pub use rib::Rib;
pub use row::{MAX_CLONES, Place, Row};
pub use solid::{Solid, touches};
pub use sweep::{MAX_COUNT, MAX_RIBS, Profile, Surface, Sweep, SweepError};

#[cfg(test)]
mod tests;
