//! Where solids are made: by the graphics card, or by the processor wherever the card cannot.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use bevy::render::renderer::{RenderAdapterInfo, RenderDevice, RenderQueue};
use midair_field::{MeshSource, Placement, Program, Recipe};
use midair_gpu::{Adapter, Emitted, Gpu, GpuError, GpuOptions, GpuSolid, SolidOptions, can_make};
use midair_mesh::TriMesh;
use midair_surface::crisp_unless;

use super::early::Early;
use super::kept::Kept;
pub use crate::settings::Backend as Choice;
use crate::show::is_software;

/// The choice between card and processor, shared by all evaluations.
///
/// Everything here runs off the frame. A card that cannot be opened, is lost or runs out of memory costs nothing but
/// time: the processor makes the same solid, and one line says why.
#[derive(Clone)]
pub struct Backend(Arc<Inner>);

struct Inner {
    /// Told on the command line: the settings do not change it.
    forced: bool,
    state: Mutex<(Choice, State)>,
    /// The device that draws, where something is drawn.
    drawing: Mutex<Option<Drawing>>,
    /// What happened to the card, for the user: whatever was made meanwhile may be given up.
    untold: Mutex<Vec<String>>,
    /// Held by whoever opens the card while others wait for it.
    opening: Mutex<()>,
    /// Solids that are still there; held while one is made.
    kept: Mutex<Kept>,
    /// A test of a card that cannot be opened.
    #[cfg(test)]
    broken: Mutex<Option<GpuError>>,
    /// Bytes that a solid may have on the card at most.
    budget: AtomicU64,
    /// How many solids the card made.
    made: AtomicUsize,
    /// The user knows that some solid is too large for the card, and that it has no memory left at the moment.
    told_of_size: AtomicBool,
    told_of_memory: AtomicBool,
}

/// What pictures are drawn with.
struct Drawing {
    device: RenderDevice,
    queue: RenderQueue,
    adapter: Adapter,
}

/// In 16 bits wherever that moves the surface by less than a hundredth of a millimetre.
const KEPT: SolidOptions = SolidOptions {
    quantised: false,
    within: Some(1.0e-5),
};

enum State {
    /// Nobody asked for a card yet.
    Unopened,
    Opening,
    Open(Arc<Gpu>),
    /// Why there is none.
    Closed(String),
}

/// A solid that the card made.
pub(super) struct OnCard {
    pub mesh: TriMesh,
    /// How many of its vertices came from the card; those of its edges follow.
    pub plain: usize,
    pub fuse: Duration,
    pub extract: Duration,
}

/// What came of asking the card.
pub(super) enum Asked {
    Made(OnCard),
    /// The processor is to do it.
    Processor,
}

impl Backend {
    /// As a setting says, which may change.
    pub fn following(choice: Choice) -> Self {
        Self::new(choice, false)
    }

    /// As told on the command line.
    pub fn forced(choice: Choice) -> Self {
        Self::new(choice, true)
    }

    fn new(choice: Choice, forced: bool) -> Self {
        Self(Arc::new(Inner {
            forced,
            state: Mutex::new((choice, State::Unopened)),
            drawing: Mutex::default(),
            untold: Mutex::default(),
            opening: Mutex::default(),
            kept: Mutex::default(),
            #[cfg(test)]
            broken: Mutex::default(),
            budget: AtomicU64::new(GpuOptions::default().budget),
            made: AtomicUsize::new(0),
            told_of_size: AtomicBool::new(false),
            told_of_memory: AtomicBool::new(false),
        }))
    }

    /// A card that is opened from here on gives a solid so many bytes of its memory at most.
    pub fn grant(&self, bytes: u64) {
        self.0.budget.store(bytes, Ordering::Relaxed);
    }

    /// What a card is opened with.
    fn options(&self, software: bool) -> GpuOptions {
        GpuOptions {
            software,
            budget: self.0.budget.load(Ordering::Relaxed),
        }
    }

    /// Takes up a setting that changed; a card that was lost is tried again.
    pub fn follow(&self, choice: Choice) {
        let mut state = self.state();
        if !self.0.forced && state.0 != choice {
            *state = (choice, State::Unopened);
        }
    }

    /// From here on a card that is opened is the one that draws: what it makes is drawn where it lies.
    pub fn draw_with(&self, device: RenderDevice, queue: RenderQueue, info: &RenderAdapterInfo) {
        let adapter = Adapter {
            name: info.name.clone(),
            api: format!("{:?}", info.backend),
            software: is_software(info),
        };
        let mut drawing = self
            .0
            .drawing
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        *drawing = Some(Drawing {
            device,
            queue,
            adapter,
        });
    }

    /// Opens the card that draws, or, where nothing is drawn or that one will not do, one of its own.
    fn open(&self, options: &GpuOptions) -> Result<Gpu, GpuError> {
        #[cfg(test)]
        if let Some(error) = self.0.broken.lock().ok().and_then(|b| b.clone()) {
            return Err(error);
        }
        let drawing = self
            .0
            .drawing
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        if let Some(drawing) = &*drawing {
            let (device, queue) = (
                drawing.device.wgpu_device().clone(),
                (***drawing.queue).clone(),
            );
            if let Ok(gpu) = Gpu::share(device, queue, drawing.adapter.clone(), options) {
                return Ok(gpu);
            }
        }
        drop(drawing);
        Gpu::open(options)
    }

    /// Who makes solids, for people.
    pub fn says(&self) -> String {
        let state = self.state();
        match &*state {
            (Choice::Processor, _) => "The processor makes solids.".to_owned(),
            (_, State::Unopened) => "The card is asked with the next solid.".to_owned(),
            (_, State::Opening) => "The card is being asked.".to_owned(),
            (_, State::Open(gpu)) => format!(
                "{} makes solids, each in {} MiB of its memory at most.",
                gpu.adapter().name,
                gpu.budget() >> 20
            ),
            (_, State::Closed(why)) => format!("The processor makes solids: {why}."),
        }
    }

    /// The card, where one makes solids at the moment.
    pub fn in_use(&self) -> Option<Arc<Gpu>> {
        match &self.state().1 {
            State::Open(gpu) => Some(gpu.clone()),
            _ => None,
        }
    }

    /// How many solids and sketches the card made so far.
    pub fn made(&self) -> usize {
        self.0.made.load(Ordering::Relaxed)
    }

    fn state(&self) -> std::sync::MutexGuard<'_, (Choice, State)> {
        self.0.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The card, opened by whoever asks first. Where it is optional nobody waits for it.
    fn card(&self) -> Result<Arc<Gpu>, Option<String>> {
        let mut state = self.state();
        match &*state {
            (Choice::Processor, _) | (_, State::Closed(_)) => Err(None),
            (_, State::Open(gpu)) => Ok(gpu.clone()),
            (Choice::Auto, State::Opening) => Err(None),
            (Choice::Auto, State::Unopened) => {
                state.1 = State::Opening;
                let asked = self.clone();
                let open = move || {
                    let opened = asked.open(&asked.options(false));
                    // What came of it is in the state.
                    let _ = asked.opened(Choice::Auto, opened);
                };
                let spawned = std::thread::Builder::new()
                    .name("opening the card".to_owned())
                    .spawn(open);
                if let Err(e) = spawned {
                    state.1 = State::Closed(e.to_string());
                }
                Err(None)
            }
            (Choice::Card, State::Unopened | State::Opening) => {
                drop(state);
                self.card_at_last()
            }
        }
    }

    /// The card that was asked for by name: all wait for whoever opens it.
    fn card_at_last(&self) -> Result<Arc<Gpu>, Option<String>> {
        let _one = self
            .0
            .opening
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        match &mut *self.state() {
            (_, State::Open(gpu)) => return Ok(gpu.clone()),
            (_, State::Closed(_)) => return Err(None),
            (_, state) => *state = State::Opening,
        }
        let opened = self.open(&self.options(true));
        self.opened(Choice::Card, opened).map_err(Some)
    }

    fn opened(&self, choice: Choice, opened: Result<Gpu, GpuError>) -> Result<Arc<Gpu>, String> {
        let mut state = self.state();
        let opened = opened.map(Arc::new).map_err(|e| e.to_string());
        if state.0 == choice {
            state.1 = match &opened {
                Ok(gpu) => State::Open(gpu.clone()),
                Err(why) => State::Closed(why.clone()),
            };
        }
        opened
    }

    /// The solid by the card, if that is to make it and can; what can be seen of it sooner is in `early` then. It may lack
    /// its edges once `cancel` is set.
    pub(super) fn make(
        &self,
        recipe: &Recipe,
        step: f32,
        meshes: &dyn MeshSource,
        early: &Early,
        cancel: &AtomicBool,
    ) -> Asked {
        if !can_make(recipe) {
            return Asked::Processor;
        }
        let gpu = match self.card() {
            Ok(gpu) => gpu,
            Err(line) => {
                self.tell(line);
                return Asked::Processor;
            }
        };
        // What a recipe lacks is told by the processor's path.
        let Ok(program) = Program::compile(recipe, &Placement::IDENTITY, step, meshes) else {
            return Asked::Processor;
        };
        let mut made = self.on_card(&gpu, &program, early, cancel);
        // What others have there gives way before the processor is asked.
        if let Err(GpuError::OutOfMemory { .. } | GpuError::Full) = made
            && self.forget()
        {
            made = self.on_card(&gpu, &program, early, cancel);
        }
        match made {
            Ok(made) => {
                self.succeeded();
                Asked::Made(made)
            }
            Err(error) => {
                self.tell(self.failed(&error));
                Asked::Processor
            }
        }
    }

    fn succeeded(&self) {
        self.0.made.fetch_add(1, Ordering::Relaxed);
        self.0.told_of_memory.store(false, Ordering::Relaxed);
    }

    /// A card that failed is not asked again, unless it only lacked memory; what the user should know of it, once.
    fn failed(&self, error: &GpuError) -> Option<String> {
        let line = || {
            format!(
                "{}; the processor makes the solid.",
                capital(&error.to_string())
            )
        };
        match error {
            GpuError::Unsupported(_) => return None,
            // Each edit of a large solid asks again: once is enough.
            GpuError::Budget { .. } | GpuError::TooFine(_) => {
                let told = self.0.told_of_size.swap(true, Ordering::Relaxed);
                return (!told).then(line);
            }
            _ => {}
        }
        self.forget();
        // Memory comes back; a card that is gone or answers nonsense does not.
        if let GpuError::OutOfMemory { .. } | GpuError::Full = error {
            let told = self.0.told_of_memory.swap(true, Ordering::Relaxed);
            return (!told).then(line);
        }
        let mut state = self.state();
        let first = matches!(state.1, State::Open(_));
        state.1 = State::Closed(error.to_string());
        first.then(line)
    }

    /// A sketch for the eye by the card, from the one before where there is one; `None` where the processor is to make
    /// it.
    pub(super) fn sketch(
        &self,
        recipe: &Recipe,
        step: f32,
        meshes: &dyn MeshSource,
        last: Option<GpuSolid>,
    ) -> Option<(GpuSolid, Emitted)> {
        if !can_make(recipe) {
            return None;
        }
        let gpu = self.card().map_err(|line| self.tell(line)).ok()?;
        let program = Program::compile(recipe, &Placement::IDENTITY, step, meshes).ok()?;
        let make = || {
            let solid = match last {
                Some(mut solid) if solid.is_on(&gpu) => {
                    solid.update(&program)?;
                    solid
                }
                _ => GpuSolid::make_with(&gpu, &program, KEPT)?,
            };
            let surface = solid.emit()?;
            self.succeeded();
            Ok((solid, surface))
        };
        make().map_err(|error| self.tell(self.failed(&error))).ok()
    }

    /// For whoever asks next what happened.
    fn tell(&self, line: Option<String>) {
        if let Some(line) = line {
            let mut untold = self.0.untold.lock().unwrap_or_else(PoisonError::into_inner);
            untold.push(line);
        }
    }

    /// What happened to the card since it was asked last, a line each.
    pub(super) fn untold(&self) -> Vec<String> {
        let mut untold = self.0.untold.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut *untold)
    }

    fn on_card(
        &self,
        gpu: &Arc<Gpu>,
        program: &Program,
        early: &Early,
        cancel: &AtomicBool,
    ) -> Result<OnCard, GpuError> {
        let mut kept = self.0.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let started = Instant::now();
        let solid = match kept.take(gpu, program) {
            Some(mut solid) => {
                solid.update(program)?;
                solid
            }
            None => GpuSolid::make_with(gpu, program, KEPT)?,
        };
        let made = started.elapsed();
        let emitted = solid.emit()?;
        if gpu.is_shared() {
            early.lies_on_card(emitted.clone());
        }
        let mesh = emitted.mesh()?;
        if !program.is_painting() {
            early.is_plain(&mesh);
        }
        let timing = solid.timing();
        kept.keep(solid, gpu.budget());
        // Edges are the processor's: the card is free for others meanwhile.
        drop(kept);
        let plain = mesh.positions.len();
        let sharp = crisp_unless(&mesh, program, cancel).ok().flatten();
        let mesh = sharp.unwrap_or(mesh);
        // Without a clock on the device all of it counts as fusing, all of the way back as extracting.
        let fuse = timing.cull.zip(timing.fuse).map_or(made, |(a, b)| a + b);
        Ok(OnCard {
            mesh,
            plain,
            fuse,
            extract: started.elapsed().saturating_sub(fuse),
        })
    }

    /// Gives up what is on the card; whether there was anything.
    fn forget(&self) -> bool {
        let mut kept = self.0.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.clear()
    }

    /// Loses the card on purpose, as a test of what then happens.
    #[cfg(test)]
    fn lose(&self) {
        if let State::Open(gpu) = &self.state().1 {
            gpu.lose();
        }
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests;
