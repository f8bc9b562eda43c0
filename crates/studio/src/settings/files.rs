use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

/// What is remembered of files.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FileSettings {
    /// The documents opened or saved last, the latest first.
    pub recent: Vec<PathBuf>,
    /// The ending of the mesh files that a hand's *save* writes: stl, 3mf, glb, obj, ply.
    pub save_mesh_as: String,
}

impl Default for FileSettings {
    fn default() -> Self {
        Self {
            recent: Vec::new(),
            save_mesh_as: "stl".to_owned(),
        }
    }
}

/// How many documents are remembered.
const RECENT: usize = 10;

impl FileSettings {
    /// A document was opened or saved.
    pub(crate) fn note(&mut self, path: &Path) {
        self.recent.retain(|p| p != path);
        self.recent.insert(0, path.to_owned());
        self.recent.truncate(RECENT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_comes_first_and_only_once() {
        let mut files = FileSettings::default();
        for i in 0..20 {
            files.note(Path::new(&format!("{}.midair", i % 12)));
        }
        assert_eq!(files.recent.len(), RECENT);
        assert_eq!(files.recent[0], Path::new("7.midair"));
        files.note(Path::new("5.midair"));
        assert_eq!(files.recent[0], Path::new("5.midair"));
        assert_eq!(files.recent.len(), RECENT);
    }
}
