//! On how many threads the systems of a frame run.

use bevy::ecs::schedule::{Schedules, SingleThreadedExecutor};
use bevy::prelude::*;

/// Runs the systems of the main world one after the other, on the main thread.
///
/// A frame has some hundreds of systems, of which most take microseconds: handing each to another thread and waiting for it
/// takes longer than it does, the more so where other work has the processor. What is heavy and in many pieces is spread
/// over threads inside its system; drawing and evaluations have threads of their own. The order of systems is then the
/// same in every frame.
pub(crate) struct OneThreadPlugin;

impl Plugin for OneThreadPlugin {
    fn build(&self, _: &mut App) {}

    fn cleanup(&self, app: &mut App) {
        // Every plugin has added its schedules by now.
        if let Some(mut schedules) = app.world_mut().get_resource_mut::<Schedules>() {
            for (_, schedule) in schedules.iter_mut() {
                schedule.set_executor(SingleThreadedExecutor::new());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;
    use std::thread::{self, ThreadId};

    use super::*;

    #[derive(Resource, Default)]
    struct Ran(Mutex<Vec<ThreadId>>);

    fn here<const N: usize>(ran: Res<Ran>) {
        // Long enough for another thread to take the next one.
        thread::sleep(std::time::Duration::from_millis(1));
        ran.0.lock().unwrap().push(thread::current().id());
    }

    #[test]
    fn every_system_of_a_frame_runs_where_the_app_does() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, OneThreadPlugin))
            .init_resource::<Ran>()
            .add_systems(PreUpdate, (here::<0>, here::<1>, here::<2>))
            .add_systems(Update, (here::<3>, here::<4>, here::<5>))
            .add_systems(PostUpdate, (here::<6>, here::<7>, here::<8>));
        app.finish();
        app.cleanup();
        app.update();
        let ran = app.world().resource::<Ran>().0.lock().unwrap().clone();
        assert_eq!(ran, vec![thread::current().id(); 9]);
    }
}
