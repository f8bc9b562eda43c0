use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use super::BakeError;

/// A handle shared between the thread that bakes and the one that waits: how far the work has
/// come, and whether it is still wanted. Clones share one state.
#[derive(Clone, Debug, Default)]
pub struct Progress(Arc<State>);

#[derive(Debug, Default)]
struct State {
    fraction: AtomicU32,
    cancelled: AtomicBool,
}

impl Progress {
    /// A handle at fraction 0, not cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// How much of the work is done, 0 to 1. It never falls during one piece of work.
    pub fn fraction(&self) -> f32 {
        f32::from_bits(self.0.fraction.load(Ordering::Relaxed))
    }

    /// States how much of the work is done, 0 to 1.
    pub fn set_fraction(&self, fraction: f32) {
        self.0
            .fraction
            .store(fraction.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
    }

    /// Asks the work to stop; it ends within milliseconds with [`BakeError::Cancelled`].
    pub fn cancel(&self) {
        self.0.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether [`Progress::cancel`] was called.
    pub fn is_cancelled(&self) -> bool {
        self.0.cancelled.load(Ordering::Relaxed)
    }

    pub(super) fn check(&self) -> Result<(), BakeError> {
        if self.is_cancelled() {
            Err(BakeError::Cancelled)
        } else {
            Ok(())
        }
    }
}
