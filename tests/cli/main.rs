//! The command line as a script meets it: exit status, one line for what cannot be done, nothing
//! lost.

mod archive;
mod commands;
mod documents;
mod meshes;
mod place;
mod real;
mod sessions;
mod steamvr;
