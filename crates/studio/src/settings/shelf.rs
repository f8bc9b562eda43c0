use serde::{Deserialize, Serialize};

/// What a person likes and used of the library.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ShelfSettings {
    /// Ids of components with a star, in the order they got it.
    pub favourites: Vec<String>,
    /// Ids of what was placed last, the latest first.
    pub recent: Vec<String>,
    /// Points along each side of a tile.
    pub tile: f32,
}

impl Default for ShelfSettings {
    fn default() -> Self {
        Self {
            favourites: Vec::new(),
            recent: Vec::new(),
            tile: 76.0,
        }
    }
}

/// How many are remembered.
const RECENT: usize = 12;

impl ShelfSettings {
    /// A component was placed.
    pub(crate) fn note(&mut self, id: &str) {
        self.recent.retain(|r| r != id);
        self.recent.insert(0, id.to_owned());
        self.recent.truncate(RECENT);
    }

    /// The favourites with one more, or without it where it was one.
    pub(crate) fn toggled(&self, id: &str) -> Vec<String> {
        let mut next = self.favourites.clone();
        match next.iter().position(|f| f == id) {
            Some(at) => {
                next.remove(at);
            }
            None => next.push(id.to_owned()),
        }
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_comes_first_and_a_star_comes_and_goes() {
        let mut shelf = ShelfSettings::default();
        for id in ["a", "b", "a"] {
            shelf.note(id);
        }
        assert_eq!(shelf.recent, ["a", "b"]);
        shelf.favourites = shelf.toggled("a");
        shelf.favourites = shelf.toggled("b");
        assert_eq!(shelf.toggled("a"), ["b"]);
    }
}
