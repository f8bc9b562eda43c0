use std::path::PathBuf;

use midair_field::{Node, Recipe};
use serde::{Deserialize, Serialize};

/// The categories Midair itself uses, in the order of the shelf. Others follow by name, and
/// [`OWN`] comes last.
pub const CATEGORIES: [&str; 6] = ["Solids", "Brushes", "Chair", "Cup", "Numerals", "Letters"];

/// The category of what the user imports or saves.
pub const OWN: &str = "Own";

/// A solid on the shelf.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its stable name, as `solid/cube`: saved in documents and sessions, never changed.
    pub id: String,
    /// What the panel shows.
    pub name: String,
    /// Where on the shelf it stands.
    pub category: String,
    /// Other words it is found by.
    pub tags: Vec<String>,
    /// What it is, about the origin, in metres.
    pub recipe: Recipe,
    /// Where it came from.
    pub source: Source,
    /// Whether a mesh it is made of is gone: it is shown but cannot be placed.
    pub missing: bool,
}

/// Where a component came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// From Midair's own shelf.
    Bundled,
    /// From this file of the user's.
    User(PathBuf),
}

impl Component {
    /// The recipe of an object made from it: the same solid, remembering which component it was.
    pub fn placed(&self) -> Recipe {
        Recipe::new(Node::Component {
            id: self.id.clone(),
            recipe: self.recipe.clone(),
        })
    }

    pub(crate) fn from_file(file: ComponentFile, source: Source) -> Self {
        Self {
            id: file.id,
            name: file.name,
            category: file.category,
            tags: file.tags,
            recipe: file.recipe,
            source,
            missing: false,
        }
    }

    pub(crate) fn to_file(&self) -> ComponentFile {
        ComponentFile {
            id: self.id.clone(),
            name: self.name.clone(),
            category: self.category.clone(),
            tags: self.tags.clone(),
            recipe: self.recipe.clone(),
        }
    }
}

/// A component as its file spells it. `assets/components/solid/cube.ron` documents the fields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ComponentFile {
    pub id: String,
    pub name: String,
    #[serde(default = "own")]
    pub category: String,
    #[serde(default)]
    pub tags: Vec<String>,
    pub recipe: Recipe,
}

fn own() -> String {
    OWN.to_owned()
}

/// Where a category stands: the known ones, the others by name, the user's own.
pub(crate) fn category_rank(category: &str) -> (usize, &str) {
    match CATEGORIES.iter().position(|&c| c == category) {
        Some(i) => (i, ""),
        None if category == OWN => (CATEGORIES.len() + 1, ""),
        None => (CATEGORIES.len(), category),
    }
}
