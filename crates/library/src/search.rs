use crate::component::Component;
use crate::library::Library;

impl Library {
    /// The components a query may mean, best first; all of them for an empty query. Every word
    /// must be found in the name, the tags, the category or the id: whole, as the beginning, inside, or with a
    /// letter or two mistyped.
    pub fn search(&self, query: &str) -> Vec<&Component> {
        let wanted: Vec<String> = words(query).collect();
        let mut found: Vec<(u32, &Component)> = self
            .components()
            .iter()
            .filter_map(|c| Some((score(c, &wanted)?, c)))
            .collect();
        // Of equals the plainest name first; stable, so that the rest stay in the order of the shelf.
        found.sort_by_key(|&(s, c)| (std::cmp::Reverse(s), words(&c.name).count()));
        found.into_iter().map(|(_, c)| c).collect()
    }
}

fn words(text: &str) -> impl Iterator<Item = String> + '_ {
    text.split(|c: char| !c.is_alphanumeric())
        .filter(|w| !w.is_empty())
        .map(str::to_lowercase)
}

/// How well a component fits all words: higher is better, `None` when a word is not found.
fn score(c: &Component, query: &[String]) -> Option<u32> {
    let name: Vec<String> = words(&c.name).collect();
    let whole = u32::from(!query.is_empty() && name == query) * 100;
    let tags: Vec<String> = c.tags.iter().flat_map(|t| words(t)).collect();
    let rest: Vec<String> = words(&c.id).chain(words(&c.category)).collect();
    let of = |q: &String| {
        let best = |ws: &[String]| ws.iter().map(|w| likeness(q, w)).max().unwrap_or(0);
        let s = (best(&name) * 4).max(best(&tags) * 3).max(best(&rest) * 2);
        (s > 0).then_some(s)
    };
    query.iter().map(of).sum::<Option<u32>>().map(|s| s + whole)
}

fn likeness(query: &str, word: &str) -> u32 {
    let slips = match query.chars().count() {
        0..4 => 0,
        4..7 => 1,
        _ => 2,
    };
    if query == word {
        8
    } else if word.starts_with(query) {
        6
    } else if slips > 0 && word.contains(query) {
        4
    } else if slips > 0 && strsim::osa_distance(query, word) <= slips {
        2
    } else {
        0
    }
}
