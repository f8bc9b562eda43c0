//! Which runtime is the active one: a person who has two wants to know.

use std::path::PathBuf;

/// The manifest of the active runtime, where the platform says so in a file.
///
/// The loader asks in this order: `XR_RUNTIME_JSON`, the user's `openxr/1/active_runtime.json`, the system's. On Windows
/// it is in the registry, which is not read here.
pub fn active_runtime() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("XR_RUNTIME_JSON").filter(|v| !v.is_empty()) {
        return Some(PathBuf::from(named));
    }
    if cfg!(windows) {
        return None;
    }
    let set = |name: &str| {
        std::env::var_os(name)
            .filter(|v| !v.is_empty())
            .map(PathBuf::from)
    };
    let own = set("XDG_CONFIG_HOME").or_else(|| set("HOME").map(|h| h.join(".config")));
    let systems = ["/etc/xdg", "/usr/local/etc", "/etc", "/usr/share"].map(PathBuf::from);
    own.into_iter()
        .chain(systems)
        .map(|folder| folder.join("openxr/1/active_runtime.json"))
        .find(|file| file.exists())
}
