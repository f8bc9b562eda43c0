//! What comes of an errand, taken into the world.

use std::path::PathBuf;

use std::sync::mpsc::TryRecvError;

use bevy::prelude::*;
use midair_document::{Document, History, MeshStore, Object};
use midair_field::Placement;

use super::batch::{Batch, Brought};
use super::{Errand, Errands, Outcome, add};
use crate::evaluate::Evaluations;
use crate::notice::Notices;
use crate::project::{Begin, Places, Project, Recoverables, Shelf, attach, install};
use crate::settings::Settings;

/// Metres between things that were dropped together.
const APART: f32 = 0.05;

pub(super) fn finish(world: &mut World) {
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
    let brought = errands.bypass_change_detection().imports.take();
    for (outcome, revision) in done {
        take_in(world, outcome, revision);
    }
    if !brought.is_empty() {
        take_in_imports(world, brought);
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
        Outcome::Kept(name) => {
            let places = world.resource::<Places>().clone();
            world.resource_scope(|world, mut shelf: Mut<Shelf>| {
                let mut notices = world.resource_mut::<Notices>();
                shelf.reload(&places.library, &mut notices);
                notices.info(format!("{name} is in the library now."));
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
        Outcome::Pictured(object, bytes) => {
            world.resource_scope(|world, mut notices: Mut<Notices>| {
                let mut project = world.resource_mut::<Project>();
                project.meshes().insert_image(bytes);
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

/// Meshes that are in the library now. The library is read again once all of them are.
fn take_in_imports(world: &mut World, brought: Vec<Brought>) {
    let places = world.resource::<Places>().clone();
    world.resource_scope(|world, mut errands: Mut<Errands>| {
        let errands = &mut *errands;
        for Brought { import, result } in brought {
            let batch = &mut errands.imports;
            let mut notices = world.resource_mut::<Notices>();
            let component = match result {
                Ok(component) => component,
                Err(reason) => {
                    match reason {
                        Some(reason) => {
                            batch.failed += 1;
                            notices.warn(reason);
                        }
                        None => batch.given_up += 1,
                    }
                    continue;
                }
            };
            if batch.total == 1 {
                notices.info(format!("{} is in the library now.", component.name));
            }
            if let Some(at) = import.at {
                let bounds = component.recipe.bounds();
                // Side by side in the order in which they were read, each on its foot; the first where it was dropped.
                let x = batch.taken.map_or(0.0, |end| end + APART - bounds.min.x);
                batch.taken = Some(x + bounds.max.x);
                let foot = Vec3::new(x, -bounds.min.y, 0.0);
                let object = Object::solid(component.name.clone(), component.placed())
                    .placed(Placement::at(at + foot));
                world.resource_scope(|world, mut notices: Mut<Notices>| {
                    let mut project = world.resource_mut::<Project>();
                    errands.place(object, &mut project, &mut notices);
                });
            }
        }
        let batch = &errands.imports;
        if batch.len() > 0 {
            return;
        }
        world.resource_scope(|world, mut shelf: Mut<Shelf>| {
            let mut notices = world.resource_mut::<Notices>();
            if batch.total > 1 || batch.given_up > 0 {
                notices.info(summary(batch));
            }
            shelf.reload(&places.library, &mut notices);
        });
        errands.imports = Batch::default();
    });
}

/// One line for many files.
fn summary(batch: &Batch) -> String {
    let brought = batch.total - batch.failed - batch.given_up;
    let mut line = format!("{brought} of {} meshes are in the library now", batch.total);
    if batch.failed > 0 {
        line += &format!("; {} could not be brought in", batch.failed);
    }
    if batch.given_up > 0 {
        line += &format!("; {} were given up", batch.given_up);
    }
    line + "."
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
