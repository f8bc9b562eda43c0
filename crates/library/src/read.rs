use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use crate::check::check;
use crate::component::ComponentFile;

/// No component file is larger; the largest bundled one has 6 kB.
const LARGEST_FILE: u64 = 4 << 20;
/// How deep below a folder files are looked for: a link back to a parent must end somewhere.
const DEEPEST: usize = 4;
/// How many files are read from one folder.
const MOST_FILES: usize = 20_000;

/// Why something on the shelf is not as its files say. One line each.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Warning {
    /// A file that could not be read from the disk.
    #[error("{}: cannot be read: {reason}", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        reason: String,
    },
    /// A file that is not a component.
    #[error("{}:{line}: not a component: {reason}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// Where in it, from 1.
        line: usize,
        /// What is wrong there.
        reason: String,
    },
    /// Two of the user's files claim one id; the first in the order of their names is used.
    #[error("{}: the id \"{id}\" is already that of {}; give it another", path.display(), first.display())]
    Duplicate {
        /// The file that is passed over.
        path: PathBuf,
        /// The id both have.
        id: String,
        /// The file that is used.
        first: PathBuf,
    },
    /// A mesh that a component is made of is not in the library.
    #[error("{}: the mesh {mesh} of \"{name}\" is gone from the library; import it again", path.display())]
    MeshGone {
        /// The component's file.
        path: PathBuf,
        /// The component's name.
        name: String,
        /// The mesh's name.
        mesh: String,
    },
}

/// Reads a component from the text of its file; on failure the line (from 1) and the reason.
pub(crate) fn parse(text: &str) -> Result<ComponentFile, (usize, String)> {
    let file: ComponentFile = ron::from_str(text).map_err(|e| {
        let reason = e.code.to_string().replace('\n', " ");
        (e.span.start.line.max(1), reason)
    })?;
    let line_of = |field: &str| {
        let at = |l: &str| l.trim_start().starts_with(field);
        text.lines().position(at).map_or(1, |i| i + 1)
    };
    for (field, value) in [
        ("id", &file.id),
        ("name", &file.name),
        ("category", &file.category),
    ] {
        if value.trim().is_empty() || value.len() > 200 || value.contains(char::is_control) {
            let reason = format!("the {field} must be between 1 and 200 characters on one line");
            return Err((line_of(field), reason));
        }
    }
    check(&file.recipe).map_err(|reason| (line_of("recipe"), reason))?;
    Ok(file)
}

/// All component files below `folder` in the order of their paths, read. A folder that does not
/// exist holds none.
pub(crate) fn read_folder(
    folder: &Path,
    warnings: &mut Vec<Warning>,
) -> Vec<(PathBuf, ComponentFile)> {
    let mut paths = Vec::new();
    walk(folder, 0, &mut paths, warnings);
    paths.sort();
    let mut found = Vec::with_capacity(paths.len());
    for path in paths {
        match parse_file(&path) {
            Ok(file) => found.push((path, file)),
            Err(w) => warnings.push(w),
        }
    }
    found
}

fn walk(folder: &Path, depth: usize, paths: &mut Vec<PathBuf>, warnings: &mut Vec<Warning>) {
    let unreadable = |reason: io::Error| Warning::Unreadable {
        path: folder.to_owned(),
        reason: reason.to_string(),
    };
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return,
        Err(e) => return warnings.push(unreadable(e)),
    };
    for entry in entries {
        let path = match entry {
            Ok(entry) => entry.path(),
            Err(e) => return warnings.push(unreadable(e)),
        };
        if path.is_dir() {
            if depth < DEEPEST {
                walk(&path, depth + 1, paths, warnings);
            }
        } else if path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("ron"))
        {
            if paths.len() >= MOST_FILES {
                return;
            }
            paths.push(path);
        }
    }
}

pub(crate) fn parse_file(path: &Path) -> Result<ComponentFile, Warning> {
    let text = read_text(path).map_err(|e| Warning::Unreadable {
        path: path.to_owned(),
        reason: e.to_string(),
    })?;
    parse(&text).map_err(|(line, reason)| Warning::Broken {
        path: path.to_owned(),
        line,
        reason,
    })
}

fn read_text(path: &Path) -> io::Result<String> {
    // Opening a pipe would wait for its writer for ever.
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::other("not a regular file"));
    }
    let mut text = String::new();
    File::open(path)?
        .take(LARGEST_FILE + 1)
        .read_to_string(&mut text)?;
    if text.len() as u64 > LARGEST_FILE {
        return Err(io::Error::other("larger than 4 MiB"));
    }
    Ok(text)
}
