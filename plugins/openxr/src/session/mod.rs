//! A session's life: waited for, worn, laid aside, lost, found again.
//!
//! Whatever the runtime does, the app goes on: without a session it is a flat one, mouse and keyboard work, and nothing of
//! the document depends on it. What happens is said in one line each.

mod life;
mod link;
mod open;
mod search;

pub use life::Life;
pub use link::Link;
pub(crate) use open::below_the_eyes;

use bevy::prelude::*;
use bevy_mod_xr::session::{XrFirst, XrHandleEvents};
use midair_studio::StudioSet;
use midair_studio::command::Command;

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Life>()
        .add_systems(
            XrFirst,
            (link::refusals, link::poll, link::attend, life::follow)
                .chain()
                .in_set(XrHandleEvents::SessionStateUpdateEvents),
        )
        .add_systems(Update, switch.in_set(StudioSet::Ask))
        // The session ends before the graphics card that it draws with.
        .add_systems(Last, link::close.run_if(on_message::<AppExit>));
}

/// The switch in the running app: into the headset and out of it.
fn switch(mut commands: MessageReader<Command>, mut link: ResMut<Link>) {
    for command in commands.read() {
        if let Command::Headset(on) = command {
            link.want(*on);
        }
    }
}
