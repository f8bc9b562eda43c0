//! Carries commands out.

use std::path::PathBuf;

use bevy::prelude::*;
use midair_document::{Edit, Object};
use midair_field::Placement;
use midair_solid::ExportOptions;

use super::{
    Command, Dialogs,
    errand::{Errand, Errands, Import},
};
use crate::StudioSet;
use crate::hands::{Action, Hands, Side};
use crate::materials::MaterialShelf;
use crate::notice::Notices;
use crate::panel::Panels;
use crate::project::{Places, Project, Selection, Shelf};
use crate::reference;
use crate::settings::Settings;
use crate::show::Drafts;
use crate::tools::Tools;

/// Metres from one picture to the next where several are brought in together.
const REFERENCES_APART: f32 = 0.65;

/// The most files that come into the scene when they are dropped on it together.
const MOST_PLACED: usize = 4;

pub(super) fn plugin(app: &mut App) {
    // Buttons become commands before commands are carried out, in the same frame.
    app.add_systems(Update, (buttons, handle).chain().in_set(StudioSet::Ask));
}

/// The buttons that mean the same in every mode. The menu is the leading hand's.
fn buttons(hands: Res<Hands>, settings: Res<Settings>, mut commands: MessageWriter<Command>) {
    if hands.pressed(Action::Undo).is_some() {
        commands.write(Command::Undo);
    }
    if hands.pressed(Action::Redo).is_some() {
        commands.write(Command::Redo);
    }
    if hands.get(settings.hands.main()).pressed(Action::Library) {
        commands.write(Command::ToggleLibrary);
    }
}

fn handle(
    mut commands: MessageReader<Command>,
    hands: Res<Hands>,
    mut project: ResMut<Project>,
    mut shelf: ResMut<Shelf>,
    mut tools: ResMut<Tools>,
    mut drafts: ResMut<Drafts>,
    mut selection: ResMut<Selection>,
    mut errands: ResMut<Errands>,
    (mut settings, mut panels, mut dialogs): (ResMut<Settings>, ResMut<Panels>, ResMut<Dialogs>),
    (places, materials): (Res<Places>, Res<MaterialShelf>),
    mut notices: ResMut<Notices>,
) {
    for command in commands.read() {
        match command {
            Command::Undo => {
                drafts.clear();
                match project.undo() {
                    Some(name) => notices.info(format!("Undone: {name}")),
                    None => notices.info("Nothing to undo."),
                }
            }
            Command::Redo => {
                drafts.clear();
                match project.redo() {
                    Some(name) => notices.info(format!("Redone: {name}")),
                    None => notices.info("Nothing to redo."),
                }
            }
            Command::ToggleLibrary => {
                shelf.open = !shelf.open;
                panels.set_open("library", shelf.open);
            }
            Command::Panel { id, open } => {
                if id == "library" {
                    shelf.open = *open;
                }
                if !panels.set_open(id, *open) {
                    notices.warn(format!("There is no panel \"{id}\"."));
                }
            }
            Command::Set { key, value } => {
                let mut next = settings.clone();
                match next.set(key, value) {
                    Ok(()) => {
                        settings.set_if_neq(next);
                    }
                    Err(fault) => notices.warn(fault.to_string()),
                }
            }
            Command::Place { component, side } => {
                if let Some(object) = placed(component, *side, &shelf, &hands, &mut notices) {
                    let mut next = settings.shelf.clone();
                    next.note(component);
                    if next != settings.shelf {
                        settings.shelf = next;
                    }
                    errands.place(object, &mut project, &mut notices);
                }
            }
            Command::Mode(id) => {
                if !tools.activate(id.as_str()) {
                    notices.warn(format!(
                        "No mode \"{id}\" is plugged in. Add its plugin and start Midair again."
                    ));
                }
            }
            Command::Step(step) => {
                project.commit("Set step", [Edit::SetStep { step: *step }], &mut notices);
            }
            Command::Edit(edit) => {
                project.commit(edit.describe().to_owned(), [edit.clone()], &mut notices);
            }
            Command::Save => {
                let path = project
                    .path()
                    .map_or_else(|| project.new_path(), Into::into);
                errands.start(Errand::Save(path), &project);
            }
            Command::SaveAs(path) => {
                errands.start(Errand::Save(path.clone()), &project);
            }
            Command::Export {
                path,
                step,
                unit,
                up,
                only,
            } => errands.start(
                Errand::Export {
                    path: path.clone(),
                    options: ExportOptions {
                        step: *step,
                        unit: *unit,
                        up: *up,
                        only: *only,
                        materials: materials.all().clone(),
                    },
                },
                &project,
            ),
            Command::ExportObject { object, path } => errands.start(
                Errand::Export {
                    path: path.clone(),
                    options: ExportOptions {
                        only: Some(*object),
                        materials: materials.all().clone(),
                        ..default()
                    },
                },
                &project,
            ),
            Command::Import(paths) => {
                let import = |path: &PathBuf| Import {
                    path: path.clone(),
                    at: None,
                };
                errands.import(paths.iter().map(import), &places);
            }
            Command::Keep { objects } => {
                let ids = if objects.is_empty() {
                    &selection.0
                } else {
                    objects
                };
                if ids.is_empty() {
                    notices.warn("Nothing to keep in the library: select a solid first.");
                }
                for id in ids {
                    let Some(object) = project.document().object(*id) else {
                        continue;
                    };
                    let Some(recipe) = object.operand() else {
                        notices.warn(format!(
                            "{} is not closed, so it cannot be a component: close it first.",
                            object.name
                        ));
                        continue;
                    };
                    let keep = Errand::Keep {
                        folders: places.library.clone(),
                        name: object.name.clone(),
                        // As large as it stands in the room.
                        recipe: recipe.placed(Placement {
                            scale: object.placement.scale,
                            ..Placement::IDENTITY
                        }),
                    };
                    errands.start(keep, &project);
                }
            }
            Command::TakeAway { component } => {
                let name = shelf.library.get(component).map(|c| c.name.clone());
                match shelf.library.take_away(component) {
                    Ok(Some(file)) => notices.info(format!(
                        "{} is out of the library. Its file is kept as {}; what was made of it stays.",
                        name.unwrap_or_default(),
                        file.display()
                    )),
                    Ok(None) => notices.warn(format!(
                        "\"{component}\" is no component of your own: only those can be taken out of the library."
                    )),
                    Err(error) => notices.warn(format!("It stays in the library: {error}.")),
                }
            }
            Command::Bring { paths, at } => {
                // What was dropped by the handful is meant for the library.
                let at = (paths.len() <= MOST_PLACED && at.is_finite()).then_some(*at);
                let import = |path: &PathBuf| Import {
                    path: path.clone(),
                    at,
                };
                errands.import(paths.iter().map(import), &places);
            }
            Command::Reference { paths, at } => {
                for (i, path) in paths.iter().enumerate() {
                    let aside = i as f32 * REFERENCES_APART * Vec3::X;
                    let errand = Errand::Reference {
                        path: path.clone(),
                        at: at
                            .or((i > 0).then_some(reference::BEHIND))
                            .map(|at| at + aside),
                    };
                    errands.start(errand, &project);
                }
            }
            Command::Open(path) => {
                errands.start(Errand::Open(path.clone()), &project);
            }
            Command::Dialog(dialog) => dialogs.ask(*dialog),
            // Leaving is the project's.
            Command::Leave(_) | Command::Answer(_) => {}
            Command::CancelErrands => errands.cancel(None),
            Command::CancelErrand(id) => errands.cancel(Some(*id)),
            Command::New => errands.start(Errand::New, &project),
            Command::Restore => errands.start(Errand::Restore, &project),
            Command::Dismiss => errands.start(Errand::Dismiss, &project),
            // Whose they are reads them.
            Command::Tool { .. }
            | Command::Carry { .. }
            | Command::Objects(_)
            | Command::Operand(_)
            | Command::Plane(_)
            | Command::Measure(_)
            | Command::World(_)
            | Command::Headset(_) => {}
        }
    }
    for warning in project.bypass_change_detection().take_warnings() {
        notices.warn(warning);
    }
    let document = project.document();
    if selection.0.iter().any(|&id| document.object(id).is_none()) {
        selection.0.retain(|&id| document.object(id).is_some());
    }
}

/// The wand has picked a component: it is to appear at the hand.
fn placed(
    component: &str,
    side: Side,
    shelf: &Shelf,
    hands: &Hands,
    notices: &mut Notices,
) -> Option<Object> {
    if !shelf.open {
        notices.warn("The library is closed: open it first, then pick a component.");
        return None;
    }
    let Some(found) = shelf.library.get(component) else {
        notices.warn(format!(
            "The library has no component \"{component}\". \"midair library\" lists what there is."
        ));
        return None;
    };
    if found.missing {
        notices.warn(format!(
            "The mesh of {} is gone from the library. Import it again.",
            found.name
        ));
        return None;
    }
    let at = Placement::at(hands.get(side).pose.position);
    Some(Object::solid(found.name.clone(), found.placed()).placed(at))
}
