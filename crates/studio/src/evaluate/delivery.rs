use bevy::prelude::*;
use serde::{Deserialize, Serialize};

/// The name of one piece of work done off the frame: the same work has the same name in every run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Job(pub u64);

/// Which finished work a frame takes in: a recorded session plays back the frames in which results
/// arrived, so that what a hand could touch then it can touch again.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub enum Delivery {
    /// Live: whatever is finished.
    #[default]
    AsTheyCome,
    /// Whatever is finished, by a player that waits between frames until all is.
    All,
    /// These and no others, in this order.
    Exactly(Vec<Job>),
}

/// What this frame took in, in order.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Delivered(pub Vec<Job>);

/// The step of a frame that takes results in.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct Deliver;
