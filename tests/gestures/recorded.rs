//! What was done at a desk, recorded and played back without it.

use std::path::{Path, PathBuf};

use midair::{Stage, probe};
use midair_mesh::{Report, check};
use midair_playback::{PlayOptions, PlayerPlugin, RecorderPlugin, Session, play};
use midair_studio::project::{Begin, Places};

use crate::desk::Desk;

/// The one mesh that was saved.
fn saved(home: &Path) -> PathBuf {
    let work = Places::below(home).work;
    let files = std::fs::read_dir(&work).unwrap().map(|e| e.unwrap().path());
    let mut meshes: Vec<_> = files
        .filter(|p| p.extension().is_some_and(|e| e == "stl"))
        .collect();
    assert_eq!(meshes.len(), 1, "{meshes:?}");
    meshes.remove(0)
}

impl Desk {
    /// An empty document; all that is done is written to `path`.
    pub fn recorded(path: &Path, title: &str) -> Self {
        let recorder = RecorderPlugin::create(path, title).unwrap();
        Self::with(move |app| {
            app.add_plugins(recorder);
        })
    }

    /// The mesh that was saved has no fault, nothing was warned of, and the recording ends with so many objects and
    /// in the same bytes.
    pub fn plays_back(self, recording: &Path, objects: usize) -> Report {
        assert_eq!(self.warnings(), [] as [String; 0]);
        println!(
            "{} presses and pushes, {:.0} s",
            self.presses,
            self.seconds()
        );
        let Self { app, home, .. } = self;
        // The recording ends with the app.
        drop(app);
        let mesh = saved(home.path());
        let report = check(&midair_mesh::read(&mesh).unwrap().mesh);
        assert!(report.is_faultless(), "{:?}", report.faults());
        let again = tempfile::tempdir().unwrap();
        let mut player = midair::app(Stage::Bare, Places::below(again.path()), Begin::default());
        player.add_plugins(PlayerPlugin);
        let options = PlayOptions {
            probe,
            ..PlayOptions::default()
        };
        let played = play(&mut player, Session::load(recording).unwrap(), options).unwrap();
        assert_eq!(played.objects.len(), objects);
        let [a, b] = [mesh, saved(again.path())].map(|p| std::fs::read(p).unwrap());
        assert!(a == b, "the same bytes");
        report
    }
}
