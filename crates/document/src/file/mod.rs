//! `*.midair`: a zip with `document.ron` and the meshes and pictures it names.

mod atomic;
mod open;
mod save;
#[cfg(test)]
mod tests;

use std::io;

use midair_mesh::MeshHash;

use crate::ImageHash;

pub use open::{OpenError, Opened, open};
pub use save::{SaveError, may_save, save};

const DOCUMENT: &str = "document.ron";

fn mesh_entry(hash: MeshHash) -> String {
    format!("meshes/{hash}.ply")
}

/// A picture lies there as it was brought in, under an ending that says what it is.
fn image_entry(hash: ImageHash, bytes: &[u8]) -> String {
    let ending = if bytes.starts_with(b"\xff\xd8") {
        "jpg"
    } else {
        "png"
    };
    format!("images/{hash}.{ending}")
}

/// What the system said, as part of a sentence: without its number, in one line.
pub(crate) fn reason(e: &io::Error) -> String {
    let text = match e.kind() {
        io::ErrorKind::StorageFull => "the disk is full".into(),
        io::ErrorKind::ReadOnlyFilesystem => "the disk is read-only".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        io::ErrorKind::NotFound => "there is no such file or folder".into(),
        _ => e.to_string(),
    };
    let text = match text.find(" (os error") {
        Some(at) => &text[..at],
        None => &text,
    };
    crate::check::one_line(text)
}
