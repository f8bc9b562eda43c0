mod errors;
mod reference;
mod shaders;
mod support;
