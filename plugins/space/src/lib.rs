//! What is seen and touched in a room: panels on quads, wands that click them, hands, labels, comfort.
//!
//! Everything here follows from [`Hands`](midair_studio::hands::Hands), the head and the studio's resources; no device
//! is known. It is there while panels are hosted in the room ([`Host::Room`]): a headset is worn, or a recording is
//! looked at as if one were.
//!
//! Places are in metres of the room, as a body has them. One entity, [`Root`](room::Root), carries them all: when the
//! world is moved or scaled, the room goes through it and no object moves.

pub mod boards;
mod comfort;
mod desktop;
mod hands;
mod ink;
mod labels;
mod ring;
pub mod room;
pub mod wand;

use bevy::prelude::*;
use bevy::transform::TransformSystems;
use bevy_egui::EguiPostUpdateSet;
use midair_studio::{
    StudioSet,
    hands::{AdvanceHands, FilterHands},
    panel::Host,
};

pub use boards::{BoardId, Boards};
pub use room::Stance;
pub use wand::Wands;

/// Points of a panel per degree of size that holds at any distance: one point is so many dmm (1 mm seen at 1 m).
pub const DMM_PER_POINT: f32 = 1.5;

/// Panels, wands, hands, labels and comfort in a room.
pub struct SpacePlugin;

impl Plugin for SpacePlugin {
    fn build(&self, app: &mut App) {
        ink::plugin(app);
        app.init_resource::<Boards>()
            .init_resource::<Stance>()
            .init_resource::<Wands>()
            .init_resource::<labels::Labels>()
            .init_resource::<ring::Ring>()
            .init_resource::<comfort::Grips>()
            .init_resource::<comfort::Pace>()
            .init_resource::<boards::Painted>()
            .add_systems(Startup, (room::spawn, hands::spawn, wand::spawn).chain())
            .add_systems(First, comfort::begin)
            .add_systems(Last, comfort::end)
            .add_systems(
                Update,
                (
                    (room::sense, wand::point, comfort::steer)
                        .chain()
                        .in_set(FilterHands)
                        .run_if(in_room),
                    room::settle
                        .in_set(StudioSet::Gather)
                        .after(AdvanceHands)
                        .run_if(in_room),
                    ring::turn
                        .in_set(StudioSet::Gather)
                        .after(AdvanceHands)
                        .run_if(in_room),
                    room::follow.in_set(StudioSet::Cue),
                    (
                        boards::arrange,
                        hands::draw,
                        wand::show,
                        labels::begin,
                        labels::readouts,
                        labels::operands,
                        labels::notices,
                        labels::buttons,
                        labels::empty,
                        comfort::tell,
                        labels::draw,
                        comfort::darken,
                    )
                        .chain()
                        .after(StudioSet::Cue)
                        .run_if(in_room),
                ),
            )
            .add_systems(
                PostUpdate,
                (
                    (boards::paint, boards::place)
                        .chain()
                        // What is drawn here is taken up by the renderer in the same frame.
                        .before(EguiPostUpdateSet::ProcessOutput)
                        .before(TransformSystems::Propagate),
                    desktop::mirror.before(TransformSystems::Propagate),
                ),
            );
        boards::plugin(app);
    }
}

/// The panels are in the room.
fn in_room(host: Res<Host>) -> bool {
    *host == Host::Room
}
