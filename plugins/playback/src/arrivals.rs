//! How results of background work come into the world in the frames in which they came when recorded.

use bevy::prelude::*;
use midair_studio::{
    command::Errands,
    evaluate::{Delivered, Delivery, Evaluations, Job},
    show::Arriving,
};

/// What works off the frame, as the player and the recorder see it.
///
/// The implementor takes results in at one point of the frame, before the point at which it starts
/// new work, so that no result arrives in the frame that asked for it.
pub trait OffFrame: Send + Sync + 'static {
    /// How many results were asked for and are not finished; cancelled ones do not count.
    fn unfinished(&self, world: &World) -> usize;
    /// How many results are finished and not taken in.
    fn waiting(&self, world: &World) -> usize;
    /// Whether this one is finished and not taken in.
    fn is_waiting(&self, world: &World, job: Job) -> bool;
    /// Says what the next frame takes in.
    fn deliver(&self, world: &mut World, delivery: Delivery);
    /// What the last frame took in, in order.
    fn delivered(&self, world: &World) -> Vec<Job>;
}

/// The background work to wait for: the studio's, unless the app puts in its own.
#[derive(Resource)]
pub struct Arrivals(pub Box<dyn OffFrame>);

impl Default for Arrivals {
    fn default() -> Self {
        Self(Box::new(Studio))
    }
}

/// The studio's evaluations and errands, as far as they are there.
struct Studio;

impl OffFrame for Studio {
    fn unfinished(&self, world: &World) -> usize {
        let solids = world.get_resource::<Evaluations>();
        let files = world.get_resource::<Errands>();
        solids.map_or(0, Evaluations::outstanding) + files.map_or(0, Errands::outstanding)
    }

    fn waiting(&self, world: &World) -> usize {
        let solids = world.get_resource::<Evaluations>();
        let files = world.get_resource::<Errands>();
        let all = solids.map_or(0, |e| e.progress().count()) + files.map_or(0, Errands::len);
        let arriving = world.get_resource::<Arriving>();
        all.saturating_sub(self.unfinished(world)) + arriving.map_or(0, Arriving::count)
    }

    fn is_waiting(&self, world: &World, job: Job) -> bool {
        world
            .get_resource::<Evaluations>()
            .is_some_and(|e| e.is_finished(job))
    }

    fn deliver(&self, world: &mut World, delivery: Delivery) {
        world.insert_resource(delivery);
    }

    fn delivered(&self, world: &World) -> Vec<Job> {
        world
            .get_resource::<Delivered>()
            .map_or_else(Vec::new, |d| d.0.clone())
    }
}
