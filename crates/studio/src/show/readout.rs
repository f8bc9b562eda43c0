use bevy::prelude::*;

use crate::StudioSet;
use crate::snap::ClearGuides;

/// A short text that stands in the view for one frame: a length, a scale, an angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Readout {
    /// Where, in world metres.
    pub at: Vec3,
    /// What it says.
    pub text: String,
}

/// The texts of this frame. Every way in draws them.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Readouts(pub Vec<Readout>);

impl Readouts {
    /// Says something at a place.
    pub fn say(&mut self, at: Vec3, text: impl Into<String>) {
        self.0.push(Readout {
            at,
            text: text.into(),
        });
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Readouts>().add_systems(
        Update,
        (|mut readouts: ResMut<Readouts>| {
            if !readouts.0.is_empty() {
                readouts.0.clear();
            }
        })
        .in_set(StudioSet::Gather)
        .in_set(ClearGuides),
    );
}
