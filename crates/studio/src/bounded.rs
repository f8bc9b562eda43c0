//! What is kept as long as there is room: the last used longest.

use std::collections::HashMap;
use std::hash::Hash;

/// A table that holds no more than so many values.
#[derive(Clone, Debug)]
pub(crate) struct Bounded<K, V> {
    most: usize,
    clock: u64,
    kept: HashMap<K, (V, u64)>,
}

impl<K: Copy + Eq + Hash, V> Bounded<K, V> {
    /// Empty, with room for `most`.
    pub fn new(most: usize) -> Self {
        Self {
            most,
            clock: 0,
            kept: HashMap::new(),
        }
    }

    /// A value, which counts as used by that.
    pub fn get(&mut self, key: &K) -> Option<&V> {
        self.clock += 1;
        let (value, used) = self.kept.get_mut(key)?;
        *used = self.clock;
        Some(value)
    }

    /// A value, without counting as used.
    pub fn look(&self, key: &K) -> Option<&V> {
        self.kept.get(key).map(|(value, _)| value)
    }

    /// Keeps a value; what was not used for longest gives way.
    pub fn insert(&mut self, key: K, value: V) {
        self.clock += 1;
        self.kept.insert(key, (value, self.clock));
        while self.kept.len() > self.most {
            let oldest = self.kept.iter().min_by_key(|(_, (_, used))| *used);
            let Some(key) = oldest.map(|(key, _)| *key) else {
                return;
            };
            self.kept.remove(&key);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_used_stay() {
        let mut kept = Bounded::new(3);
        for key in 0..3 {
            kept.insert(key, key * 10);
        }
        assert_eq!(kept.get(&0), Some(&0));
        kept.insert(3, 30);
        assert_eq!(kept.look(&1), None, "used longest ago");
        assert_eq!((kept.look(&0), kept.look(&3)), (Some(&0), Some(&30)));
        kept.insert(3, 31);
        assert_eq!(kept.look(&2), Some(&20), "the same key takes no more room");
    }
}
