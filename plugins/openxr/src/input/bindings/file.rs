//! Tables in a file: `{ "valve/index_controller": (undo: ["off a/click"]) }`.

use std::collections::BTreeMap;

use midair_studio::bound::{LineFault, Lines, line_of};
use midair_studio::hands::Side;

use super::{Control, Kind, PROFILES, Part, Place, Profile};

/// What one file says of each profile.
pub(super) type Tables = BTreeMap<&'static str, BTreeMap<Control, Vec<Place>>>;

/// What a file says, as far as it can be understood, and what cannot.
pub(super) fn read(text: &str) -> (Tables, Vec<LineFault>) {
    let mut tables = Tables::new();
    let mut faults = Vec::new();
    let profiles = match ron::from_str::<BTreeMap<String, Lines>>(text) {
        Ok(profiles) => profiles,
        Err(error) => {
            faults.push(error.into());
            return (tables, faults);
        }
    };
    for (id, lines) in profiles {
        let begins = line_of(text, &id, 1);
        let Some(profile) = Profile::named(&id) else {
            let known: Vec<_> = PROFILES.iter().map(|p| p.id).collect();
            faults.push(LineFault {
                line: begins,
                reason: format!(
                    "there is no controller \"{id}\"; those are {}",
                    known.join(", ")
                ),
            });
            continue;
        };
        let table = tables.entry(profile.id).or_default();
        for (name, texts) in lines.0 {
            match understood(profile, &name, &texts) {
                Ok((control, places)) => {
                    table.insert(control, places);
                }
                Err(reason) => faults.push(LineFault {
                    line: line_of(text, &name, begins),
                    reason,
                }),
            }
        }
    }
    faults.sort_by_key(|f| f.line);
    (tables, faults)
}

fn understood(
    profile: &Profile,
    name: &str,
    texts: &[String],
) -> Result<(Control, Vec<Place>), String> {
    let Some(control) = Control::named(name) else {
        let all: Vec<_> = Control::ALL.iter().map(|c| c.name()).collect();
        return Err(format!(
            "there is nothing called \"{name}\"; it can be {}",
            all.join(", ")
        ));
    };
    let mut places = Vec::new();
    for text in texts {
        let place = Place::parse(text)?;
        match (&place.part, control.kind()) {
            (Part::Component(component), kind) => {
                if kind == Kind::Choice {
                    return Err(format!(
                        "{name} is read from a stick or a pad: write \"either stick\" or \"either pad\""
                    ));
                }
                // One that only one hand has may still be meant for whichever hand leads.
                let had = Side::BOTH.iter().any(|&s| profile.has(s, component));
                if !had {
                    let mut all: Vec<_> = Side::BOTH
                        .iter()
                        .flat_map(|&s| profile.components(s))
                        .collect();
                    all.sort_unstable();
                    all.dedup();
                    return Err(format!(
                        "{} has no \"{component}\"; it has {}",
                        profile.name,
                        all.join(", ")
                    ));
                }
                let plane = matches!(component.as_str(), "thumbstick" | "trackpad");
                if plane != (kind == Kind::Plane) {
                    return Err(format!(
                        "\"{component}\" does not fit {name}: a stick or a pad is for stick and pad, everything else takes \
                         buttons"
                    ));
                }
            }
            (Part::Arm(..), Kind::Button) | (Part::All(_), Kind::Choice) => {}
            _ => {
                return Err(format!("\"{text}\" does not fit {name}"));
            }
        }
        places.push(place);
    }
    Ok((control, places))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mistake_is_named_with_its_line_and_costs_only_its_own_line() {
        let text = "{\n  \"valve/index_controller\": (\n    undo: [\"off menu/click\"],\n    redo: [\"off b/click\"],\n    \
                    rdo: [\"main a/click\"],\n    save: [\"a/click\"],\n    act: [\"either thumbstick\"],\n  ),\n  \
                    \"valve/knuckles\": (),\n}";
        let (tables, faults) = read(text);
        let lines: Vec<_> = faults.iter().map(|f| f.line).collect();
        assert_eq!(lines, [3, 5, 6, 7, 9], "{faults:?}");
        let index = &tables["valve/index_controller"];
        assert_eq!(index.len(), 1);
        assert!(index.contains_key(&Control::Redo));
    }

    #[test]
    fn what_is_no_ron_at_all_is_one_fault() {
        for text in [
            "",
            "{",
            "undo: 1",
            "{\"valve/index_controller\": [1]}",
            "\u{0}",
        ] {
            let (tables, faults) = read(text);
            assert!(tables.is_empty(), "{text:?}");
            assert_eq!(faults.len(), 1, "{text:?}");
        }
    }
}
