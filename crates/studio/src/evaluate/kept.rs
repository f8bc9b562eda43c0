//! Solids that stay on the card: an edit of one makes again only the bricks that it touched.

use std::sync::Arc;

use midair_field::Program;
use midair_gpu::{Gpu, GpuSolid};

/// How many, at most: of a few objects, each at the document's step and at that for the eye.
const MOST: usize = 8;

/// They, the one that was not used for longest first.
#[derive(Default)]
pub(super) struct Kept(Vec<GpuSolid>);

impl Kept {
    /// Takes out the one that is most of what is to be made. Where none is, and there are enough, one whose buffers are
    /// used again.
    pub fn take(&mut self, gpu: &Arc<Gpu>, program: &Program) -> Option<GpuSolid> {
        self.0.retain(|s| s.is_on(gpu));
        match self.0.iter().rposition(|s| s.is_near(program)) {
            Some(near) => Some(self.0.remove(near)),
            None if self.0.len() >= MOST => Some(self.0.remove(0)),
            None => None,
        }
    }

    /// Keeps one, and in all no more bytes than one may have.
    pub fn keep(&mut self, solid: GpuSolid, budget: u64) {
        self.0.push(solid);
        let mut bytes: u64 = self.0.iter().map(|s| s.memory().reserved).sum();
        while bytes > budget && self.0.len() > 1 {
            bytes -= self.0.remove(0).memory().reserved;
        }
    }

    /// Gives all of them up; whether there were any.
    pub fn clear(&mut self) -> bool {
        !std::mem::take(&mut self.0).is_empty()
    }

    /// The one that was used last.
    #[cfg(test)]
    pub fn last(&self) -> Option<&GpuSolid> {
        self.0.last()
    }
}
