//! Where solids are made: by the graphics card, or by the processor wherever the card cannot.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use midair_field::{MeshSource, Placement, Program, Recipe};
use midair_gpu::{Gpu, GpuError, GpuOptions, GpuSolid};
use midair_mesh::TriMesh;

pub use crate::settings::Backend as Choice;

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
    /// Held by whoever opens the card while others wait for it.
    opening: Mutex<()>,
    /// The solid that was made last, whose buffers the next one takes over.
    last: Mutex<Option<GpuSolid>>,
}

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
                    let opened = Gpu::open(&GpuOptions::default());
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
        let opened = Gpu::open(&GpuOptions {
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

    /// The solid by the card, if that is to make it and can.
    pub(super) fn make(&self, recipe: &Recipe, step: f32, meshes: &dyn MeshSource) -> Asked {
        let gpu = match self.card() {
            Ok(gpu) => gpu,
            Err(line) => return Asked::Processor(line),
        };
        // What a recipe lacks is told by the processor's path.
        let Ok(program) = Program::compile(recipe, &Placement::IDENTITY, step, meshes) else {
            return Asked::Processor(None);
        };
        match self.on_card(&gpu, &program) {
            Ok(made) => Asked::Made(made),
            Err(GpuError::Unsupported(_) | GpuError::Budget { .. } | GpuError::TooFine(_)) => {
                Asked::Processor(None)
            }
            Err(error) => {
                self.forget();
                let mut state = self.state();
                let first = matches!(state.1, State::Open(_));
                // Memory comes back; a card that is gone or answers nonsense does not.
                if !matches!(error, GpuError::OutOfMemory { .. }) {
                    state.1 = State::Closed(error.to_string());
                }
                let line = format!(
                    "{}; the processor makes the solid.",
                    capital(&error.to_string())
                );
                Asked::Processor(first.then_some(line))
            }
        }
    }

    fn on_card(&self, gpu: &Arc<Gpu>, program: &Program) -> Result<OnCard, GpuError> {
        let mut last = self.0.last.lock().unwrap_or_else(PoisonError::into_inner);
        let started = Instant::now();
        let solid = match last.take() {
            Some(mut solid) if solid.is_on(gpu) => {
                solid.update(program)?;
                solid
            }
            _ => GpuSolid::make(gpu, program)?,
        };
        let made = started.elapsed();
        let mesh = solid.mesh()?;
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
            backend.make(&ball(0.1), 0.01, &()),
            Asked::Processor(None)
        ));
        backend.follow(Choice::Card);
        assert_eq!(backend.says(), "The processor makes solids.");
    }

    #[test]
    fn nobody_waits_for_a_card_that_is_optional() {
        let backend = Backend::following(Choice::Auto);
        assert!(matches!(
            backend.make(&ball(0.1), 0.01, &()),
            Asked::Processor(None)
        ));
    }

    #[test]
    fn a_lost_card_is_told_once_and_the_processor_goes_on() {
        let backend = Backend::forced(Choice::Card);
        let Some(first) = made(backend.make(&ball(0.1), 0.01, &())) else {
            // No adapter, not even software: said, and left to the processor.
            assert!(backend.says().contains("processor"), "{}", backend.says());
            eprintln!("skipped: {}", backend.says());
            return;
        };
        let exact = 4.0 / 3.0 * std::f64::consts::PI * 1e-3;
        assert!((first.mesh.volume() / exact - 1.0).abs() < 0.02);
        // The next takes over its buffers.
        let second = made(backend.make(&ball(0.12), 0.01, &())).unwrap();
        assert!(second.mesh.volume() > 1.5 * first.mesh.volume());
        backend.lose();
        let Asked::Processor(Some(line)) = backend.make(&ball(0.1), 0.01, &()) else {
            panic!("a lost card makes nothing");
        };
        assert!(
            line.contains("lost") && line.contains("processor"),
            "{line}"
        );
        assert!(matches!(
            backend.make(&ball(0.1), 0.01, &()),
            Asked::Processor(None)
        ));
        assert!(backend.says().contains("lost"), "{}", backend.says());
    }
}
