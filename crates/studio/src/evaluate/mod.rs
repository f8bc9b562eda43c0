//! Solids made from recipes, off the frame.
//!
//! Whoever shows a solid asks for it every frame with [`Evaluations::want`]; what nobody asks for
//! any more is cancelled. Results are keyed by (recipe hash, step) and taken in at one point of the
//! frame, the start of [`StudioSet::Rebuild`], before new work is started.

mod backend;
mod delivery;
mod early;
mod job;
mod kept;
mod live;
mod memory;

use std::sync::Arc;
use std::sync::atomic::Ordering;

use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::renderer::{RenderAdapterInfo, RenderDevice, RenderQueue};
use bevy::tasks::AsyncComputeTaskPool;
use midair_field::{Recipe, RecipeHash};
use midair_gpu::Emitted;
use midair_library::Volumes;
use midair_solid::Solid;

pub use backend::{Backend, Choice};
pub use delivery::{Deliver, Delivered, Delivery, Job};
pub use job::Made;
use job::Running;
pub(crate) use job::{ONE_BY_ONE, merged};
pub use live::{Live, Sketch};
use memory::Memory;

use crate::{StudioSet, notice::Notices, settings::Settings};

/// Which solid: a recipe at a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    /// The recipe's name.
    pub recipe: RecipeHash,
    step: u32,
}

impl Key {
    /// `recipe` with nodes every `step` metres of its own frame.
    pub fn new(recipe: &Recipe, step: f32) -> Self {
        Self {
            recipe: recipe.hash(),
            step: step.to_bits(),
        }
    }

    /// Metres between nodes.
    pub fn step(&self) -> f32 {
        f32::from_bits(self.step)
    }

    /// Its name as a piece of work, the same in every run.
    pub fn job(&self) -> Job {
        let mut bytes = [0; 8];
        bytes.copy_from_slice(&self.recipe.0[..8]);
        Job(u64::from_le_bytes(bytes) ^ u64::from(self.step).rotate_left(32))
    }
}

/// One update of a boolean sequence, for the report (EasyVRModeling Table 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Update {
    /// Milliseconds to fuse the operands' fields.
    pub fuse_ms: f64,
    /// Milliseconds to extract the surface.
    pub extract_ms: f64,
    /// Triangles extracted.
    pub triangles: usize,
}

/// What has been made, what is being made, and what could not be.
#[derive(Resource)]
pub struct Evaluations {
    /// Baked grids of imported meshes, shared by all evaluations.
    pub volumes: Arc<Volumes>,
    /// Who makes them: card or processor.
    pub backend: Backend,
    made: Memory,
    running: Vec<Running>,
    /// Surfaces on the card that draws, of what this frame took in.
    fresh: HashMap<Key, Emitted>,
    failed: HashMap<Key, String>,
    counted: Vec<Key>,
    updates: Vec<Update>,
    /// An update left nothing, and nobody was told yet.
    empty: bool,
    frame: u64,
}

impl Evaluations {
    /// With nothing made yet, by the processor unless told otherwise.
    pub fn new(volumes: Arc<Volumes>) -> Self {
        Self {
            volumes,
            backend: Backend::forced(Choice::Processor),
            made: Memory::default(),
            running: Vec::new(),
            fresh: HashMap::default(),
            failed: HashMap::default(),
            counted: Vec::new(),
            updates: Vec::new(),
            empty: false,
            frame: 0,
        }
    }

    /// The solid, if it is there; otherwise it is being made from now on. To be asked again every
    /// frame for as long as it is wanted.
    pub fn want(&mut self, recipe: &Recipe, step: f32) -> Option<Arc<Made>> {
        self.want_after(recipe, step, None)
    }

    /// The same of a painting that was `before`: only where the two differ is it made anew.
    pub fn want_after(
        &mut self,
        recipe: &Recipe,
        step: f32,
        before: Option<RecipeHash>,
    ) -> Option<Arc<Made>> {
        let key = Key::new(recipe, step);
        if let Some(made) = self.made.get(&key) {
            return Some(made);
        }
        if self.failed.contains_key(&key) {
            return None;
        }
        match self.running.iter_mut().find(|r| r.key == key) {
            Some(running) => running.wanted = self.frame,
            None => {
                let base = before.and_then(|recipe| self.made.look(&Key { recipe, ..key }));
                let base = base.and_then(|made| made.solid.clone());
                self.start(recipe.clone(), base, key);
            }
        }
        None
    }

    /// The solid, if it is there; never starts work.
    pub fn peek(&mut self, key: &Key) -> Option<Arc<Made>> {
        self.made.get(key)
    }

    /// What is made already, without asking for it or keeping it longer.
    pub fn made(&self, key: &Key) -> Option<Arc<Made>> {
        self.made.look(key)
    }

    /// Its surface on the card that draws, from when that has made it until the frame that takes the solid in: what can
    /// be seen before it can be touched. For the eye alone, so no session knows of it.
    pub fn surface(&self, key: &Key) -> Option<Emitted> {
        let early = self.on_its_way(key).and_then(|r| r.early.surface());
        early.or_else(|| self.fresh.get(key)).cloned()
    }

    /// The same from main memory, for whoever asks first: a finished solid without the sharp edges that it will have.
    pub(crate) fn take_plain(&self, key: &Key) -> Option<Mesh> {
        self.on_its_way(key)?.early.take_plain()
    }

    /// Asked for, and not taken in yet.
    pub(crate) fn is_coming(&self, key: &Key) -> bool {
        self.on_its_way(key).is_some()
    }

    fn on_its_way(&self, key: &Key) -> Option<&Running> {
        self.running.iter().find(|r| r.key == *key)
    }

    /// Why it cannot be made, if it was tried.
    pub fn failure(&self, key: &Key) -> Option<&str> {
        self.failed.get(key).map(String::as_str)
    }

    /// Asked for and not finished.
    pub fn outstanding(&self) -> usize {
        self.running.iter().filter(|r| !r.is_finished()).count()
    }

    /// Finished, and not taken in yet.
    pub fn is_finished(&self, job: Job) -> bool {
        self.running
            .iter()
            .any(|r| r.key.job() == job && r.is_finished())
    }

    /// Finished or not: what is on its way, the oldest first, with its progress from 0 to 1.
    pub fn progress(&self) -> impl Iterator<Item = (Key, f32)> + '_ {
        self.running.iter().map(|r| (r.key, r.progress.fraction()))
    }

    /// Counts the making of this solid as one update of a boolean sequence.
    pub fn count_update(&mut self, key: Key) {
        match self.made.get(&key) {
            Some(made) => self.count(&made),
            None => self.counted.push(key),
        }
    }

    fn count(&mut self, made: &Made) {
        let update = made.update();
        self.empty |= update.triangles == 0;
        self.updates.push(update);
    }

    /// The updates so far.
    pub fn updates(&self) -> &[Update] {
        &self.updates
    }

    /// Bytes held by what has been made.
    pub fn bytes(&self) -> usize {
        self.made.bytes()
    }

    fn start(&mut self, recipe: Recipe, base: Option<Arc<Solid>>, key: Key) {
        let running = Running::new(key, self.frame);
        let work = running.work(recipe, base, self.volumes.clone(), self.backend.clone());
        AsyncComputeTaskPool::get()
            .spawn(async move { work() })
            .detach();
        self.running.push(running);
    }

    /// Takes in what the delivery allows, in the order in which it was asked for.
    fn take_in(&mut self, delivery: &Delivery, delivered: &mut Vec<Job>, notices: &mut Notices) {
        let due: Vec<Key> = match delivery {
            Delivery::AsTheyCome | Delivery::All => self
                .running
                .iter()
                .filter(|r| r.is_finished())
                .map(|r| r.key)
                .collect(),
            Delivery::Exactly(jobs) => jobs
                .iter()
                .filter_map(|&j| {
                    self.running
                        .iter()
                        .find(|r| r.key.job() == j && r.is_finished())
                        .map(|r| r.key)
                })
                .collect(),
        };
        if std::mem::take(&mut self.empty) {
            notices.warn(
                "Nothing is left of the operands. Undo, move them until they overlap, and update again.",
            );
        }
        for key in due {
            let Some(at) = self.running.iter().position(|r| r.key == key) else {
                continue;
            };
            let running = self.running.remove(at);
            if let Some(surface) = running.early.surface() {
                self.fresh.insert(key, surface.clone());
            }
            match running.take() {
                Some(Ok(made)) => {
                    delivered.push(key.job());
                    if let Some(at) = self.counted.iter().position(|k| *k == key) {
                        self.counted.remove(at);
                        self.count(&made);
                    }
                    self.made.insert(key, made);
                }
                Some(Err(reason)) => {
                    delivered.push(key.job());
                    notices.warn(reason.clone());
                    self.failed.insert(key, reason);
                }
                None => {}
            }
        }
    }

    /// Gives up what nobody asked for in the frame before.
    fn drop_stale(&mut self) {
        let frame = self.frame;
        self.running.retain(|r| {
            let wanted = r.wanted + 1 >= frame;
            if !wanted {
                r.progress.cancel();
                r.cancelled.store(true, Ordering::Relaxed);
            }
            wanted
        });
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Delivery>()
        .init_resource::<Delivered>()
        // Results are taken in before the entities follow and ask for new ones.
        .configure_sets(Update, Deliver.in_set(StudioSet::Rebuild))
        .add_systems(Startup, draw_with)
        .add_systems(Update, (choose, deliver).chain().in_set(Deliver));
}

/// What the card makes is drawn by the same device, where something is drawn.
fn draw_with(
    device: Option<Res<RenderDevice>>,
    queue: Option<Res<RenderQueue>>,
    adapter: Option<Res<RenderAdapterInfo>>,
    evaluations: Res<Evaluations>,
) {
    if let (Some(device), Some(queue), Some(adapter)) = (device, queue, adapter) {
        evaluations
            .backend
            .draw_with(device.clone(), queue.clone(), &adapter);
    }
}

/// The setting reaches whoever makes solids before new ones are asked for.
fn choose(settings: Option<Res<Settings>>, evaluations: Res<Evaluations>) {
    if let Some(settings) = settings.filter(|s| s.is_changed()) {
        evaluations.backend.follow(settings.compute.backend);
    }
}

fn deliver(
    mut evaluations: ResMut<Evaluations>,
    delivery: Res<Delivery>,
    mut delivered: ResMut<Delivered>,
    mut notices: ResMut<Notices>,
) {
    delivered.0.clear();
    evaluations.frame += 1;
    evaluations.fresh.clear();
    for line in evaluations.backend.untold() {
        notices.warn(line);
    }
    // What was baked and could not be kept is baked again in each run.
    if let Some(line) = evaluations.volumes.take_warning() {
        notices.warn(line);
    }
    evaluations.take_in(&delivery, &mut delivered.0, &mut notices);
    evaluations.drop_stale();
}
