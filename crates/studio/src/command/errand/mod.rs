//! Files read and written off the frame.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex};

use bevy::prelude::*;
use midair_document::{
    Document, Edit, History, Journal, MeshSpool, MeshStore, Object, ObjectId, Opened, open, save,
};
use midair_field::Recipe;
use midair_field::bake::Progress;
use midair_library::{Component, Volumes};
use midair_mesh::{MeshHash, TriMesh, Unit};
use midair_solid::{ExportOptions, export};

use crate::StudioSet;
use crate::evaluate::Evaluations;
use crate::notice::Notices;
use crate::project::{Begin, Places, Project, Recoverables, Shelf, attach, install};
use crate::settings::Settings;

/// What is to be fetched or brought.
#[derive(Clone, Debug)]
pub(crate) enum Errand {
    New,
    Open(PathBuf),
    Save(PathBuf),
    Export {
        path: PathBuf,
        step: Option<f32>,
        unit: Option<Unit>,
        only: Option<ObjectId>,
    },
    Import(PathBuf),
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
    Imported(Box<Component>),
    Fetched(Box<Object>, Vec<Arc<TriMesh>>),
    Failed(String),
    Cancelled,
}

struct Running {
    what: String,
    progress: Progress,
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
    volumes: Option<Arc<Volumes>>,
}

impl Errands {
    /// How many are not finished.
    pub fn outstanding(&self) -> usize {
        let done = |r: &&Running| r.finished.load(Ordering::Acquire);
        self.running.len() - self.running.iter().filter(done).count()
    }

    /// How many are under way or waiting to be taken in.
    pub fn len(&self) -> usize {
        self.running.len() + self.now.len()
    }

    /// Whether nothing is under way.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What is being done, with its progress from 0 to 1 where that is known.
    pub fn progress(&self) -> impl Iterator<Item = (&str, f32)> {
        self.running
            .iter()
            .map(|r| (r.what.as_str(), r.progress.fraction()))
    }

    /// Gives all of them up; files stay as they were.
    pub fn cancel(&mut self) {
        for running in &self.running {
            running.progress.cancel();
            running.cancelled.store(true, Ordering::Relaxed);
        }
    }

    /// Puts an object into the document. A mesh that the document does not hold yet is read, and
    /// handed to the journal, off the frame first: from then on it travels with the document.
    pub(crate) fn place(
        &mut self,
        object: Object,
        project: &mut Project,
        places: &Places,
        notices: &mut Notices,
    ) {
        let held = |hash: &MeshHash| project.meshes().contains(*hash);
        let whole = object.recipe().is_none_or(|r| r.meshes().iter().all(held));
        if whole {
            add(object, project, notices);
        } else {
            self.start(Errand::Place(Box::new(object)), project, places);
        }
    }

    pub(crate) fn start(&mut self, errand: Errand, project: &Project, places: &Places) {
        let volumes = self.volumes.clone();
        let (document, store) = (project.document().clone(), project.meshes().clone());
        let progress = Progress::new();
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
            Errand::Export {
                path,
                step,
                unit,
                only,
            } => {
                let cancelled = cancelled.clone();
                (
                    format!("Exporting {}", name(&path)),
                    Box::new(move || {
                        let Some(volumes) = volumes else {
                            return Outcome::Cancelled;
                        };
                        make_folder(&path);
                        let options = ExportOptions { step, unit, only };
                        match export(&path, &document, &store, &*volumes, &options, &cancelled) {
                            Ok(triangles) => Outcome::Exported(path, triangles),
                            Err(_) if cancelled.load(Ordering::Relaxed) => Outcome::Cancelled,
                            Err(error) => Outcome::Failed(error.to_string()),
                        }
                    }),
                )
            }
            Errand::Place(object) => {
                let spool = project.history().journal().map(Journal::spool);
                (
                    format!("Placing {}", object.name),
                    Box::new(move || fetch(object, volumes, spool)),
                )
            }
            Errand::Import(path) => {
                let (folders, progress) = (places.library.clone(), progress.clone());
                (
                    format!("Importing {}", name(&path)),
                    Box::new(move || {
                        match midair_library::import(&folders, &path, None, &progress) {
                            Ok(component) => Outcome::Imported(Box::new(component)),
                            Err(_) if progress.is_cancelled() => Outcome::Cancelled,
                            Err(error) => Outcome::Failed(error.to_string()),
                        }
                    }),
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
            self.running.push(Running {
                what,
                progress,
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

fn add(object: Object, project: &mut Project, notices: &mut Notices) {
    let id = ObjectId(project.document().next_id());
    let name = format!("Place {}", object.name);
    let object = object.into();
    project.commit(name, [Edit::Add { id, object }], notices);
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
        .add_systems(Update, finish.in_set(StudioSet::Gather));
}

fn finish(world: &mut World) {
    let volumes = world.resource::<Evaluations>().volumes.clone();
    let mut errands = world.resource_mut::<Errands>();
    errands
        .bypass_change_detection()
        .volumes
        .get_or_insert(volumes);
    let mut done = Vec::new();
    errands
        .bypass_change_detection()
        .running
        .retain_mut(|running| {
            let outcome = match running.outcome.get_mut() {
                Ok(receiver) => receiver.try_recv(),
                Err(poisoned) => poisoned.into_inner().try_recv(),
            };
            match outcome {
                Err(TryRecvError::Empty) => true,
                Err(TryRecvError::Disconnected) => false,
                Ok(outcome) => {
                    done.push((outcome, running.revision));
                    false
                }
            }
        });
    let now = std::mem::take(&mut errands.bypass_change_detection().now);
    for (outcome, revision) in done {
        take_in(world, outcome, revision);
    }
    for errand in now {
        match errand {
            Errand::New => replace(world, History::new(Document::new(), MeshStore::new()), None),
            Errand::Restore => restore(world),
            Errand::Dismiss => dismiss(world),
            _ => {}
        }
    }
}

fn take_in(world: &mut World, outcome: Outcome, revision: u64) {
    match outcome {
        Outcome::Opened(path, opened) => {
            for warning in &opened.warnings {
                world.resource_mut::<Notices>().warn(warning.clone());
            }
            let opened = *opened;
            note(world, &path);
            replace(
                world,
                History::new(opened.document, opened.meshes),
                Some(path),
            );
        }
        Outcome::Saved(path, warnings) => {
            let mut project = world.resource_mut::<Project>();
            if project.history().revision() == revision {
                project.saved(path.clone());
            }
            let mut notices = world.resource_mut::<Notices>();
            for warning in warnings {
                notices.warn(warning);
            }
            notices.info(format!("Saved {}", path.display()));
            note(world, &path);
        }
        Outcome::Exported(path, triangles) => world
            .resource_mut::<Notices>()
            .info(format!("Wrote {} ({triangles} triangles)", path.display())),
        Outcome::Imported(component) => {
            let places = world.resource::<Places>().library.clone();
            world.resource_scope(|world, mut shelf: Mut<Shelf>| {
                let mut notices = world.resource_mut::<Notices>();
                notices.info(format!("{} is in the library now.", component.name));
                shelf.reload(&places, &mut notices);
            });
        }
        Outcome::Fetched(object, meshes) => {
            world.resource_scope(|world, mut notices: Mut<Notices>| {
                let mut project = world.resource_mut::<Project>();
                for mesh in meshes {
                    project.meshes().insert(mesh);
                }
                add(*object, &mut project, &mut notices);
            });
        }
        Outcome::Failed(reason) => {
            world
                .resource_mut::<Project>()
                .bypass_change_detection()
                .keep();
            world.resource_mut::<Notices>().warn(reason);
        }
        Outcome::Cancelled => world
            .resource_mut::<Notices>()
            .info("Given up; nothing was changed."),
    }
}

/// The document is among the recent ones.
fn note(world: &mut World, path: &std::path::Path) {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut settings = world.resource_mut::<Settings>();
    let mut files = settings.files.clone();
    files.note(&path);
    if settings.files != files {
        settings.files = files;
    }
}

/// Another document takes the place of the one at hand. What is not saved stays in its journal and
/// is offered at the next start.
fn replace(world: &mut World, mut history: History, path: Option<PathBuf>) {
    let places = world.resource::<Places>().clone();
    if world.resource::<Begin>().journal {
        world.resource_scope(|_, mut notices: Mut<Notices>| {
            attach(&mut history, &places, path.as_deref(), &mut notices);
        });
    }
    world.resource_mut::<Project>().retire();
    install(world, history, path);
}

fn restore(world: &mut World) {
    let mut found = world.resource_mut::<Recoverables>();
    if found.0.is_empty() {
        world
            .resource_mut::<Notices>()
            .info("No work was left behind.");
        return;
    }
    let first = found.0.remove(0);
    match first.recover() {
        Ok(recovered) => {
            for warning in recovered.warnings {
                world.resource_mut::<Notices>().warn(warning);
            }
            world.resource_mut::<Project>().retire();
            install(world, recovered.history, recovered.origin);
            world
                .resource_mut::<Notices>()
                .info("Your work is back, its undo list included.");
        }
        Err(error) => world.resource_mut::<Notices>().warn(error.to_string()),
    }
}

fn dismiss(world: &mut World) {
    let found = std::mem::take(&mut world.resource_mut::<Recoverables>().0);
    for left in found {
        if let Err(error) = left.discard() {
            world
                .resource_mut::<Notices>()
                .warn(format!("The journal was not deleted: {error}."));
        }
    }
}
