//! What each controller's buttons do: tables by the names of OpenXR's interaction profiles.

mod control;
mod file;
mod place;
mod profile;
mod table;

pub(crate) use table::{profiles, read as read_own};

pub use control::{Control, Kind};
pub use place::{Arm, Part, Place, Source, Who};
pub use profile::{PROFILES, Profile};
pub use table::{Arms, Bindings};
