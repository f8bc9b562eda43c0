//! How a run begins: empty, from a file, and with what an earlier run left behind.

use bevy::prelude::*;
use midair_document::{Document, History, Journal, MeshStore, Recoverable, Recovery};

use super::{Places, Project};
use crate::evaluate::Evaluations;
use crate::notice::Notices;

/// What a run begins with.
#[derive(Resource, Default)]
pub struct Begin {
    /// The document at the start, its meshes, and the file they came from.
    pub opened: Option<(Document, MeshStore, std::path::PathBuf)>,
    /// Whether a journal is kept; tests and sessions may do without.
    pub journal: bool,
}

/// Work that earlier runs left behind, offered until it is taken or put aside.
#[derive(Resource, Debug, Default)]
pub struct Recoverables(pub Vec<Recoverable>);

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Recoverables>().init_resource::<Begin>();
}

/// Makes the project; called once, before the first frame.
pub(crate) fn begin(world: &mut World) {
    let places = world.resource::<Places>().clone();
    let mut begin = world.remove_resource::<Begin>().unwrap_or_default();
    let mut found = Vec::new();
    if begin.journal {
        found = Recovery::find(&places.journals);
    }
    let (document, meshes, path) = match begin.opened.take() {
        Some((document, meshes, path)) => (document, meshes, Some(path)),
        None => (Document::new(), MeshStore::new(), None),
    };
    let mut history = History::new(document, meshes);
    let mut notices = world.resource_mut::<Notices>();
    if begin.journal {
        attach(&mut history, &places, path.as_deref(), &mut notices);
        if let Some(first) = found.first() {
            let what = first
                .origin
                .as_ref()
                .and_then(|p| p.file_name())
                .map_or("an unsaved document".into(), |n| {
                    n.to_string_lossy().into_owned()
                });
            notices.info(format!(
                "Midair ended unexpectedly while you worked on {what} ({} steps). Restore it, or leave it aside.",
                first.steps
            ));
        }
    }
    world.insert_resource(Recoverables(found));
    world.insert_resource(begin);
    install(world, history, path);
}

/// Puts a history in place of the one at hand.
pub(crate) fn install(world: &mut World, history: History, path: Option<std::path::PathBuf>) {
    let store = history.meshes().clone();
    world
        .resource::<Evaluations>()
        .volumes
        .add_meshes(move |hash| store.get(*hash));
    let work = world.resource::<Places>().work.clone();
    world.insert_resource(Project::new(history, path, work));
    world.resource_mut::<super::Selection>().0.clear();
}

/// Keeps a journal from here on; without one the work goes on, and the user knows.
pub(crate) fn attach(
    history: &mut History,
    places: &Places,
    origin: Option<&std::path::Path>,
    notices: &mut Notices,
) {
    match Journal::start(
        &places.journals,
        history.document(),
        history.meshes(),
        origin,
    ) {
        Ok(journal) => history.attach(journal),
        Err(error) => notices.warn(error.to_string()),
    }
}
