//! Files read and written off the frame.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};

use bevy::prelude::*;
use midair_document::{Edit, ImageHash, Journal, MeshSpool, Object, ObjectId, Opened, open, save};
use midair_field::Recipe;
use midair_library::{Folders, Volumes};
use midair_mesh::{MeshHash, TriMesh};
use midair_solid::{ExportOptions, export};

use crate::StudioSet;
use crate::notice::Notices;
use crate::project::{Places, Project};
use crate::reference;

mod batch;
mod take_in;

use batch::Batch;
pub(crate) use batch::Import;

/// What is to be fetched or brought.
#[derive(Clone, Debug)]
pub(crate) enum Errand {
    New,
    Open(PathBuf),
    Save(PathBuf),
    Export {
        path: PathBuf,
        options: ExportOptions,
    },
    /// Read a picture to work from.
    Reference {
        path: PathBuf,
        at: Option<Vec3>,
    },
    /// Keep a solid in the user's library.
    Keep {
        folders: Folders,
        name: String,
        recipe: Recipe,
    },
    /// Fetch the meshes of a library component before it is placed.
    Place(Box<Object>),
    Restore,
    Dismiss,
}

/// What came of it.
enum Outcome {
    Opened(PathBuf, Box<Opened>),
    Saved(PathBuf, Vec<String>),
    Exported(PathBuf, usize),
    Kept(String),
    Fetched(Box<Object>, Vec<Arc<TriMesh>>),
    Pictured(Box<Object>, Vec<u8>),
    Failed(String),
    Cancelled,
}

struct Running {
    id: u64,
    what: String,
    cancelled: Arc<AtomicBool>,
    finished: Arc<AtomicBool>,
    outcome: Mutex<Receiver<Outcome>>,
    /// What was saved, so that edits made meanwhile stay unsaved.
    revision: u64,
}

/// The errands on their way.
#[derive(Resource, Default)]
pub struct Errands {
    running: Vec<Running>,
    /// Done at once in the next exclusive step: they replace the work at hand.
    now: Vec<Errand>,
    imports: Batch,
    volumes: Option<Arc<Volumes>>,
    /// The number of the latest; the batch of imports is number 0.
    latest: u64,
}

/// One thing under way, as a panel shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its number, to cancel it by.
    pub id: u64,
    /// What is being done.
    pub what: String,
    /// How far it is, from 0 to 1, where that is known.
    pub fraction: Option<f32>,
}

impl Errands {
    /// How many are not finished.
    pub fn outstanding(&self) -> usize {
        let done = |r: &&Running| r.finished.load(Ordering::Acquire);
        self.running.len() - self.running.iter().filter(done).count() + self.imports.outstanding()
    }

    /// How many are under way or waiting to be taken in.
    pub fn len(&self) -> usize {
        self.running.len() + self.now.len() + self.imports.len()
    }

    /// Whether nothing is under way.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What is being done.
    pub fn rows(&self) -> Vec<Row> {
        let imports = self.imports.progress().map(|(what, fraction)| Row {
            id: 0,
            what,
            fraction: Some(fraction),
        });
        let others = self.running.iter().map(|r| Row {
            id: r.id,
            what: r.what.clone(),
            fraction: None,
        });
        imports.into_iter().chain(others).collect()
    }

    /// Gives all of them up, or one; files stay as they were.
    pub fn cancel(&mut self, only: Option<u64>) {
        for running in &self.running {
            if only.is_none_or(|id| id == running.id) {
                running.cancelled.store(true, Ordering::Relaxed);
            }
        }
        if only.is_none_or(|id| id == 0) {
            self.imports.cancel();
        }
    }

    /// Brings meshes into the library, and those with a place into the scene.
    pub(crate) fn import(&mut self, imports: impl IntoIterator<Item = Import>, places: &Places) {
        self.imports.add(imports, &places.library);
    }

    /// Puts an object into the document. A mesh that the document does not hold yet is read, and
    /// handed to the journal, off the frame first: from then on it travels with the document.
    pub(crate) fn place(&mut self, object: Object, project: &mut Project, notices: &mut Notices) {
        let held = |hash: &MeshHash| project.meshes().contains(*hash);
        let whole = object.recipe().is_none_or(|r| r.meshes().iter().all(held));
        if whole {
            add(object, project, notices);
        } else {
            self.start(Errand::Place(Box::new(object)), project);
        }
    }

    pub(crate) fn start(&mut self, errand: Errand, project: &Project) {
        let volumes = self.volumes.clone();
        let (document, store) = (project.document().clone(), project.meshes().clone());
        let cancelled = Arc::new(AtomicBool::new(false));
        let (what, work): (String, Box<dyn FnOnce() -> Outcome + Send>) = match errand {
            Errand::New | Errand::Restore | Errand::Dismiss => {
                self.now.push(errand);
                return;
            }
            Errand::Open(path) => (
                format!("Opening {}", name(&path)),
                Box::new(move || match open(&path) {
                    Ok(opened) => Outcome::Opened(path, Box::new(opened)),
                    Err(error) => Outcome::Failed(error.to_string()),
                }),
            ),
            Errand::Save(path) => (
                format!("Saving {}", name(&path)),
                Box::new(move || {
                    make_folder(&path);
                    match save(&path, &document, &store) {
                        Ok(warnings) => Outcome::Saved(path, warnings),
                        Err(error) => Outcome::Failed(error.to_string()),
                    }
                }),
            ),
            Errand::Export { path, options } => {
                let cancelled = cancelled.clone();
                (
                    format!("Exporting {}", name(&path)),
                    Box::new(move || {
                        let Some(volumes) = volumes else {
                            return Outcome::Cancelled;
                        };
                        make_folder(&path);
                        match export(&path, &document, &store, &*volumes, &options, &cancelled) {
                            Ok(triangles) => Outcome::Exported(path, triangles),
                            Err(_) if cancelled.load(Ordering::Relaxed) => Outcome::Cancelled,
                            Err(error) => Outcome::Failed(error.to_string()),
                        }
                    }),
                )
            }
            Errand::Reference { path, at } => {
                let spool = project.history().journal().map(Journal::spool);
                (
                    format!("Reading {}", name(&path)),
                    Box::new(move || picture(&path, at, spool)),
                )
            }
            Errand::Keep {
                folders,
                name,
                recipe,
            } => (
                format!("Keeping {name}"),
                Box::new(move || {
                    let mesh = |hash: &MeshHash| {
                        let held = store.get(*hash);
                        held.or_else(|| volumes.as_ref().and_then(|v| v.mesh(hash)))
                    };
                    match midair_library::save(&folders, &name, &recipe, &mesh) {
                        Ok(component) => Outcome::Kept(component.name),
                        Err(error) => Outcome::Failed(format!("{name} was not kept: {error}.")),
                    }
                }),
            ),
            Errand::Place(object) => {
                let spool = project.history().journal().map(Journal::spool);
                (
                    format!("Placing {}", object.name),
                    Box::new(move || fetch(object, volumes, spool)),
                )
            }
        };
        let (done, outcome) = channel();
        let finished = Arc::new(AtomicBool::new(false));
        let flag = finished.clone();
        let spawned = std::thread::Builder::new()
            .name("errand".into())
            .spawn(move || {
                // Nobody waits any more when the program ends.
                let _ = done.send(work());
                flag.store(true, Ordering::Release);
            });
        if spawned.is_ok() {
            self.latest += 1;
            self.running.push(Running {
                id: self.latest,
                what,
                cancelled,
                finished,
                outcome: Mutex::new(outcome),
                revision: project.history().revision(),
            });
        }
    }
}

/// Makes the folder a file is to lie in. Writing the file says what is wrong with it, if something is.
fn make_folder(file: &std::path::Path) {
    if let Some(folder) = file.parent().filter(|f| !f.as_os_str().is_empty()) {
        let _ = std::fs::create_dir_all(folder);
    }
}

/// Reads what an object is made of from the library.
fn fetch(object: Box<Object>, volumes: Option<Arc<Volumes>>, spool: Option<MeshSpool>) -> Outcome {
    let mut meshes = Vec::new();
    for hash in object.recipe().map(Recipe::meshes).unwrap_or_default() {
        let Some(mesh) = volumes.as_ref().and_then(|v| v.mesh(&hash)) else {
            return Outcome::Failed(format!(
                "The mesh of {} is gone from the library. Import it again.",
                object.name
            ));
        };
        if let Some(spool) = &spool {
            // A disk that is full is the journal's to report, at the commit.
            let _ = spool.write(&mesh);
        }
        meshes.push(mesh);
    }
    Outcome::Fetched(object, meshes)
}

/// Reads a picture to work from.
fn picture(path: &std::path::Path, at: Option<Vec3>, spool: Option<MeshSpool>) -> Outcome {
    let picture = match reference::read(path) {
        Ok(picture) => picture,
        Err(line) => return Outcome::Failed(line),
    };
    let image = ImageHash::of(&picture.bytes);
    if let Some(spool) = &spool {
        // A disk that is full is the journal's to report, at the commit.
        let _ = spool.write_image(image, &picture.bytes);
    }
    let called = path.file_stem().map_or_else(
        || "Picture".to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    );
    let object = reference::object(called, image, picture.size, at);
    Outcome::Pictured(Box::new(object), picture.bytes)
}

fn add(object: Object, project: &mut Project, notices: &mut Notices) {
    let id = ObjectId(project.document().next_id());
    let name = format!("Place {}", object.name);
    let object = object.into();
    project.commit_live(name, [Edit::Add { id, object }], notices);
}

fn name(path: &std::path::Path) -> String {
    path.file_name().map_or_else(
        || path.display().to_string(),
        |n| n.to_string_lossy().into_owned(),
    )
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Errands>()
        // Before commands start new errands, so that none starts and ends in one frame.
        .add_systems(Update, take_in::finish.in_set(StudioSet::Gather));
}
