use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use bevy::prelude::*;
use bevy_rapier3d::rapier::prelude::{SharedShape, TriMesh as Trimesh, TriMeshFlags};
use midair_field::Placement;
use midair_field::Recipe;
use midair_field::bake::Progress;
use midair_library::Volumes;
use midair_mesh::TriMesh;
use midair_solid::{Solid, SolidError};

use super::{Key, Update};
use crate::show::to_bevy_mesh;

/// A solid, made.
pub struct Made {
    /// The whole surface, closed and welded, in the recipe's own frame.
    pub mesh: Arc<TriMesh>,
    /// The same, ready to be drawn; taken by the first that draws it.
    pub(crate) drawn: std::sync::Mutex<Option<Mesh>>,
    /// The same, ready to be picked; `None` where the solid is empty.
    pub shape: Option<SharedShape>,
    /// Milliseconds to fuse and to extract.
    pub fuse_ms: f64,
    /// Milliseconds to extract.
    pub extract_ms: f64,
    /// Enclosed volume in cubic metres.
    pub volume: f64,
    /// What was noticed on the way, a line each.
    pub warnings: Vec<String>,
    /// Bytes held, about.
    pub bytes: usize,
}

impl Made {
    /// As the report counts it.
    pub fn update(&self) -> Update {
        Update {
            fuse_ms: self.fuse_ms,
            extract_ms: self.extract_ms,
            triangles: self.mesh.triangles.len(),
        }
    }

    /// From a mesh that needs no evaluation.
    pub fn from_mesh(mesh: Arc<TriMesh>) -> Self {
        let shape = shape(&mesh);
        let drawn = to_bevy_mesh(&mesh);
        // Positions, normals and indices, held as a mesh, a drawing and a collider with its tree.
        let bytes = mesh.positions.len() * 24 * 3 + mesh.triangles.len() * (12 * 3 + 64);
        Self {
            volume: mesh.volume(),
            drawn: std::sync::Mutex::new(Some(drawn)),
            shape,
            fuse_ms: 0.0,
            extract_ms: 0.0,
            warnings: Vec::new(),
            bytes,
            mesh,
        }
    }
}

type Outcome = Result<Arc<Made>, String>;

/// One evaluation on its way.
pub(super) struct Running {
    pub key: Key,
    /// The last frame in which somebody asked for it.
    pub wanted: u64,
    pub progress: Progress,
    pub cancelled: Arc<AtomicBool>,
    outcome: Arc<OnceLock<Option<Outcome>>>,
}

impl Running {
    pub fn new(key: Key, frame: u64) -> Self {
        Self {
            key,
            wanted: frame,
            progress: Progress::new(),
            cancelled: Arc::default(),
            outcome: Arc::default(),
        }
    }

    pub fn is_finished(&self) -> bool {
        self.outcome.get().is_some()
    }

    /// The outcome; `None` where it was cancelled.
    pub fn take(self) -> Option<Outcome> {
        self.outcome.get()?.clone()
    }

    /// What another thread is to do.
    pub fn work(&self, recipe: Recipe, volumes: Arc<Volumes>) -> impl FnOnce() + Send + 'static {
        let step = self.key.step();
        let progress = self.progress.clone();
        let (cancelled, outcome) = (self.cancelled.clone(), self.outcome.clone());
        move || {
            // A mesh that is baked on the way shows its progress and stops when asked to.
            let meshes = volumes.watched(&progress);
            let make = || Solid::make(&recipe, &Placement::IDENTITY, step, &meshes, &cancelled);
            // Whoever waits for this is told, whatever happens in here.
            let made = match catch_unwind(AssertUnwindSafe(make)) {
                Ok(Ok(solid)) => {
                    let mut made = Made::from_mesh(Arc::new(solid.mesh()));
                    made.fuse_ms = solid.fuse.as_secs_f64() * 1e3;
                    made.extract_ms = solid.extract.as_secs_f64() * 1e3;
                    Some(Ok(Arc::new(made)))
                }
                Ok(Err(SolidError::Cancelled)) => None,
                Ok(Err(_)) if progress.is_cancelled() => None,
                Ok(Err(error)) => Some(Err(error.to_string())),
                Err(_) => Some(Err(
                    "A solid could not be made. Undo the last step, or choose another grid step."
                        .to_owned(),
                )),
            };
            // Set once, here only.
            let _ = outcome.set(made);
        }
    }
}

fn shape(mesh: &TriMesh) -> Option<SharedShape> {
    if mesh.triangles.is_empty() {
        return None;
    }
    // Oriented, so that a hand inside the solid touches it.
    let trimesh = Trimesh::with_flags(
        mesh.positions.clone(),
        mesh.triangles.clone(),
        TriMeshFlags::ORIENTED,
    );
    trimesh.ok().map(SharedShape::new)
}
