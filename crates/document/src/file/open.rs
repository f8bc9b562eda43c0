use std::fs::File;
use std::io::{self, BufReader, Read, Seek};
use std::path::{Path, PathBuf};

use midair_mesh::{MeshHash, TriMesh};
use zip::ZipArchive;
use zip::result::ZipError;

use super::{DOCUMENT, image_entry, mesh_entry, reason};
use crate::check::one_line;
use crate::stored::TextError;
use crate::{Document, ImageHash, MeshStore};

/// A document read from a file.
#[derive(Debug)]
pub struct Opened {
    /// The document; sound.
    pub document: Document,
    /// Its meshes.
    pub meshes: MeshStore,
    /// What is not as it should be and does not keep the document from opening, one line each.
    pub warnings: Vec<String>,
}

/// Why a file does not open. One line: the file, what is wrong with it, what can be done.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// The file cannot be read.
    #[error("{} cannot be read: {reason}. Check its name and whether you may read it", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// Not an archive at all.
    #[error("{} is no Midair document: {reason}. A mesh is brought in with `midair import`", path.display())]
    NotADocument {
        /// The file.
        path: PathBuf,
        /// What it is instead.
        reason: &'static str,
    },
    /// The file ends too early, or bytes in it were changed.
    #[error("{} is cut off or damaged: {reason}. Open an earlier copy or the newest autosave", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Where.
        reason: String,
    },
    /// Written by a version to come.
    #[error("{} was written by a newer Midair (format {found}; this one reads up to {}). Update Midair to open it", path.display(), crate::FORMAT)]
    Newer {
        /// The file.
        path: PathBuf,
        /// Its format.
        found: u32,
    },
    /// `document.ron` cannot be read.
    #[error("{}: {DOCUMENT}: {reason}. Correct it, or open an earlier copy or the newest autosave", path.display())]
    Unsound {
        /// The file.
        path: PathBuf,
        /// Where and what.
        reason: String,
    },
    /// It unpacks to more than any document needs.
    #[error("{} unpacks to more than {limit} MiB, far more than a document of its size needs. It is not opened; open an earlier copy", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// How much would be read, in MiB.
        limit: u64,
    },
}

const MIB: u64 = 1 << 20;

/// How large `document.ron` may be.
const TEXT_LIMIT: u64 = 256 * MIB;

/// How often its own size a file may unpack to, beyond [`FREE`]. Text of ours reaches 30.
const RATIO: u64 = 100;

/// What any file may unpack to.
const FREE: u64 = 16 * MIB;

/// Opens a document. Objects whose mesh or picture is missing or damaged are kept, with a warning.
///
/// # Errors
/// [`OpenError`].
pub fn open(path: &Path) -> Result<Opened, OpenError> {
    let unreadable = |e: &io::Error| OpenError::Unreadable {
        path: path.to_owned(),
        reason: reason(e),
    };
    let file = File::open(path).map_err(|e| unreadable(&e))?;
    let meta = file.metadata().map_err(|e| unreadable(&e))?;
    if meta.is_dir() {
        return Err(OpenError::NotADocument {
            path: path.to_owned(),
            reason: "it is a folder",
        });
    }
    read(path, BufReader::new(file), meta.len())
}

pub(super) fn read(path: &Path, mut from: impl Read + Seek, len: u64) -> Result<Opened, OpenError> {
    let damaged = |reason: &str| OpenError::Damaged {
        path: path.to_owned(),
        reason: one_line(reason),
    };
    let mut magic = Vec::new();
    let sniffed = from.by_ref().take(4).read_to_end(&mut magic);
    sniffed
        .and_then(|_| from.rewind())
        .map_err(|e| OpenError::Unreadable {
            path: path.to_owned(),
            reason: reason(&e),
        })?;
    match &magic[..] {
        b"PK\x03\x04" => {}
        [] => return Err(damaged("it is empty")),
        m if b"PK\x03\x04".starts_with(m) => return Err(damaged("it ends after its first bytes")),
        _ => {
            return Err(OpenError::NotADocument {
                path: path.to_owned(),
                reason: "it is not a zip archive",
            });
        }
    }
    let mut zip = ZipArchive::new(from).map_err(|_| damaged("its list of contents is missing"))?;
    let mut budget = FREE + len.saturating_mul(RATIO);
    let too_large = |limit: u64| OpenError::TooLarge {
        path: path.to_owned(),
        limit: limit / MIB,
    };
    let text_limit = budget.min(TEXT_LIMIT);
    let text = match entry(&mut zip, DOCUMENT, text_limit) {
        Ok(bytes) => bytes,
        Err(EntryError::Missing) => {
            return Err(OpenError::NotADocument {
                path: path.to_owned(),
                reason: "it is an archive without document.ron",
            });
        }
        Err(EntryError::TooLarge) => return Err(too_large(text_limit)),
        Err(EntryError::Damaged { reason, .. }) => {
            return Err(damaged(&format!("{DOCUMENT}: {reason}")));
        }
    };
    budget -= text.len() as u64;
    let unsound = |reason: String| OpenError::Unsound {
        path: path.to_owned(),
        reason,
    };
    let text = String::from_utf8(text).map_err(|_| unsound("it is not UTF-8 text".into()))?;
    let (document, unknown) = Document::from_ron(&text).map_err(|e| match e {
        TextError::Newer(found) => OpenError::Newer {
            path: path.to_owned(),
            found,
        },
        e => unsound(e.to_string()),
    })?;
    let mut warnings = Vec::new();
    if !unknown.is_empty() {
        warnings.push(format!(
            "{} holds what this version does not know and would not save again: {}",
            path.display(),
            unknown.join(", ")
        ));
    }
    let meshes = MeshStore::new();
    for hash in document.meshes() {
        match entry(&mut zip, &mesh_entry(hash), budget) {
            Ok(bytes) => {
                budget -= bytes.len() as u64;
                match decode(&bytes, hash) {
                    Ok(mesh) => drop(meshes.insert(mesh)),
                    Err(reason) => {
                        warnings.push(lost(path, hash, &reason));
                        meshes.keep_damaged(hash, bytes);
                    }
                }
            }
            Err(EntryError::Missing) => warnings.push(lost(path, hash, "it is missing")),
            Err(EntryError::TooLarge) => return Err(too_large(FREE + len.saturating_mul(RATIO))),
            Err(EntryError::Damaged { reason, so_far }) => {
                warnings.push(lost(path, hash, &reason));
                budget = budget.saturating_sub(so_far.len() as u64);
                meshes.keep_damaged(hash, so_far);
            }
        }
    }
    for hash in document.images() {
        match image(&mut zip, hash, budget) {
            Ok(bytes) => {
                budget -= bytes.len() as u64;
                // What is damaged is kept under another name, which no object has.
                if meshes.insert_image(bytes) != hash {
                    warnings.push(lost_image(
                        path,
                        hash,
                        "it is not the picture its name says",
                    ));
                }
            }
            Err(EntryError::Missing) => warnings.push(lost_image(path, hash, "it is missing")),
            Err(EntryError::TooLarge) => return Err(too_large(FREE + len.saturating_mul(RATIO))),
            Err(EntryError::Damaged { reason, .. }) => {
                warnings.push(lost_image(path, hash, &reason));
            }
        }
    }
    Ok(Opened {
        document,
        meshes,
        warnings,
    })
}

fn lost(path: &Path, hash: MeshHash, reason: &str) -> String {
    let hash = hash.to_string();
    format!(
        "{}: the mesh {}… cannot be used: {}; its objects are kept and not shown, an earlier copy may hold it",
        path.display(),
        &hash[..8],
        one_line(reason)
    )
}

/// A picture's file, whichever of the two kinds it is.
fn image(
    zip: &mut ZipArchive<impl Read + Seek>,
    hash: ImageHash,
    limit: u64,
) -> Result<Vec<u8>, EntryError> {
    let name = |start: &[u8]| image_entry(hash, start);
    match entry(zip, &name(b""), limit) {
        Err(EntryError::Missing) => entry(zip, &name(b"\xff\xd8"), limit),
        found => found,
    }
}

fn lost_image(path: &Path, hash: ImageHash, reason: &str) -> String {
    let hash = hash.to_string();
    format!(
        "{}: the picture {}… cannot be used: {}; its object is kept and stands empty, bring the picture in again",
        path.display(),
        &hash[..8],
        one_line(reason)
    )
}

fn decode(bytes: &[u8], hash: MeshHash) -> Result<TriMesh, String> {
    let mesh = midair_mesh::from_bytes(bytes).map_err(|e| e.to_string())?;
    if mesh.hash() == hash {
        Ok(mesh)
    } else {
        Err("it is not the mesh its name says".into())
    }
}

enum EntryError {
    Missing,
    TooLarge,
    Damaged { reason: String, so_far: Vec<u8> },
}

/// Reads one entry whole, and never more than `limit` bytes of it, whatever it claims.
fn entry(
    zip: &mut ZipArchive<impl Read + Seek>,
    name: &str,
    limit: u64,
) -> Result<Vec<u8>, EntryError> {
    let entry = zip.by_name(name).map_err(|e| match e {
        ZipError::FileNotFound => EntryError::Missing,
        e => EntryError::Damaged {
            reason: e.to_string(),
            so_far: Vec::new(),
        },
    })?;
    let mut bytes = Vec::new();
    if let Err(e) = entry.take(limit + 1).read_to_end(&mut bytes) {
        return Err(EntryError::Damaged {
            reason: reason(&e),
            so_far: bytes,
        });
    }
    if bytes.len() as u64 > limit {
        return Err(EntryError::TooLarge);
    }
    Ok(bytes)
}
