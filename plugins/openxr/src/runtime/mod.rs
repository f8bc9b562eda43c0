//! From nothing to a runtime with a headset: the loader, the instance, the graphics card.

mod active;
mod connection;
mod fault;
mod loader;

pub use active::active_runtime;
pub use connection::{Card, Connection};
pub use fault::RuntimeFault;
