//! A monitor is unplugged: the window goes on, on one that is left.

use bevy::ecs::relationship::RelationshipTarget;
use bevy::prelude::*;
use bevy::window::{HasWindows, Monitor, OnMonitor, PrimaryWindow};
use midair_studio::notice::Notices;

pub(crate) fn plugin(app: &mut App) {
    app.add_observer(keep).add_systems(Update, follow);
}

/// The engine lets a monitor take its windows with it, and the last window ends the app: they are let
/// go first.
fn keep(
    gone: On<Despawn, HasWindows>,
    mut monitors: Query<&mut HasWindows>,
    mut commands: Commands,
) {
    let Ok(mut windows) = monitors.get_mut(gone.entity) else {
        return;
    };
    let left: Vec<Entity> = windows.iter().collect();
    windows.collection_mut_risky().clear();
    for window in left {
        // Where it is now is found by the engine itself.
        commands.entity(window).try_remove::<OnMonitor>();
    }
}

/// A window that nobody would see comes to a monitor that is left.
fn follow(
    mut gone: RemovedComponents<Monitor>,
    monitors: Query<&Monitor>,
    mut windows: Query<&mut Window, With<PrimaryWindow>>,
    mut notices: ResMut<Notices>,
) {
    if gone.read().count() == 0 {
        return;
    }
    let Some(first) = monitors.iter().next() else {
        notices.warn("The last monitor was unplugged. Your work is kept: plug one in to go on.");
        return;
    };
    let mut moved = false;
    for mut window in &mut windows {
        let WindowPosition::At(at) = window.position else {
            continue;
        };
        let size = window.physical_size().as_ivec2();
        let seen = |m: &Monitor| {
            let (low, high) = (
                m.physical_position,
                m.physical_position + m.physical_size().as_ivec2(),
            );
            // Enough of its head to take it by.
            at.x < high.x - 50
                && at.x + size.x > low.x + 50
                && at.y >= low.y - 50
                && at.y < high.y - 50
        };
        if !monitors.iter().any(seen) {
            window.position = WindowPosition::At(first.physical_position + IVec2::splat(50));
            moved = true;
        }
    }
    notices.info(if moved {
        "A monitor was unplugged: the window is on the one that is left."
    } else {
        "A monitor was unplugged. Everything is as it was."
    });
}
