//! Bindings in a file: `undo: ["Ctrl+Z", "Pad X"]`.

use std::collections::BTreeMap;
use std::fmt::Write;

use midair_studio::bound::{LineFault, Lines, line_of};

use super::{Binding, Control};

/// What a file says, as far as it can be understood, and what cannot.
pub(super) fn read(text: &str) -> (BTreeMap<Control, Vec<Binding>>, Vec<LineFault>) {
    let mut bound = BTreeMap::new();
    let mut faults = Vec::new();
    let lines = match ron::from_str::<Lines>(text) {
        Ok(lines) => lines.0,
        Err(error) => {
            faults.push(error.into());
            return (bound, faults);
        }
    };
    for (name, texts) in lines {
        let line = line_of(text, &name, 1);
        let mut fault = |reason: String| faults.push(LineFault { line, reason });
        let Some(control) = Control::named(&name) else {
            let near = nearest(&name);
            fault(format!(
                "there is no control \"{name}\"; did you mean \"{near}\"?"
            ));
            continue;
        };
        let read: Result<Vec<_>, _> = texts.iter().map(|t| Binding::parse(t)).collect();
        match read {
            Ok(bindings) => {
                let stick = |b: &&Binding| matches!(b, Binding::Stick(_));
                let unfit = bindings.iter().find(|b| stick(b) != control.is_stick());
                match unfit {
                    Some(unfit) => {
                        fault(super::BindingFault::Kind(unfit.to_string()).to_string());
                    }
                    None => {
                        bound.insert(control, bindings);
                    }
                }
            }
            Err(reason) => fault(reason.to_string()),
        }
    }
    (bound, faults)
}

/// The same as a file.
pub(super) fn write(bound: &BTreeMap<Control, Vec<Binding>>) -> String {
    let mut text = String::from(
        "// Written by Midair (Controls). What stands here takes the place of the usual keys.\n(\n",
    );
    for (control, bindings) in bound {
        let names: Vec<_> = bindings.iter().map(|b| format!("\"{b}\"")).collect();
        let _ = writeln!(text, "    {}: [{}],", control.name(), names.join(", "));
    }
    text.push_str(")\n");
    text
}

/// The control whose name is most like `name`.
fn nearest(name: &str) -> &'static str {
    let letters = |text: &str| {
        let mut letters: Vec<_> = text.bytes().collect();
        letters.sort_unstable();
        letters
    };
    let wanted = letters(name);
    let unlike = |other: &str| {
        let mut rest = letters(other);
        let mut missing = 0;
        for letter in &wanted {
            match rest.iter().position(|l| l == letter) {
                Some(at) => {
                    rest.remove(at);
                }
                None => missing += 1,
            }
        }
        missing + rest.len()
    };
    let names = Control::ALL.iter().map(|c| c.name());
    names.min_by_key(|other| unlike(other)).unwrap_or("undo")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_and_written() {
        let text = "// mine\n(\n  undo: [\"Ctrl+U\"],\n  redo: [],\n)";
        let (bound, faults) = read(text);
        assert_eq!(faults, []);
        assert_eq!(bound[&Control::Undo], [Binding::parse("Ctrl+U").unwrap()]);
        assert_eq!(bound[&Control::Redo], []);
        assert_eq!(read(&write(&bound)).0, bound);
    }

    #[test]
    fn a_mistake_is_named_with_its_line_and_costs_only_its_own_line() {
        let text = "(\n  undo: [\"Ctrl+Foo\"],\n  rdo: [\"Ctrl+R\"],\n  save: [\"F9\"],\n  act: [\"Pad Left stick\"],\n)";
        let (bound, faults) = read(text);
        assert_eq!(bound.len(), 1);
        assert!(bound.contains_key(&Control::Save));
        let lines: Vec<_> = faults.iter().map(|f| f.line).collect();
        assert_eq!(lines, [2, 3, 5]);
        assert!(faults[0].reason.contains("Ctrl+Foo"), "{}", faults[0]);
        assert!(faults[1].reason.contains("\"redo\""), "{}", faults[1]);
    }

    #[test]
    fn what_is_no_ron_at_all_is_one_fault() {
        for text in [
            "",
            "undo",
            "(undo: Ctrl+Z)",
            "(undo: [\"Z\"]",
            "{\"undo\": [\"Z\"]}",
            "\u{0}",
        ] {
            let (bound, faults) = read(text);
            assert!(bound.is_empty(), "{text:?}");
            assert_eq!(faults.len(), 1, "{text:?}");
        }
    }
}
