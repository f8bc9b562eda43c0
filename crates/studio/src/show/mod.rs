//! Entities that follow the document, and how they look.

mod card;
mod cue;
mod ease;
mod follow;
mod form;
mod guides;
mod halo;
mod ink;
mod material;
mod readout;
mod rim;
mod room;
mod showing;
mod stand_in;

use std::collections::BTreeMap;

use bevy::prelude::*;
use midair_document::ObjectId;
use midair_field::Placement;

pub(crate) use card::Roomy;
pub use card::{CardMesh, CardWrites, Seen, SeenParts};
pub use cue::{Cue, Cues, Tint};
pub use follow::{Arriving, ObjectEntity, ObjectMap, ShowObjects, display_steps, to_bevy_mesh};
pub use form::form;
pub use readout::{Readout, Readouts};
pub(crate) use rim::outward;
pub use room::{Eye, FIELD_OF_VIEW, RoomPlugin, Unhurried, camera, headset, is_software};
pub use showing::Drawn;
pub use stand_in::{Latest, StandIn};

/// Where objects stand while a hand moves them: thrown away on cancel, an edit on release.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Drafts(BTreeMap<ObjectId, Placement>);

impl Drafts {
    /// Where the hand has it now, if a hand has it.
    pub fn get(&self, object: ObjectId) -> Option<&Placement> {
        self.0.get(&object)
    }

    /// What hands move, and where they have it.
    pub fn iter(&self) -> impl Iterator<Item = (ObjectId, &Placement)> {
        self.0.iter().map(|(&id, placement)| (id, placement))
    }

    /// Moves the entity without touching the document. An unsound placement (a NaN pose) is left out.
    pub fn set(&mut self, object: ObjectId, placement: Placement) {
        if placement.is_sound() {
            self.0.insert(object, placement);
        }
    }

    /// The gesture is over.
    pub fn take(&mut self, object: ObjectId) -> Option<Placement> {
        self.0.remove(&object)
    }

    /// Every gesture is over.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Whether no hand moves anything.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// As Bevy moves entities.
pub fn transform(p: &Placement) -> Transform {
    Transform {
        translation: p.translation,
        rotation: p.rotation,
        scale: p.scale,
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Drafts>().init_resource::<Cues>();
    card::plugin(app);
    follow::plugin(app);
    material::plugin(app);
    readout::plugin(app);
}
