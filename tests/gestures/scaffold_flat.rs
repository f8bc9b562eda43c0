//! Scaffold with a mouse alone, and with a gamepad alone.

use bevy::input::gamepad::GamepadButton;
use bevy::math::DVec3;
use bevy::prelude::*;
use midair_document::{ConstructionLine, DrawnStroke};
use midair_scaffold::SCAFFOLD;
use midair_studio::command::Command;
use midair_studio::hands::Hands;
use midair_studio::settings::{Draws, Settings};

use crate::desk::Desk;

impl Desk {
    fn asks(&mut self, command: Command) {
        self.app.world_mut().write_message(command);
        self.wait(2);
    }

    fn drawn_lines(&self) -> Vec<ConstructionLine> {
        let all = self.document().objects();
        all.filter_map(|(_, o)| o.line().cloned()).collect()
    }

    fn drawn_strokes(&self) -> Vec<DrawnStroke> {
        let all = self.document().objects();
        all.filter_map(|(_, o)| o.stroke().cloned()).collect()
    }
}

fn drawing() -> Desk {
    let mut desk = Desk::new();
    desk.asks(Command::Mode(SCAFFOLD));
    desk
}

#[test]
fn a_mouse_draws_from_points_and_along_axes() {
    let mut desk = drawing();
    let (a, b) = (Vec3::new(-0.2, 0.0, 0.1), Vec3::new(0.25, 0.0, 0.1));
    let (from, to) = (desk.pixel(a), desk.pixel(b));
    desk.drag(MouseButton::Left, from, to);
    let lines = desk.drawn_lines();
    assert_eq!(lines.len(), 1, "{:?}", desk.warnings());
    assert!(desk.world().resource::<Hands>().pixel > 0.0);
    let end = lines[0].b;
    // Straight up from its end: the pointer is some pixels beside the axis.
    let from = desk.pixel(end.as_vec3());
    let to = desk.pixel((end + DVec3::Y * 0.3).as_vec3()) + Vec2::new(4.0, 0.0);
    desk.drag(MouseButton::Left, from + Vec2::new(2.0, 3.0), to);
    let lines = desk.drawn_lines();
    assert_eq!(lines.len(), 2, "{:?}", desk.warnings());
    assert!(lines[1].a.distance(end) < 1e-9, "{lines:?}");
    let along = (lines[1].b - lines[1].a).normalize();
    assert!(along.cross(DVec3::Y).length() < 1e-6, "{along}");
    assert!((lines[1].b.y - end.y - 0.3).abs() < 0.03, "{lines:?}");
    // Two presses on points join them.
    let far = [lines[0].a, lines[1].b].map(|p| desk.pixel(p.as_vec3()));
    for at in far {
        desk.glide(at);
        desk.click();
    }
    let joined = desk.drawn_lines();
    assert_eq!(joined.len(), 3, "{:?}", desk.warnings());
    assert!(joined[2].a.distance(lines[0].a) < 1e-9 && joined[2].b.distance(lines[1].b) < 1e-9);
    // A stroke along the triangle lies in its plane, though a pointer has no depth.
    desk.asks(Settings::command("scaffold.draws", Draws::Stroke));
    let corners = [lines[0].a, lines[0].b, lines[1].b];
    let start = desk.pixel(corners[0].as_vec3());
    desk.glide(start);
    desk.mouse(MouseButton::Left, true);
    desk.wait(2);
    for corner in [corners[1], corners[2]] {
        let to = desk.pixel(corner.as_vec3());
        desk.glide(to);
    }
    desk.mouse(MouseButton::Left, false);
    desk.wait(3);
    let strokes = desk.drawn_strokes();
    assert_eq!(strokes.len(), 1, "{:?}", desk.warnings());
    let normal = (corners[1] - corners[0])
        .cross(corners[2] - corners[0])
        .normalize();
    for p in &strokes[0].raw {
        assert!((*p - corners[0]).dot(normal).abs() < 0.02, "{p}");
    }
}

#[test]
fn a_gamepad_draws_a_line() {
    let mut desk = drawing();
    desk.plug();
    desk.push(false, Vec2::new(-0.6, 0.3), 20);
    desk.down(GamepadButton::RightTrigger2);
    desk.push(false, Vec2::new(1.0, 0.0), 40);
    desk.up(GamepadButton::RightTrigger2);
    desk.wait(3);
    let lines = desk.drawn_lines();
    assert_eq!(lines.len(), 1, "{:?}", desk.warnings());
    assert!(lines[0].a.distance(lines[0].b) > 0.05);
}

#[test]
fn what_is_drawn_keeps_its_depth_and_a_press_on_one_spot_is_no_stroke() {
    for orthographic in [false, true] {
        let mut desk = drawing();
        desk.asks(Settings::command("look.orthographic", orthographic));
        desk.asks(Settings::command("scaffold.draws", Draws::Stroke));
        // On the ground, where nothing stands.
        let corners = [(-0.3, 0.2), (0.3, 0.25), (0.35, -0.2), (-0.25, -0.25)];
        let corners = corners.map(|(x, z)| desk.pixel(Vec3::new(x, 0.0, z)));
        desk.glide(corners[0]);
        desk.mouse(MouseButton::Left, true);
        desk.wait(40);
        desk.mouse(MouseButton::Left, false);
        desk.wait(3);
        assert_eq!(
            desk.document().objects().count(),
            0,
            "a press on one spot draws nothing"
        );
        desk.mouse(MouseButton::Left, true);
        desk.wait(20);
        for corner in [corners[1], corners[2], corners[3], corners[0]] {
            desk.glide(corner);
        }
        desk.mouse(MouseButton::Left, false);
        desk.wait(3);
        let strokes = desk.drawn_strokes();
        assert_eq!(strokes.len(), 1, "{:?}", desk.warnings());
        let raw = &strokes[0].raw;
        let deep: Vec<f32> = raw.iter().map(|p| desk.seen(p.as_vec3()).z).collect();
        assert!(
            deep.iter().all(|d| (d - deep[0]).abs() < 1e-3),
            "{:?} to {:?} deep, orthographic: {orthographic}",
            deep.first(),
            deep.last()
        );
        assert!(strokes[0].closed, "it ends where it began");
    }
}

#[test]
fn a_loop_with_a_corner_where_it_begins_closes() {
    let mut desk = drawing();
    desk.asks(Settings::command("scaffold.draws", Draws::Stroke));
    let corners = [
        (300, 520),
        (330, 580),
        (420, 600),
        (480, 550),
        (420, 500),
        (340, 490),
        (300, 520),
    ];
    let corners = corners.map(|(x, y)| IVec2::new(x, y).as_vec2());
    desk.glide(corners[0]);
    desk.mouse(MouseButton::Left, true);
    for pair in corners.windows(2) {
        for i in 1..=5 {
            desk.cursor(pair[0].lerp(pair[1], i as f32 / 5.0));
            desk.frame();
        }
    }
    desk.mouse(MouseButton::Left, false);
    desk.wait(3);
    let (id, object) = desk.document().objects().next().expect("a stroke");
    let stroke = object.stroke().expect("a stroke").clone();
    assert!(stroke.closed);
    // Press and first step came in one frame: it begins where it was pressed.
    let first = stroke.raw[0];
    let seen = desk.pixel(first.as_vec3());
    assert!(seen.distance(corners[0]) < 0.5, "{seen}");
    // A press on one spot of it selects it.
    let on = stroke.points()[9].as_vec3();
    let at = desk.pixel(on);
    desk.wait(700);
    desk.settle();
    assert_eq!(desk.selected(), []);
    // It is pointed at from beside it, on whichever side.
    for beside in [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y] {
        desk.asks(Command::Objects(midair_studio::objects::Ask::SelectNone));
        desk.glide(at + 5.0 * beside);
        desk.click();
        assert_eq!(desk.selected(), [id], "{beside}: {:?}", desk.warnings());
        assert_eq!(desk.document().objects().count(), 1, "{beside}");
    }
    // In Assemble too, though it hangs in the air.
    desk.asks(Command::Objects(midair_studio::objects::Ask::SelectNone));
    desk.asks(Command::Mode(midair_studio::tools::ToolId::new("csg")));
    desk.glide(at + Vec2::new(200.0, -150.0));
    desk.glide(at + Vec2::new(0.0, 3.0));
    desk.click();
    assert_eq!(desk.selected(), [id]);
}
