//! What the card makes is drawn where it lies, before main memory has it, and looks as what the processor makes.

use std::time::{Duration, Instant};

use bevy::camera::RenderTarget;
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy::render::renderer::RenderDevice;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use midair::{Stage, app};
use midair_document::{Edit, Object, ObjectId};
use midair_field::{Node, Op, Operand, Placement, Primitive, Recipe};
use midair_studio::evaluate::{Backend, Choice, Delivery, Evaluations};
use midair_studio::notice::Notices;
use midair_studio::project::{Begin, Places, Project};
use midair_studio::show::{CardWrites, Eye, ObjectMap, camera};

const SIZE: UVec2 = UVec2::new(480, 320);

#[derive(Resource, Default)]
struct Taken(Option<Image>);

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
    _home: tempfile::TempDir,
}

impl Drawn {
    fn by(choice: Choice) -> Option<Self> {
        let home = tempfile::tempdir().unwrap();
        let mut app = app(Stage::Picture, Places::below(home.path()), Begin::default());
        app.world_mut().resource_mut::<Evaluations>().backend = Backend::forced(choice);
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
        let object = Object::solid("bitten", bitten(0.2)).placed(Placement::at(Vec3::Y));
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
            _home: home,
        };
        drawn.settle();
        Some(drawn)
    }

    fn change(&mut self, radius: f32) {
        commit(&mut self.app, Edit::set_recipe(self.id, bitten(radius)));
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
        for _ in 0..8 {
            self.app.update();
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
        says.ends_with("makes solids.") && !says.contains("processor"),
        "{says}"
    );
    let bitten_once = processor.picture();
    assert!(
        different(&card.picture(), &bitten_once) < 0.002,
        "as made first"
    );
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
        different(&bitten_once, &expected) > 0.01,
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
