//! `settings.ron`: read at the start, written off the frame when something was set.

use std::io::Write;
use std::path::Path;

use bevy::prelude::*;
use bevy::tasks::IoTaskPool;

use super::Settings;
use crate::notice::Notices;
use crate::project::Places;

/// Reads and keeps a person's settings; added where a person works.
pub struct KeepSettingsPlugin;

impl Plugin for KeepSettingsPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(PreStartup, read)
            .add_systems(Last, write.run_if(resource_changed::<Settings>));
    }
}

fn read(places: Res<Places>, mut settings: ResMut<Settings>, mut notices: ResMut<Notices>) {
    let path = places.settings();
    match std::fs::read_to_string(&path) {
        Ok(text) => match ron::from_str(&text) {
            Ok(kept) => *settings = kept,
            Err(fault) => {
                let aside = path.with_extension("ron.bad");
                // Kept beside, since the next change writes the file anew.
                let _ = std::fs::copy(&path, &aside);
                notices.warn(format!(
                    "{}, line {}: {}. The usual settings are used; your file is kept as {}.",
                    path.display(),
                    fault.span.start.line,
                    fault.code,
                    aside.display()
                ));
            }
        },
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            *settings = Settings::of_a_person();
        }
        Err(error) => notices.warn(format!(
            "{} cannot be read: {error}. The usual settings are used.",
            path.display()
        )),
    }
}

fn write(settings: Res<Settings>, places: Res<Places>, mut begun: Local<bool>) {
    // What has just been read is in the file already.
    if !std::mem::replace(&mut *begun, true) {
        return;
    }
    let path = places.settings();
    let Ok(text) = ron::ser::to_string_pretty(&*settings, ron::ser::PrettyConfig::default()) else {
        return;
    };
    IoTaskPool::get()
        .spawn(async move {
            if let Err(error) = replace_file(&path, &text) {
                warn!("{} was not written: {error}", path.display());
            }
        })
        .detach();
}

/// Writes a small file of a person's, and the folders it needs. Either the old file or the new one is
/// there, never half of it.
///
/// # Errors
///
/// What the system says; the old file is as it was.
pub fn replace_file(path: &Path, text: &str) -> std::io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder)?;
    let aside = path.with_extension("ron.new");
    let mut file = std::fs::File::create(&aside)?;
    file.write_all(text.as_bytes())?;
    file.sync_all()?;
    std::fs::rename(aside, path)
}
