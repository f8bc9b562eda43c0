use std::sync::{Mutex, OnceLock};

use bevy::prelude::*;
use midair_gpu::Emitted;
use midair_mesh::TriMesh;

use crate::show::to_bevy_mesh;

/// What can be seen of a solid before it is finished: its surface as marching cubes leaves it.
#[derive(Default)]
pub(super) struct Early {
    /// Where the card that draws has it.
    surface: OnceLock<Emitted>,
    /// The same from main memory, until it is taken.
    plain: Mutex<Option<Mesh>>,
}

impl Early {
    /// Of one evaluation there is one surface.
    pub fn lies_on_card(&self, surface: Emitted) {
        drop(self.surface.set(surface));
    }

    pub fn surface(&self) -> Option<&Emitted> {
        self.surface.get()
    }

    pub fn is_plain(&self, mesh: &TriMesh) {
        let drawn = to_bevy_mesh(mesh);
        if let Ok(mut plain) = self.plain.lock() {
            *plain = Some(drawn);
        }
    }

    /// What draws it, the first time it is asked for.
    pub fn take_plain(&self) -> Option<Mesh> {
        self.plain.lock().ok()?.take()
    }
}
