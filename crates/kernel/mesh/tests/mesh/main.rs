//! The whole of the crate, as its users call it.

mod bad_input;
mod checks;
mod formats;
mod real_meshes;
mod shapes;
mod solids;
