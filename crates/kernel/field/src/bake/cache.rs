use std::io::Write;
use std::path::{Path, PathBuf};

use midair_mesh::{MeshHash, TriMesh};

use super::{BakeError, BakeOptions, Progress, Volume, bake, store};

/// Volumes kept in a folder, a file for each mesh, step and padding.
///
/// A file that is cut off, damaged or of another version is as good as none. A folder that cannot
/// be written to costs the keeping only, never the volume. Several programs may share one.
#[derive(Clone, Debug)]
pub struct BakeCache {
    folder: PathBuf,
}

/// What [`BakeCache::get_or_bake`] gives.
#[derive(Clone, Debug)]
pub struct Baked {
    /// The volume asked for.
    pub volume: Volume,
    /// Whether it was found in the folder.
    pub found: bool,
    /// One line saying why it could not be kept for the next time.
    pub warning: Option<String>,
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

    /// The volume of `mesh`, whose [`TriMesh::hash`] is `hash`: read where it was kept before,
    /// else baked and kept.
    ///
    /// # Errors
    /// As [`bake`]; never because of the folder.
    pub fn get_or_bake(
        &self,
        mesh: &TriMesh,
        hash: MeshHash,
        options: &BakeOptions,
        progress: &Progress,
    ) -> Result<Baked, BakeError> {
        let path = self.path(hash, options);
        let kept = std::fs::read(&path).ok();
        if let Some(volume) = kept.and_then(|bytes| Volume::from_bytes(&bytes)) {
            progress.set_fraction(1.0);
            return Ok(Baked {
                volume,
                found: true,
                warning: None,
            });
        }
        let volume = bake(mesh, options, progress)?;
        let warning = self.keep(&path, &volume).err().map(|e| {
            format!(
                "{}: the baked mesh could not be kept and will be baked again next time: {e}",
                path.display()
            )
        });
        Ok(Baked {
            volume,
            found: false,
            warning,
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
    fn keep(&self, path: &Path, volume: &Volume) -> std::io::Result<()> {
        std::fs::create_dir_all(&self.folder)?;
        let mut file = tempfile::NamedTempFile::new_in(&self.folder)?;
        file.write_all(&volume.to_bytes())?;
        file.persist(path).map_err(|e| e.error)?;
        Ok(())
    }
}
