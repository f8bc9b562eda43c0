use std::io;

use serde::{Deserialize, Serialize};

use crate::recipes::{RecipeIndex, RecipeTable, look_up};
use crate::stored::Never;
use crate::{Document, Edit};

/// What happened to the document.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Change {
    /// A transaction.
    Commit,
    /// A step back.
    Undo,
    /// A step forth.
    Redo,
}

/// The payload of one frame.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Record {
    /// Where all that follows starts from.
    Base {
        document: Document,
        origin: Option<String>,
        /// Whether the base itself is work that no file holds.
        unsaved: bool,
    },
    /// Edits that take the document from the frame before to this one. A step back or forth
    /// carries its edits too, so that it can be read without the step it reverses.
    Change {
        change: Change,
        name: String,
        recipes: RecipeTable,
        edits: Vec<Edit<RecipeIndex>>,
    },
    /// The document as it is here is safe in a file.
    Saved { path: String },
}

impl Record {
    pub(super) fn change(change: Change, name: &str, edits: &[Edit]) -> Self {
        let mut recipes = RecipeTable::default();
        let edits = edits
            .iter()
            .map(|edit| {
                let Ok(stored) = edit.map(&mut |r| Ok::<_, Never>(recipes.enter(r)));
                stored
            })
            .collect();
        Self::Change {
            change,
            name: name.into(),
            recipes,
            edits,
        }
    }

    pub(super) fn to_bytes(&self) -> io::Result<Vec<u8>> {
        ron::to_string(self)
            .map(String::into_bytes)
            .map_err(io::Error::other)
    }

    pub(super) fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        ron::de::from_bytes(bytes).map_err(|e| crate::check::one_line(&e.code.to_string()))
    }
}

/// The edits of a change with their recipes put together.
pub(super) fn edits(
    recipes: RecipeTable,
    edits: &[Edit<RecipeIndex>],
) -> Result<Vec<Edit>, String> {
    let recipes = recipes.build().map_err(|e| e.to_string())?;
    edits
        .iter()
        .map(|edit| edit.map(&mut |&at| look_up(&recipes, at)))
        .collect::<Result<_, _>>()
        .map_err(|e| e.to_string())
}
