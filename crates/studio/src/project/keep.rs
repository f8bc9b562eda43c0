//! Keeping the work: autosaves, what the history has to say, a clean end.

use std::sync::Mutex;

use bevy::prelude::*;
use midair_document::Autosave;

use super::{Places, Project};
use crate::StudioSet;
use crate::notice::Notices;

/// Autosaves in a pause of the work; added where a person works.
pub struct KeepPlugin;

#[derive(Resource)]
struct Saver(Mutex<Autosave>);

impl Plugin for KeepPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(PostStartup, start)
            // Last: what this frame committed is journalled already.
            .add_systems(Update, keep.after(StudioSet::Cue))
            .add_systems(Last, end.run_if(on_message::<AppExit>));
    }
}

fn start(project: Res<Project>, places: Res<Places>, mut commands: Commands) {
    commands.insert_resource(Saver(Mutex::new(Autosave::new(
        &places.autosaves,
        project.history(),
    ))));
}

fn keep(
    saver: Option<ResMut<Saver>>,
    project: Res<Project>,
    time: Res<Time<Real>>,
    mut notices: ResMut<Notices>,
) {
    if let Some(mut saver) = saver
        && let Ok(saver) = saver.0.get_mut()
        && let Some(line) = saver.tick(time.elapsed(), project.history())
    {
        notices.warn(line);
    }
}

/// A clean end with nothing unsaved leaves no journal; otherwise the next start offers the work.
fn end(mut project: ResMut<Project>) {
    project.retire();
}
