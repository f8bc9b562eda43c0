//! The shelf of components: bundled recipes, the user's own meshes, baking.
//!
//! - [`Library`] is everything that can be placed: the components built into the program, and the
//!   user's own from `midair/components` in the platform's data folder ([`Folders`]).
//! - [`import`] brings a mesh file into it, [`save`] a solid that was made.
//! - [`Volumes`] holds the distance grids of meshes, baked when they are first asked for.
//!
//! Nothing here knows a window or an engine. Loading never fails as a whole: what cannot be read
//! is a [`Warning`], and the rest is there.
//!
//! ```
//! use midair_library::{Folders, Library};
//!
//! let home = std::env::temp_dir().join("a-home-that-does-not-exist");
//! let library = Library::load(&Folders::below(&home));
//! let cube = library.get("solid/cube").expect("bundled");
//! assert_eq!(cube.name, "Cube");
//! assert_eq!(library.search("donut")[0].id, "solid/torus-thick");
//! assert!(library.warnings().is_empty());
//! ```

mod check;
mod component;
mod folders;
mod import;
mod keeper;
mod library;
mod listing;
mod read;
mod save;
mod search;
mod shelf;
mod volumes;

pub use component::{CATEGORIES, Component, OWN, Source};
pub use folders::{Folders, NoHome};
pub use import::{ImportError, import, import_all};
pub use library::Library;
pub use read::Warning;
pub use save::{SaveError, save};
pub use shelf::MeshShelf;
pub use volumes::{FindMesh, VolumeError, Volumes, Watched};
