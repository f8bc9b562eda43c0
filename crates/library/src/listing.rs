use std::fmt::Write as _;

use serde::Serialize;

use crate::component::{Component, Source};
use crate::library::Library;

/// One line of `midair library --json`. Fields may be added, none renamed.
#[derive(Serialize)]
struct Entry<'a> {
    id: &'a str,
    name: &'a str,
    category: &'a str,
    tags: &'a [String],
    /// Side lengths in metres.
    size: [f32; 3],
    /// `bundled` or `user`.
    source: &'static str,
    /// The user's file.
    file: Option<String>,
    missing: bool,
    recipe: String,
}

impl Library {
    /// What `midair library --json` prints: a list of `{id, name, category, tags, size, source,
    /// file, missing, recipe}`, `size` in metres, `recipe` the recipe's hash.
    pub fn to_json(&self) -> String {
        let entry = |c: &Component| -> serde_json::Value {
            let entry = |file: Option<String>| Entry {
                id: &c.id,
                name: &c.name,
                category: &c.category,
                tags: &c.tags,
                size: c.recipe.bounds().size().to_array(),
                source: if file.is_some() { "user" } else { "bundled" },
                file,
                missing: c.missing,
                recipe: format!("{:?}", c.recipe.hash()),
            };
            let file = match &c.source {
                Source::Bundled => None,
                Source::User(path) => Some(path.display().to_string()),
            };
            serde_json::to_value(entry(file)).unwrap_or_default()
        };
        let all = serde_json::Value::Array(self.components().iter().map(entry).collect());
        format!("{all:#}")
    }

    /// What `midair library` prints: a heading for each category, a line for each component with
    /// its id, its name and its size in metres.
    pub fn to_text(&self) -> String {
        let width = |of: fn(&Component) -> &str| {
            let chars = |c| of(c).chars().count();
            self.components().iter().map(chars).max().unwrap_or(0)
        };
        let (ids, names) = (width(|c| &c.id), width(|c| &c.name));
        let mut text = String::new();
        for (category, components) in self.categories() {
            let gap = if text.is_empty() { "" } else { "\n" };
            let _ = writeln!(text, "{gap}{category} ({})", components.len());
            for c in components {
                let s = c.recipe.bounds().size();
                let _ = write!(
                    text,
                    "  {:ids$}  {:names$}  {:.2} × {:.2} × {:.2} m",
                    c.id, c.name, s.x, s.y, s.z
                );
                if let Source::User(path) = &c.source {
                    let _ = write!(text, "  {}", path.display());
                }
                let _ = writeln!(text, "{}", if c.missing { "  (mesh gone)" } else { "" });
            }
        }
        text
    }
}
