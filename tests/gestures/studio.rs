//! The studio driven frame by frame, its document looked at after every one.

use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use midair::{Stage, app};
use midair_document::{Document, Object, ObjectId};
use midair_field::{Op, Placement, Recipe};
use midair_mesh::{Report, TriMesh, check};
use midair_solid::Solid;
use midair_studio::command::{Command, Errands};
use midair_studio::evaluate::Evaluations;
use midair_studio::hands::{Action, HandsInput, Pose, Side, WriteHands};
use midair_studio::hold::Held;
use midair_studio::notice::Notices;
use midair_studio::pick::Touch;
use midair_studio::project::{Begin, Places, Project, Shelf};
use midair_studio::show::{Arriving, Drafts, ObjectMap};
use midair_studio::tools::{AddTool, Tool, ToolId};

/// A second mode that does nothing, to leave Assemble for.
pub const ELSEWHERE: ToolId = ToolId::new("test/elsewhere");

/// Seconds within which no two clicks are one double click.
const APART: f32 = 0.45;
/// A frame at 90 Hz.
const FRAME: Duration = Duration::from_nanos(11_111_111);
/// The longest frame that counts in full towards a hold.
const LONG: Duration = Duration::from_nanos(33_333_333);

/// What the devices say, written into the hands in every frame as a way in does.
#[derive(Resource, Default)]
struct Device(HandsInput);

pub struct Studio {
    app: App,
    pub home: tempfile::TempDir,
}

impl Studio {
    /// An empty studio at a coarse step, hands away from everything.
    pub fn new() -> Self {
        Self::with(|_| {})
    }

    /// The same, with more in it.
    pub fn with(prepare: impl FnOnce(&mut App)) -> Self {
        let home = tempfile::tempdir().unwrap();
        let mut app = app(Stage::Bare, Places::below(home.path()), Begin::default());
        app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME))
            .add_tool(Tool {
                id: ELSEWHERE,
                name: "Elsewhere",
                about: "Nothing",
                order: 90,
            })
            .init_resource::<Device>()
            .add_systems(
                Update,
                (|device: Res<Device>, mut input: ResMut<HandsInput>| {
                    input.set_if_neq(device.0);
                })
                .in_set(WriteHands),
            );
        prepare(&mut app);
        app.finish();
        app.cleanup();
        let mut studio = Self { app, home };
        studio.put(Side::Left, Pose::at(Vec3::new(-1.0, 3.0, 0.0)));
        studio.put(Side::Right, Pose::at(Vec3::new(1.0, 3.0, 0.0)));
        studio.frames(2);
        studio.ask(Command::Step(0.02));
        studio
    }

    pub fn world(&self) -> &World {
        self.app.world()
    }

    pub fn document(&self) -> &Document {
        self.world().resource::<Project>().document()
    }

    pub fn object(&self, id: ObjectId) -> &Object {
        self.document().object(id).expect("the object is there")
    }

    pub fn placement(&self, id: ObjectId) -> Placement {
        self.object(id).placement
    }

    pub fn only(&self) -> ObjectId {
        assert_eq!(self.document().len(), 1);
        self.document().objects().next().unwrap().0
    }

    pub fn undo_len(&self) -> usize {
        self.world().resource::<Project>().history().undo_len()
    }

    pub fn redo_len(&self) -> usize {
        self.world().resource::<Project>().history().redo_len()
    }

    pub fn held(&self) -> &Held {
        self.world().resource::<Held>()
    }

    pub fn touched(&self, side: Side) -> Option<ObjectId> {
        let touch = self.world().resource::<Touch>();
        touch.get(side).map(|t| t.object)
    }

    pub fn library_open(&self) -> bool {
        self.world().resource::<Shelf>().open
    }

    pub fn warnings(&self) -> &[String] {
        self.world().resource::<Notices>().warnings()
    }

    /// Where an object is shown.
    pub fn shown(&self, id: ObjectId) -> Transform {
        let entity = self.world().resource::<ObjectMap>().get(id);
        let entity = entity.expect("the object is shown");
        *self.world().get::<Transform>(entity).unwrap()
    }

    /// Where a hand has an object at the moment.
    pub fn drafted(&self, id: ObjectId) -> Option<Placement> {
        self.world().resource::<Drafts>().get(id).copied()
    }

    /// One frame; the document is sound after it, and so is what is shown.
    pub fn frame(&mut self) {
        self.app.update();
        let document = self.document();
        let faults = document.check();
        assert!(faults.is_empty(), "{faults:?}");
        let ids: Vec<_> = document.objects().map(|(id, _)| id).collect();
        let map = self.world().resource::<ObjectMap>();
        let arriving = self.world().resource::<Arriving>().count() > 0;
        let ids: Vec<_> = ids
            .into_iter()
            .filter(|&id| !arriving || map.get(id).is_some())
            .collect();
        for id in ids {
            assert!(self.shown(id).is_finite(), "object {id} is shown nowhere");
            if let Some(draft) = self.drafted(id) {
                assert!(draft.is_sound(), "object {id} is held nowhere");
            }
        }
    }

    /// How many things have a component.
    pub fn count<T: Component>(&mut self) -> usize {
        let world = self.app.world_mut();
        world.query::<&T>().iter(world).count()
    }

    /// One frame and nothing beside it, to be timed.
    pub fn app_update(&mut self) {
        self.app.update();
    }

    pub fn frames(&mut self, n: usize) {
        for _ in 0..n {
            self.frame();
        }
    }

    /// Time passes in long frames while the hands rest: what goes by seconds takes a third of the frames.
    pub fn pass(&mut self, seconds: f32) {
        let strategy = TimeUpdateStrategy::ManualDuration(LONG);
        self.app.insert_resource(strategy);
        self.frames((seconds / LONG.as_secs_f32()).ceil() as usize);
        let strategy = TimeUpdateStrategy::ManualDuration(FRAME);
        self.app.insert_resource(strategy);
    }

    /// Frames until something has come about.
    pub fn until(&mut self, what: &str, is: impl Fn(&Self) -> bool) {
        let since = Instant::now();
        while !is(self) {
            self.frame();
            std::thread::sleep(Duration::from_millis(5));
            assert!(since.elapsed() < Duration::from_secs(30), "never {what}");
        }
    }

    /// Frames until nothing is on its way, and what is there can be touched.
    pub fn settle(&mut self) {
        let since = Instant::now();
        let mut quiet = 0;
        while quiet < 4 {
            self.frame();
            let world = self.world();
            let busy = world.resource::<Evaluations>().progress().next().is_some()
                || world.resource::<Arriving>().count() > 0
                || !world.resource::<Errands>().is_empty();
            quiet = if busy { 0 } else { quiet + 1 };
            if busy {
                std::thread::sleep(Duration::from_micros(300));
            }
            assert!(since.elapsed() < Duration::from_secs(60), "never done");
        }
    }

    pub fn ask(&mut self, command: Command) {
        self.app.world_mut().write_message(command);
        self.frame();
    }

    /// Asks for something in the frame that comes next.
    pub fn send(&mut self, command: Command) {
        self.app.world_mut().write_message(command);
    }

    pub fn world_mut(&mut self) -> &mut World {
        self.app.world_mut()
    }

    pub fn input(&mut self) -> Mut<'_, HandsInput> {
        let device = self.app.world_mut().resource_mut::<Device>();
        device.map_unchanged(|d| &mut d.0)
    }

    /// The hand is there from the next frame on.
    pub fn put(&mut self, side: Side, pose: Pose) {
        self.input().side(side).pose = Some(pose);
    }

    pub fn pose(&mut self, side: Side) -> Pose {
        self.input().side(side).pose.expect("a hand")
    }

    /// The hand is there, and has noticed what it touches.
    pub fn reach(&mut self, side: Side, at: Vec3) {
        self.put(side, Pose::at(at));
        self.frames(2);
    }

    /// Both hands go where they are to in some frames, on straight lines.
    pub fn carry(&mut self, left: Option<Pose>, right: Option<Pose>) {
        const FRAMES: usize = 12;
        let ends = [(Side::Left, left), (Side::Right, right)];
        let starts =
            ends.map(|(side, _)| self.input().side(side).pose.unwrap_or(Pose::at(Vec3::ZERO)));
        for i in 1..=FRAMES {
            let t = i as f32 / FRAMES as f32;
            for ((side, end), start) in ends.into_iter().zip(starts) {
                if let Some(end) = end {
                    self.put(
                        side,
                        Pose {
                            position: start.position.lerp(end.position, t),
                            rotation: start.rotation.slerp(end.rotation, t),
                        },
                    );
                }
            }
            self.frame();
        }
        for (side, end) in ends {
            if let Some(end) = end {
                self.put(side, end);
            }
        }
        self.frame();
    }

    pub fn carry_right(&mut self, to: Vec3) {
        self.carry(None, Some(Pose::at(to)));
    }

    pub fn press(&mut self, side: Side, action: Action) {
        self.input().side(side).down.set(action, true);
        self.frame();
    }

    pub fn let_go(&mut self, side: Side, action: Action) {
        self.input().side(side).down.set(action, false);
        self.frame();
    }

    pub fn swipe(&mut self, touch: Option<Vec2>) {
        self.input().side(Side::Right).swipe = touch;
        self.frame();
    }

    /// A click that is not half of a double click.
    pub fn click(&mut self, side: Side, action: Action) {
        self.press(side, action);
        self.pass(0.09);
        self.let_go(side, action);
        if matches!(action, Action::Centre | Action::Menu) {
            self.pass(APART);
        }
    }

    /// The component appears at `at`, the right hand with it.
    pub fn place(&mut self, component: &str, at: Vec3) -> ObjectId {
        if !self.library_open() {
            self.click(Side::Right, Action::Library);
        }
        self.reach(Side::Right, at);
        let before = self.document().len();
        self.ask(Command::Place {
            component: component.to_owned(),
            side: Side::Right,
        });
        assert_eq!(self.document().len(), before + 1, "{:?}", self.warnings());
        self.settle();
        self.document().objects().next_back().unwrap().0
    }

    /// Opens SceneOperate on the right hand, which touches nothing.
    pub fn operate(&mut self) {
        self.reach(Side::Right, Vec3::new(0.0, 4.0, 0.0));
        self.click(Side::Right, Action::Up);
    }

    /// Marks with the right hand at `at`.
    pub fn mark(&mut self, at: Vec3, arm: Action) {
        self.reach(Side::Right, at);
        self.click(Side::Right, arm);
    }

    /// The middle of the pad, held; then the result is there.
    pub fn finish(&mut self) {
        self.press(Side::Right, Action::Centre);
        self.pass(0.44);
        self.let_go(Side::Right, Action::Centre);
        self.pass(APART);
        self.settle();
    }

    pub fn marks(&self) -> Vec<(ObjectId, Op)> {
        self.document().pending().to_vec()
    }

    /// The solid as it stands, at a step.
    pub fn mesh(&self, id: ObjectId, step: f32) -> TriMesh {
        let object = self.object(id);
        let recipe: &Recipe = object.recipe().expect("a solid");
        let volumes = &self.world().resource::<Evaluations>().volumes;
        let go = std::sync::atomic::AtomicBool::new(false);
        Solid::make(recipe, &object.placement, step, &**volumes, &go)
            .unwrap()
            .crisp()
    }

    /// The same, which has no fault.
    pub fn faultless(&self, id: ObjectId, step: f32) -> Report {
        let report = check(&self.mesh(id, step));
        assert!(report.is_faultless(), "{:?}", report.faults());
        report
    }
}

pub fn near(a: Vec3, b: Vec3, by: f32) {
    assert!(a.distance(b) <= by, "{a} is not {b}");
}
