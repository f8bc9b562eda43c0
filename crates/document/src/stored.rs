use std::collections::BTreeMap;
use std::sync::Arc;

use midair_field::Op;
use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};

use crate::recipes::{RecipeIndex, RecipeTable, TableError, look_up};
use crate::{Document, Group, GroupId, Layer, LayerId, Object, ObjectId};

/// The version of `document.ron` that this crate writes, and the newest it reads.
pub const FORMAT: u32 = 1;

/// A document as it is written: recipes in a list, everything else as it is.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Stored {
    format: u32,
    #[serde(default = "step")]
    step: f32,
    next_id: u64,
    layers: BTreeMap<LayerId, Layer>,
    #[serde(default)]
    groups: BTreeMap<GroupId, Group>,
    #[serde(default)]
    recipes: RecipeTable,
    objects: BTreeMap<ObjectId, Object<RecipeIndex>>,
    #[serde(default)]
    pending: Vec<(ObjectId, Op)>,
}

fn step() -> f32 {
    0.01
}

impl From<Document> for Stored {
    fn from(document: Document) -> Self {
        Self::from(&document)
    }
}

impl From<&Document> for Stored {
    fn from(document: &Document) -> Self {
        let mut recipes = RecipeTable::default();
        let mut objects = BTreeMap::new();
        for (id, object) in document.objects() {
            let Ok(stored) = object.map(&mut |r| Ok::<_, Never>(recipes.enter(r)));
            objects.insert(id, stored);
        }
        Self {
            format: FORMAT,
            step: document.step,
            next_id: document.next_id,
            layers: (*document.layers).clone(),
            groups: (*document.groups).clone(),
            recipes,
            objects,
            pending: document.pending.to_vec(),
        }
    }
}

pub(crate) type Never = std::convert::Infallible;

impl TryFrom<Stored> for Document {
    type Error = TextError;

    fn try_from(stored: Stored) -> Result<Self, TextError> {
        if stored.format > FORMAT {
            return Err(TextError::Newer(stored.format));
        }
        let recipes = stored.recipes.build()?;
        let mut objects = BTreeMap::new();
        for (id, object) in stored.objects {
            let object = object.map(&mut |&at| look_up(&recipes, at))?;
            objects.insert(id, Arc::new(object));
        }
        let document = Self {
            step: stored.step,
            next_id: stored.next_id,
            objects: Arc::new(objects),
            layers: Arc::new(stored.layers),
            groups: Arc::new(stored.groups),
            pending: Arc::new(stored.pending),
        };
        match document.check().into_iter().next() {
            Some(fault) => Err(TextError::Unsound(fault)),
            None => Ok(document),
        }
    }
}

/// Why a text is no document.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TextError {
    /// Written by a newer version.
    #[error("was written by a newer Midair (format {0}; this one reads up to {FORMAT})")]
    Newer(u32),
    /// Not RON, or not a document.
    #[error("line {line}, column {column}: {reason}")]
    Syntax {
        /// From 1.
        line: usize,
        /// From 1.
        column: usize,
        /// What was expected there.
        reason: String,
    },
    /// A list of recipes that cannot be put together.
    #[error(transparent)]
    Recipes(#[from] TableError),
    /// Read, but not sound: the first of [`Document::check`].
    #[error("{0}")]
    Unsound(String),
}

impl Document {
    /// The document as readable text: RON, the version first. Equal documents give equal bytes.
    pub fn to_ron(&self) -> String {
        let config = PrettyConfig::new()
            .depth_limit(3)
            .indentor("  ")
            .new_line("\n");
        // Writing to a string cannot fail, and nothing here refuses to be serialised.
        let mut text = ron::ser::to_string_pretty(&Stored::from(self), config).unwrap_or_default();
        text.push('\n');
        text
    }

    /// Reads what [`Document::to_ron`] wrote. Also returns the names of fields that this version
    /// does not know and would not write again.
    ///
    /// # Errors
    /// [`TextError`] where the text is no sound document.
    pub fn from_ron(text: &str) -> Result<(Self, Vec<String>), TextError> {
        if let Some(format) = version(text).filter(|&v| v > FORMAT) {
            return Err(TextError::Newer(format));
        }
        let mut unknown = Vec::new();
        let stored: Stored = read(text, |field| {
            if unknown.len() < 8 {
                unknown.push(crate::check::one_line(&field));
            }
        })?;
        Ok((Self::try_from(stored)?, unknown))
    }
}

fn read<T: for<'de> Deserialize<'de>>(
    text: &str,
    mut unknown: impl FnMut(String),
) -> Result<T, TextError> {
    let syntax = |e: ron::error::SpannedError| TextError::Syntax {
        line: e.span.start.line,
        column: e.span.start.col,
        reason: match e.code {
            // The library's own words are meant for programmers.
            ron::Error::ExceededRecursionLimit => "nested too deeply".into(),
            code => crate::check::one_line(&code.to_string()),
        },
    };
    let mut ron = ron::Deserializer::from_str(text).map_err(syntax)?;
    let value = serde_ignored::deserialize(&mut ron, |path| unknown(path.to_string()))
        .and_then(|value| ron.end().map(|()| value));
    value.map_err(|e| syntax(ron.span_error(e)))
}

/// The number after `format:`, which stands first; found even where the rest cannot be read.
fn version(text: &str) -> Option<u32> {
    let mut rest = text.trim_start_matches('\u{feff}').trim_start();
    while let Some(comment) = rest.strip_prefix("//") {
        rest = comment.split_once('\n')?.1.trim_start();
    }
    let rest = rest.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_');
    let rest = rest.trim_start().strip_prefix('(')?.trim_start();
    let rest = rest.strip_prefix("format")?.trim_start();
    let rest = rest.strip_prefix(':')?.trim_start();
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    if digits.is_empty() {
        return None;
    }
    Some(digits.parse().unwrap_or(u32::MAX))
}
