//! How long each system of the main world runs, for whoever looks for what a frame is spent on.

use std::any::TypeId;
use std::sync::{Arc, Mutex};
use std::time::Instant;

use bevy::ecs::change_detection::{CheckChangeTicks, Tick};
use bevy::ecs::query::FilteredAccessSet;
use bevy::ecs::schedule::{ApplyDeferred, InternedSystemSet, Schedules, SystemWithAccess};
use bevy::ecs::system::{RunSystemError, System, SystemIn, SystemStateFlags};
use bevy::ecs::world::{DeferredWorld, unsafe_world_cell::UnsafeWorldCell};
use bevy::prelude::*;
use bevy::utils::prelude::DebugName;
use serde::Serialize;

/// One system, over the frames that were counted.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SystemReport {
    /// Where it is defined.
    pub name: String,
    /// The schedule it is in.
    pub schedule: String,
    /// How often it ran.
    pub runs: usize,
    /// Microseconds of half of its runs at most.
    pub median_us: f64,
    /// All of it, in milliseconds.
    pub total_ms: f64,
}

/// What a system has taken so far, run by run, in microseconds.
#[derive(Default)]
struct Runs(Mutex<Vec<f32>>);

impl Runs {
    fn with<T: Default>(&self, f: impl FnOnce(&mut Vec<f32>) -> T) -> T {
        self.0
            .lock()
            .map(|mut runs| f(&mut runs))
            .unwrap_or_default()
    }
}

/// Every system that is timed.
#[derive(Default)]
pub(crate) struct Systems(Vec<(String, String, Arc<Runs>)>);

impl Systems {
    /// Forgets the runs so far.
    pub fn restart(&self) {
        for (.., runs) in &self.0 {
            runs.with(Vec::clear);
        }
    }

    /// Those that ran, the costliest first.
    pub fn figures(&self) -> Vec<SystemReport> {
        let mut all: Vec<_> = self
            .0
            .iter()
            .map(|(schedule, name, runs)| {
                let mut us = runs.with(|runs| runs.clone());
                us.sort_by(f32::total_cmp);
                SystemReport {
                    name: name.clone(),
                    schedule: schedule.clone(),
                    runs: us.len(),
                    median_us: us.get(us.len() / 2).copied().map_or(0.0, f64::from),
                    total_ms: us.iter().map(|&us| f64::from(us)).sum::<f64>() * 1e-3,
                }
            })
            .filter(|s| s.runs > 0)
            .collect();
        all.sort_by(|a, b| b.total_ms.total_cmp(&a.total_ms));
        all
    }
}

/// Has every system timed that is in a schedule and has not run yet.
pub(crate) fn time(world: &mut World) -> Systems {
    let mut all = Systems::default();
    let Some(mut schedules) = world.get_resource_mut::<Schedules>() else {
        return all;
    };
    for (label, schedule) in schedules.iter_mut() {
        let label = format!("{label:?}");
        let graph = schedule.graph_mut();
        let keys: Vec<_> = graph.systems.iter().map(|(key, ..)| key).collect();
        for key in keys {
            let Some(slot) = graph.systems.get_mut(key) else {
                continue;
            };
            // The executor knows these by their type.
            if slot.system_type() == TypeId::of::<ApplyDeferred>() {
                continue;
            }
            let runs = Arc::<Runs>::default();
            let name = slot.name().to_string();
            all.0.push((label.clone(), name, runs.clone()));
            let inner = std::mem::replace(slot, SystemWithAccess::new(Box::new(ApplyDeferred)));
            let timed = Timed { inner, runs };
            *slot = SystemWithAccess::new(Box::new(timed));
        }
    }
    all
}

/// A system and the clock beside it.
struct Timed {
    inner: SystemWithAccess,
    runs: Arc<Runs>,
}

impl System for Timed {
    type In = ();
    type Out = ();

    fn name(&self) -> DebugName {
        self.inner.name()
    }

    fn system_type(&self) -> TypeId {
        self.inner.system_type()
    }

    fn flags(&self) -> SystemStateFlags {
        self.inner.flags()
    }

    unsafe fn run_unsafe(
        &mut self,
        input: SystemIn<'_, Self>,
        world: UnsafeWorldCell,
    ) -> Result<(), RunSystemError> {
        let since = Instant::now();
        // SAFETY: it is run as it would be by itself, with the access that it asked for.
        let done = unsafe { self.inner.run_unsafe(input, world) };
        let took = since.elapsed().as_secs_f32() * 1e6;
        self.runs.with(|runs| runs.push(took));
        done
    }

    fn apply_deferred(&mut self, world: &mut World) {
        self.inner.apply_deferred(world);
    }

    fn queue_deferred(&mut self, world: DeferredWorld) {
        self.inner.queue_deferred(world);
    }

    fn initialize(&mut self, world: &mut World) -> FilteredAccessSet {
        self.inner.initialize(world)
    }

    fn check_change_tick(&mut self, check: CheckChangeTicks) {
        self.inner.check_change_tick(check);
    }

    fn default_system_sets(&self) -> Vec<InternedSystemSet> {
        self.inner.default_system_sets()
    }

    fn get_last_run(&self) -> Tick {
        self.inner.get_last_run()
    }

    fn set_last_run(&mut self, last_run: Tick) {
        self.inner.set_last_run(last_run);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_run_of_a_system_is_counted_and_it_does_what_it_did() {
        #[derive(Resource, Default)]
        struct Sum(u32);
        fn add(mut sum: ResMut<Sum>, mut commands: Commands) {
            sum.0 += 1;
            commands.spawn_empty();
        }
        fn never() {}
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .init_resource::<Sum>()
            .add_systems(Update, (add, never.run_if(|| false)));
        let before = app.world().entities().count_spawned();
        let systems = time(app.world_mut());
        for _ in 0..3 {
            app.update();
        }
        assert_eq!(app.world().resource::<Sum>().0, 3);
        assert!(app.world().entities().count_spawned() >= before + 3);
        let figures = systems.figures();
        let found = |name: &str| figures.iter().find(|s| s.name.contains(name));
        let added = found("add").unwrap();
        assert_eq!((added.runs, &*added.schedule), (3, "Update"));
        assert_eq!(found("never"), None);
        systems.restart();
        assert!(systems.figures().is_empty());
    }
}
