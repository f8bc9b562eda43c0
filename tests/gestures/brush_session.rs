//! A figure of two parts, painted by mouse alone and by gamepad alone, recorded and played back.

use std::path::Path;

use bevy::input::gamepad::GamepadButton as Button;
use bevy::prelude::*;
use midair::{Stage, probe};
use midair_brush::{BRUSH, canvas};
use midair_mesh::check;
use midair_playback::{PlayOptions, PlayerPlugin, Session, play};
use midair_solid::Solid;
use midair_studio::command::Command;
use midair_studio::project::{Begin, Places, Project};
use midair_studio::settings::Settings;

use crate::desk::Desk;

impl Desk {
    /// As the mode's button on the bar asks.
    fn take_brush(&mut self) {
        self.app.world_mut().write_message(Command::Mode(BRUSH));
        self.wait(3);
    }

    fn strokes(&self) -> usize {
        let (_, object) = self.document().objects().next().expect("a painting");
        canvas(object).expect("a painting").strokes.len()
    }
}

#[test]
fn a_figure_by_mouse_alone_plays_back_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("figure.ron");
    let mut desk = Desk::recorded(&recording, "A figure, by mouse");
    desk.take_brush();
    let radius = |d: &Desk| d.world().resource::<Settings>().brush.radius;
    let before = radius(&desk);
    // On the work plane: a body led along it, a head beside its end.
    desk.strike_one(KeyCode::KeyP);
    let (from, to) = (Vec3::new(0.0, 0.0, 0.2), Vec3::new(0.3, 0.0, 0.0));
    let [a, b] = [from, to].map(|p| desk.pixel(p));
    desk.drag(MouseButton::Left, a, b);
    desk.settle();
    assert_eq!(desk.strokes(), 1);
    desk.strike_one(KeyCode::ArrowUp);
    assert!(radius(&desk) > before);
    let head = desk.pixel(Vec3::new(0.33, 0.0, -0.02));
    desk.glide(head);
    desk.click();
    desk.settle();
    assert_eq!(desk.strokes(), 2);
    let on = desk.pixel(Vec3::new(0.15, 0.02, 0.1));
    desk.glide(on);
    desk.wait(2);
    desk.strike_one(KeyCode::KeyE);
    desk.settle();
    let report = desk.plays_back(&recording, 1);
    assert_eq!(report.pieces, 1);
}

#[test]
fn the_wheel_with_ctrl_sizes_the_brush_and_x_erases() {
    use bevy::input::mouse::{MouseScrollUnit, MouseWheel};
    let mut desk = Desk::new();
    desk.take_brush();
    let brush = |d: &Desk| d.world().resource::<Settings>().brush.clone();
    let before = brush(&desk).radius;
    let at = desk.pixel(Vec3::ZERO);
    desk.glide(at);
    desk.hold(KeyCode::ControlLeft, true);
    desk.wait(2);
    let window = desk
        .app
        .world_mut()
        .query_filtered::<Entity, With<bevy::window::PrimaryWindow>>()
        .single(desk.app.world())
        .unwrap();
    desk.app.world_mut().write_message(MouseWheel {
        unit: MouseScrollUnit::Line,
        x: 0.0,
        y: 3.0,
        window,
        phase: bevy::input::touch::TouchPhase::Moved,
    });
    desk.wait(12);
    desk.hold(KeyCode::ControlLeft, false);
    desk.wait(2);
    let grown = brush(&desk).radius / before;
    assert!(
        (1.3..1.5).contains(&grown),
        "three lines, three presses: {grown}"
    );
    desk.strike_one(KeyCode::KeyX);
    assert!(brush(&desk).erase);
    desk.strike_one(KeyCode::KeyX);
    assert!(!brush(&desk).erase);
}

#[test]
fn a_figure_by_gamepad_alone_plays_back_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("figure.ron");
    let mut desk = Desk::recorded(&recording, "A figure, by gamepad");
    desk.plug();
    desk.take_brush();
    // A line from end to end, dragged.
    desk.tap(Button::DPadRight);
    desk.aim(Vec3::new(-0.1, 0.2, 0.0));
    desk.down(Button::RightTrigger2);
    desk.aim(Vec3::new(0.2, 0.3, 0.0));
    desk.up(Button::RightTrigger2);
    desk.settle();
    assert_eq!(desk.strokes(), 1);
    // A head.
    desk.tap(Button::DPadLeft);
    desk.tap(Button::DPadUp);
    desk.aim(Vec3::new(0.22, 0.32, 0.0));
    desk.tap(Button::RightTrigger2);
    desk.settle();
    assert_eq!(desk.strokes(), 2);
    desk.point(Vec3::new(0.05, 0.26, 0.0));
    desk.tap(Button::Select);
    desk.settle();
    let report = desk.plays_back(&recording, 1);
    assert_eq!(report.pieces, 1);
}

#[test]
fn by_gamepad_a_stroke_is_changed_later_and_erased_from() {
    let mut desk = Desk::new();
    desk.plug();
    desk.take_brush();
    for x in [-0.15, 0.15] {
        desk.aim(Vec3::new(x, 0.2, 0.0));
        desk.tap(Button::RightTrigger2);
        desk.settle();
    }
    let strokes = |d: &Desk| {
        let (_, object) = d.document().objects().next().expect("a painting");
        canvas(object).expect("a painting").strokes.clone()
    };
    let before = strokes(&desk);
    assert_eq!(before.len(), 2);
    // Finish on it selects it; the trigger drags it, the cross resizes and weighs it.
    desk.point(Vec3::new(0.15, 0.2, 0.0));
    desk.tap(Button::South);
    let selected = |d: &Desk| d.world().resource::<midair_brush::Easel>().selected;
    assert_eq!(selected(&desk), Some(1));
    desk.down(Button::RightTrigger2);
    desk.aim(Vec3::new(0.15, 0.35, 0.0));
    desk.up(Button::RightTrigger2);
    desk.settle();
    let moved = strokes(&desk)[1].placement.translation - before[1].placement.translation;
    assert!(moved.y > 0.1, "{moved}");
    desk.tap(Button::DPadUp);
    desk.tap(Button::DPadRight);
    let changed = &strokes(&desk)[1];
    assert!(changed.placement.scale.x > 1.1 && changed.weight > 1.1 * before[1].weight);
    for _ in 0..2 {
        desk.tap(Button::RightThumb);
    }
    desk.settle();
    assert_eq!(strokes(&desk), before[..1]);
    assert_eq!(selected(&desk), None);
    // A held turns the trigger around.
    desk.aim(Vec3::new(-0.15, 0.22, 0.0));
    desk.down(Button::South);
    desk.tap(Button::RightTrigger2);
    desk.up(Button::South);
    desk.settle();
    assert_eq!(strokes(&desk).len(), 2);
    assert!(strokes(&desk)[1].erase);
}

/// 3DBrushVR Fig. 6, at the scale of its Fig. 4.
#[test]
fn the_sagittarius_is_one_closed_piece() {
    let session = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/assets/sessions/sagittarius.ron"
    );
    let home = tempfile::tempdir().unwrap();
    let mut player = midair::app(Stage::Bare, Places::below(home.path()), Begin::default());
    player.add_plugins(PlayerPlugin);
    let options = PlayOptions {
        probe,
        ..PlayOptions::default()
    };
    let report = play(
        &mut player,
        Session::load(Path::new(session)).unwrap(),
        options,
    )
    .unwrap();
    assert_eq!(report.objects.len(), 1);
    let document = player.world().resource::<Project>().document();
    let (_, object) = document.objects().next().unwrap();
    let go = std::sync::atomic::AtomicBool::new(false);
    let recipe = object.recipe().unwrap();
    let made = Solid::make(recipe, &object.placement, document.step(), &(), &go).unwrap();
    let report = check(&made.mesh());
    assert!(report.is_faultless(), "{:?}", report.faults());
    assert_eq!(report.pieces, 1);
    assert!(report.triangles > 110_000, "{}", report.triangles);
}
