//! Where solids are made: by the graphics card, or by the processor wherever the card cannot.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use bevy::render::renderer::{RenderAdapterInfo, RenderDevice, RenderQueue};
use midair_field::{MeshSource, Placement, Program, Recipe};
use midair_gpu::{Adapter, Emitted, Gpu, GpuError, GpuOptions, GpuSolid, SolidOptions};
use midair_mesh::TriMesh;

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
    /// What happened to a sketch, for the user.
    untold: Mutex<Option<String>>,
    /// Held by whoever opens the card while others wait for it.
    opening: Mutex<()>,
    /// The solid that was made last, whose buffers the next one takes over.
    last: Mutex<Option<GpuSolid>>,
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
    pub fuse: Duration,
    pub extract: Duration,
}

/// What came of asking the card.
pub(super) enum Asked {
    Made(OnCard),
    /// The processor is to do it; where something happened that the user should know, one line.
    Processor(Option<String>),
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
            last: Mutex::default(),
        }))
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
            (_, State::Open(gpu)) => format!("{} makes solids.", gpu.adapter().name),
            (_, State::Closed(why)) => format!("The processor makes solids: {why}."),
        }
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
                    let opened = asked.open(&GpuOptions::default());
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
        let opened = self.open(&GpuOptions {
            software: true,
            ..GpuOptions::default()
        });
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

    /// The solid by the card, if that is to make it and can. Where the card draws as well, `early` has its surface
    /// before main memory does.
    pub(super) fn make(
        &self,
        recipe: &Recipe,
        step: f32,
        meshes: &dyn MeshSource,
        early: &dyn Fn(Emitted),
    ) -> Asked {
        let gpu = match self.card() {
            Ok(gpu) => gpu,
            Err(line) => {
                let mut untold = self.0.untold.lock().unwrap_or_else(PoisonError::into_inner);
                return Asked::Processor(line.or_else(|| untold.take()));
            }
        };
        // What a recipe lacks is told by the processor's path.
        let Ok(program) = Program::compile(recipe, &Placement::IDENTITY, step, meshes) else {
            return Asked::Processor(None);
        };
        match self.on_card(&gpu, &program, early) {
            Ok(made) => Asked::Made(made),
            Err(error) => {
                let line = self.failed(&error);
                Asked::Processor(line)
            }
        }
    }

    /// A card that failed is not asked again, unless it only lacked memory; what the user should know of it, once.
    fn failed(&self, error: &GpuError) -> Option<String> {
        if let GpuError::Unsupported(_) | GpuError::Budget { .. } | GpuError::TooFine(_) = error {
            return None;
        }
        self.forget();
        let mut state = self.state();
        let first = matches!(state.1, State::Open(_));
        // Memory comes back; a card that is gone or answers nonsense does not.
        if !matches!(error, GpuError::OutOfMemory { .. } | GpuError::Full) {
            state.1 = State::Closed(error.to_string());
        }
        let line = format!(
            "{}; the processor makes the solid.",
            capital(&error.to_string())
        );
        first.then_some(line)
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
        let gpu = self.card().map_err(|line| self.tell_later(line)).ok()?;
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
            Ok((solid, surface))
        };
        make()
            .map_err(|error| self.tell_later(self.failed(&error)))
            .ok()
    }

    /// A sketch has nobody to tell what happened to it; the next solid does.
    fn tell_later(&self, line: Option<String>) {
        if let Some(line) = line {
            let mut untold = self.0.untold.lock().unwrap_or_else(PoisonError::into_inner);
            *untold = Some(line);
        }
    }

    fn on_card(
        &self,
        gpu: &Arc<Gpu>,
        program: &Program,
        early: &dyn Fn(Emitted),
    ) -> Result<OnCard, GpuError> {
        let mut last = self.0.last.lock().unwrap_or_else(PoisonError::into_inner);
        let started = Instant::now();
        let solid = match last.take() {
            Some(mut solid) if solid.is_on(gpu) => {
                solid.update(program)?;
                solid
            }
            _ => GpuSolid::make_with(gpu, program, KEPT)?,
        };
        let made = started.elapsed();
        let emitted = solid.emit()?;
        if gpu.is_shared() {
            early(emitted.clone());
        }
        let mesh = emitted.mesh()?;
        let timing = solid.timing();
        *last = Some(solid);
        // Without a clock on the device all of it counts as fusing, all of the way back as extracting.
        let fuse = timing.cull.zip(timing.fuse).map_or(made, |(a, b)| a + b);
        Ok(OnCard {
            mesh,
            fuse,
            extract: started.elapsed().saturating_sub(fuse),
        })
    }

    fn forget(&self) {
        *self.0.last.lock().unwrap_or_else(PoisonError::into_inner) = None;
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
mod tests {
    use super::*;
    use midair_field::Primitive;

    fn ball(radius: f32) -> Recipe {
        Primitive::Sphere { radius }.into()
    }

    fn made(asked: Asked) -> Option<OnCard> {
        match asked {
            Asked::Made(made) => Some(made),
            Asked::Processor(_) => None,
        }
    }

    #[test]
    fn the_processor_is_asked_where_it_was_chosen() {
        let backend = Backend::forced(Choice::Processor);
        assert!(matches!(
            backend.make(&ball(0.1), 0.01, &(), &|_| ()),
            Asked::Processor(None)
        ));
        backend.follow(Choice::Card);
        assert_eq!(backend.says(), "The processor makes solids.");
    }

    #[test]
    fn nobody_waits_for_a_card_that_is_optional() {
        let backend = Backend::following(Choice::Auto);
        assert!(matches!(
            backend.make(&ball(0.1), 0.01, &(), &|_| ()),
            Asked::Processor(None)
        ));
    }

    #[test]
    fn a_lost_card_is_told_once_and_the_processor_goes_on() {
        let backend = Backend::forced(Choice::Card);
        let Some(first) = made(backend.make(&ball(0.1), 0.01, &(), &|_| ())) else {
            // No adapter, not even software: said, and left to the processor.
            assert!(backend.says().contains("processor"), "{}", backend.says());
            eprintln!("skipped: {}", backend.says());
            return;
        };
        let exact = 4.0 / 3.0 * std::f64::consts::PI * 1e-3;
        assert!((first.mesh.volume() / exact - 1.0).abs() < 0.02);
        // The next takes over its buffers.
        let second = made(backend.make(&ball(0.12), 0.01, &(), &|_| ())).unwrap();
        assert!(second.mesh.volume() > 1.5 * first.mesh.volume());
        backend.lose();
        let Asked::Processor(Some(line)) = backend.make(&ball(0.1), 0.01, &(), &|_| ()) else {
            panic!("a lost card makes nothing");
        };
        assert!(
            line.contains("lost") && line.contains("processor"),
            "{line}"
        );
        assert!(matches!(
            backend.make(&ball(0.1), 0.01, &(), &|_| ()),
            Asked::Processor(None)
        ));
        assert!(backend.says().contains("lost"), "{}", backend.says());
    }
}
