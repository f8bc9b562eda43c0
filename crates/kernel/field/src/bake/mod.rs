//! From a triangle mesh to a signed distance (EasyVRModeling §5.2).

#[cfg(target_arch = "x86_64")]
mod avx2;
mod band;
mod bars;
mod boundary;
mod cache;
mod eight;
mod frame;
mod lanes;
mod lids;
mod options;
mod points;
mod progress;
mod repair;
mod sample;
mod sign;
mod splat;
mod store;
mod tree;
mod triangle;
mod volume;
mod wave;
mod work;

pub use cache::BakeCache;
pub use options::{BakeError, BakeOptions, LONGEST_SIDE, PADDING, STEP};
pub use progress::Progress;
pub use volume::Volume;
pub use work::bake;

#[cfg(test)]
mod tests;
