//! What a newcomer does by mouse with what the documents promise.

use bevy::prelude::*;
use midair_studio::tools::Tools;

use crate::desk::Desk;

impl Desk {
    /// The middle of a button, in pixels of the window.
    fn place_of(&mut self, button: &str) -> Vec2 {
        let seen = self.button_called(button);
        let at = seen.expect("it is to be seen").rect.center();
        Vec2::new(at.x, at.y)
    }
}

#[test]
fn what_is_dragged_onto_a_modes_button_is_carried_into_it() {
    let mut desk = Desk::new();
    desk.open_eyes();
    let cube = desk.thing("solid/cube");
    let (stood, steps) = (desk.stands(cube), desk.steps());
    let from = desk.hover(cube);
    let to = desk.place_of("Brush");
    desk.drag(MouseButton::Left, from, to);
    desk.wait(4);
    let tools = desk.world().resource::<Tools>();
    assert_eq!(tools.active().map(|t| t.id.as_str()), Some("brush"));
    assert_eq!(desk.stands(cube), stood, "it goes back to where it stood");
    assert_eq!(desk.steps(), steps, "{:?}", desk.warnings());
}

#[test]
fn what_is_let_go_of_over_another_panel_is_put_down_as_it_was_dragged() {
    let mut desk = Desk::new();
    desk.open_eyes();
    let cube = desk.thing("solid/cube");
    let (stood, steps) = (desk.stands(cube), desk.steps());
    let from = desk.hover(cube);
    desk.drag(MouseButton::Left, from, Vec2::new(120.0, 400.0));
    desk.wait(4);
    assert_eq!(desk.steps(), steps + 1);
    let moved = desk.stands(cube);
    let at = desk.pixel(moved);
    assert!(at.x < 300.0, "under the pointer: {stood}, {moved}, {at}");
}
