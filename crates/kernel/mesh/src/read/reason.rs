use std::io;

use thiserror::Error;

use crate::Format;

/// A file that could not be read: one line with its name, the reason and a way out.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{file} {reason}")]
pub struct ReadError {
    /// The file's name without its folder.
    pub file: String,
    /// What is wrong with it.
    pub reason: ReadReason,
}

/// Why a file could not be read; follows the file's name in a sentence.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ReadReason {
    /// There is no such file.
    #[error("is not there. Check the name and the folder.")]
    Missing,
    /// It is a folder.
    #[error("is a folder. Pick a file inside it.")]
    Folder,
    /// The user may not read it.
    #[error("may not be read by you. Change its permissions, or copy it.")]
    Forbidden,
    /// The disk or the system refused.
    #[error("could not be read: {0}. Check the disk and try again.")]
    Io(String),
    /// It has no content.
    #[error("is empty. Export it again, or pick another file.")]
    Empty,
    /// Neither content nor extension tell what it is.
    #[error("is of no known type. Midair reads {}.", Format::READABLE)]
    UnknownFormat,
    /// It is not of the type its name says, nor of another that is known.
    #[error(
        "is not a {0} file, though its name says so, nor of another known type. Midair reads {known}.",
        known = Format::READABLE
    )]
    NotWhatItSays(Format),
    /// 3MF is written only.
    #[error(
        "is a 3MF file (or another archive), which Midair writes but does not read. Export it as {} instead.",
        Format::READABLE
    )]
    WriteOnly,
    /// It breaks off.
    #[error("is cut off: {0}. Copy or export it again.")]
    CutOff(String),
    /// It does not follow its format.
    #[error("is damaged: {0}. Export it again, or pick another file.")]
    Damaged(String),
    /// It uses a part of its format that is not read.
    #[error("uses {0}, which Midair does not read. Export it without.")]
    Unsupported(String),
    /// A file that it points to cannot be had.
    #[error("needs {0}. Keep the two together, or export it as GLB.")]
    Needs(String),
    /// It has no triangle.
    #[error("has no faces. Export it again with faces, or pick another file.")]
    NoFaces,
    /// Every triangle is collapsed.
    #[error("has only faces without area. Export it again, or pick another file.")]
    NoArea,
    /// A coordinate is NaN or infinite.
    #[error(
        "has a vertex that is not a number (vertex {vertex}). Clean it up in the program it comes from and export it again."
    )]
    NotFinite {
        /// Its place in the file, counted from 0.
        vertex: usize,
    },
    /// A face names a vertex that is not there.
    #[error(
        "is damaged: triangle {triangle} names vertex {vertex}, but there are only {vertices}. Export it again, or pick another file."
    )]
    IndexOutOfRange {
        /// The triangle, counted from 0.
        triangle: usize,
        /// The vertex it names, counted from 0.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// More than 50 million triangles.
    #[error("has more than 50 million triangles. Simplify it first.")]
    TooManyTriangles,
    /// More than 4 GiB.
    #[error("is larger than 4 GiB. Simplify it first.")]
    TooManyBytes,
    /// A coordinate is beyond the range of f32 in metres.
    #[error("is too large for its unit. Check the unit, or scale it down.")]
    TooLarge,
}

/// The reason behind an error of the file system.
pub(super) fn of_io(error: io::Error) -> ReadReason {
    match error.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => ReadReason::Missing,
        io::ErrorKind::PermissionDenied => ReadReason::Forbidden,
        kind => ReadReason::Io(kind.to_string()),
    }
}

/// The first line of what a parser says, without its full stop and not too long.
pub(super) fn line(what: impl ToString) -> String {
    let what = what.to_string();
    let first = what
        .lines()
        .next()
        .unwrap_or_default()
        .trim()
        .trim_end_matches(['.', ':']);
    first
        .chars()
        .filter(|c| !c.is_control())
        .take(160)
        .collect()
}
