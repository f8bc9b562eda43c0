use std::io::{self, Write};
use std::path::Path;

use tempfile::NamedTempFile;

use super::WriteReason;

/// Puts `bytes` at `path`, whole or not at all. An existing file stays as it was until then.
pub(super) fn save(path: &Path, bytes: &[u8]) -> Result<(), WriteReason> {
    // Dropped on every error, and its file with it.
    let mut file = begin(path)?;
    file.write_all(bytes).map_err(of_io)?;
    // Some file systems only find out here that they are full.
    file.as_file().sync_all().map_err(of_io)?;
    file.persist(path).map_err(|error| of_io(error.error))?;
    Ok(())
}

/// The file beside `path` that is to take its place.
pub(super) fn begin(path: &Path) -> Result<NamedTempFile, WriteReason> {
    if path.is_dir() {
        return Err(WriteReason::Folder);
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".midair-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // What any new file gets; the umask takes its part away.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder).map_err(of_io)
}

fn of_io(error: io::Error) -> WriteReason {
    use io::ErrorKind as Kind;
    match error.kind() {
        Kind::NotFound | Kind::NotADirectory => WriteReason::NoFolder,
        Kind::IsADirectory => WriteReason::Folder,
        Kind::StorageFull | Kind::QuotaExceeded | Kind::FileTooLarge | Kind::WriteZero => {
            WriteReason::DiskFull
        }
        Kind::PermissionDenied | Kind::ReadOnlyFilesystem => WriteReason::ReadOnly,
        kind => WriteReason::Io(kind.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_obstacle_has_its_own_line() {
        for (kind, reason) in [
            (io::ErrorKind::StorageFull, WriteReason::DiskFull),
            (io::ErrorKind::ReadOnlyFilesystem, WriteReason::ReadOnly),
            (io::ErrorKind::PermissionDenied, WriteReason::ReadOnly),
            (io::ErrorKind::NotFound, WriteReason::NoFolder),
        ] {
            assert_eq!(of_io(kind.into()), reason);
            assert_eq!(reason.to_string().lines().count(), 1);
        }
    }
}
