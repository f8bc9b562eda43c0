use midair_document::Colour;
use serde::{Deserialize, Serialize};

/// A look that was kept: a colour, and the material it was kept with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Swatch {
    /// Its colour.
    pub colour: Colour,
    /// The material's id; that of what it is given to stays where there is none.
    #[serde(default)]
    pub material: Option<String>,
}

/// A palette of a person's own.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OwnPalette {
    /// What it is called.
    pub name: String,
    /// Its looks, in the order in which they were kept.
    #[serde(default)]
    pub swatches: Vec<Swatch>,
}

/// The palettes a person has made.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct PaletteSettings {
    /// They themselves.
    pub own: Vec<OwnPalette>,
    /// Which is shown: 0 for the usual one, 1 for the first of a person's own, and so on.
    pub shown: usize,
}

/// The most palettes, and the most looks in one: what can be found again at a glance.
const PALETTES: usize = 32;
const SWATCHES: usize = 64;
/// The longest name, in letters.
const NAME: usize = 40;

impl PaletteSettings {
    /// The palette that is shown, where it is one of a person's own.
    pub fn current(&self) -> Option<&OwnPalette> {
        self.own.get(self.shown.checked_sub(1)?)
    }

    /// With one look more in the palette that is shown; the usual one stays as it is, a new one begins
    /// beside it. `None` where it is there already, or where there is no more room.
    pub fn with(&self, swatch: Swatch) -> Option<Self> {
        let mut next = if self.current().is_some() {
            self.clone()
        } else {
            self.with_palette()?
        };
        let at = next.shown.checked_sub(1)?;
        let palette = next.own.get_mut(at)?;
        if palette.swatches.contains(&swatch) || palette.swatches.len() >= SWATCHES {
            return None;
        }
        palette.swatches.push(swatch);
        Some(next)
    }

    /// Without one look of the palette that is shown.
    pub fn without(&self, at: usize) -> Option<Self> {
        let mut next = self.clone();
        let palette = next.own.get_mut(self.shown.checked_sub(1)?)?;
        (at < palette.swatches.len()).then(|| palette.swatches.remove(at))?;
        Some(next)
    }

    /// With one palette more, which is shown then.
    pub fn with_palette(&self) -> Option<Self> {
        if self.own.len() >= PALETTES {
            return None;
        }
        let mut next = self.clone();
        let taken = |name: &str| self.own.iter().any(|p| p.name == name);
        let name = (1..).map(|n| match n {
            1 => "Mine".to_owned(),
            n => format!("Mine {n}"),
        });
        next.own.push(OwnPalette {
            name: name.into_iter().find(|n| !taken(n))?,
            swatches: Vec::new(),
        });
        next.shown = next.own.len();
        Some(next)
    }

    /// Without the palette that is shown.
    pub fn without_palette(&self) -> Option<Self> {
        let at = self
            .shown
            .checked_sub(1)
            .filter(|at| *at < self.own.len())?;
        let mut next = self.clone();
        next.own.remove(at);
        next.shown = at.min(next.own.len());
        Some(next)
    }

    /// With another name for the palette that is shown; `None` where it is none.
    pub fn renamed(&self, name: &str) -> Option<Self> {
        let name: String = name.trim().chars().take(NAME).collect();
        let mut next = self.clone();
        let palette = next.own.get_mut(self.shown.checked_sub(1)?)?;
        if name.is_empty() || palette.name == name {
            return None;
        }
        palette.name = name;
        Some(next)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn red() -> Swatch {
        Swatch {
            colour: Colour([200, 10, 10]),
            material: Some("metal".into()),
        }
    }

    #[test]
    fn looks_come_go_and_are_kept_once() {
        let kept = PaletteSettings::default().with(red()).unwrap();
        assert_eq!(kept.current().unwrap().name, "Mine");
        assert_eq!(kept.current().unwrap().swatches, [red()]);
        assert_eq!(kept.with(red()), None, "it is there already");
        assert_eq!(kept.without(0).unwrap().current().unwrap().swatches, []);
        assert_eq!(kept.without(1), None);
        let two = kept.with_palette().unwrap();
        assert_eq!((two.own.len(), two.shown), (2, 2));
        assert_eq!(two.current().unwrap().name, "Mine 2");
        let named = two.renamed("  Ceramics ").unwrap();
        assert_eq!(named.current().unwrap().name, "Ceramics");
        assert_eq!(named.renamed("  "), None);
        assert_eq!(named.without_palette().unwrap(), kept);
        assert_eq!(PaletteSettings::default().without_palette(), None);
    }

    #[test]
    fn there_is_an_end_to_them() {
        let mut all = PaletteSettings::default();
        while let Some(next) = all.with_palette() {
            all = next;
        }
        assert_eq!(all.own.len(), PALETTES);
        for i in 0..=u8::MAX {
            let colour = Colour([i, 0, 0]);
            all = all
                .with(Swatch {
                    colour,
                    material: None,
                })
                .unwrap_or(all);
        }
        assert_eq!(all.current().unwrap().swatches.len(), SWATCHES);
        let wild = PaletteSettings { shown: 99, ..all };
        assert_eq!((wild.current(), wild.without_palette()), (None, None));
    }
}
