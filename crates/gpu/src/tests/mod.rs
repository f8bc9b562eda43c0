mod canvases;
mod emit;
mod errors;
mod growth;
mod reference;
mod shaders;
mod support;
mod voxels;
