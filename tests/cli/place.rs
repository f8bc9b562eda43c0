//! A folder to work in, with a home of its own, and Midair run there.

use std::path::PathBuf;
use std::process::{Command, Output};

pub struct Place {
    folder: tempfile::TempDir,
}

pub struct Said {
    pub status: i32,
    pub out: String,
    pub err: String,
}

impl Place {
    pub fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    pub fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_midair"));
        command
            .current_dir(self.folder.path())
            .env("MIDAIR_HOME", self.path("home"))
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY");
        command
    }

    pub fn midair(&self, args: &[&str]) -> Said {
        Said::of(&self.command().args(args).output().unwrap())
    }

    /// It is done, and nothing is to be said about it.
    pub fn done(&self, args: &[&str]) -> String {
        let said = self.midair(args);
        assert_eq!((said.status, said.err.as_str()), (0, ""), "{args:?}");
        said.out
    }

    /// It cannot be done: status 1 and one line, in which all of `words` are.
    pub fn refused(&self, args: &[&str], words: &[&str]) -> String {
        let said = self.midair(args);
        assert_eq!(said.status, 1, "{args:?}: {}{}", said.out, said.err);
        let lines: Vec<_> = said.err.lines().collect();
        assert_eq!(lines.len(), 1, "{args:?}: {}", said.err);
        for word in words.iter().chain(&["midair: "]) {
            assert!(
                lines[0].contains(word),
                "{args:?}: no {word:?} in {}",
                lines[0]
            );
        }
        said.err
    }

    /// A session of these steps, named `session.ron`.
    pub fn session(&self, steps: &str) {
        let text = format!("(format: 1, title: \"A test\", steps: [{steps}])");
        self.write("session.ron", text);
    }
}

impl Said {
    pub fn of(output: &Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        Self {
            status: output.status.code().expect("it ended by itself"),
            out: text(&output.stdout),
            err: text(&output.stderr),
        }
    }
}

/// Steps that place a cube at the right hand.
pub const CUBE: &str = r#"
    Click(Right, Library),
    Move(hand: Right, to: (0, 1, 0)),
    Ask(Place(component: "solid/cube", side: Right)),
    Expect(objects: 1, closed: true),
"#;
