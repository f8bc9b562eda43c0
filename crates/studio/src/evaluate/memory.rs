use std::sync::Arc;

use bevy::platform::collections::HashMap;

use super::{Key, Made};

/// Solids that nobody shows are kept up to this many bytes, the last used longest: undo and redo
/// find them again.
const BUDGET: usize = 768 << 20;

/// What has been made, within a budget.
#[derive(Default)]
pub(super) struct Memory {
    made: HashMap<Key, (Arc<Made>, u64)>,
    bytes: usize,
    clock: u64,
}

impl Memory {
    pub fn get(&mut self, key: &Key) -> Option<Arc<Made>> {
        self.clock += 1;
        let (made, used) = self.made.get_mut(key)?;
        *used = self.clock;
        Some(made.clone())
    }

    /// Without counting as a use.
    pub fn look(&self, key: &Key) -> Option<Arc<Made>> {
        self.made.get(key).map(|(made, _)| made.clone())
    }

    pub fn insert(&mut self, key: Key, made: Arc<Made>) {
        self.clock += 1;
        self.bytes += made.bytes;
        if let Some((old, _)) = self.made.insert(key, (made, self.clock)) {
            self.bytes -= old.bytes;
        }
        while self.bytes > BUDGET {
            // What is shown is also held by its entity: dropping it here frees nothing.
            let oldest = self
                .made
                .iter()
                .filter(|(_, (m, _))| Arc::strong_count(m) == 1)
                .min_by_key(|(_, (_, used))| *used)
                .map(|(k, _)| *k);
            let Some(key) = oldest else { break };
            if let Some((old, _)) = self.made.remove(&key) {
                self.bytes -= old.bytes;
            }
        }
    }

    pub fn bytes(&self) -> usize {
        self.bytes
    }
}
