//! The pointer, as in a window: clicks, drags, handles, snaps, the view.

use bevy::input::keyboard::{Key, NativeKey};
use bevy::prelude::*;
use midair_document::ObjectId;
use midair_flatscreen::{Gizmo, Mode, Orbit, Pointer};
use midair_studio::hands::{HandsInput, Side};
use midair_studio::plane::WorkPlane;
use midair_studio::project::{Project, Selection};
use midair_studio::ruler::Ruler;
use midair_studio::settings::Settings;
use midair_studio::snap::own_box;
use midair_studio::world::WorldView;

use crate::desk::Desk;

const PLAIN: Key = Key::Unidentified(NativeKey::Unidentified);

impl Desk {
    /// Where a point of the world is on the screen.
    pub fn pixel(&mut self, at: Vec3) -> Vec2 {
        let world = self.app.world_mut();
        let mut eyes = world.query_filtered::<(&Camera, &Transform), With<Orbit>>();
        let (camera, eye) = eyes.single(world).unwrap();
        let eye = GlobalTransform::from(*eye);
        camera.world_to_viewport(&eye, at).expect("in view")
    }

    pub fn orbit(&mut self) -> Orbit {
        let world = self.app.world_mut();
        *world.query::<&Orbit>().single(world).unwrap()
    }

    /// The pointer goes there in a few frames.
    pub fn glide(&mut self, to: Vec2) {
        let world = self.app.world_mut();
        let mut windows = world.query::<&Window>();
        let from = windows.single(world).unwrap().cursor_position();
        let from = from.filter(|f| f.is_finite()).unwrap_or(to - 20.0);
        for i in 1..=10 {
            self.cursor(from.lerp(to, i as f32 / 10.0));
            self.frame();
        }
        self.wait(2);
    }

    /// One click where the pointer is.
    pub fn click(&mut self) {
        self.presses += 1;
        self.mouse(MouseButton::Left, true);
        self.wait(4);
        self.mouse(MouseButton::Left, false);
        self.wait(3);
    }

    /// Presses here and lets go there.
    pub fn drag(&mut self, button: MouseButton, from: Vec2, to: Vec2) {
        self.glide(from);
        self.presses += 1;
        self.mouse(button, true);
        self.wait(2);
        self.glide(to);
        self.mouse(button, false);
        self.wait(3);
    }

    pub fn hold(&mut self, key: KeyCode, down: bool) {
        self.key(key, PLAIN, down);
        self.frame();
    }

    pub fn selected(&self) -> Vec<ObjectId> {
        self.world().resource::<Selection>().0.clone()
    }

    pub fn stands(&self, id: ObjectId) -> Vec3 {
        self.document().object(id).unwrap().placement.translation
    }

    pub fn steps(&self) -> usize {
        self.world().resource::<Project>().history().undo_len()
    }

    /// Moves the pointer over a place of an object where it is the first that is met.
    pub fn hover(&mut self, id: ObjectId) -> Vec2 {
        let project = self.world().resource::<Project>();
        let object = self.document().object(id).unwrap();
        let (low, high) = own_box(project, object).unwrap();
        let affine = object.placement.affine();
        for t in [
            Vec3::splat(0.5),
            Vec3::new(0.5, 0.3, 0.5),
            Vec3::new(0.5, 0.15, 0.5),
            Vec3::new(0.3, 0.4, 0.8),
            Vec3::new(0.8, 0.4, 0.8),
            Vec3::new(0.5, 0.9, 0.5),
            Vec3::new(0.15, 0.8, 0.9),
            Vec3::new(0.85, 0.8, 0.9),
        ] {
            let at = self.pixel(affine.transform_point3(low + t * (high - low)));
            self.glide(at);
            if self.touched(Side::Right) == Some(id) {
                return at;
            }
        }
        panic!("{id} is nowhere seen");
    }

    /// A component on the ground, by the library's own command.
    pub fn thing(&mut self, component: &str) -> ObjectId {
        if !self.is_open("library") {
            self.strike_one(KeyCode::KeyL);
        }
        let world = self.app.world_mut();
        world.resource_mut::<Pointer>().pick(component.to_owned());
        self.settle();
        let last = self.document().objects().map(|(id, _)| id).next_back();
        last.expect("it is there")
    }

    /// Where a handle of the gizmo is to be taken.
    pub fn handle(&mut self, pivot: Vec3, axis: Vec3) -> Vec2 {
        let eye = self.orbit().transform().translation;
        self.pixel(pivot + axis * (0.6 * 0.12 * pivot.distance(eye)))
    }
}

#[test]
fn a_click_selects_shift_adds_nothing_clears_and_a_box_takes_all() {
    let mut desk = Desk::new();
    let (a, b) = (desk.thing("solid/cube"), desk.thing("solid/sphere"));
    desk.hover(a);
    desk.click();
    assert_eq!(desk.selected(), [a]);
    desk.hover(b);
    desk.hold(KeyCode::ShiftLeft, true);
    desk.click();
    desk.hold(KeyCode::ShiftLeft, false);
    assert_eq!(desk.selected(), [a, b]);
    let steps = desk.steps();
    let nothing = desk.pixel(Vec3::new(0.0, 0.0, 0.6));
    desk.glide(nothing);
    desk.click();
    assert_eq!(desk.selected(), []);
    let far = desk.pixel(Vec3::new(0.6, 0.3, -0.6));
    let near = Vec2::new(300.0, 640.0);
    desk.drag(MouseButton::Left, near, Vec2::new(1270.0, far.y.min(60.0)));
    assert_eq!(desk.selected().len(), 2, "from {near} to {far}");
    assert_eq!(desk.steps(), steps, "selecting is no step");
}

#[test]
fn a_handle_moves_all_that_is_selected_in_one_step_and_escape_puts_it_back() {
    let mut desk = Desk::new();
    let (a, b) = (desk.thing("solid/cube"), desk.thing("solid/sphere"));
    desk.strike(&[(KeyCode::ControlLeft, Key::Control), (KeyCode::KeyA, PLAIN)]);
    assert_eq!(desk.selected(), [a, b]);
    let before = [desk.stands(a), desk.stands(b)];
    let steps = desk.steps();
    let boxes = desk.world().resource::<Selection>().clone();
    let drafts = midair_studio::show::Drafts::default();
    let project = desk.world().resource::<Project>();
    let (low, high) = midair_studio::ruler::selected_box(project, &boxes, &drafts).unwrap();
    let pivot = low.midpoint(high);
    let grip = desk.handle(pivot, Vec3::Y);
    let up = desk.handle(pivot + 0.2 * Vec3::Y, Vec3::Y);
    desk.drag(MouseButton::Left, grip, up);
    for (id, from) in [a, b].into_iter().zip(before) {
        let by = desk.stands(id) - from;
        assert!(
            (by.y - 0.2).abs() < 0.03 && by.with_y(0.0).length() < 1e-4,
            "{by}"
        );
    }
    assert_eq!(desk.steps(), steps + 1);
    // Given up in the middle of it.
    let there = desk.stands(a);
    let grip = desk.handle(pivot + (there.y - before[0].y) * Vec3::Y, Vec3::Y);
    desk.glide(grip);
    desk.mouse(MouseButton::Left, true);
    desk.wait(2);
    assert!(desk.world().resource::<Gizmo>().is_dragged());
    desk.glide(grip + Vec2::new(0.0, 80.0));
    desk.strike_one(KeyCode::Escape);
    desk.mouse(MouseButton::Left, false);
    desk.wait(3);
    assert_eq!(desk.stands(a), there);
    assert_eq!(desk.steps(), steps + 1);
    desk.strike(&[(KeyCode::ControlLeft, Key::Control), (KeyCode::KeyZ, PLAIN)]);
    assert_eq!([desk.stands(a), desk.stands(b)], before);
}

#[test]
fn handles_turn_in_steps_and_scale() {
    let mut desk = Desk::new();
    let a = desk.thing("solid/cube");
    desk.app
        .world_mut()
        .write_message(Settings::command("snap.angle.on", true));
    desk.hover(a);
    desk.click();
    desk.strike_one(KeyCode::KeyT);
    assert_eq!(desk.world().resource::<Gizmo>().mode, Some(Mode::Turn));
    let pivot = desk.stands(a);
    let eye = desk.orbit().transform().translation;
    let ring = 0.12 * pivot.distance(eye);
    let at = |degrees: f32| pivot + Quat::from_rotation_y(degrees.to_radians()) * Vec3::X * ring;
    let (from, to) = (desk.pixel(at(-60.0)), desk.pixel(at(-29.0)));
    desk.drag(MouseButton::Left, from, to);
    let turned = desk.document().object(a).unwrap().placement.rotation;
    let wanted = Quat::from_rotation_y(30_f32.to_radians());
    assert!(turned.angle_between(wanted) < 1e-3, "{turned}");
    desk.strike_one(KeyCode::KeyY);
    let (from, to) = (
        desk.pixel(pivot),
        desk.pixel(pivot) + Vec2::new(40.0, -40.0),
    );
    desk.drag(MouseButton::Left, from, to);
    let scale = desk.document().object(a).unwrap().placement.scale;
    assert!(
        scale.x > 1.2 && scale.x == scale.y && scale.y == scale.z,
        "{scale}"
    );
}

#[test]
fn a_drag_snaps_to_the_surface_below_unless_that_is_held_off() {
    let mut desk = Desk::new();
    let a = desk.thing("solid/cube");
    desk.app
        .world_mut()
        .write_message(Settings::command("snap.surface.on", true));
    let ground = desk.stands(a).y;
    let from = desk.hover(a);
    let hand = desk.hand(Side::Right);
    let lifted = desk.pixel(hand + 0.02 * Vec3::Y);
    desk.drag(MouseButton::Left, from, lifted);
    assert!(
        (desk.stands(a).y - ground).abs() < 1e-4,
        "{}",
        desk.stands(a)
    );
    let from = desk.hover(a);
    let hand = desk.hand(Side::Right);
    let lifted = desk.pixel(hand + 0.02 * Vec3::Y);
    desk.hold(KeyCode::ControlLeft, true);
    desk.drag(MouseButton::Left, from, lifted);
    desk.hold(KeyCode::ControlLeft, false);
    assert!(desk.stands(a).y - ground > 0.01, "{}", desk.stands(a));
}

#[test]
fn a_drag_along_the_work_plane_keeps_its_height() {
    let mut desk = Desk::new();
    let a = desk.thing("solid/cube");
    desk.strike_one(KeyCode::KeyP);
    assert!(desk.world().resource::<WorkPlane>().shown);
    let from = desk.hover(a);
    let hand = desk.hand(Side::Right);
    let before = desk.stands(a);
    let by = Vec3::new(-0.15, 0.0, 0.25);
    let to = desk.pixel(hand + by);
    desk.drag(MouseButton::Left, from, to);
    let moved = desk.stands(a) - before;
    assert!(moved.distance(by) < 5e-3, "{moved}");
}

#[test]
fn a_pointer_that_is_nowhere_moves_nothing() {
    let mut desk = Desk::new();
    let a = desk.thing("solid/cube");
    let from = desk.hover(a);
    desk.mouse(MouseButton::Left, true);
    desk.wait(2);
    desk.glide(from + Vec2::new(30.0, 0.0));
    let held = desk.hand(Side::Right);
    for nowhere in [None, Some(Vec2::NAN), Some(Vec2::INFINITY)] {
        desk.leave(nowhere);
        desk.wait(3);
        assert_eq!(desk.hand(Side::Right), held, "{nowhere:?}");
    }
    desk.mouse(MouseButton::Left, false);
    desk.wait(3);
    assert!(desk.stands(a).is_finite());
    let view = desk.orbit();
    desk.mouse(MouseButton::Middle, true);
    desk.wait(2);
    desk.leave(Some(Vec2::NAN));
    desk.wait(3);
    desk.mouse(MouseButton::Middle, false);
    desk.wait(2);
    assert_eq!(desk.orbit(), view);
    desk.resize(200.0, 100.0);
    desk.wait(5);
    for at in [Vec2::new(100.0, 50.0), Vec2::new(199.0, 99.0), Vec2::ZERO] {
        desk.glide(at);
        desk.click();
        desk.drag(MouseButton::Middle, at, Vec2::new(20.0, 80.0));
    }
    assert!(desk.orbit().transform().is_finite());
}

#[test]
fn the_view_flies_looks_from_the_sides_and_comes_home() {
    let mut desk = Desk::new();
    let first = desk.orbit();
    desk.glide(Vec2::new(800.0, 400.0));
    desk.mouse(MouseButton::Right, true);
    desk.wait(2);
    desk.hold(KeyCode::KeyW, true);
    desk.wait(40);
    desk.hold(KeyCode::KeyW, false);
    desk.mouse(MouseButton::Right, false);
    desk.wait(2);
    let ahead = *first.transform().forward();
    let flown = (desk.orbit().focus - first.focus).dot(ahead);
    assert!(flown > 0.3, "{flown}");
    desk.strike(&[(KeyCode::AltLeft, Key::Alt), (KeyCode::Digit7, PLAIN)]);
    assert!(desk.orbit().transform().forward().distance(Vec3::NEG_Y) < 1e-3);
    desk.strike_one(KeyCode::Home);
    assert_eq!(desk.orbit(), first);
}

#[test]
fn both_grips_on_nothing_scale_the_world_and_a_key_puts_it_back() {
    let mut desk = Desk::new();
    let ground = desk.pixel(Vec3::new(0.2, 0.0, 0.2));
    desk.glide(ground);
    let first = desk.orbit();
    desk.strike_one(KeyCode::KeyS);
    desk.glide(ground + Vec2::new(180.0, 0.0));
    let world = *desk.world().resource::<WorldView>();
    assert!(world.is_held());
    assert!((world.scale() - 2.0).abs() < 0.05, "{}", world.scale());
    desk.click();
    let scaled = desk.orbit();
    assert!((scaled.distance / first.distance - 0.5).abs() < 0.03);
    let metres = desk.world().resource::<HandsInput>().metres_per_world;
    assert!((metres - 2.0).abs() < 0.1, "{metres}");
    desk.strike(&[(KeyCode::ShiftLeft, Key::Shift), (KeyCode::Home, PLAIN)]);
    desk.wait(3);
    assert_eq!(desk.world().resource::<WorldView>().scale(), 1.0);
    assert!((desk.orbit().distance - first.distance).abs() < 1e-3);
    assert!(desk.orbit().focus.distance(first.focus) < 1e-2);
}

#[test]
fn the_ruler_measures_between_two_clicks() {
    let mut desk = Desk::new();
    desk.strike_one(KeyCode::KeyK);
    for x in [0.0, 0.3] {
        let at = desk.pixel(Vec3::new(x, 0.0, 0.2));
        desk.glide(at);
        desk.click();
    }
    let (a, b) = desk.world().resource::<Ruler>().ends().unwrap();
    assert!((a.distance(b) - 0.3).abs() < 5e-3);
    desk.strike_one(KeyCode::Escape);
    assert_eq!(desk.world().resource::<Ruler>().ends(), None);
}

#[test]
fn what_is_opened_is_in_view_and_what_is_new_begins_at_the_start() {
    let mut desk = Desk::new();
    let start = desk.seen(Vec3::ZERO);
    // A document of which nothing stands where one looks at first.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("far.midair");
    let mut document = midair_document::Document::new();
    {
        let mut history =
            midair_document::History::new(document, midair_document::MeshStore::new());
        let shelf = desk.world().resource::<midair_studio::project::Shelf>();
        let cube = shelf.library.get("solid/cube").unwrap().placed();
        let at = midair_field::Placement::at(Vec3::new(7.0, 3.0, -5.0));
        let object = midair_document::Object::solid("far", cube).placed(at);
        history.add(object).unwrap();
        document = history.document().clone();
    }
    midair_document::save(&file, &document, &midair_document::MeshStore::new()).unwrap();
    desk.app
        .world_mut()
        .write_message(midair_studio::command::Command::Open(file));
    desk.settle();
    assert_eq!(desk.document().len(), 1, "{:?}", desk.warnings());
    let seen = desk.seen(Vec3::new(7.0, 3.0, -5.0));
    assert!(seen.truncate().length() < 0.1 * seen.z, "{seen}");
    assert!((0.2..3.0).contains(&seen.z), "{seen}");
    desk.app
        .world_mut()
        .write_message(midair_studio::command::Command::New);
    desk.settle();
    assert!(desk.seen(Vec3::ZERO).distance(start) < 1e-3);
}
