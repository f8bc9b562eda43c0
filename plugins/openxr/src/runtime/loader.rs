//! Where the OpenXR loader is.

use super::RuntimeFault;

/// Names to open the loader by. The unversioned one comes with the developers' package alone, which players do not
/// have: the openxr crate asks for no other, so this is done here.
#[cfg(all(unix, not(target_os = "macos")))]
const NAMES: &[&str] = &["libopenxr_loader.so.1", "libopenxr_loader.so"];
#[cfg(target_os = "macos")]
const NAMES: &[&str] = &["libopenxr_loader.dylib"];

/// Names a loader that is somewhere else.
#[cfg(not(windows))]
const ELSEWHERE: &str = "MIDAIR_OPENXR_LOADER";

/// Opens the loader.
///
/// # Errors
///
/// It is not installed, or what is there is none.
#[cfg(not(windows))]
pub(super) fn open() -> Result<openxr::Entry, RuntimeFault> {
    use std::path::{Path, PathBuf};
    let beside = std::env::current_exe()
        .ok()
        .and_then(|exe| exe.parent().map(Path::to_owned));
    let own = std::env::var_os(ELSEWHERE)
        .filter(|v| !v.is_empty())
        .map(PathBuf::from);
    let names = NAMES.iter().map(PathBuf::from);
    let near = NAMES
        .iter()
        .filter_map(|name| beside.as_ref().map(|folder| folder.join(name)));
    let mut reason = String::new();
    for path in own.into_iter().chain(names).chain(near) {
        // SAFETY: a library of this name is an OpenXR loader; a person who names another one answers for it.
        match unsafe { openxr::Entry::load_from(&path) } {
            Ok(entry) => return Ok(entry),
            Err(error) if reason.is_empty() => reason = error.to_string(),
            Err(_) => {}
        }
    }
    Err(RuntimeFault::NoLoader { reason })
}

/// Opens the loader, which is built in on Windows.
#[cfg(windows)]
pub(super) fn open() -> Result<openxr::Entry, RuntimeFault> {
    Ok(openxr::Entry::linked())
}
