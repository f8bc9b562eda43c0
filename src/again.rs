//! From the flat screen into the headset: the app starts itself again, with the work as it stands.
//!
//! What draws in a headset has to be made as its runtime asks, before anything else is drawn with it, so the flat app
//! cannot take a headset up as it is. The journal holds the work with its undo list, or the document's file does.

use std::ffi::OsString;
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};

use bevy::prelude::*;
use midair_openxr::runtime::{Connection, RuntimeFault};
use midair_studio::StudioSet;
use midair_studio::command::Command;
use midair_studio::notice::Notices;
use midair_studio::project::{Project, Recoverables};

/// How the app is to start again once it has ended.
#[derive(Resource, Clone, Default)]
pub struct Again {
    start: Arc<Mutex<Option<Vec<OsString>>>>,
    /// Arguments that stay as they are.
    kept: Vec<OsString>,
}

impl Again {
    /// With arguments that stay as they are.
    pub fn keeping(kept: Vec<OsString>) -> Self {
        Self {
            kept,
            ..Self::default()
        }
    }

    /// The arguments, if it is to.
    pub fn take(&self) -> Option<Vec<OsString>> {
        match self.start.lock() {
            Ok(mut slot) => slot.take(),
            Err(poisoned) => poisoned.into_inner().take(),
        }
    }

    fn set(&self, arguments: Vec<OsString>) {
        if let Ok(mut slot) = self.start.lock() {
            *slot = Some(arguments);
        }
    }
}

/// The switch into the headset, for an app that has none.
pub struct SwitchPlugin(pub Again);

impl Plugin for SwitchPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(self.0.clone())
            .add_systems(Update, switch.in_set(StudioSet::Ask));
    }
}

/// Takes up the work that the flat app left, without being asked.
pub struct ResumePlugin;

impl Plugin for ResumePlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            PostStartup,
            |left: Res<Recoverables>, mut commands: MessageWriter<Command>| {
                if !left.0.is_empty() {
                    commands.write(Command::Restore);
                }
            },
        );
    }
}

type Look = Mutex<Receiver<Result<(), RuntimeFault>>>;

fn switch(
    mut commands: MessageReader<Command>,
    again: Res<Again>,
    project: Res<Project>,
    mut notices: ResMut<Notices>,
    mut exit: MessageWriter<AppExit>,
    mut look: Local<Option<Look>>,
) {
    let asked = commands.read().any(|c| matches!(c, Command::Headset(true)));
    if asked && look.is_none() {
        notices.info("Looking for a headset…");
        let (sender, receiver) = channel();
        let begun = std::thread::Builder::new()
            .name("headset search".to_owned())
            .spawn(move || {
                // The connection is let go of again: the next start makes its own.
                let _ = sender.send(Connection::open().map(drop));
            });
        if begun.is_ok() {
            *look = Some(Mutex::new(receiver));
        }
    }
    let found = match look.as_mut().map(Mutex::get_mut) {
        Some(Ok(receiver)) => receiver.try_recv(),
        _ => return,
    };
    match found {
        Err(std::sync::mpsc::TryRecvError::Empty) => return,
        Err(std::sync::mpsc::TryRecvError::Disconnected) => {}
        Ok(Err(fault)) => notices.warn(format!("No headset: {fault}.")),
        Ok(Ok(())) => {
            let mut arguments = again.kept.clone();
            arguments.push("--vr".into());
            if project.history().is_unsaved() {
                arguments.push("--resume".into());
            } else if let Some(path) = project.path() {
                arguments.push(path.into());
            }
            again.set(arguments);
            exit.write(AppExit::Success);
        }
    }
    *look = None;
}

/// Starts the app again in this one's place. Does not come back where that succeeds.
///
/// # Errors
///
/// What the system says.
pub fn start_again(arguments: &[OsString]) -> std::io::Result<()> {
    let mut command = std::process::Command::new(std::env::current_exe()?);
    command.args(arguments);
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt;
        Err(command.exec())
    }
    #[cfg(not(unix))]
    {
        command.spawn().map(drop)
    }
}
