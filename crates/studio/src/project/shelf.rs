use bevy::prelude::*;
use midair_library::{Folders, Library};

use crate::notice::Notices;

/// The library on screen: what there is, whether it is shown, what one looks for.
#[derive(Resource, Debug, Default)]
pub struct Shelf {
    /// All components.
    pub library: Library,
    /// Whether the panel is open.
    pub open: bool,
}

impl Shelf {
    /// Reads the library again: after an import.
    pub fn reload(&mut self, folders: &Folders, notices: &mut Notices) {
        self.library = Library::load(folders);
        for warning in self.library.warnings() {
            notices.warn(warning.to_string());
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Shelf>().add_systems(
        Startup,
        |mut shelf: ResMut<Shelf>, places: Res<super::Places>, mut notices: ResMut<Notices>| {
            shelf.reload(&places.library, &mut notices);
        },
    );
}
