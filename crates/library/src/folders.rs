use std::path::{Path, PathBuf};

use etcetera::BaseStrategy;

/// Where the user's library and its caches lie.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folders {
    /// What the user made and would miss.
    data: PathBuf,
    /// What can be made again.
    cache: PathBuf,
    /// What the program keeps for itself between runs.
    state: PathBuf,
    /// Where a person looks for what was saved.
    work: PathBuf,
    /// What the user sets and may edit.
    config: PathBuf,
}

/// Neither `MIDAIR_HOME` nor a home folder is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "no home folder is known for the library; set HOME, or MIDAIR_HOME to a folder of your choice"
)]
pub struct NoHome;

impl Folders {
    /// The platform's folders (on Linux `$XDG_DATA_HOME/midair` and `$XDG_CACHE_HOME/midair`), or
    /// everything below `$MIDAIR_HOME` where that is set: for a portable installation and for tests.
    ///
    /// # Errors
    /// [`NoHome`] when the environment names neither.
    pub fn of_user() -> Result<Self, NoHome> {
        match std::env::var_os("MIDAIR_HOME") {
            Some(home) if !home.is_empty() => Ok(Self::below(Path::new(&home))),
            _ => {
                let base = etcetera::choose_base_strategy().map_err(|_| NoHome)?;
                Ok(Self {
                    data: base.data_dir().join("midair"),
                    cache: base.cache_dir().join("midair"),
                    state: base
                        .state_dir()
                        .unwrap_or_else(|| base.data_dir())
                        .join("midair"),
                    config: base.config_dir().join("midair"),
                    work: base.home_dir().join("Documents").join("Midair"),
                })
            }
        }
    }

    /// Everything below one folder, which need not exist yet.
    pub fn below(home: &Path) -> Self {
        Self {
            data: home.to_owned(),
            cache: home.join("cache"),
            state: home.join("state"),
            work: home.join("work"),
            config: home.join("config"),
        }
    }

    /// The user's components, `*.ron`, folders below included.
    pub fn components(&self) -> PathBuf {
        self.data.join("components")
    }

    /// The meshes those are made of, named by the hash of their content.
    pub fn meshes(&self) -> PathBuf {
        self.data.join("meshes")
    }

    /// Journals and autosaves.
    pub fn state(&self) -> PathBuf {
        self.state.clone()
    }

    /// What the user saves and exports without naming a place.
    pub fn work(&self) -> PathBuf {
        self.work.clone()
    }

    /// Settings and bindings.
    pub fn config(&self) -> PathBuf {
        self.config.clone()
    }

    /// Materials that the user has written in WGSL.
    pub fn materials(&self) -> PathBuf {
        self.data.join("materials")
    }

    /// Pictures of components; may be deleted at any time.
    pub fn thumbnails(&self) -> PathBuf {
        self.cache.join("thumbnails")
    }

    /// Baked distance grids; may be deleted at any time.
    pub fn bakes(&self) -> PathBuf {
        self.cache.join("bakes")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_folder_holds_everything() {
        let f = Folders::below(Path::new("home"));
        assert_eq!(f.components(), Path::new("home").join("components"));
        assert_eq!(f.meshes(), Path::new("home").join("meshes"));
        assert_eq!(f.bakes(), Path::new("home").join("cache").join("bakes"));
    }
}
