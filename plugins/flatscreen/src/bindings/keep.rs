//! `bindings.ron` beside the settings: read at the start, written off the frame when something was bound.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use bevy::tasks::IoTaskPool;
use midair_studio::bound::own_file;
use midair_studio::notice::Notices;
use midair_studio::project::Places;
use midair_studio::settings::replace_file;

use super::Bindings;

pub(super) fn plugin(app: &mut App) {
    app.add_systems(PreStartup, read)
        .add_systems(Last, write.run_if(resource_changed::<Bindings>));
}

/// Where a person's own bindings are.
pub(super) fn path(places: &Places) -> PathBuf {
    places.library.config().join("bindings.ron")
}

fn read(places: Res<Places>, mut bindings: ResMut<Bindings>, mut notices: ResMut<Notices>) {
    let path = path(&places);
    let way_out = |path: &Path| {
        let aside = path.with_extension("ron.bad");
        // Kept beside, since the next key that is bound writes the file anew.
        let _ = std::fs::copy(path, &aside);
        format!(
            "correct the line, or bind the keys anew in Controls. Your file is kept as {}.",
            aside.display()
        )
    };
    let read = own_file(&path, "keys", way_out, Bindings::with_file, &mut notices);
    if let Some(read) = read {
        *bindings = read;
    }
}

fn write(bindings: Res<Bindings>, places: Res<Places>, mut begun: Local<bool>) {
    // What has just been read is in the file already.
    if !std::mem::replace(&mut *begun, true) {
        return;
    }
    let (path, text) = (path(&places), bindings.to_file());
    IoTaskPool::get()
        .spawn(async move {
            if let Err(error) = replace_file(&path, &text) {
                warn!("{} was not written: {error}", path.display());
            }
        })
        .detach();
}
