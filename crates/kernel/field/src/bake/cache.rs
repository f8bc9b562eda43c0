use std::io::Write;
use std::path::{Path, PathBuf};

use midair_mesh::MeshHash;

use super::{BakeOptions, Volume, store};

/// Volumes kept in a folder, a file for each mesh, step and padding.
///
/// A file that is cut off, damaged or of another version is as good as none. A folder that cannot
/// be written to costs the keeping only, never the volume. Several programs may share one.
#[derive(Clone, Debug)]
pub struct BakeCache {
    folder: PathBuf,
}

impl BakeCache {
    /// A cache in `folder`, which is made when first needed.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: folder.into(),
        }
    }

    /// The folder it keeps its files in.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The volume of the mesh of that name, where it was kept before.
    pub fn find(&self, mesh: MeshHash, options: &BakeOptions) -> Option<Volume> {
        let bytes = std::fs::read(self.path(mesh, options)).ok()?;
        Volume::from_bytes(&bytes)
    }

    /// Keeps the volume of the mesh of that name for the next time.
    ///
    /// # Errors
    /// One line that says why it could not be kept.
    pub fn keep(
        &self,
        mesh: MeshHash,
        options: &BakeOptions,
        volume: &Volume,
    ) -> Result<(), String> {
        let path = self.path(mesh, options);
        self.write(&path, volume).map_err(|e| {
            format!(
                "{}: the baked mesh could not be kept and will be baked again next time: {e}",
                path.display()
            )
        })
    }

    fn path(&self, hash: MeshHash, options: &BakeOptions) -> PathBuf {
        let (step, padding) = (options.step.to_bits(), options.padding.to_bits());
        self.folder.join(format!(
            "{hash}-{step:08x}-{padding:08x}-v{}.volume",
            store::VERSION
        ))
    }

    /// Written beside its place and then renamed, so that no reader sees half a file.
    fn write(&self, path: &Path, volume: &Volume) -> std::io::Result<()> {
        std::fs::create_dir_all(&self.folder)?;
        let mut file = tempfile::NamedTempFile::new_in(&self.folder)?;
        file.write_all(&volume.to_bytes())?;
        file.persist(path).map_err(|e| e.error)?;
        Ok(())
    }
}
