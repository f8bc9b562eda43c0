//! `settings.ron`: read at the start, written off the frame once nothing is being set any more.

use std::io::Write;
use std::path::Path;

use bevy::prelude::*;
use bevy::tasks::IoTaskPool;

use super::Settings;
use crate::notice::Notices;
use crate::project::Places;

/// Seconds without a change after which they are written: what a key that is held or a slider changes in every
/// frame is written once, when it is let go.
const QUIET: f32 = 0.4;

/// Reads and keeps a person's settings; added where a person works.
pub struct KeepSettingsPlugin;

impl Plugin for KeepSettingsPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(PreStartup, read).add_systems(Last, write);
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

fn write(
    settings: Res<Settings>,
    places: Res<Places>,
    time: Res<Time<Real>>,
    mut exits: MessageReader<AppExit>,
    mut begun: Local<bool>,
    mut changed: Local<Option<f32>>,
) {
    // What has just been read is in the file already.
    if settings.is_changed() && std::mem::replace(&mut *begun, true) {
        *changed = Some(0.0);
    } else if let Some(quiet) = changed.as_mut() {
        *quiet += time.delta_secs();
    }
    let ends = exits.read().count() > 0;
    if !changed.is_some_and(|quiet| ends || quiet >= QUIET) {
        return;
    }
    *changed = None;
    let path = places.settings();
    let Ok(text) = ron::ser::to_string_pretty(&*settings, ron::ser::PrettyConfig::default()) else {
        return;
    };
    let work = move || {
        if let Err(error) = replace_file(&path, &text) {
            warn!("{} was not written: {error}", path.display());
        }
    };
    if ends {
        // Nobody waits for other threads any more.
        work();
    } else {
        IoTaskPool::get().spawn(async move { work() }).detach();
    }
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

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use bevy::time::TimeUpdateStrategy;

    use super::*;

    fn app(home: &Path) -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, KeepSettingsPlugin))
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(
                20,
            )))
            .insert_resource(Places::below(home))
            .init_resource::<Settings>()
            .init_resource::<Notices>();
        app.update();
        app
    }

    fn radius(home: &Path) -> Option<f32> {
        let text = std::fs::read_to_string(Places::below(home).settings()).ok()?;
        Some(ron::from_str::<Settings>(&text).unwrap().brush.radius)
    }

    #[test]
    fn what_changes_in_every_frame_is_written_once_it_is_let_go() {
        let home = tempfile::tempdir().unwrap();
        let mut app = app(home.path());
        for i in 0..100 {
            app.world_mut().resource_mut::<Settings>().brush.radius = 0.01 + 1e-4 * i as f32;
            app.update();
            assert_eq!(radius(home.path()), None, "held");
        }
        for _ in 0..30 {
            app.update();
        }
        let since = Instant::now();
        while radius(home.path()).is_none() {
            assert!(since.elapsed() < Duration::from_secs(20), "never written");
            std::thread::sleep(Duration::from_millis(2));
        }
        assert_eq!(radius(home.path()), Some(0.01 + 1e-4 * 99.0));
    }

    #[test]
    fn the_last_change_is_written_before_the_app_ends() {
        let home = tempfile::tempdir().unwrap();
        let mut app = app(home.path());
        app.world_mut().resource_mut::<Settings>().brush.radius = 0.07;
        app.world_mut().write_message(AppExit::Success);
        app.update();
        assert_eq!(radius(home.path()), Some(0.07));
    }
}
