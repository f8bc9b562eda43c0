//! Live links: what follows a thing is brought after it in the step that changes it.
//!
//! An object names its sources beside the shape it has ([`Link`](midair_document::Link)). A mode that makes
//! links says with [`AddFollow::add_follow`] how what it made follows; [`Project::commit`] asks it after
//! each change and puts what it answers into the same step, so that one undo takes back both. What
//! follows is never itself a source, so no link leads in a circle.

use bevy::prelude::*;
use midair_document::{Document, Edit};

use crate::project::Project;

/// The edits that bring links after their sources, given the document before a change and after it.
pub type Follow = fn(&Document, &Document) -> Vec<Edit>;

/// How links of every kind follow.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub(crate) struct Follows(Vec<Follow>);

/// Registers how a mode's links follow.
pub trait AddFollow {
    /// Asked after each change of the document.
    fn add_follow(&mut self, follow: Follow) -> &mut Self;
}

impl AddFollow for App {
    fn add_follow(&mut self, follow: Follow) -> &mut Self {
        let mut follows = self.world_mut().get_resource_or_init::<Follows>();
        follows.0.push(follow);
        self
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Follows>().add_systems(First, keep);
}

/// Every project that is taken up knows them.
fn keep(follows: Res<Follows>, mut project: ResMut<Project>) {
    if project.is_changed() && project.follows().len() != follows.0.len() {
        let follows = follows.0.clone();
        project.bypass_change_detection().set_follows(follows);
    }
}
