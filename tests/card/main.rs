//! What the card makes is drawn where it lies, before main memory has it, and looks as what the processor makes.

mod cost;
mod trouble;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use bevy::camera::RenderTarget;
use bevy::prelude::*;
use bevy::render::render_resource::{PipelineCache, TextureFormat};
use bevy::render::renderer::RenderDevice;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::render::{Render, RenderApp, RenderSystems};
use midair::{Stage, app};
use midair_document::{Edit, Object, ObjectId};
use midair_field::{Canvas, Node, Op, Operand, Placement, Primitive, Recipe, Skeleton, Stroke};
use midair_studio::evaluate::{Backend, Choice, Delivery, Evaluations, Live};
use midair_studio::notice::Notices;
use midair_studio::project::{Begin, Places, Project};
use midair_studio::show::{CardWrites, Eye, ObjectMap, camera};

const SIZE: UVec2 = UVec2::new(480, 320);

#[derive(Resource, Default)]
struct Taken(Option<Image>);

/// A hollow ball of so large a radius beside a box: several operands and nothing sharp, which the processor would
/// put in afterwards.
fn beside(radius: f32) -> Recipe {
    let part = |op, x: f32, p: Primitive| Operand {
        op,
        placement: Placement::at(Vec3::X * x),
        recipe: p.into(),
        muted: false,
    };
    let cuboid = Primitive::Cuboid {
        half: Vec3::splat(0.12),
        rounding: 0.05,
    };
    let ball = |radius| Primitive::Sphere { radius };
    Recipe::new(Node::Solid(vec![
        part(Op::Union, -0.35, cuboid),
        part(Op::Union, 0.1, ball(radius)),
        part(Op::Subtract, 0.1, ball(0.1)),
    ]))
}

/// A box from which a ball of so large a radius is taken.
fn bitten(radius: f32) -> Recipe {
    let part = |op, at: Vec3, p: Primitive| Operand {
        op,
        placement: Placement::at(at),
        recipe: p.into(),
        muted: false,
    };
    Recipe::new(Node::Solid(vec![
        part(
            Op::Union,
            Vec3::ZERO,
            Primitive::Cuboid {
                half: Vec3::splat(0.2),
                rounding: 0.02,
            },
        ),
        part(
            Op::Subtract,
            Vec3::new(0.15, 0.15, 0.2),
            Primitive::Sphere { radius },
        ),
    ]))
}

fn commit(app: &mut App, edit: Edit) {
    app.world_mut()
        .resource_scope(|world, mut project: Mut<Project>| {
            let mut notices = world.resource_mut::<Notices>();
            assert!(project.commit("a change", [edit], &mut notices));
        });
}

/// The whole app without a window, drawing; `None` where nothing can draw.
struct Drawn {
    app: App,
    target: Handle<Image>,
    id: ObjectId,
    /// How many pipelines are still made: what needs one is not seen until then.
    making: Arc<AtomicUsize>,
    _home: tempfile::TempDir,
}

impl Drawn {
    fn by(choice: Choice) -> Option<Self> {
        Self::of(choice, beside(0.2), |_| {})
    }

    fn of(choice: Choice, first: Recipe, prepare: impl FnOnce(&mut App)) -> Option<Self> {
        let home = tempfile::tempdir().unwrap();
        let mut app = app(Stage::Picture, Places::below(home.path()), Begin::default());
        app.world_mut().resource_mut::<Evaluations>().backend = Backend::forced(choice);
        let making = Arc::new(AtomicUsize::new(0));
        let count = making.clone();
        if let Some(render) = app.get_sub_app_mut(RenderApp) {
            let note = move |cache: Res<PipelineCache>| {
                count.store(cache.waiting_pipelines().count(), Ordering::Relaxed);
            };
            render.add_systems(Render, note.in_set(RenderSystems::Cleanup));
        }
        prepare(&mut app);
        app.finish();
        app.cleanup();
        if app.world().get_resource::<RenderDevice>().is_none() {
            eprintln!("skipped: nothing draws on this machine");
            return None;
        }
        app.init_resource::<Taken>();
        app.update();
        let image = Image::new_target_texture(SIZE.x, SIZE.y, TextureFormat::Rgba8UnormSrgb, None);
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
        app.world_mut().spawn((
            camera(Eye::Picture),
            RenderTarget::from(target.clone()),
            Transform::from_xyz(0.5, 1.45, 1.0).looking_at(Vec3::Y, Vec3::Y),
        ));
        let id = ObjectId(app.world().resource::<Project>().document().next_id());
        let object = Object::solid("changing", first).placed(Placement::at(Vec3::Y));
        commit(
            &mut app,
            Edit::Add {
                id,
                object: object.into(),
            },
        );
        let mut drawn = Self {
            app,
            target,
            id,
            making,
            _home: home,
        };
        drawn.settle();
        Some(drawn)
    }

    fn change(&mut self, radius: f32) {
        self.become_of(beside(radius));
    }

    fn become_of(&mut self, recipe: Recipe) {
        commit(&mut self.app, Edit::set_recipe(self.id, recipe));
    }

    /// Frames until nothing is on its way.
    fn settle(&mut self) {
        let since = Instant::now();
        let mut quiet = 0;
        while quiet < 6 {
            self.app.update();
            quiet = if self.is_busy() { 0 } else { quiet + 1 };
            assert!(since.elapsed() < Duration::from_secs(300), "never done");
        }
    }

    fn is_busy(&self) -> bool {
        self.app.world().resource::<Evaluations>().outstanding() > 0
    }

    fn written(&self) -> usize {
        self.app.world().resource::<CardWrites>().written()
    }

    fn mesh(&self) -> AssetId<Mesh> {
        let world = self.app.world();
        let entity = world.resource::<ObjectMap>().get(self.id).unwrap();
        world.get::<Mesh3d>(entity).expect("it is shown").0.id()
    }

    fn picture(&mut self) -> Vec<u8> {
        // Shadows and pipelines settle first.
        let (since, mut frames) = (Instant::now(), 0);
        while frames < 8 || self.making.load(Ordering::Relaxed) > 0 {
            self.app.update();
            frames += 1;
            assert!(since.elapsed() < Duration::from_secs(300), "no pipelines");
        }
        self.app
            .world_mut()
            .spawn(Screenshot::image(self.target.clone()))
            .observe(|shot: On<ScreenshotCaptured>, mut taken: ResMut<Taken>| {
                taken.0 = Some(shot.image.clone());
            });
        let since = Instant::now();
        loop {
            self.app.update();
            if let Some(image) = self.app.world_mut().resource_mut::<Taken>().0.take() {
                return image.try_into_dynamic().unwrap().to_rgb8().into_raw();
            }
            assert!(since.elapsed() < Duration::from_secs(300), "no picture");
        }
    }
}

/// The share of colours that differ by more than a little.
fn different(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let far = a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 6).count();
    far as f64 / a.len() as f64
}

#[test]
fn what_the_card_makes_is_drawn_before_main_memory_has_it() {
    let (Some(mut card), Some(mut processor)) =
        (Drawn::by(Choice::Card), Drawn::by(Choice::Processor))
    else {
        return;
    };
    let says = card.app.world().resource::<Evaluations>().backend.says();
    assert!(
        says.contains("makes solids") && says.contains("MiB") && !says.contains("processor"),
        "{says}"
    );
    let at_first = processor.picture();
    let off = different(&card.picture(), &at_first);
    assert!(off < 0.002, "as made first: {off}");
    // The first change comes through main memory, into a mesh with room to spare.
    card.change(0.24);
    card.settle();
    let room = card.mesh();
    let before = card.written();

    // Nothing is taken in from here on: what is seen has not come from main memory.
    card.app.insert_resource(Delivery::Exactly(Vec::new()));
    card.change(0.27);
    let since = Instant::now();
    while card.written() == before || card.is_busy() {
        card.app.update();
        assert!(since.elapsed() < Duration::from_secs(300), "never drawn");
    }
    assert_eq!(card.mesh(), room, "the same mesh is drawn all along");
    assert!(
        card.app
            .world()
            .resource::<Evaluations>()
            .progress()
            .next()
            .is_some()
    );
    processor.change(0.27);
    processor.settle();
    let expected = processor.picture();
    assert!(
        different(&at_first, &expected) > 0.01,
        "the change can be seen"
    );
    let off = different(&card.picture(), &expected);
    println!("{off:.5} of the colours differ");
    assert!(off < 0.002, "{off}");

    // Taken back before it could be touched: what was there is there again.
    card.change(0.24);
    processor.change(0.24);
    processor.settle();
    let off = different(&card.picture(), &processor.picture());
    assert!(off < 0.002, "taken back: {off}");

    // And what comes later is drawn where the card has it, or from main memory, the same.
    card.app.insert_resource(Delivery::AsTheyCome);
    card.change(0.21);
    card.settle();
    processor.change(0.21);
    processor.settle();
    let off = different(&card.picture(), &processor.picture());
    assert!(off < 0.002, "at the end: {off}");
}

/// A painting that is led on so far.
fn painted(n: u32) -> Recipe {
    let point = |i: u32| {
        let t = 0.2 * i as f32;
        Vec3::new(0.02 * i as f32 - 0.2, 0.1 * t.sin(), 0.1 * t.cos()).extend(1.0)
    };
    let corners = [(-0.2, -0.2), (0.2, -0.2), (0.0, 0.15)];
    let corners = corners.map(|(x, z)| Vec3::new(x, -0.12, z));
    Recipe::new(Node::Canvas(Canvas {
        strokes: vec![
            Stroke::new(Skeleton::Polygon(corners.into()), 0.04),
            Stroke::new(Skeleton::Points((0..=n).map(point).collect()), 0.05),
            Stroke {
                twin: 1,
                ..Stroke::new(Skeleton::Volume(bitten(0.2)), 0.03)
            },
            Stroke {
                twin: 1,
                ..Stroke::new(Skeleton::Volume(bitten(0.24)), 0.03)
            },
            Stroke::new(
                Skeleton::Line(Vec3::new(0.0, -0.1, 0.0), Vec3::Y * 0.2),
                0.03,
            ),
        ],
        ..Canvas::default()
    }))
}

#[test]
fn a_painting_is_made_and_drawn_by_the_card_as_well() {
    let first = || painted(12);
    let (Some(mut card), Some(mut processor)) = (
        Drawn::of(Choice::Card, first(), |_| {}),
        Drawn::of(Choice::Processor, first(), |_| {}),
    ) else {
        return;
    };
    for n in [16, 18, 20] {
        card.become_of(painted(n));
        card.settle();
    }
    assert!(
        card.written() > 0,
        "the last ones were drawn where they lie"
    );
    processor.become_of(painted(20));
    processor.settle();
    let off = different(&card.picture(), &processor.picture());
    println!("{off:.5} of the colours differ");
    assert!(off < 0.002, "{off}");
}

/// Shows a sketch of a recipe whose step at rest would be `finest`; gives the step it has.
fn sketch(
    drawn: &mut Drawn,
    live: &mut Live,
    entity: &mut Option<Entity>,
    recipe: &Recipe,
    finest: f32,
) -> f32 {
    let since = Instant::now();
    loop {
        let world = drawn.app.world_mut();
        let come = live.ask(recipe, finest, world.resource::<Evaluations>());
        if let Some(sketch) = come {
            let (current, step) = (sketch.key.recipe == recipe.hash(), sketch.key.step());
            let seen = world.resource_scope(|world, mut meshes: Mut<Assets<Mesh>>| {
                live.draw(sketch, &mut meshes, &mut world.resource_mut::<CardWrites>())
            });
            let seen = seen.expect("it can be drawn");
            let at = Transform::from_translation(Vec3::Y);
            let look = world
                .resource_mut::<Assets<StandardMaterial>>()
                .add(StandardMaterial::default());
            let mut commands = world.commands();
            let mut own = match *entity {
                Some(e) => commands.entity(e),
                None => commands.spawn((MeshMaterial3d(look), at)),
            };
            seen.worn_by(&mut own);
            *entity = Some(own.id());
            world.flush();
            if current {
                return step;
            }
        }
        drawn.app.update();
        assert!(since.elapsed() < Duration::from_secs(300), "no sketch");
    }
}

#[test]
fn a_live_preview_stays_on_the_card() {
    // The object itself is out of sight.
    let away = || {
        let far = Operand {
            op: Op::Union,
            placement: Placement::at(Vec3::new(0.0, 90.0, 0.0)),
            recipe: Primitive::Sphere { radius: 0.02 }.into(),
            muted: false,
        };
        Recipe::new(Node::Solid(vec![far]))
    };
    let (Some(mut card), Some(mut processor)) = (
        Drawn::of(Choice::Card, away(), |_| {}),
        Drawn::of(Choice::Processor, away(), |_| {}),
    ) else {
        return;
    };
    let (mut live, mut entity, mut step) = (Live::default(), None, 0.0);
    for radius in [0.2, 0.22, 0.24, 0.26] {
        step = sketch(&mut card, &mut live, &mut entity, &beside(radius), 0.01);
    }
    assert!(card.written() > 0, "some were drawn where they lie");
    // The first of all is twice as coarse as at rest: the same step, however quick the card was.
    let (mut live, mut entity) = (Live::default(), None);
    let last = beside(0.26);
    let same = sketch(&mut processor, &mut live, &mut entity, &last, 0.5 * step);
    assert_eq!(same, step);
    let off = different(&card.picture(), &processor.picture());
    println!("{off:.5} of the colours differ, {} written", card.written());
    assert!(off < 0.002, "{off}");
}
