//! Where a frame's time goes.

use std::collections::BTreeMap;
use std::time::Instant;

use bevy::prelude::*;
use midair_studio::StudioSet;

use crate::systems::{self, Systems};
use crate::{FrameTimes, SystemReport};

/// The parts of a frame, in order, as the report names them.
const NAMES: [&str; 9] = [
    "1 before",
    "2 gather",
    "3 ask",
    "4 pick",
    "5 act",
    "6 commit",
    "7 rebuild",
    "8 cue",
    "9 after",
];

/// How long each part took, frame by frame.
#[derive(Resource)]
pub struct Parts {
    since: Instant,
    began: Instant,
    counts: bool,
    main: Vec<f32>,
    ms: [Vec<f32>; NAMES.len()],
    systems: Systems,
}

impl Parts {
    /// Whether the next frame is one of the session's.
    pub fn count(&mut self, counts: bool) {
        self.counts = counts;
    }

    /// Forgets the frames so far.
    pub fn restart(&mut self) {
        self.main.clear();
        self.ms.iter_mut().for_each(Vec::clear);
        self.systems.restart();
    }

    /// Every system that ran, the costliest first; empty unless [`TIME_SYSTEMS`] is set.
    pub fn systems(&self) -> Vec<SystemReport> {
        self.systems.figures()
    }

    /// The whole main schedule, and its parts by name.
    pub fn figures(&self) -> (FrameTimes, BTreeMap<String, FrameTimes>) {
        let each = NAMES.iter().zip(&self.ms);
        let parts = each.map(|(name, ms)| ((*name).to_owned(), FrameTimes::of(ms.clone())));
        (FrameTimes::of(self.main.clone()), parts.collect())
    }

    fn end(&mut self, part: usize) {
        let now = Instant::now();
        if self.counts {
            self.ms[part].push((now - self.since).as_secs_f32() * 1e3);
            if part + 1 == NAMES.len() {
                self.main.push((now - self.began).as_secs_f32() * 1e3);
            }
        }
        self.since = now;
    }
}

/// The end of what is counted of a frame, in [`Last`]: what comes after it is nobody's share.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct Counted;

/// The variable of the environment that has each system timed as well.
pub const TIME_SYSTEMS: &str = "MIDAIR_TIME_SYSTEMS";

/// Marks between the parts of a frame. Left out unless asked for: each is a point at which the frame's systems meet.
pub struct PartsPlugin;

impl Plugin for PartsPlugin {
    fn build(&self, app: &mut App) {
        use StudioSet::{Act, Ask, Commit, Cue, Gather, Hold, Pick, Rebuild};
        app.insert_resource(Parts {
            since: Instant::now(),
            began: Instant::now(),
            counts: false,
            main: Vec::new(),
            ms: Default::default(),
            systems: Systems::default(),
        })
        .add_systems(First, |mut parts: ResMut<Parts>| {
            parts.since = Instant::now();
            parts.began = parts.since;
        })
        .add_systems(Update, end::<0>.before(Gather))
        .add_systems(Update, end::<1>.after(Gather).before(Ask))
        .add_systems(Update, end::<2>.after(Ask).before(Pick))
        .add_systems(Update, end::<3>.after(Pick).before(Act))
        // What hands do in every mode alike counts as acting.
        .add_systems(Update, end::<4>.after(Act).after(Hold).before(Commit))
        .add_systems(Update, end::<5>.after(Commit).before(Rebuild))
        .add_systems(Update, end::<6>.after(Rebuild).before(Cue))
        .add_systems(Update, end::<7>.after(Cue))
        .add_systems(Last, end::<8>.in_set(Counted));
    }

    fn cleanup(&self, app: &mut App) {
        // Every other plugin has added its systems by now, and none has run.
        if std::env::var_os(TIME_SYSTEMS).is_some() {
            let systems = systems::time(app.world_mut());
            app.world_mut().resource_mut::<Parts>().systems = systems;
        }
    }
}

fn end<const PART: usize>(mut parts: ResMut<Parts>) {
    parts.end(PART);
}

/// Processor time of this process so far, on all its threads.
pub(crate) fn cpu_seconds() -> Option<f64> {
    // Linux: fields 14 and 15, counted after the name, which may hold blanks; a hundred to a second.
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(11);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_a_frame_is_counted_once() {
        let mut app = App::new();
        app.configure_sets(
            Update,
            (
                StudioSet::Gather,
                StudioSet::Ask,
                StudioSet::Pick,
                StudioSet::Act,
                StudioSet::Hold,
                StudioSet::Commit,
                StudioSet::Rebuild,
                StudioSet::Cue,
            )
                .chain(),
        );
        app.add_plugins((MinimalPlugins, PartsPlugin));
        for counts in [true, false, true] {
            app.world_mut().resource_mut::<Parts>().count(counts);
            app.update();
        }
        let (main, figures) = app
            .world_mut()
            .remove_resource::<Parts>()
            .unwrap()
            .figures();
        assert_eq!(figures.len(), NAMES.len());
        assert_eq!(main.count, 2);
        assert!(figures.values().all(|f| f.count == 2), "{figures:?}");
    }
}
