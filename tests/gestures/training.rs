//! The three training tasks, done by hands (EasyVRModeling §6, Fig. 7).

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// What a training session left behind.
pub struct Trained {
    pub name: &'static str,
    pub folder: PathBuf,
}

impl Trained {
    pub fn file(&self, ending: &str) -> PathBuf {
        self.folder.join(format!("{}{ending}", self.name))
    }
}

/// Midair with a home of its own.
pub fn midair(home: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_midair"));
    command.env("MIDAIR_HOME", home.join("home"));
    command
}

pub fn run(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {said}");
    assert_eq!(said, "", "{command:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Each session is played once, for all the tests.
pub fn trained() -> &'static [Trained] {
    static ALL: OnceLock<Vec<Trained>> = OnceLock::new();
    ALL.get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("training");
        std::fs::create_dir_all(&folder).unwrap();
        ["cube-sphere", "chair", "cup"]
            .map(|name| {
                let trained = Trained {
                    name,
                    folder: folder.clone(),
                };
                let mut play = midair(&folder);
                play.arg("play")
                    .arg(format!(
                        "{}/assets/sessions/{name}.ron",
                        env!("CARGO_MANIFEST_DIR")
                    ))
                    .arg("--hands-only");
                for ending in [".stl", ".glb", ".ply", ".obj", ".3mf"] {
                    play.arg("--export").arg(trained.file(ending));
                }
                play.arg("--save").arg(trained.file(".midair"));
                play.arg("--report").arg(trained.file(".json"));
                play.arg("--record").arg(trained.file(".ron"));
                run(&mut play);
                trained
            })
            .into()
    })
}

#[test]
fn hands_alone_make_faultless_meshes_in_every_format() {
    for trained in trained() {
        let mut volumes = Vec::new();
        for ending in [".stl", ".glb", ".ply", ".obj"] {
            let mut check = midair(&trained.folder);
            let said = run(check.arg("check").arg("--json").arg(trained.file(ending)));
            let checked: serde_json::Value = serde_json::from_str(&said).unwrap();
            assert_eq!(
                checked[0]["faultless"], true,
                "{}{ending}: {said}",
                trained.name
            );
            assert_eq!(checked[0]["watertight"], true);
            volumes.push(checked[0]["volume"].as_f64().unwrap());
        }
        for volume in &volumes {
            assert!((volume / volumes[0] - 1.0).abs() < 1e-5, "{volumes:?}");
        }
        // 3MF is written only; its parts are those of a printable archive.
        let archive = std::fs::read(trained.file(".3mf")).unwrap();
        assert!(archive.starts_with(b"PK"));
        let mut check = midair(&trained.folder);
        run(check.arg("check").arg(trained.file(".midair")));
    }
}

#[test]
fn the_report_says_what_was_made() {
    for trained in trained() {
        let text = std::fs::read_to_string(trained.file(".json")).unwrap();
        let report: serde_json::Value = serde_json::from_str(&text).unwrap();
        let objects = report["objects"].as_array().unwrap();
        assert_eq!(
            objects.len(),
            if trained.name == "cube-sphere" { 3 } else { 1 }
        );
        let mut volume = 0.0;
        for object in objects {
            assert_eq!(object["closed"], true);
            assert_eq!(object["kind"], "solid");
            volume += object["volume"].as_f64().unwrap();
        }
        let written = midair_mesh::read(&trained.file(".stl"))
            .unwrap()
            .mesh
            .volume();
        assert!((volume / written - 1.0).abs() < 1e-4, "{volume} {written}");
        assert!(report["updates"].as_array().is_some_and(|u| !u.is_empty()));
        for field in [
            "lines", "strokes", "edits", "undo", "redo", "frames", "warnings",
        ] {
            assert!(!report[field].is_null(), "{field}");
        }
    }
}

#[test]
fn a_recording_plays_to_the_same_bytes() {
    for trained in trained() {
        let again = trained.file("-again.stl");
        let mut play = midair(&trained.folder);
        play.arg("play")
            .arg(trained.file(".ron"))
            .arg("--hands-only");
        run(play
            .arg("--export")
            .arg(&again)
            .arg("--save")
            .arg(trained.file("-again.midair")));
        for (first, second) in [(".stl", "-again.stl"), (".midair", "-again.midair")] {
            let [a, b] = [first, second].map(|e| std::fs::read(trained.file(e)).unwrap());
            assert!(a == b, "{}{first} and {second} differ", trained.name);
        }
    }
}
