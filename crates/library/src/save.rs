use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use midair_field::{Placement, Recipe};
use midair_mesh::{MeshHash, TriMesh};
use ron::ser::PrettyConfig;

use crate::check::check;
use crate::component::{Component, OWN, Source};
use crate::folders::Folders;
use crate::read::parse_file;
use crate::shelf::{MeshShelf, write_whole};

/// How many components of one name are told apart by a number.
const MOST_OF_A_NAME: usize = 10_000;

/// Why a solid could not be kept in the library.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The folder or the disk refused.
    #[error("{}: cannot be written: {reason}", path.display())]
    Unwritable {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        reason: io::Error,
    },
    /// A mesh that the solid is made of is nowhere to be found.
    #[error("the mesh {0} that it is made of is gone")]
    MeshGone(MeshHash),
    /// The solid encloses nothing or is beyond all measure.
    #[error("it cannot be a component: {0}")]
    Unsound(String),
}

/// Keeps a solid as a component of the user's own: centred on the origin, its size as it is, with
/// copies of the meshes it is made of, which `mesh` finds. Saving the same solid under the same
/// name again changes nothing.
///
/// # Errors
/// [`SaveError`]; nothing is then listed that was not before.
pub fn save(
    folders: &Folders,
    name: &str,
    recipe: &Recipe,
    mesh: &dyn Fn(&MeshHash) -> Option<Arc<TriMesh>>,
) -> Result<Component, SaveError> {
    check(recipe).map_err(SaveError::Unsound)?;
    let shelf = MeshShelf::new(folders.meshes());
    for hash in recipe.meshes() {
        if shelf.mesh(&hash).is_none() {
            let mesh = mesh(&hash).ok_or(SaveError::MeshGone(hash))?;
            shelf.store(&mesh).map_err(|reason| SaveError::Unwritable {
                path: folders.meshes(),
                reason,
            })?;
        }
    }
    write(folders, name, centred(recipe))
}

/// The same solid with the centre of its box at the origin.
fn centred(recipe: &Recipe) -> Recipe {
    let centre = recipe.bounds().centre();
    // Half a micrometre is below what the box itself promises.
    if centre.abs().max_element() < 5e-7 {
        return recipe.clone();
    }
    recipe.placed(Placement::at(-centre))
}

/// Writes a component's file under the first name that is free, or already holds the same solid.
pub(crate) fn write(folders: &Folders, name: &str, recipe: Recipe) -> Result<Component, SaveError> {
    let name = tidy(name);
    let slug = slug(&name);
    let unwritable = |path: &Path, reason| SaveError::Unwritable {
        path: path.to_owned(),
        reason,
    };
    for n in 1..=MOST_OF_A_NAME {
        let (name, slug) = match n {
            1 => (name.clone(), slug.clone()),
            n => (format!("{name} {n}"), format!("{slug}-{n}")),
        };
        let path = folders.components().join(format!("{slug}.ron"));
        let component = Component {
            id: format!("own/{slug}"),
            name,
            category: OWN.to_owned(),
            tags: Vec::new(),
            recipe: recipe.clone(),
            source: Source::User(path.clone()),
            missing: false,
        };
        if path.exists() {
            match parse_file(&path) {
                Ok(there) if there.recipe == recipe => {
                    return Ok(Component::from_file(there, Source::User(path)));
                }
                _ => continue,
            }
        }
        let text = ron::ser::to_string_pretty(&component.to_file(), PrettyConfig::new())
            .map_err(|e| unwritable(&path, io::Error::other(e)))?;
        write_whole(&path, text.as_bytes()).map_err(|e| unwritable(&path, e))?;
        return Ok(component);
    }
    let taken = io::Error::other(format!("{MOST_OF_A_NAME} components have this name"));
    Err(unwritable(&folders.components().join(slug), taken))
}

/// A name as the panel shows it: one line, at most 60 characters, never empty.
fn tidy(name: &str) -> String {
    let words: Vec<&str> = name
        .split(|c: char| c.is_whitespace() || c.is_control())
        .filter(|w| !w.is_empty())
        .collect();
    let name: String = words.join(" ").chars().take(60).collect();
    match name.trim_end() {
        "" => "Unnamed".to_owned(),
        name => name.to_owned(),
    }
}

/// A name as a file and an id spell it: lower case, words joined by dashes.
fn slug(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() { c } else { ' ' };
    let text: String = name.to_lowercase().chars().map(plain).collect();
    let slug = text.split_whitespace().collect::<Vec<_>>().join("-");
    // Some systems allow 255 bytes in a file's name, and a letter can have four.
    let slug: String = slug.chars().take(50).collect();
    if slug.is_empty() {
        "unnamed".to_owned()
    } else {
        slug
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_files() {
        assert_eq!(slug("Stanford  Bunny (1994)"), "stanford-bunny-1994");
        assert_eq!(slug("../../etc/passwd"), "etc-passwd");
        assert_eq!(slug("Ärmel №7"), "ärmel-7");
        assert_eq!(slug("…"), "unnamed");
        assert_eq!(tidy(" a\n b\u{7} "), "a b");
        assert_eq!(tidy("\n"), "Unnamed");
        assert!(slug(&"漢".repeat(500)).len() < 250);
    }
}
