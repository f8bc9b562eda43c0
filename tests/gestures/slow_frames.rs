//! Frames that take long: what was pressed, and where, counts as if each had its own.

use bevy::input::keyboard::{Key, NativeKey};
use bevy::prelude::*;
use midair_brush::canvas;
use midair_flatscreen::Orbit;
use midair_studio::command::Command;
use midair_studio::objects::Ask;
use midair_studio::settings::{BrushSkeleton, Settings};
use midair_studio::tools::ToolId;

use crate::desk::Desk;

const PLAIN: Key = Key::Unidentified(NativeKey::Unidentified);

impl Desk {
    /// Everything since the last frame is one; then some that take no time.
    fn slow_frame(&mut self) {
        self.frame();
        self.wait(8);
    }

    fn balls(&self) -> usize {
        let objects = self.document().objects();
        objects
            .filter_map(|(_, o)| canvas(o))
            .map(|c| c.strokes.len())
            .sum()
    }
}

#[test]
fn a_box_is_drawn_from_the_press_to_where_the_button_went_up() {
    let mut desk = Desk::new();
    let (a, b) = (desk.thing("solid/cube"), desk.thing("solid/sphere"));
    let far = desk.pixel(desk.stands(a));
    let (low, high) = (far + Vec2::new(-90.0, 160.0), far - Vec2::splat(90.0));
    let away = Vec2::new(700.0, 700.0);
    desk.glide(low);
    desk.mouse(MouseButton::Left, true);
    desk.wait(3);
    // Let go of around one of them, and then on past both.
    desk.cursor(high + Vec2::new(170.0, 0.0));
    desk.mouse(MouseButton::Left, false);
    desk.cursor(away);
    desk.slow_frame();
    assert_eq!(desk.selected(), [a]);
    // The whole of it in one frame.
    desk.says_slowly(Command::Objects(Ask::SelectNone));
    desk.glide(low);
    desk.mouse(MouseButton::Left, true);
    desk.cursor(Vec2::new(1270.0, 60.0));
    desk.mouse(MouseButton::Left, false);
    desk.cursor(away);
    desk.slow_frame();
    assert_eq!(desk.selected(), [a, b]);
}

#[test]
fn the_view_turns_by_what_was_dragged_while_the_button_was_down() {
    let mut desk = Desk::new();
    let turn = |desk: &mut Desk, at_once: bool| -> Orbit {
        desk.strike_one(KeyCode::Home);
        desk.glide(Vec2::new(800.0, 400.0));
        for to in [
            None,
            Some((900.0, 420.0)),
            Some((950.0, 380.0)),
            Some((500.0, 600.0)),
        ] {
            match to {
                None => {
                    // On its way the button is not down yet.
                    desk.cursor(Vec2::new(700.0, 300.0));
                    desk.mouse(MouseButton::Middle, true);
                }
                Some((x, y)) => desk.cursor(Vec2::new(x, y)),
            }
            if to == Some((950.0, 380.0)) {
                desk.mouse(MouseButton::Middle, false);
            }
            if !at_once {
                desk.wait(2);
            }
        }
        desk.slow_frame();
        desk.orbit()
    };
    let slow = turn(&mut desk, true);
    let first = turn(&mut desk, false);
    assert_ne!(first, Orbit::default());
    assert_eq!(slow, first);
}

#[test]
fn the_ring_opens_where_its_key_went_down_and_chooses_where_it_went_up() {
    let mut desk = Desk::new();
    let at = Vec2::new(700.0, 400.0);
    desk.glide(at - Vec2::new(300.0, 0.0));
    // To the ring's place, its key, to the right, its key up, and away to the left.
    desk.cursor(at);
    desk.key(KeyCode::KeyQ, PLAIN, true);
    desk.cursor(at + Vec2::new(90.0, 0.0));
    desk.key(KeyCode::KeyQ, PLAIN, false);
    desk.cursor(at - Vec2::new(200.0, 0.0));
    desk.slow_frame();
    assert_eq!(desk.mode(), "scaffold");
}

#[test]
fn a_panel_is_clicked_where_the_button_went_down() {
    let mut desk = Desk::new();
    desk.open_eyes();
    let brush = desk.button_called("Brush").unwrap().rect.center();
    let sweep = desk.button_called("Sweep").unwrap().rect.center();
    let place = |p: midair_studio::panel::egui::Pos2| Vec2::new(p.x, p.y);
    desk.glide(Vec2::new(700.0, 400.0));
    desk.cursor(place(brush));
    desk.mouse(MouseButton::Left, true);
    desk.mouse(MouseButton::Left, false);
    desk.cursor(place(sweep));
    desk.slow_frame();
    assert_eq!(desk.mode(), "brush");
    // And in the view, although a panel floats where the pointer was and is.
    desk.says_slowly(Command::Mode(ToolId::new("csg")));
    let cube = desk.thing("solid/cube");
    desk.says_slowly(Command::Objects(Ask::SelectNone));
    let at = desk.hover(cube);
    desk.says_slowly(Command::Panel {
        id: "snaps".into(),
        open: true,
    });
    let close = desk.button_called("Close").unwrap().rect.center();
    let panel = place(close) + Vec2::new(0.0, 40.0);
    desk.glide(panel);
    desk.cursor(at);
    desk.mouse(MouseButton::Left, true);
    desk.mouse(MouseButton::Left, false);
    desk.cursor(panel);
    desk.slow_frame();
    assert_eq!(desk.selected(), [cube]);
}

#[test]
fn a_button_that_goes_up_and_down_within_a_frame_was_let_go_of_and_pressed_again() {
    let mut desk = Desk::new();
    desk.says_slowly(Command::Mode(ToolId::new("brush")));
    desk.says_slowly(Settings::command("brush.skeleton", BrushSkeleton::Point));
    let at = Vec2::new(700.0, 400.0);
    desk.glide(at);
    desk.mouse(MouseButton::Left, true);
    desk.wait(3);
    desk.mouse(MouseButton::Left, false);
    desk.cursor(at + Vec2::new(60.0, 0.0));
    desk.mouse(MouseButton::Left, true);
    desk.slow_frame();
    desk.mouse(MouseButton::Left, false);
    desk.slow_frame();
    desk.settle();
    assert_eq!(desk.balls(), 2, "{:?}", desk.warnings());
    // Two whole clicks in one frame, each at its own place.
    for x in [120.0, 180.0] {
        desk.cursor(at + Vec2::new(x, 0.0));
        desk.mouse(MouseButton::Left, true);
        desk.mouse(MouseButton::Left, false);
    }
    desk.slow_frame();
    desk.settle();
    assert_eq!(desk.balls(), 4, "{:?}", desk.warnings());
}

#[test]
fn a_key_that_acts_as_a_button_counts_each_time_it_goes_down() {
    let mut desk = Desk::new();
    desk.glide(Vec2::new(700.0, 400.0));
    // The ruler on, off and on.
    for down in [true, false, true, false, true, false] {
        desk.key(KeyCode::KeyK, PLAIN, down);
    }
    desk.slow_frame();
    let on = |desk: &Desk| desk.world().resource::<midair_studio::ruler::Ruler>().on;
    assert!(on(&desk));
    // Held over from a frame before.
    desk.key(KeyCode::KeyK, PLAIN, true);
    desk.wait(3);
    assert!(!on(&desk));
    desk.key(KeyCode::KeyK, PLAIN, false);
    desk.key(KeyCode::KeyK, PLAIN, true);
    desk.slow_frame();
    assert!(on(&desk));
}

#[test]
fn a_mark_goes_to_what_was_pointed_at_when_its_key_was_struck() {
    let mut desk = Desk::new();
    let (a, b) = (desk.thing("solid/cube"), desk.thing("solid/sphere"));
    desk.says_slowly(Command::Objects(Ask::SelectNone));
    let on_b = desk.hover(b);
    let on_a = desk.hover(a);
    desk.glide(Vec2::new(700.0, 650.0));
    for (at, key) in [(on_a, KeyCode::KeyU), (on_b, KeyCode::KeyM)] {
        desk.cursor(at);
        desk.key(key, PLAIN, true);
        desk.key(key, PLAIN, false);
    }
    desk.cursor(Vec2::new(700.0, 650.0));
    desk.slow_frame();
    use midair_field::Op::{Subtract, Union};
    assert_eq!(desk.document().pending(), [(a, Union), (b, Subtract)]);
}

impl Desk {
    fn says_slowly(&mut self, command: Command) {
        self.app.world_mut().write_message(command);
        self.wait(3);
    }
}
