//! A card that has no memory left or is lost in the middle of an edit costs nothing but time.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use bevy::prelude::*;
use midair::{Stage, app};
use midair_document::{Edit, Object, ObjectId};
use midair_field::{Canvas, Node, Op, Operand, Placement, Recipe, Skeleton, Stroke};
use midair_solid::Solid;
use midair_studio::evaluate::{Backend, Choice, Evaluations, Key, Made};
use midair_studio::notice::Notices;
use midair_studio::project::{Begin, Places, Project};

use super::{bitten, commit};

/// The app without any picture, its solids made by a card of its own.
struct Unseen {
    app: App,
    id: ObjectId,
    home: tempfile::TempDir,
}

impl Unseen {
    fn with(first: Recipe) -> Option<Self> {
        Self::within(first, 1 << 30)
    }

    /// A card that gives a solid so many bytes.
    fn within(first: Recipe, bytes: u64) -> Option<Self> {
        if midair_gpu::Gpu::adapters().is_empty() {
            eprintln!("skipped: no adapter, not even software");
            return None;
        }
        let home = tempfile::tempdir().unwrap();
        let mut app = app(Stage::Bare, Places::below(home.path()), Begin::default());
        let backend = Backend::forced(Choice::Card);
        backend.grant(bytes);
        app.world_mut().resource_mut::<Evaluations>().backend = backend;
        app.finish();
        app.cleanup();
        app.update();
        let id = ObjectId(app.world().resource::<Project>().document().next_id());
        let object = Object::solid("changing", first).placed(Placement::at(Vec3::Y));
        let add = Edit::Add {
            id,
            object: object.into(),
        };
        commit(&mut app, add);
        let mut unseen = Self { app, id, home };
        unseen.settle();
        Some(unseen)
    }

    fn settle(&mut self) {
        let since = Instant::now();
        let mut quiet = 0;
        while quiet < 6 {
            self.app.update();
            let busy = self.evaluations().outstanding() > 0;
            quiet = if busy { 0 } else { quiet + 1 };
            assert!(since.elapsed() < Duration::from_secs(300), "never done");
        }
    }

    fn becomes(&mut self, recipe: Recipe) {
        commit(&mut self.app, Edit::set_recipe(self.id, recipe));
    }

    fn evaluations(&self) -> &Evaluations {
        self.app.world().resource()
    }

    fn backend(&self) -> Backend {
        self.evaluations().backend.clone()
    }

    /// What is there of the object as the document has it, and its step: the document's, or finer for the eye.
    fn made(&self) -> Option<(Arc<Made>, f32)> {
        let document = self.app.world().resource::<Project>().document();
        let recipe = document.object(self.id)?.recipe()?;
        [0.5, 1.0].into_iter().find_map(|finer| {
            let step = finer * document.step();
            let made = self.evaluations().made(&Key::new(recipe, step))?;
            Some((made, step))
        })
    }

    fn warnings(&self) -> Vec<String> {
        self.app.world().resource::<Notices>().warnings().to_vec()
    }
}

fn painted(n: u32) -> Recipe {
    let point = |i: u32| Vec3::new(0.03 * i as f32 - 0.2, 0.0, 0.01 * i as f32).extend(1.0);
    let ball = Stroke::new(Skeleton::Volume(bitten(0.2)), 0.03);
    let led = Stroke::new(Skeleton::Points((0..=n).map(point).collect()), 0.06);
    Recipe::new(Node::Canvas(Canvas {
        strokes: vec![ball, led],
        ..Canvas::default()
    }))
}

/// Fails unless it is what the processor makes.
fn as_the_processor(made: Option<(Arc<Made>, f32)>, recipe: &Recipe) {
    let (made, step) = made.expect("it is there");
    let go = AtomicBool::new(false);
    let solid = Solid::make(recipe, &Placement::IDENTITY, step, &(), &go).unwrap();
    assert_eq!(*made.mesh, solid.crisp());
}

fn memory_runs_out(first: Recipe, second: Recipe, third: Recipe) {
    let Some(mut it) = Unseen::with(first.clone()) else {
        return;
    };
    let backend = it.backend();
    assert!(backend.made() > 0, "{}", backend.says());
    assert_eq!(it.warnings(), Vec::<String>::new());

    // Whatever it asks for from here on is not there.
    let card = backend.in_use().expect("it makes solids");
    card.starve(Some(4096));
    it.becomes(second.clone());
    it.settle();
    as_the_processor(it.made(), &second);
    let by_card = backend.made();
    let [line] = &it.warnings()[..] else {
        panic!("{:?}", it.warnings());
    };
    assert!(
        line.contains("no ")
            && line.contains("left")
            && line.ends_with("the processor makes the solid."),
        "{line}"
    );
    assert!(!line.contains('\n'), "{line}");

    // The work is whole, and so is its history.
    {
        let mut project = it.app.world_mut().resource_mut::<Project>();
        assert!(project.undo().is_some());
        assert_eq!(
            project.document().object(it.id).unwrap().recipe(),
            Some(&first)
        );
        assert!(project.redo().is_some());
        assert_eq!(
            project.document().object(it.id).unwrap().recipe(),
            Some(&second)
        );
    }

    // Memory comes back, and with it the card.
    card.starve(None);
    it.becomes(third);
    it.settle();
    assert!(backend.made() > by_card, "{}", backend.says());
    assert!(it.made().is_some());
    assert_eq!(it.warnings().len(), 1, "{:?}", it.warnings());
}

#[test]
fn memory_that_runs_out_while_a_solid_is_edited() {
    memory_runs_out(bitten(0.2), bitten(0.24), bitten(0.22));
}

#[test]
fn memory_that_runs_out_while_a_painting_is_edited() {
    memory_runs_out(painted(10), painted(12), painted(13));
}

/// A budget that the solid outgrows: one line for it, however often it is changed.
#[test]
fn a_solid_that_outgrows_its_budget_is_told_of_once() {
    let Some(mut it) = Unseen::within(bitten(0.2), 12 << 20) else {
        return;
    };
    assert!(
        it.backend().made() > 0 && it.warnings().is_empty(),
        "{:?}",
        it.warnings()
    );
    let large = |radius: f32| {
        let part = Operand {
            op: Op::Union,
            placement: Placement {
                scale: Vec3::splat(4.0),
                ..Placement::IDENTITY
            },
            recipe: bitten(radius),
            muted: false,
        };
        Recipe::new(Node::Solid(vec![part]))
    };
    for radius in [0.2, 0.21] {
        it.becomes(large(radius));
        it.settle();
        as_the_processor(it.made(), &large(radius));
    }
    let [line] = &it.warnings()[..] else {
        panic!("{:?}", it.warnings());
    };
    assert!(
        line.contains("12 MiB") && line.contains("processor"),
        "{line}"
    );
    assert!(it.backend().says().contains("12 MiB"));
}

#[test]
fn a_card_that_is_lost_in_the_middle_of_an_edit() {
    for (first, second, third) in [
        (bitten(0.2), bitten(0.24), bitten(0.22)),
        (painted(10), painted(12), painted(13)),
    ] {
        let Some(mut it) = Unseen::with(first) else {
            return;
        };
        let backend = it.backend();
        assert!(backend.made() > 0, "{}", backend.says());
        it.becomes(second.clone());
        // On its way.
        it.app.update();
        backend.in_use().expect("it makes solids").lose();
        it.settle();
        assert!(it.made().is_some(), "{:?}", it.warnings());
        it.becomes(third.clone());
        it.settle();
        as_the_processor(it.made(), &third);
        let [line] = &it.warnings()[..] else {
            panic!("{:?}", it.warnings());
        };
        assert!(
            line.contains("lost") && line.ends_with("the processor makes the solid."),
            "{line}"
        );
        assert!(backend.says().contains("lost"), "{}", backend.says());
        assert!(it.home.path().exists());
    }
}
