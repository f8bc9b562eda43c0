//! Snapping and selecting by the surface of things, not by their boxes; the view without perspective;
//! a monitor that goes away.

use bevy::prelude::*;
use bevy::window::{Monitor, OnMonitor, PrimaryWindow, WindowPosition};
use midair_document::ObjectId;
use midair_field::Placement;
use midair_studio::command::Command;
use midair_studio::hands::Side;
use midair_studio::notice::Notices;
use midair_studio::objects::Ask;
use midair_studio::project::Project;
use midair_studio::settings::Settings;
use midair_studio::snap::own_box;

use crate::desk::Desk;

fn put(desk: &mut Desk, id: ObjectId, to: Placement) {
    let ask = Command::Objects(Ask::Place(vec![(id, to)]));
    desk.app.world_mut().write_message(ask);
    desk.settle();
    desk.wait(6);
}

#[test]
fn a_box_drawn_in_the_hole_of_a_ring_selects_no_ring() {
    let mut desk = Desk::new();
    let ring = desk.thing("solid/torus");
    desk.app
        .world_mut()
        .write_message(Settings::command("preview.on", false));
    put(&mut desk, ring, Placement::at(Vec3::Y * 0.2));
    // From above, into its hole.
    desk.hold(KeyCode::AltLeft, true);
    desk.strike_one(KeyCode::Digit7);
    desk.hold(KeyCode::AltLeft, false);
    desk.wait(4);
    let project = desk.world().resource::<Project>();
    let object = desk.document().object(ring).unwrap();
    let (low, high) = own_box(project, object).unwrap();
    let inside = 0.15 * (high.x - low.x);
    let middle = desk.pixel(Vec3::Y * 0.2);
    let edge = desk.pixel(Vec3::new(inside, 0.2, 0.0));
    let half = (edge - middle).length();
    desk.app
        .world_mut()
        .write_message(Command::Objects(Ask::SelectNone));
    desk.wait(2);
    desk.drag(MouseButton::Left, middle - 0.7 * half, middle + 0.7 * half);
    assert_eq!(desk.selected(), [], "the hole is nothing");
    // A little larger, and the ring itself is touched.
    let out = desk.pixel(Vec3::new(0.6 * high.x, 0.2, 0.0));
    let reach = (out - middle).length();
    desk.drag(
        MouseButton::Left,
        middle,
        middle + Vec2::new(reach * 1.6, reach * 0.2),
    );
    assert_eq!(desk.selected(), [ring]);
}

#[test]
fn without_perspective_a_drag_keeps_what_is_dragged_under_the_pointer() {
    let mut desk = Desk::new();
    let cube = desk.thing("solid/cube");
    desk.hold(KeyCode::ShiftLeft, true);
    desk.strike_one(KeyCode::KeyO);
    desk.hold(KeyCode::ShiftLeft, false);
    desk.wait(4);
    assert!(desk.world().resource::<Settings>().look.orthographic);
    let world = desk.app.world_mut();
    let mut cameras = world.query_filtered::<&Projection, With<midair_flatscreen::Orbit>>();
    assert!(matches!(
        cameras.single(world).unwrap(),
        Projection::Orthographic(_)
    ));
    let before = desk.stands(cube);
    let start = desk.hover(cube);
    let held = desk.hand(Side::Right);
    desk.mouse(MouseButton::Left, true);
    desk.wait(3);
    desk.glide(start + Vec2::new(60.0, 0.0));
    let now = desk.hand(Side::Right);
    let seen = desk.pixel(now);
    assert!(seen.distance(start + Vec2::new(60.0, 0.0)) < 2.0, "{seen}");
    // Across the view, and not towards it or away.
    let depths = [held, now].map(|at| desk.seen(at).z);
    assert!((depths[0] - depths[1]).abs() < 5e-3, "{depths:?}");
    desk.mouse(MouseButton::Left, false);
    desk.wait(3);
    assert!(desk.stands(cube).distance(before) > 0.02);
    // As large far away as near: two points a metre apart in depth.
    let size = |desk: &mut Desk, z: f32| {
        let orbit = desk.orbit().transform();
        let at = orbit.translation + *orbit.forward() * z;
        desk.pixel(at + *orbit.right() * 0.1)
            .distance(desk.pixel(at))
    };
    let (near, far) = (size(&mut desk, 1.0), size(&mut desk, 3.0));
    assert!((near - far).abs() < 0.1, "{near} {far}");
}

#[test]
fn with_perspective_too_the_first_move_of_a_drag_keeps_the_depth() {
    let mut desk = Desk::new();
    let cube = desk.thing("solid/cube");
    let start = desk.hover(cube);
    let held = desk.hand(Side::Right);
    desk.mouse(MouseButton::Left, true);
    desk.wait(3);
    desk.glide(start + Vec2::new(40.0, 0.0));
    let now = desk.hand(Side::Right);
    let depths = [held, now].map(|at| desk.seen(at).z);
    desk.mouse(MouseButton::Left, false);
    desk.wait(2);
    assert!((depths[0] - depths[1]).abs() < 2e-3, "{depths:?}");
}

#[test]
fn a_ball_comes_to_rest_on_what_it_touches_and_not_on_its_box() {
    let mut desk = Desk::new();
    for (key, on) in [("snap.surface.on", true), ("snap.grid.on", false)] {
        desk.app
            .world_mut()
            .write_message(Settings::command(key, on));
    }
    let (plate, ball) = (desk.thing("solid/cube"), desk.thing("solid/sphere"));
    let project = desk.world().resource::<Project>();
    let of = |id| own_box(project, desk.document().object(id).unwrap()).unwrap();
    let ((_, top), (_, high)) = (of(plate), of(ball));
    let radius = high.y;
    // A plate 20 mm high, whose edge lies under the rim of the ball's box and not under the ball.
    let flat = Placement {
        scale: Vec3::new(1.0, 0.01 / top.y, 1.0),
        ..Placement::at(Vec3::new(0.0, 0.01, 0.0))
    };
    put(&mut desk, plate, flat);
    let beside = Vec3::new(top.x + 0.7 * radius, radius + 0.012, 0.0);
    put(&mut desk, ball, Placement::at(beside + Vec3::Y * 0.3));
    // By the handle that moves it straight down.
    desk.hover(ball);
    desk.click();
    let pivot = desk.stands(ball);
    let from = desk.handle(pivot, Vec3::Y);
    let to = desk.handle(beside, Vec3::Y);
    desk.drag(MouseButton::Left, from, to);
    let rests = desk.stands(ball).y;
    assert!((rests - radius).abs() < 4e-3, "{rests} is not {radius}");
}

#[test]
fn a_monitor_that_is_unplugged_takes_no_window_with_it() {
    let mut desk = Desk::new();
    let monitor = |x: i32| Monitor {
        name: None,
        physical_height: 1080,
        physical_width: 1920,
        physical_position: IVec2::new(x, 0),
        refresh_rate_millihertz: None,
        scale_factor: 1.0,
        video_modes: Vec::new(),
    };
    let world = desk.app.world_mut();
    let (left, right) = (
        world.spawn(monitor(0)).id(),
        world.spawn(monitor(1920)).id(),
    );
    let mut windows = world.query_filtered::<Entity, With<PrimaryWindow>>();
    let window = windows.single(world).unwrap();
    let mut shown = world.get_mut::<Window>(window).unwrap();
    shown.position = WindowPosition::At(IVec2::new(2100, 100));
    world.entity_mut(window).insert(OnMonitor(right));
    desk.wait(2);
    desk.app.world_mut().despawn(right);
    desk.wait(2);
    let at = desk
        .app
        .world()
        .get::<Window>(window)
        .expect("the window goes on")
        .position;
    assert_eq!(at, WindowPosition::At(IVec2::splat(50)));
    let said = |desk: &Desk, text: &str| {
        let notices = desk.world().resource::<Notices>();
        notices.recent(1e9).any(|n| n.text.contains(text))
    };
    assert!(said(&desk, "on the one that is left"));
    desk.app.world_mut().despawn(left);
    desk.wait(2);
    assert!(desk.app.world().get::<Window>(window).is_some());
    assert!(said(&desk, "last monitor"));
}
