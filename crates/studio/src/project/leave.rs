//! Leaving the work at hand for another, or for good: never without asking what becomes of it.

use std::path::PathBuf;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use super::Project;
use crate::StudioSet;
use crate::command::{Command, Errands};
use crate::notice::Notices;
use crate::panel::Panels;

/// What comes after the work at hand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Then {
    /// An empty document.
    New,
    /// A document from a file.
    Open(PathBuf),
    /// What an earlier run left behind.
    Restore,
    /// The end.
    Quit,
}

/// What becomes of work that is not saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Answer {
    /// It is saved first.
    Save,
    /// It is given up.
    Discard,
    /// One stays with it.
    Stay,
}

/// The question that is open.
#[derive(Resource, Debug, Default)]
pub struct Leaving {
    then: Option<Then>,
    /// It is being saved: how many warnings there were before.
    saving: Option<usize>,
}

impl Leaving {
    /// What the answer is waited for with.
    pub fn then(&self) -> Option<&Then> {
        self.then.as_ref()
    }
}

/// The panel that asks.
pub(crate) const PANEL: &str = "leave";

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Leaving>()
        .add_systems(Update, (ask, saved).chain().in_set(StudioSet::Ask));
}

fn ask(
    mut commands: ParamSet<(MessageReader<Command>, MessageWriter<Command>)>,
    mut leaving: ResMut<Leaving>,
    mut project: ResMut<Project>,
    mut panels: ResMut<Panels>,
    notices: Res<Notices>,
    mut exit: MessageWriter<AppExit>,
) {
    let mut next = Vec::new();
    let mut go = None;
    for command in commands.p0().read() {
        match command {
            Command::Leave(then) if !project.history().is_unsaved() => go = Some(then.clone()),
            Command::Leave(then) => {
                leaving.then = Some(then.clone());
                leaving.saving = None;
                panels.set_open(PANEL, true);
            }
            Command::Answer(answer) => {
                let Some(then) = leaving.then.clone() else {
                    continue;
                };
                panels.set_open(PANEL, false);
                match answer {
                    Answer::Save => {
                        leaving.saving = Some(notices.warnings().len());
                        next.push(Command::Save);
                    }
                    Answer::Discard => {
                        project.bypass_change_detection().give_up = true;
                        leaving.then = None;
                        go = Some(then);
                    }
                    Answer::Stay => leaving.then = None,
                }
            }
            // The question was put away unanswered.
            Command::Panel { id, open: false } if id == PANEL && leaving.saving.is_none() => {
                leaving.then = None;
            }
            _ => {}
        }
    }
    if let Some(then) = go {
        next.extend(go_on(then, &mut exit));
    }
    for command in next {
        commands.p1().write(command);
    }
}

/// Goes on once the work is saved; stays where it could not be.
fn saved(
    mut leaving: ResMut<Leaving>,
    project: Res<Project>,
    errands: Res<Errands>,
    mut notices: ResMut<Notices>,
    mut commands: MessageWriter<Command>,
    mut exit: MessageWriter<AppExit>,
) {
    let Some(before) = leaving.saving else {
        return;
    };
    if !project.history().is_unsaved() {
        leaving.saving = None;
        if let Some(then) = leaving.then.take() {
            commands.write_batch(go_on(then, &mut exit));
        }
    } else if errands.is_empty() && notices.warnings().len() > before {
        leaving.saving = None;
        leaving.then = None;
        notices.warn("The document was not saved, so it stays open.");
    }
}

fn go_on(then: Then, exit: &mut MessageWriter<AppExit>) -> Option<Command> {
    Some(match then {
        Then::New => Command::New,
        Then::Open(path) => Command::Open(path),
        Then::Restore => Command::Restore,
        Then::Quit => {
            exit.write(AppExit::Success);
            return None;
        }
    })
}
