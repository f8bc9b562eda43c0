use std::ops::RangeInclusive;

use super::MaterialInfo;

/// A number that a person sets of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Dial {
    /// Its name in the file and in documents: `dial.speed` in WGSL.
    pub id: String,
    /// What people read.
    pub name: String,
    /// The least it can be.
    pub least: f32,
    /// The most.
    pub most: f32,
    /// What it is where nothing was set.
    pub usual: f32,
}

impl Dial {
    /// A number within its bounds; the usual one for what is none.
    pub fn bound(&self, value: f32) -> f32 {
        if value.is_finite() {
            value.clamp(self.least, self.most)
        } else {
            self.usual
        }
    }

    /// What it can be.
    pub fn range(&self) -> RangeInclusive<f32> {
        self.least..=self.most
    }
}

/// The most dials of one material.
pub const MOST_DIALS: usize = 8;

/// A head that is not one: the line, from 1, and why.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {why}")]
pub struct HeadFault {
    /// In the file, from 1.
    pub line: usize,
    /// What is wrong with it and what it should be.
    pub why: String,
}

impl MaterialInfo {
    /// Reads the head of a material that is written in WGSL, the lines that begin with `//!`:
    ///
    /// ```text
    /// //! name: Jelly
    /// //! about: Wobbles as if it had been touched
    /// //! colour: #6fcf97
    /// //! roughness: 0.2
    /// //! metallic: 0
    /// //! clear: 0.1
    /// //! dial speed: 0 to 4, usually 1, Speed
    /// ```
    ///
    /// A name is all that is needed. The WGSL itself is not looked at here.
    ///
    /// # Errors
    ///
    /// [`HeadFault`] with the line.
    pub fn read(id: &str, text: &str) -> Result<Self, HeadFault> {
        let mut info = Self::plain(id, "", 0.6, 0.0, 0.0);
        info.wgsl = Some(text.to_owned());
        for (at, line) in text.lines().enumerate() {
            let Some(head) = line.trim_start().strip_prefix("//!") else {
                continue;
            };
            let fault = |why: String| HeadFault { line: at + 1, why };
            let (key, value) = head.split_once(':').ok_or_else(|| {
                fault("a line of the head is a word, a colon and what it is".to_owned())
            })?;
            let (key, value) = (key.trim(), value.trim());
            let part = || {
                let number = value.parse::<f32>().ok();
                number
                    .filter(|n| (0.0..=1.0).contains(n))
                    .ok_or_else(|| fault(format!("{key} is a number from 0 to 1, not \"{value}\"")))
            };
            match key {
                "name" => info.name = value.to_owned(),
                "about" => info.about = value.to_owned(),
                "roughness" => info.roughness = part()?,
                "metallic" => info.metallic = part()?,
                "clear" => info.clear = part()?,
                "colour" => {
                    let colour = colour(value).ok_or_else(|| {
                        fault(format!(
                            "\"{value}\" is no colour; write six digits: #c04030"
                        ))
                    })?;
                    info.colour = Some(colour);
                }
                _ => {
                    let name = key.strip_prefix("dial ").ok_or_else(|| {
                        fault(format!(
                            "\"{key}\" is none of name, about, colour, roughness, metallic, clear and dial"
                        ))
                    })?;
                    let dial = dial(name.trim(), value).map_err(fault)?;
                    if info.dials.iter().any(|d| d.id == dial.id) {
                        return Err(fault(format!("there are two dials {}", dial.id)));
                    }
                    if info.dials.len() == MOST_DIALS {
                        return Err(fault(format!("a material has {MOST_DIALS} dials at most")));
                    }
                    info.dials.push(dial);
                }
            }
        }
        if info.name.is_empty() {
            return Err(HeadFault {
                line: 1,
                why: "a material begins with its name: //! name: Jelly".to_owned(),
            });
        }
        Ok(info)
    }
}

/// `0 to 4, usually 1, Speed`
fn dial(id: &str, value: &str) -> Result<Dial, String> {
    let good = id.starts_with(|c: char| c.is_ascii_lowercase())
        && id
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
        && !id.starts_with("midair");
    if !good {
        return Err(format!(
            "\"{id}\" cannot name a dial: it is small letters, digits and _"
        ));
    }
    let read = || {
        let mut parts = value.splitn(3, ',').map(str::trim);
        let (least, most) = parts.next()?.split_once("to")?;
        let usual = parts.next()?.strip_prefix("usually")?;
        let number = |text: &str| text.trim().parse::<f32>().ok().filter(|n| n.is_finite());
        let (least, most, usual) = (number(least)?, number(most)?, number(usual)?);
        let name = parts.next().filter(|n| !n.is_empty()).unwrap_or(id);
        (least < most && (least..=most).contains(&usual)).then(|| Dial {
            id: id.to_owned(),
            name: name.to_owned(),
            least,
            most,
            usual,
        })
    };
    read().ok_or_else(|| {
        format!("a dial is written as \"0 to 4, usually 1, Speed\", not \"{value}\"")
    })
}

fn colour(text: &str) -> Option<[u8; 3]> {
    let digits = text
        .strip_prefix('#')
        .filter(|d| d.len() == 6 && d.is_ascii())?;
    let part = |i: usize| u8::from_str_radix(digits.get(i..i + 2)?, 16).ok();
    Some([part(0)?, part(2)?, part(4)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_head_is_read() {
        let text = "//! name: Moss\n//! about: Green\n//! colour: #336622\n//! clear: 0.25\n\
                    //! dial speed: -1 to 4, usually 0.5, How fast\n//! dial b: 0 to 1, usually 1\nfn a() {}\n";
        let info = MaterialInfo::read("moss", text).unwrap();
        assert_eq!((info.name.as_str(), info.clear), ("Moss", 0.25));
        assert_eq!(info.dials[0].name, "How fast");
        assert_eq!((info.dials[0].least, info.dials[0].most), (-1.0, 4.0));
        assert_eq!(
            (info.dials[1].name.as_str(), info.dials[1].usual),
            ("b", 1.0)
        );
        assert_eq!(info.wgsl.as_deref(), Some(text));
    }

    #[test]
    fn a_fault_is_named_with_its_line() {
        let fault = |text: &str| MaterialInfo::read("moss", text).unwrap_err().to_string();
        for (text, says) in [
            ("fn a() {}", "line 1: a material begins with its name"),
            ("//! name: A\n//! what", "line 2: a line of the head"),
            ("//! name: A\n//! shine: 1", "line 2: \"shine\" is none"),
            (
                "//! name: A\n\n//! roughness: 2",
                "line 3: roughness is a number",
            ),
            (
                "//! name: A\n//! colour: red",
                "line 2: \"red\" is no colour",
            ),
            (
                "//! name: A\n//! colour: #é3333",
                "line 2: \"#é3333\" is no colour",
            ),
            (
                "//! name: A\n//! dial Speed: 0 to 1, usually 0",
                "line 2: \"Speed\"",
            ),
            (
                "//! name: A\n//! dial a: 1 to 0, usually 0",
                "line 2: a dial is written",
            ),
            (
                "//! name: A\n//! dial a: 0 to 1, usually NaN",
                "line 2: a dial is written",
            ),
            (
                "//! name: A\n//! dial a: 0 to 1, usually 0\n//! dial a: 0 to 1, usually 0",
                "line 3: there are two dials a",
            ),
        ] {
            assert!(fault(text).starts_with(says), "{text}: {}", fault(text));
        }
        let many: String = (0..9)
            .map(|i| format!("//! dial a{i}: 0 to 1, usually 0\n"))
            .collect();
        assert!(fault(&format!("//! name: A\n{many}")).contains("8 dials at most"));
    }
}
