use serde::{Deserialize, Serialize};

use crate::Report;

/// What a session claims to be true at a point; what it leaves out is not checked. Written
/// `Expect(objects: 1, closed: true)`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Expect", deny_unknown_fields, default)]
pub struct Expectation {
    /// How many objects the document holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub objects: Option<usize>,
    /// Whether every solid's surface is closed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closed: Option<bool>,
    /// The volume of all solids together, in m³, between these two.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub volume: Option<(f64, f64)>,
    /// How many edits were made so far.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edits: Option<usize>,
    /// How many steps can be taken back.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undo: Option<usize>,
    /// How many steps can be taken again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub redo: Option<usize>,
    /// How many warnings were given so far.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub warnings: Option<usize>,
}

impl Expectation {
    /// The first claim that does not hold, as "objects: 2 instead of 1".
    pub fn failure(&self, is: &Report) -> Option<String> {
        let count = |name: &str, want: Option<usize>, is: usize| {
            want.filter(|&w| w != is)
                .map(|w| format!("{name}: {is} instead of {w}"))
        };
        count("objects", self.objects, is.objects.len())
            .or_else(|| {
                let want = self.closed?;
                let odd = is
                    .objects
                    .iter()
                    .find(|o| o.closed.is_some_and(|c| c != want))?;
                let is = if want { "not closed" } else { "closed" };
                Some(format!("`{}` is {is}", odd.name))
            })
            .or_else(|| {
                let (low, high) = self.volume?;
                let sum: f64 = is.objects.iter().filter_map(|o| o.volume).sum();
                // A volume that is not a number is within nothing.
                let within = sum >= low && sum <= high;
                (!within).then(|| format!("volume: {sum} m³ instead of {low} to {high}"))
            })
            .or_else(|| count("edits", self.edits, is.edits))
            .or_else(|| count("undo", self.undo, is.undo))
            .or_else(|| count("redo", self.redo, is.redo))
            .or_else(|| {
                let failed = count("warnings", self.warnings, is.warnings.len())?;
                Some(match is.warnings.last() {
                    Some(last) => format!("{failed}; the last: {last}"),
                    None => failed,
                })
            })
    }
}
