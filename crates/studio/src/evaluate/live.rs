//! A solid that a hand is changing, made again and again off the frame.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy::tasks::{AsyncComputeTaskPool, Task, futures::check_ready};
use midair_field::bake::Progress;
use midair_field::{Placement, Program, Recipe};
use midair_gpu::{Emitted, GpuSolid};
use midair_mesh::Aabb;
use midair_solid::Solid;

use super::{Evaluations, Key};
use crate::show::{CardMesh, CardWrites, Roomy, Seen, to_bevy_mesh};

/// Slower than this and the next is made coarser: with the frame that shows it, twenty a second.
const SLOW: Duration = Duration::from_millis(40);
/// Quicker than this several times over and the next is made finer: half the cells of a surface
/// more take twice as long.
const QUICK: Duration = Duration::from_millis(14);
/// How many quick ones it takes.
const SURE: u32 = 6;
/// What takes longer than this while something newer is wanted is given up for a coarser one.
const TOO_LONG: Duration = Duration::from_millis(250);
/// The coarsest: eight times the finest step.
const COARSEST: u32 = 6;

/// How coarse, from how long it took.
#[derive(Clone, Copy, Debug)]
struct Pace {
    /// Halves of a doubling of the step.
    coarser: u32,
    quick: u32,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            coarser: 2,
            quick: 0,
        }
    }
}

impl Pace {
    fn step(self, finest: f32) -> f32 {
        finest * (0.5 * self.coarser as f32).exp2()
    }

    fn note(&mut self, took: Duration) {
        if took > SLOW {
            let by = if took > 3 * SLOW { 2 } else { 1 };
            self.coarser = (self.coarser + by).min(COARSEST);
            self.quick = 0;
        } else if took < QUICK {
            self.quick += 1;
            if self.quick >= SURE {
                self.coarser = self.coarser.saturating_sub(1);
                self.quick = 0;
            }
        } else {
            self.quick = 0;
        }
    }
}

/// One on its way.
struct Flight {
    key: Key,
    since: Instant,
    progress: Progress,
    cancelled: Arc<AtomicBool>,
    task: Task<Option<Landed>>,
}

/// One that has come.
struct Landed {
    base: Base,
    picture: Picture,
    took: Duration,
    remade: bool,
}

/// What the next one is made from.
enum Base {
    Processor(Arc<Solid>),
    Card(Box<GpuSolid>),
}

impl Base {
    fn step(&self) -> f32 {
        match self {
            Self::Processor(solid) => solid.grid().step(),
            Self::Card(solid) => solid.step(),
        }
    }
}

/// How it can be drawn.
enum Picture {
    Mesh(Mesh),
    /// The card made it, and there was no room for it where the card draws.
    Roomy(Roomy, Aabb),
    /// It lies on the card.
    Surface(Emitted, Aabb),
}

/// A coarse solid, ready to be drawn by [`Live::draw`].
pub struct Sketch {
    /// Of which recipe, at which step.
    pub key: Key,
    picture: Picture,
    /// How long it took to make.
    pub took: Duration,
}

/// At most one evaluation at a time of a recipe that keeps changing; the latest wins.
///
/// Each starts from the one before and works only where they differ ([`Solid::remake`]). The step is chosen
/// from how long the last ones took. Nothing of it is recorded or counted as an update: it is for
/// the eye alone, and the document and what hands can touch do not depend on it.
#[derive(Default)]
pub struct Live {
    flight: Option<Flight>,
    last: Option<Base>,
    shown: Option<Key>,
    pace: Pace,
    /// What the card draws sketches into.
    card: Option<CardMesh>,
}

impl Live {
    /// To be asked every frame for what is wanted now, `finest` being the step it has at rest.
    /// Gives what has come since, be it of this recipe or of an earlier one.
    pub fn ask(
        &mut self,
        recipe: &Recipe,
        finest: f32,
        evaluations: &Evaluations,
    ) -> Option<Sketch> {
        let come = self.land();
        let key = Key::new(recipe, self.pace.step(finest));
        if let Some(flight) = &self.flight
            && flight.key.recipe != key.recipe
            && flight.since.elapsed() > TOO_LONG
            && self.pace.coarser < COARSEST
        {
            self.pace.note(flight.since.elapsed());
            self.cancel();
        }
        // What stands there is good enough while nothing moves: only a move asks for another step.
        let there = self.shown.is_some_and(|s| s.recipe == key.recipe);
        if self.flight.is_none() && !there {
            let key = Key::new(recipe, self.pace.step(finest));
            let room = self.card.as_ref().map(CardMesh::room);
            // A sketch on the card changes where it lies; a flight that is given up takes it along.
            let last = match &self.last {
                Some(Base::Processor(solid)) => Some(Base::Processor(solid.clone())),
                _ => self.last.take(),
            };
            self.flight = Some(start(key, recipe.clone(), last, room, evaluations));
        }
        come
    }

    /// What draws a sketch that has come: where it lies on the card, or from main memory.
    pub fn draw(
        &mut self,
        sketch: Sketch,
        meshes: &mut Assets<Mesh>,
        writes: &mut CardWrites,
    ) -> Option<Seen> {
        match sketch.picture {
            Picture::Mesh(mesh) => Some(meshes.add(mesh).into()),
            Picture::Roomy(roomy, around) => {
                let mesh = roomy.added(meshes);
                let seen = mesh.seen(around);
                self.card = Some(mesh);
                Some(seen)
            }
            Picture::Surface(surface, around) => {
                let mesh = self.card.as_ref()?;
                mesh.write(&surface, writes).then(|| mesh.seen(around))
            }
        }
    }

    /// Begins with a solid that is there already, made at `finest` halved or doubled some times: what is
    /// asked for next is made from it.
    pub fn begin(&mut self, with: Arc<Solid>, finest: f32) {
        self.clear();
        let doublings = (with.grid().step() / finest).log2();
        self.pace = Pace {
            coarser: (2.0 * doublings).round().clamp(0.0, COARSEST as f32) as u32,
            quick: 0,
        };
        self.last = Some(Base::Processor(with));
    }

    /// Whether one is on its way.
    pub fn is_busy(&self) -> bool {
        self.flight.is_some()
    }

    /// Gives up what is on its way: what was wanted is there already.
    pub fn rest(&mut self) {
        self.cancel();
    }

    /// Gives up what is on its way, and forgets what came.
    pub fn clear(&mut self) {
        self.cancel();
        self.last = None;
        self.shown = None;
    }

    fn cancel(&mut self) {
        if let Some(flight) = self.flight.take() {
            flight.progress.cancel();
            flight.cancelled.store(true, Ordering::Relaxed);
            flight.task.detach();
        }
    }

    fn land(&mut self) -> Option<Sketch> {
        let flight = self.flight.as_mut()?;
        let landed = check_ready(&mut flight.task)?;
        let key = flight.key;
        self.flight = None;
        // One that cannot be made is not tried again: at rest the reason is told.
        self.shown = Some(key);
        let landed = landed?;
        if landed.remade || landed.took > SLOW {
            self.pace.note(landed.took);
        }
        self.last = Some(landed.base);
        Some(Sketch {
            key,
            picture: landed.picture,
            took: landed.took,
        })
    }
}

/// One core is the frame's own.
fn workers() -> Option<&'static rayon::ThreadPool> {
    static POOL: OnceLock<Option<rayon::ThreadPool>> = OnceLock::new();
    let make = || {
        let cores = std::thread::available_parallelism().map_or(2, |n| n.get());
        rayon::ThreadPoolBuilder::new()
            .num_threads(cores.saturating_sub(1).max(1))
            .thread_name(|_| "live preview".to_owned())
            .build()
            .ok()
    };
    POOL.get_or_init(make).as_ref()
}

fn start(
    key: Key,
    recipe: Recipe,
    last: Option<Base>,
    room: Option<(u32, u32)>,
    evaluations: &Evaluations,
) -> Flight {
    let (volumes, backend) = (evaluations.volumes.clone(), evaluations.backend.clone());
    let progress = Progress::new();
    let cancelled = Arc::new(AtomicBool::new(false));
    let (watched, stop) = (progress.clone(), cancelled.clone());
    let task = AsyncComputeTaskPool::get().spawn(async move {
        let work = || {
            let meshes = volumes.watched(&watched);
            let (at, step) = (Placement::IDENTITY, key.step());
            let since = Instant::now();
            let last = last.filter(|l| l.step() == step);
            let remade = last.is_some();
            let (solid, on_card) = match last {
                Some(Base::Processor(solid)) => (Some(solid), None),
                Some(Base::Card(solid)) => (None, Some(*solid)),
                None => (None, None),
            };
            // What was made by the processor goes on there.
            let by_card = if solid.is_none() {
                backend.sketch(&recipe, step, &meshes, on_card)
            } else {
                None
            };
            if let Some((solid, surface)) = by_card {
                let around = recipe.bounds().grown(step);
                let drawn = surface.is_drawn() && room.is_some_and(|(v, i)| surface.fits(v, i));
                let picture = if drawn {
                    Picture::Surface(surface, around)
                } else {
                    let mesh = surface.mesh().ok()?;
                    if surface.is_drawn() {
                        Picture::Roomy(Roomy::new(&mesh), around)
                    } else {
                        Picture::Mesh(to_bevy_mesh(&mesh))
                    }
                };
                return Some(Landed {
                    picture,
                    took: since.elapsed(),
                    remade,
                    base: Base::Card(Box::new(solid)),
                });
            }
            let made = match &solid {
                Some(last) => last.remake(&recipe, &at, step, &meshes, &stop),
                None => Solid::make(&recipe, &at, step, &meshes, &stop),
            };
            let solid = Arc::new(made.ok()?);
            let picture = Picture::Mesh(to_bevy_mesh(&solid.mesh()));
            Some(Landed {
                picture,
                took: since.elapsed(),
                remade,
                base: Base::Processor(solid),
            })
        };
        // A sketch that fails is left out; what update makes says why.
        let guarded = AssertUnwindSafe(|| {
            // Meshes are baked out here: a worker that waits for help would take up another sketch meanwhile, which may wait
            // for the very mesh that it bakes.
            let meshes = volumes.watched(&watched);
            Program::compile(&recipe, &Placement::IDENTITY, key.step(), &meshes).ok()?;
            match workers() {
                Some(pool) => pool.install(work),
                None => work(),
            }
        });
        catch_unwind(guarded).ok().flatten()
    });
    Flight {
        key,
        since: Instant::now(),
        progress,
        cancelled,
        task,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_slow_gets_coarser_and_what_is_quick_finer() {
        let mut pace = Pace::default();
        let begun = pace.step(0.01);
        assert!((begun - 0.02).abs() < 1e-6);
        pace.note(2 * SLOW);
        assert!(pace.step(0.01) > begun);
        for _ in 0..2 * SURE {
            pace.note(QUICK / 2);
        }
        assert!(pace.step(0.01) < begun);
        for _ in 0..100 {
            pace.note(10 * SLOW);
        }
        assert!(
            (pace.step(0.01) - 0.08).abs() < 1e-6,
            "never coarser than that"
        );
    }

    #[test]
    fn now_and_then_a_quick_one_changes_nothing() {
        let mut pace = Pace::default();
        for _ in 0..50 {
            pace.note(QUICK / 2);
            pace.note(SLOW);
        }
        assert_eq!(pace.coarser, 2);
    }
}
