//! The folders of materials, read at the start and looked at again while the app runs.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use bevy::asset::io::file::FileAssetReader;
use bevy::prelude::*;
use bevy::shader::Shader;
use bevy::tasks::{IoTaskPool, Task, block_on, poll_once};

use super::MaterialShelf;
use crate::notice::Notices;
use crate::project::Places;

/// Seconds between two looks.
const EVERY: f32 = 0.4;
/// The longest file, in bytes.
const LONGEST: u64 = 256 << 10;

/// When a file was written last, and how long it is.
type Stamp = (Option<SystemTime>, u64);
type Stamps = HashMap<PathBuf, Stamp>;

/// What a look found: how the files stand, and the text of those that are not as they were.
struct Look {
    stamps: Stamps,
    texts: Vec<(PathBuf, Result<String, String>)>,
}

#[derive(Resource, Default)]
struct Watch {
    folders: Vec<PathBuf>,
    stamps: Stamps,
    looking: Option<Task<Look>>,
    since: f32,
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Watch>()
        .add_systems(Startup, begin)
        .add_systems(First, look);
}

/// Later folders come before earlier ones: the person's own has the last word.
fn folders(places: &Places) -> Vec<PathBuf> {
    // Beside the app, or in the checkout that it was built from: the first that has one.
    let built = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let bundled = [FileAssetReader::get_base_path(), built.to_owned()]
        .into_iter()
        .map(|folder| folder.join("assets/materials"))
        .find(|folder| folder.is_dir());
    bundled
        .into_iter()
        .chain([places.library.materials()])
        .collect()
}

fn begin(
    places: Option<Res<Places>>,
    mut watch: ResMut<Watch>,
    mut shelf: ResMut<MaterialShelf>,
    mut shaders: ResMut<Assets<Shader>>,
    mut notices: ResMut<Notices>,
) {
    let Some(places) = places else { return };
    watch.folders = folders(&places);
    let found = find(&watch.folders, &Stamps::new());
    watch.stamps = found.stamps;
    take(found.texts, &mut shelf, &mut shaders, &mut notices);
}

fn look(
    time: Res<Time<Real>>,
    mut watch: ResMut<Watch>,
    mut shelf: ResMut<MaterialShelf>,
    mut shaders: ResMut<Assets<Shader>>,
    mut notices: ResMut<Notices>,
) {
    let watch = watch.bypass_change_detection();
    if let Some(task) = watch.looking.as_mut() {
        if let Some(found) = block_on(poll_once(task)) {
            watch.looking = None;
            watch.stamps = found.stamps;
            take(found.texts, &mut shelf, &mut shaders, &mut notices);
        }
        return;
    }
    watch.since += time.delta_secs();
    if watch.since < EVERY || watch.folders.is_empty() {
        return;
    }
    watch.since = 0.0;
    let (folders, stamps) = (watch.folders.clone(), watch.stamps.clone());
    watch.looking = Some(IoTaskPool::get().spawn(async move { find(&folders, &stamps) }));
}

fn find(folders: &[PathBuf], before: &Stamps) -> Look {
    let mut found = Look {
        stamps: Stamps::new(),
        texts: Vec::new(),
    };
    for folder in folders {
        // A folder that is not there holds nothing.
        let mut files: Vec<_> = std::fs::read_dir(folder)
            .into_iter()
            .flatten()
            .flatten()
            .map(|e| e.path())
            .filter(|p| p.extension().is_some_and(|e| e == "wgsl"))
            .collect();
        files.sort();
        for file in files {
            let Ok(about) = std::fs::metadata(&file) else {
                continue;
            };
            let stamp = (about.modified().ok(), about.len());
            if before.get(&file) != Some(&stamp) {
                let text = if about.len() > LONGEST {
                    Err(format!("it is longer than {} kB", LONGEST >> 10))
                } else {
                    std::fs::read_to_string(&file).map_err(|e| e.to_string())
                };
                found.texts.push((file.clone(), text));
            }
            found.stamps.insert(file, stamp);
        }
    }
    found
}

fn take(
    texts: Vec<(PathBuf, Result<String, String>)>,
    shelf: &mut ResMut<MaterialShelf>,
    shaders: &mut Assets<Shader>,
    notices: &mut Notices,
) {
    for (file, text) in texts {
        let Some(id) = name(&file) else { continue };
        let stays = if shelf.all().find(&id).is_some() {
            "The material stays as it was"
        } else {
            "It is not offered"
        };
        match text {
            Ok(text) => {
                if let Err(fault) = shelf.take(&id, &text, shaders) {
                    notices.warn(format!(
                        "{}, {fault}. {stays} until that is mended.",
                        file.display()
                    ));
                }
            }
            Err(reason) => notices.warn(format!(
                "{} cannot be read: {reason}. {stays}.",
                file.display()
            )),
        }
    }
}

fn name(file: &Path) -> Option<String> {
    Some(file.file_stem()?.to_str()?.to_owned())
}
