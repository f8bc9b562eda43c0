use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Writes a file beside the old one, forces it to disk and puts it in the old one's place: at any
/// moment either is whole. Follows a link, keeps the old file's permissions.
///
/// # Errors
/// What the system says; the old file is as it was, the new one gone.
pub(super) fn replace(
    path: &Path,
    write: impl FnOnce(&mut File) -> io::Result<()>,
) -> io::Result<()> {
    let (path, old, mut temporary) = begin(path)?;
    write(temporary.as_file_mut())?;
    if let Some(old) = old {
        // Not every disk knows permissions.
        let _ = temporary.as_file().set_permissions(old.permissions());
    }
    temporary.as_file().sync_all()?;
    temporary.persist(&path).map_err(|e| e.error)?;
    // The new name itself; not every system can do this to a folder.
    if let Some(folder) = path.parent()
        && let Ok(folder) = File::open(folder)
    {
        let _ = folder.sync_all();
    }
    Ok(())
}

/// Whether a file could be put there; leaves nothing behind.
///
/// # Errors
/// What the system says.
pub(super) fn check(path: &Path) -> io::Result<()> {
    begin(path).map(drop)
}

/// Where the file really lies, what it is now, and the one beside it that is to take its place.
fn begin(path: &Path) -> io::Result<(PathBuf, Option<fs::Metadata>, NamedTempFile)> {
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let old = fs::metadata(&path).ok();
    match &old {
        Some(m) if m.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
        // Renaming over it would work, and is not what its owner asked for.
        Some(m) if m.permissions().readonly() => {
            return Err(io::Error::other("the file is write-protected"));
        }
        _ => {}
    }
    let folder: PathBuf = match path.parent() {
        Some(p) if !p.as_os_str().is_empty() => p.into(),
        _ => ".".into(),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".midair-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let temporary = builder.tempfile_in(&folder)?;
    Ok((path, old, temporary))
}
