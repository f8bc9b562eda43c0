//! What somebody meets who tries a mode for the first time, with mouse and keyboard.

use bevy::input::keyboard::{Key, NativeKey};
use bevy::prelude::*;
use bevy_egui::{EguiContext, PrimaryEguiContext};
use midair_brush::BRUSH;
use midair_document::{Edit, ObjectId};
use midair_field::Op;
use midair_flatscreen::Gizmo;
use midair_studio::command::Command;
use midair_studio::evaluate::Delivery;
use midair_studio::hands::Action;
use midair_studio::notice::Notices;
use midair_studio::objects::Ask;
use midair_studio::panel::egui::{Id, containers::panel::PanelState};
use midair_studio::settings::{BrushSkeleton, Settings};
use midair_studio::show::{ObjectMap, Readouts};
use midair_studio::tools::{HintKey, Hints, ToolId, Tools};
use midair_sweep::{Draft, SWEEP, Solo, Wires};

use crate::desk::Desk;

impl Desk {
    fn says(&mut self, command: Command) {
        self.app.world_mut().write_message(command);
        self.wait(3);
    }

    /// How wide the column of panels at the right is, in points.
    fn right_column(&mut self) -> f32 {
        let world = self.app.world_mut();
        let mut contexts = world.query_filtered::<&mut EguiContext, With<PrimaryEguiContext>>();
        let mut context = contexts.single_mut(world).unwrap();
        let state = PanelState::load(context.get_mut(), Id::new("right"));
        state.expect("a column at the right").outer_rect.width()
    }

    fn was_told(&self, words: &str) -> bool {
        let notices = self.world().resource::<Notices>();
        notices.recent(60.0).any(|n| n.text.contains(words))
    }

    fn is_drawn(&self, id: ObjectId) -> bool {
        let entity = self.world().resource::<ObjectMap>().get(id);
        entity.is_some_and(|e| self.world().get::<Mesh3d>(e).is_some())
    }

    fn in_mode(&self, id: &str) -> bool {
        let tools = self.world().resource::<Tools>();
        tools.active().is_some_and(|t| t.id.as_str() == id)
    }

    /// A sheet that is swept upwards, and the frame after it was let go of.
    fn sheet(&mut self) -> ObjectId {
        self.says(Command::Mode(SWEEP));
        let [left, right] = [Vec2::new(560.0, 400.0), Vec2::new(720.0, 400.0)];
        let (down, up) = (Vec2::new(0.0, 60.0), Vec2::new(0.0, -120.0));
        self.drag(MouseButton::Left, left, left + down);
        self.drag(MouseButton::Left, right, right + down);
        self.drag(MouseButton::Left, left, left + up);
        self.drag(MouseButton::Left, right, right + up);
        let (sheet, _) = self.document().objects().next_back().expect("a sheet");
        sheet
    }

    fn status(&self) -> &str {
        &self.world().resource::<Hints>().status
    }
}

#[test]
fn the_panel_of_brush_stays_as_wide_as_it_is() {
    let mut desk = Desk::new();
    desk.says(Command::Mode(BRUSH));
    desk.glide(Vec2::new(800.0, 400.0));
    desk.wait(30);
    let before = desk.right_column();
    for skeleton in BrushSkeleton::ALL {
        desk.says(Settings::command("brush.skeleton", skeleton));
        desk.wait(60);
        // A number that is wider than any before may take some points, once.
        let now = desk.right_column();
        assert!((now - before).abs() < 10.0, "{skeleton:?}: {before}, {now}");
        desk.wait(60);
        assert_eq!(desk.right_column(), now, "{skeleton:?}");
    }
}

#[test]
fn a_polygon_says_how_many_corners_it_needs() {
    let mut desk = Desk::new();
    desk.says(Command::Mode(BRUSH));
    desk.says(Settings::command("brush.skeleton", BrushSkeleton::Polygon));
    let needs = [
        "A polygon with 1 corner: 3 more at least",
        "A polygon with 2 corners: 2 more at least",
        "A polygon with 3 corners: 1 more at least",
        "A polygon with 4 corners",
    ];
    let corners = [(700, 300), (900, 300), (900, 420), (700, 420)];
    for ((x, y), needs) in corners.into_iter().zip(needs) {
        desk.glide(IVec2::new(x, y).as_vec2());
        desk.click();
        assert_eq!(desk.status(), needs);
    }
}

#[test]
fn in_sweep_a_click_selects_what_is_there_and_is_no_way() {
    let mut desk = Desk::new();
    desk.says(Command::Mode(SWEEP));
    let [left, right] = [Vec2::new(560.0, 400.0), Vec2::new(720.0, 400.0)];
    let down = Vec2::new(0.0, 60.0);
    desk.drag(MouseButton::Left, left, left + down);
    desk.drag(MouseButton::Left, right, right + down);
    let draft = |desk: &Desk| desk.world().resource::<Draft>().solo.clone();
    let ready = draft(&desk);
    assert!(matches!(ready, Solo::Ready { .. }), "{ready:?}");
    let around = desk.document().len();
    // Where nothing is.
    desk.glide(Vec2::new(300.0, 200.0));
    desk.click();
    assert_eq!(draft(&desk), ready);
    let up = Vec2::new(0.0, -120.0);
    desk.drag(MouseButton::Left, left, left + up);
    assert!(matches!(draft(&desk), Solo::LeftDrawn { .. }));
    desk.drag(MouseButton::Left, right, right + up);
    desk.settle();
    assert_eq!(desk.document().len(), around + 1, "{:?}", desk.warnings());
    let (sheet, _) = desk.document().objects().next_back().unwrap();
    desk.says(Command::Objects(Ask::SelectNone));
    assert_eq!(desk.selected(), []);
    let ready = draft(&desk);
    let at = desk.hover(sheet);
    desk.glide(at);
    desk.click();
    assert_eq!(desk.selected(), [sheet]);
    assert_eq!(draft(&desk), ready, "and the ends stand where they stood");
}

const PLAIN: Key = Key::Unidentified(NativeKey::Unidentified);

#[test]
fn what_was_swept_is_a_net_until_it_is_seen() {
    let mut desk = Desk::new();
    // Nothing is taken in yet, so that there is something to wait for.
    desk.app.insert_resource(Delivery::Exactly(Vec::new()));
    let sheet = desk.sheet();
    let waits = |desk: &Desk| desk.world().resource::<Wires>().waits();
    desk.wait(30);
    assert!(waits(&desk) && !desk.is_drawn(sheet));
    desk.app.insert_resource(Delivery::AsTheyCome);
    let mut left = 2000;
    while !desk.is_drawn(sheet) {
        assert!(waits(&desk), "nothing of it would be seen");
        desk.frame();
        std::thread::sleep(std::time::Duration::from_millis(1));
        left -= 1;
        assert!(left > 0, "never drawn");
    }
    desk.wait(20);
    assert!(!waits(&desk));
    let world = desk.app.world_mut();
    let mut names = world.query::<&Name>();
    assert!(names.iter(world).all(|n| n.as_str() != "Wires"));
}

#[test]
fn what_would_close_a_surface_is_said_where_it_was_carried() {
    let mut desk = Desk::new();
    let sheet = desk.sheet();
    desk.settle();
    desk.strike(&[(KeyCode::ShiftLeft, Key::Shift), (KeyCode::Digit1, PLAIN)]);
    assert!(desk.in_mode("csg"));
    let hints = desk.world().resource::<Hints>();
    let says = |action| {
        let hint = hints
            .buttons
            .iter()
            .find(|h| h.action == HintKey::Action(action));
        hint.map(|h| h.does.as_str())
    };
    assert_eq!(says(Action::Finish), Some("make it 20.0 mm thick"));
    assert_eq!(says(Action::Cancel), Some("leave it"));
    desk.strike_one(KeyCode::Enter);
    assert_eq!(desk.document().pending(), [(sheet, Op::Union)]);
    assert!(!desk.status().contains("open"), "{}", desk.status());
}

#[test]
fn a_cut_that_takes_nothing_away_is_told() {
    let mut desk = Desk::new();
    let (cube, ball) = (desk.thing("solid/cube"), desk.thing("solid/sphere"));
    for (id, key) in [(cube, KeyCode::KeyU), (ball, KeyCode::KeyM)] {
        desk.hover(id);
        desk.strike(&[(key, PLAIN)]);
    }
    desk.strike_one(KeyCode::Enter);
    assert_eq!(desk.document().len(), 1, "{:?}", desk.warnings());
    assert!(desk.was_told("Sphere takes nothing away"));
    // Where it does, nothing is said.
    let mut desk = Desk::new();
    let (cube, ball) = (desk.thing("solid/cube"), desk.thing("solid/sphere"));
    let placement = desk.document().object(cube).unwrap().placement;
    desk.says(Command::Objects(Ask::Place(vec![(ball, placement)])));
    let pending = vec![(cube, Op::Union), (ball, Op::Subtract)];
    desk.says(Command::Edit(Edit::SetPending { pending }));
    desk.strike_one(KeyCode::Enter);
    assert_eq!(desk.document().len(), 1, "{:?}", desk.warnings());
    assert!(!desk.was_told("takes nothing away"));
}

#[test]
fn what_is_pointed_at_is_carried_where_nothing_is_selected() {
    let mut desk = Desk::new();
    let cube = desk.thing("solid/cube");
    desk.says(Command::Objects(Ask::SelectNone));
    desk.hover(cube);
    desk.strike(&[(KeyCode::ShiftLeft, Key::Shift), (KeyCode::Digit4, PLAIN)]);
    assert!(desk.in_mode("brush"), "{:?}", desk.warnings());
    assert!(desk.was_told("is the volume brush now"));
}

#[test]
fn where_a_press_draws_handles_come_when_they_are_asked_for() {
    let mut desk = Desk::new();
    let cube = desk.thing("solid/cube");
    desk.says(Command::Objects(Ask::Select {
        ids: vec![cube],
        how: midair_studio::objects::How::Set,
    }));
    let stands = desk.stands(cube);
    let at = desk.handle(stands, Vec3::Y);
    let taken = |desk: &mut Desk| {
        desk.glide(at);
        desk.world().resource::<Gizmo>().has_pointer()
    };
    assert!(taken(&mut desk));
    desk.says(Command::Mode(BRUSH));
    assert!(!taken(&mut desk), "a press paints");
    desk.strike(&[(KeyCode::KeyG, PLAIN)]);
    assert!(taken(&mut desk));
    // From one mode that draws into another, too.
    for id in ["sweep", "scaffold", "brush"] {
        desk.says(Command::Mode(ToolId::new(id)));
        assert!(!taken(&mut desk), "asked for elsewhere than in {id}");
        desk.strike(&[(KeyCode::KeyG, PLAIN)]);
        assert!(taken(&mut desk), "{id}");
    }
    desk.says(Command::Mode(ToolId::new("csg")));
    desk.says(Command::Mode(BRUSH));
    assert!(!taken(&mut desk));
}

#[test]
fn a_handle_is_taken_and_let_go_of_where_that_was_within_a_slow_frame() {
    let mut desk = Desk::new();
    let cube = desk.thing("solid/cube");
    desk.hover(cube);
    desk.click();
    let before = desk.stands(cube);
    let at = desk.handle(before, Vec3::Y);
    desk.glide(at);
    let by = Vec2::new(0.0, -80.0);
    // The press, and a way off the handle, in one frame.
    desk.mouse(MouseButton::Left, true);
    desk.cursor(at + by);
    desk.frame();
    assert!(desk.world().resource::<Gizmo>().is_dragged());
    desk.wait(2);
    desk.mouse(MouseButton::Left, false);
    desk.cursor(at + 3.0 * by);
    desk.wait(3);
    let after = desk.stands(cube);
    let lifted = desk.handle(after, Vec3::Y);
    assert!(after.y > before.y + 0.05, "{before}, {after}");
    assert!(lifted.distance(at + by) < 8.0, "{lifted}, {}", at + by);
    assert_eq!(desk.selected(), [cube]);
}

#[test]
fn a_painting_is_as_large_as_what_is_seen_of_it() {
    let mut desk = Desk::new();
    let cube = desk.thing("solid/cube");
    desk.says(Command::Mode(BRUSH));
    desk.hover(cube);
    desk.strike_one(KeyCode::Enter);
    desk.click();
    desk.settle();
    desk.says(Command::Objects(Ask::Select {
        ids: vec![cube],
        how: midair_studio::objects::How::Set,
    }));
    let readouts = &desk.world().resource::<Readouts>().0;
    let size = readouts
        .iter()
        .find(|r| r.text.contains('×'))
        .expect("its size");
    let sides: Vec<f32> = size
        .text
        .split([' ', '×'])
        .filter_map(|w| w.parse().ok())
        .collect();
    // A cube of 400 mm and half of a ball of 30 mm.
    assert!(
        sides.iter().all(|s| (395.0..445.0).contains(s)),
        "{}",
        size.text
    );
}

#[test]
fn undo_that_is_struck_twice_within_a_frame_is_two_steps() {
    let mut desk = Desk::new();
    for what in ["solid/cube", "solid/sphere", "solid/cone"] {
        desk.thing(what);
    }
    desk.glide(Vec2::new(900.0, 200.0));
    desk.key(KeyCode::ControlLeft, Key::Control, true);
    desk.frame();
    for down in [true, false, true, false] {
        desk.key(KeyCode::KeyZ, PLAIN, down);
    }
    desk.frame();
    desk.key(KeyCode::ControlLeft, Key::Control, false);
    desk.wait(3);
    assert_eq!(desk.document().len(), 1);
}
