use std::io::{self, Cursor, Seek, Write};
use std::path::{Path, PathBuf};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::{DOCUMENT, atomic, image_entry, mesh_entry, reason};
use crate::{Document, MeshStore};

/// A document that was not saved. The file, where there was one, is as it was.
#[derive(Debug, thiserror::Error)]
#[error(
    "{} could not be saved: {reason}. What was there before is untouched; make room or choose another place",
    path.display()
)]
pub struct SaveError {
    /// The file.
    pub path: PathBuf,
    /// What the system said.
    pub reason: String,
}

/// Saves a document, and the meshes and pictures it uses. The same document gives the same bytes. The old file
/// stays in place until the new one is whole and on disk.
///
/// Returns a line for each object that lacks a mesh or its picture; it is saved all the same.
///
/// # Errors
/// [`SaveError`] where the disk is full, read-only, or the folder is not there.
pub fn save(
    path: &Path,
    document: &Document,
    meshes: &MeshStore,
) -> Result<Vec<String>, SaveError> {
    archive(document, meshes)
        .and_then(|bytes| atomic::replace(path, |file| file.write_all(&bytes)))
        .map_err(|e| SaveError {
            path: path.to_owned(),
            reason: reason(&e),
        })?;
    Ok(document.check_meshes(meshes))
}

/// Whether [`save`] could put a document at `path`, before anything is made for it. Leaves nothing behind.
///
/// # Errors
/// [`SaveError`], as [`save`] would; a disk may still be full then.
pub fn may_save(path: &Path) -> Result<(), SaveError> {
    atomic::check(path).map_err(|e| SaveError {
        path: path.to_owned(),
        reason: reason(&e),
    })
}

/// The archive: the document, pictures and meshes, each in the order of their names, all of one fixed time. It is put together in
/// memory, so that only whole ones ever reach the disk.
pub(super) fn archive(document: &Document, meshes: &MeshStore) -> io::Result<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let text = document.to_ron();
    entry(&mut zip, DOCUMENT, text.as_bytes(), 6)?;
    for hash in document.images() {
        // A picture is packed already.
        if let Some(bytes) = meshes.image(hash) {
            entry(&mut zip, &image_entry(hash, &bytes), &bytes, 1)?;
        }
    }
    for hash in document.meshes() {
        // Coordinates hardly compress: the fastest level is as good as any.
        if let Some(mesh) = meshes.get(hash) {
            entry(
                &mut zip,
                &mesh_entry(hash),
                &midair_mesh::to_bytes(&mesh),
                1,
            )?;
        } else if let Some(bytes) = meshes.damaged(hash) {
            entry(&mut zip, &mesh_entry(hash), &bytes, 1)?;
        }
    }
    Ok(zip.finish()?.into_inner())
}

fn entry<W: Write + Seek>(
    zip: &mut ZipWriter<W>,
    name: &str,
    bytes: &[u8],
    level: i64,
) -> io::Result<()> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(level))
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644)
        .large_file(bytes.len() as u64 >= u64::from(u32::MAX));
    zip.start_file(name, options)?;
    zip.write_all(bytes)
}
