//! The drawing's whole history as a file (ScaffoldSketch §3.2): every step, with what was drawn and what became
//! of it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bevy::math::DVec3;
use bevy::prelude::*;
use bevy::tasks::{IoTaskPool, Task, block_on, poll_once};
use midair_document::{Document, Kind, Object, ObjectId, affine};
use midair_studio::notice::Notices;
use midair_studio::project::Project;
use serde_json::{Value, json};

use crate::sheet::sheet;

/// A history or a sheet that is being written.
#[derive(Resource, Default)]
pub struct Writing(Option<Task<Result<String, String>>>);

/// Starts writing; the file is named by the project where no name is given.
pub(crate) fn start(path: Option<PathBuf>, project: &Project, writing: &mut Writing) {
    let path = named(path, "history.json", project);
    let past = project.history().past();
    writing.0 = Some(IoTaskPool::get().spawn(async move {
        let text = serde_json::to_string_pretty(&told(&past)).unwrap_or_default();
        let steps = past.len().saturating_sub(1);
        write(&path, &(text + "\n"), &format!("{steps} steps are"))
    }));
}

/// The same for the drawing on a sheet.
pub(crate) fn start_sheet(path: Option<PathBuf>, project: &Project, writing: &mut Writing) {
    let path = named(path, "sheet.svg", project);
    let document = project.document().clone();
    writing.0 = Some(IoTaskPool::get().spawn(async move {
        match sheet(&document) {
            Some(text) => write(&path, &text, "Front, side, top and isometric view are"),
            None => Err(format!(
                "{} was not written: no line or stroke can be seen. Draw or show some first.",
                path.display()
            )),
        }
    }));
}

fn named(path: Option<PathBuf>, ending: &str, project: &Project) -> PathBuf {
    path.unwrap_or_else(|| {
        let name = format!("{} {ending}", project.title());
        project.work_folder().join(name)
    })
}

pub(crate) fn collect(mut writing: ResMut<Writing>, mut notices: ResMut<Notices>) {
    let Some(task) = &mut writing.bypass_change_detection().0 else {
        return;
    };
    if let Some(done) = block_on(poll_once(task)) {
        match done {
            Ok(line) => notices.info(line),
            Err(line) => notices.warn(line),
        }
        writing.bypass_change_detection().0 = None;
    }
}

fn write(path: &Path, text: &str, what: &str) -> Result<String, String> {
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        // Writing the file says what is wrong with it, if something is.
        let _ = std::fs::create_dir_all(folder);
    }
    match std::fs::write(path, text) {
        Ok(()) => Ok(format!("{what} in {}.", path.display())),
        Err(error) => Err(format!(
            "{} was not written: {error}. Choose another place.",
            path.display()
        )),
    }
}

/// The steps from the oldest on; `past` begins with the state before the first.
pub fn told(past: &[(String, Document)]) -> Value {
    let steps: Vec<Value> = past
        .windows(2)
        .map(|pair| step(&pair[1].0, &pair[0].1, &pair[1].1))
        .collect();
    json!({ "format": 1, "unit": "m", "steps": steps })
}

fn step(name: &str, before: &Document, after: &Document) -> Value {
    let old: BTreeMap<ObjectId, &Object> = before.objects().collect();
    let drawn: Vec<Value> = after
        .objects()
        .filter(|(id, object)| old.get(id).is_none_or(|o| *o != *object))
        .filter_map(|(id, object)| one(id, object))
        .collect();
    let gone: Vec<u64> = old
        .keys()
        .filter(|id| after.object(**id).is_none())
        .map(|id| id.0)
        .collect();
    json!({ "name": name, "drawn": drawn, "gone": gone })
}

fn one(id: ObjectId, object: &Object) -> Option<Value> {
    let there = affine(&object.placement);
    let at = |p: &DVec3| there.transform_point3(*p).to_array();
    Some(match &object.kind {
        Kind::Line(line) => json!({
            "id": id.0, "kind": "line", "name": object.name,
            "raw": line.raw.iter().map(at).collect::<Vec<_>>(),
            "a": at(&line.a), "b": at(&line.b),
            "ticks": line.ticks, "corrected": line.reading.auto,
            "kept": line.kept.iter().map(|k| json!({
                "relation": k.relation.name(), "end": k.end, "with": k.with.map(|id| id.0),
            })).collect::<Vec<_>>(),
        }),
        Kind::Stroke(stroke) => json!({
            "id": id.0, "kind": "stroke", "name": object.name,
            "raw": stroke.raw.iter().map(at).collect::<Vec<_>>(),
            "points": stroke.points().iter().map(at).collect::<Vec<_>>(),
            "closed": stroke.closed, "width": stroke.width, "corrected": stroke.reading.auto,
            "through": stroke.through.iter().filter(|k| k.of_scaffold).map(|k| at(&k.point)).collect::<Vec<_>>(),
        }),
        _ => return None,
    })
}
