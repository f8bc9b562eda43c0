//! What files of bindings have in common, whatever device they are for: lines like `undo: ["Ctrl+Z"]`, a mistake that costs its
//! own line, and the usual bindings beside it.

use std::fmt;
use std::io::ErrorKind;
use std::path::Path;

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};

use crate::notice::Notices;

/// What is written for each name, not understood yet.
#[derive(Debug)]
pub struct Lines(pub Vec<(String, Vec<String>)>);

impl<'de> Deserialize<'de> for Lines {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Lines;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("lines like undo: [\"Ctrl+Z\"], between ( and )")
            }
            fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Lines, M::Error> {
                let mut lines = Vec::new();
                while let Some(name) = map.next_key::<String>()? {
                    lines.push((name, map.next_value()?));
                }
                Ok(Lines(lines))
            }
        }
        d.deserialize_struct("", &[], Reader)
    }
}

/// A line that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {reason}")]
pub struct LineFault {
    /// Counted from 1.
    pub line: usize,
    /// What is wrong and how it would be right.
    pub reason: String,
}

impl From<ron::error::SpannedError> for LineFault {
    fn from(error: ron::error::SpannedError) -> Self {
        Self {
            line: error.span.start.line,
            reason: error.code.to_string(),
        }
    }
}

/// The line on which a name stands, from `from` on, counted from 1. Comments are passed over.
pub fn line_of(text: &str, name: &str, from: usize) -> usize {
    let named = |line: &str| {
        let code = line.split("//").next().unwrap_or(line);
        code.split(|c: char| !c.is_alphanumeric() && !matches!(c, '_' | '/'))
            .any(|word| word == name)
    };
    let skipped = from.saturating_sub(1);
    let found = text.lines().skip(skipped).position(named);
    found.map_or(from, |i| skipped + i + 1)
}

/// Reads a person's own file by `read`, if there is one. What of it cannot be used is said in one line, with `usual` as what is
/// used there instead and `way_out` as what to do about it.
pub fn own_file<T>(
    path: &Path,
    usual: &str,
    way_out: impl FnOnce(&Path) -> String,
    read: impl FnOnce(&str) -> (T, Vec<LineFault>),
    notices: &mut Notices,
) -> Option<T> {
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == ErrorKind::NotFound => return None,
        Err(error) => {
            notices.warn(format!(
                "{} cannot be read: {error}. The usual {usual} are used.",
                path.display()
            ));
            return None;
        }
    };
    let (bound, faults) = read(&text);
    if let Some(first) = faults.first() {
        let more = match faults.len() {
            1 => String::new(),
            n => format!(" ({} more like it)", n - 1),
        };
        notices.warn(format!(
            "{}, {first}{more}. The usual {usual} are used there; {}",
            path.display(),
            way_out(path)
        ));
    }
    Some(bound)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_found_on_its_line_and_not_in_comments_or_other_names() {
        let text = "// undo\n(\n  undo_all: [],\n  undo: [],\n)\nundo";
        assert_eq!(line_of(text, "undo", 1), 4);
        assert_eq!(line_of(text, "undo", 5), 6);
        assert_eq!(line_of(text, "redo", 2), 2);
        assert_eq!(line_of("", "redo", 1), 1);
    }

    #[test]
    fn what_cannot_be_used_is_said_once_and_the_rest_is_used() {
        let folder = std::env::temp_dir().join(format!("midair-bound-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("bindings.ron");
        let mut notices = Notices::default();
        let fault = |line| LineFault {
            line,
            reason: "it is none".to_owned(),
        };
        let read = |_: &str| (7, vec![fault(2), fault(3)]);
        let none = own_file(&file, "keys", |_| String::new(), read, &mut notices);
        assert_eq!((none, notices.warnings().len()), (None, 0));
        std::fs::write(&file, "()").unwrap();
        let way_out = |_: &Path| "correct the line.".to_owned();
        let some = own_file(&file, "keys", way_out, read, &mut notices);
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(some, Some(7));
        let said = notices.warnings().join("\n");
        assert!(
            said.ends_with(
                "bindings.ron, line 2: it is none (1 more like it). The usual keys are used there; correct the line."
            ),
            "{said}"
        );
    }
}
