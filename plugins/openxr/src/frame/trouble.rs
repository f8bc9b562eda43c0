//! What the runtime refused, from whichever thread.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use bevy::prelude::*;
use bevy::render::extract_resource::ExtractResource;
use openxr::sys::Result as Code;

/// A call that the runtime refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Refusal {
    /// The function.
    pub call: &'static str,
    /// What it gave.
    pub code: Code,
}

impl Refusal {
    /// Whether nothing can be asked of this runtime any more.
    pub fn is_end(&self) -> bool {
        matches!(
            self.code,
            Code::ERROR_INSTANCE_LOST
                | Code::ERROR_SESSION_LOST
                | Code::ERROR_RUNTIME_FAILURE
                | Code::ERROR_RUNTIME_UNAVAILABLE
                | Code::ERROR_HANDLE_INVALID
        )
    }
}

/// Refusals of the frames so far that nobody has looked at; shared by both worlds.
#[derive(Resource, ExtractResource, Clone, Debug, Default)]
pub(crate) struct Trouble {
    list: Arc<Mutex<Vec<Refusal>>>,
    /// The last frame that was waited for could not be begun.
    stuck: Arc<AtomicBool>,
}

/// More than this many wait for nobody.
const KEPT: usize = 16;

impl Trouble {
    /// Whether the last frame that was waited for was not begun.
    pub fn is_stuck(&self) -> bool {
        self.stuck.load(Ordering::Relaxed)
    }

    /// Says so.
    pub fn set_stuck(&self, stuck: bool) {
        self.stuck.store(stuck, Ordering::Relaxed);
    }

    /// Writes one down.
    pub fn note(&self, call: &'static str, code: Code) {
        let mut list = match self.list.lock() {
            Ok(list) => list,
            Err(poisoned) => poisoned.into_inner(),
        };
        if list.len() < KEPT {
            list.push(Refusal { call, code });
        }
    }

    /// Those since the last time.
    pub fn take(&self) -> Vec<Refusal> {
        match self.list.lock() {
            Ok(mut list) => std::mem::take(&mut *list),
            Err(poisoned) => std::mem::take(&mut *poisoned.into_inner()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_reach_the_other_world_and_do_not_pile_up() {
        let main = Trouble::default();
        let render = main.clone();
        for _ in 0..100 {
            render.note("xrBeginFrame", Code::ERROR_CALL_ORDER_INVALID);
        }
        let taken = main.take();
        assert_eq!(taken.len(), KEPT);
        assert!(!taken[0].is_end());
        assert!(main.take().is_empty());
        render.note("xrEndFrame", Code::ERROR_INSTANCE_LOST);
        assert!(main.take()[0].is_end());
    }
}
